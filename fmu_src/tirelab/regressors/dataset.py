"""The data with which every set of effects is compared: all recordings, averaged over blocks (see `experiment`).

All comparisons are made in units of the noise of the averaged misfit.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray
from radialtire import CATALOGUE, CHANNELS, Channel, TireModel
from radialtire.effect import PLACES
from radialtire.model import READING_NOISE

from ..preprocessing.noise import Noise, resting
from ..preprocessing.samples import Recorded
from ..simulation.kept_stages import KeptStages
from ..simulation.simulate import SmoothedMotion, elastic_stage, simulate, smoothed_motion
from .experiment import Experiment, experiment_in_blocks, read_anew, read_motion

__all__ = ["BLOCKS", "Dataset", "Experiment", "Samples", "Scales", "arranged", "dataset_of", "samples_of"]

FloatArray = NDArray[np.float64]
BoolArray = NDArray[np.bool_]


@dataclass(frozen=True)
class Scales:
    """The scales of the recordings, by which priors are scaled; all positive.

    force [N]: peak, of a part without air beside its preload; travel [m]: span of the tire's own deflection, which
    begins beyond the gap of a part; duration [s]: of the
    longest recording; interval [s]: between samples; rate [m/s], acceleration [m/s^2]: root mean squares over the
    counted blocks; gauge [m]: noise of the deflection reading; channels: level of each channel in its SI unit, by its
    name
    """

    force: float
    travel: float
    duration: float
    interval: float
    rate: float
    acceleration: float
    gauge: float
    channels: Mapping[str, float] = field(default_factory=dict)

    def of(self, scale: str) -> float:
        """Return the size that a prior's `scale` names, such as "force/travel"."""
        above, _, below = scale.partition("/")
        return self._size(above) / self._size(below or "1")

    def _size(self, name: str) -> float:
        if name in self.channels:
            return self.channels[name]
        return 1.0 if name == "1" else float(getattr(self, name))


BLOCKS = 4000
"""Number of blocks of all recordings together, where the motion allows it; signatures and fits cost in proportion."""

MOST_BLOCKS = 40_000
"""Budget: most blocks of all recordings together, even if the motion needs shorter ones."""

LARGEST = 0.999
"""Quantile of the sizes of all forces that is their scale: a single false reading is no load."""

STEPS_LEFT = 0.3
"""Part of a gauge's steps that remains in the deflection after the steps are removed; averaging does not reduce it,
because it is smooth over a step."""


@dataclass(frozen=True)
class Dataset:
    """All recordings of a diagnosis and the baseline tire; stages: of simulations of the same motions, if there are."""

    experiments: tuple[Experiment, ...]
    tire: TireModel
    scales: Scales
    stages: tuple[KeptStages, ...] | None = None

    @cached_property
    def misfit(self) -> FloatArray:
        """Misfit of the baseline tire in units of the noise, all counted blocks in a row (m,)."""
        return self.stacked([e.misfit for e in self.experiments])

    @property
    def rounding_error(self) -> float:
        """Root mean square, in units of the noise, of the rounding errors that neighbouring blocks have in common:
        those of the deflection's steps, and those of a force that rests on a step.
        """
        count = np.array([e.counts.sum() for e in self.experiments])
        left = [np.hypot(STEPS_LEFT * e.floor.steps, e.resting) / e.noise for e in self.experiments]
        return float(np.sqrt(count @ np.square(left) / max(int(count.sum()), 1)))

    @property
    def load(self) -> float:
        """Root mean square force in units of the noise: of the baseline, or for a two-sided part of the recording."""
        read = self.misfit if self.tire.two_sided else 0.0
        elastic = self.stacked([e.baseline - zero_of(self.tire) for e in self.experiments])
        return float(np.sqrt(np.mean((elastic + read) ** 2)))

    @cached_property
    def deflection(self) -> FloatArray:
        """The baseline tire's own deflection [m] (see `own_deflection`), counted blocks in a row (m,)."""
        return self.gathered([own_deflection(self.tire, e) for e in self.experiments])

    @cached_property
    def radii(self) -> tuple[float, ...]:
        """Radii [m] of the surfaces, the flattest first."""
        found = np.unique(np.concatenate([np.unique(e.surface_radius) for e in self.experiments]))
        return tuple(sorted((float(r) for r in found), key=lambda r: abs(1.0 / r)))

    def stacked(self, values: Sequence[FloatArray]) -> FloatArray:
        """Return forces (n,) or (n, k) [N] of each experiment in units of its noise, counted blocks in a row."""
        pairs = zip(self.experiments, values, strict=True)
        return np.concatenate([(v.T / e.noises).T[e.counts] for e, v in pairs])

    def gathered(self, values: Sequence[FloatArray]) -> FloatArray:
        """Return any values (n,) of each experiment at the counted blocks in a row."""
        return np.concatenate([v[e.counts] for e, v in zip(self.experiments, values, strict=True)])

    def averaged(self, values: Sequence[FloatArray]) -> list[FloatArray]:
        """Return the means over the blocks of values at each sample of the recordings."""
        pairs = zip(values, self.experiments, strict=True)
        return [e.blocks.mean(v) for v, e in pairs]

    def apart(self, values: FloatArray) -> list[FloatArray]:
        """Return values at the counted blocks (m,) recording by recording."""
        ends = np.cumsum([int(e.counts.sum()) for e in self.experiments])
        return np.split(values, ends[:-1])

    @cached_property
    def _stages(self) -> tuple[KeptStages, ...]:
        return self.stages or tuple(KeptStages(e) for e in self.experiments)

    def response(self, tire: TireModel) -> FloatArray:
        """Return the force (m,) of `tire` minus that of the baseline tire, in units of the noise."""
        pairs = zip(self._stages, self.experiments, strict=True)
        return self.stacked([stages.simulate(tire) - e.baseline for stages, e in pairs])

    def corrected(self, left_out: Sequence[FloatArray]) -> Dataset:
        """Return the dataset with this distortion by its blocks [N] subtracted from the misfit, in place of the
        last.
        """
        pairs = zip(self.experiments, left_out, strict=True)
        changed = (replace(e, misfit=e.misfit + e.left_out - own, left_out=own) for e, own in pairs)
        return replace(self, experiments=tuple(changed), stages=self._stages)

    def with_noise(self, noises: Sequence[Noise]) -> Dataset:
        """Return the dataset with another noise [N] of each averaged misfit, that of its blocks in proportion."""
        pairs = zip(self.experiments, noises, strict=True)
        return replace(
            self, experiments=tuple(e.with_noise(noise) for e, noise in pairs), stages=self._stages
        )

    def read_anew(self, recordings: Sequence[Recorded]) -> Dataset:
        """Return the dataset as other readings of the same motions would show it; recordings: those of the dataset."""
        pairs = zip(recordings, self.experiments, strict=True)
        return replace(self, experiments=tuple(read_anew(r, e, self.tire) for r, e in pairs), stages=None)

    def counting(self, kept: Sequence[BoolArray]) -> Dataset:
        """Return the dataset in which only blocks count whose samples are all in `kept` (n,), one array per recording;
        the motion is that of the whole recordings.
        """
        pairs = zip(self.experiments, kept, strict=True)
        found = (replace(e, counts=e.counts & e.blocks.of(k).all(axis=1)) for e, k in pairs)
        return replace(self, experiments=tuple(found), stages=None)

    def only(self, kept: Sequence[BoolArray]) -> Dataset:
        """Return the same without the recordings of which nothing counts."""
        counting = self.counting(kept)
        return replace(counting, experiments=tuple(e for e in counting.experiments if e.counts.any()))


def dataset_of(
    recordings: Sequence[Recorded],
    tire: TireModel,
    readings: Sequence[Noise | None] | None = None,
) -> Dataset:
    """Return the recordings in blocks, with the misfit of `tire`, the baseline.

    readings: noise of the samples of each recording, if it is known; blocks are at least as long as its memory
    """
    total = sum(r.time.size for r in recordings)
    size = max(1, -(-total // BLOCKS))
    least = size * BLOCKS // MOST_BLOCKS
    known: Sequence[Noise | None] = readings or [None] * len(recordings)
    experiments = [
        experiment_in_blocks(r, tire, (least, size), n) for r, n in zip(recordings, known, strict=True)
    ]
    if series := [e for e in experiments if e.reading.told_by_series]:
        for i, e in enumerate(experiments):
            if not e.reading.told_by_series and known[i] is None:
                experiments[i] = experiment_in_blocks(recordings[i], tire, (least, size), None, series)
    gauge = float(np.median([e.gauge for e in experiments]))
    return Dataset(
        tuple(experiments),
        replace(tire, reading_noise=min(gauge, READING_NOISE.maximum)),
        _scales(experiments, recordings, tire),
    )


@dataclass(frozen=True)
class Samples:
    """The samples of a dataset's experiments: the recordings, their motion, and the baseline's force [N] there."""

    recordings: tuple[Recorded, ...]
    motions: tuple[SmoothedMotion, ...]
    baselines: tuple[FloatArray, ...]

    def only(self, kept: Sequence[int]) -> Samples:
        """Return those of the recordings `kept`."""
        return Samples(
            tuple(self.recordings[i] for i in kept),
            tuple(self.motions[i] for i in kept),
            tuple(self.baselines[i] for i in kept),
        )

    def residuals(self, tire: TireModel) -> tuple[FloatArray, ...]:
        """Return the residuals [N] of a tire where it is given the noise-free deflection."""
        pairs = zip(self.recordings, self.motions, strict=True)
        return tuple(r.force - simulate(tire, m, m) for r, m in pairs)

    def noises(self, dataset: Dataset) -> tuple[FloatArray, ...]:
        """Return the noise floor [N] of every sample (n,), with the profile of the blocks of the dataset."""
        several = zip(self.motions, self.baselines, dataset.experiments, strict=True)
        return tuple(e.floor.level * e.profile.of(resting(m.rate), load) for m, load, e in several)

    def left_out(self, dataset: Dataset, tire: TireModel) -> tuple[FloatArray, ...]:
        """Return the distortion [N] of `tire`'s response by averaging: its mean over the samples of a block minus the
        response computed from block to block, one array (n,) for each experiment.

        A delay shorter than a block differs from that between samples, and the average over a knee is not the knee of
        the average.
        """
        pairs = zip(self.motions, self.baselines, strict=True)
        averaged = dataset.averaged([simulate(tire, m, m) - baseline for m, baseline in pairs])
        return tuple(
            own - (simulate(tire, e, e) - e.baseline) if e.size > 1 else np.zeros(e.time.size)
            for e, own in zip(dataset.experiments, averaged, strict=True)
        )


def samples_of(recordings: Sequence[Recorded], tire: TireModel) -> Samples:
    """Return the samples from which the blocks of the recordings are made; tire: the baseline."""
    motions = tuple(smoothed_motion(r, read_motion(r)[0]) for r in recordings)
    return Samples(tuple(recordings), motions, tuple(simulate(tire, m, m) for m in motions))


def arranged(tire: TireModel, effects: Sequence[tuple[str, tuple[float, ...]]], **changes: Any) -> TireModel:
    """Return `tire` with the effects of these names and values, in the order of the signal path.

    changes: of the other fields of the tire
    """
    chosen = {e.name: (e, v) for e, v in tire.effects} | {n: (CATALOGUE[n], v) for n, v in effects}
    own = [chosen[name] for name in CATALOGUE if name in chosen]
    return replace(tire, effects=tuple(sorted(own, key=lambda p: PLACES.index(p[0].place))), **changes)


def own_deflection(tire: TireModel, experiment: Experiment) -> FloatArray:
    """Return the tire's own deflection [m] (n,), after the effects that change what was read; 0 in the air."""
    own = elastic_stage(tire, experiment, experiment)[0].deflection
    return own if tire.two_sided else np.maximum(own, 0.0)


def zero_of(tire: TireModel) -> float:
    """Return the force [N] that counts for nothing: the preload of a part without air may be a load cell's zero."""
    return 0.0 if tire.inflated else tire.pretension


def _scales(experiments: Sequence[Experiment], recordings: Sequence[Recorded], baseline: TireModel) -> Scales:
    rate = np.concatenate([e.rate[e.counts] for e in experiments])
    acceleration = np.concatenate([e.acceleration[e.counts] for e in experiments])
    force = np.concatenate([np.abs(r.force - zero_of(baseline)) for r in recordings])
    deflection = np.concatenate([own_deflection(baseline, e) for e in experiments])
    return Scales(
        force=max(float(np.quantile(force, LARGEST)), 1e-12),
        travel=max(float(np.ptp(deflection)), 1e-9),
        duration=max(float(r.time[-1] - r.time[0]) for r in recordings),
        interval=min(float(np.median(np.diff(r.time))) for r in recordings),
        rate=max(float(np.sqrt(np.mean(rate**2))), 1e-12),
        acceleration=max(float(np.sqrt(np.mean(acceleration**2))), 1e-12),
        gauge=max(float(np.median([e.gauge for e in experiments])), 1e-12),
        channels={channel.name: _level(channel, experiments) for channel in CHANNELS},
    )


def _level(channel: Channel, experiments: Sequence[Experiment]) -> float:
    """Return the median of a channel over all recordings that hold it, or its usual value."""
    held = [e.measured[channel.name] for e in experiments if channel.name in e.measured]
    level = float(np.median(np.concatenate(held))) if held else channel.usual
    return level if level > 0.0 else channel.usual
