"""The data with which every set of effects is compared: recordings averaged over blocks.

A block holds neighbouring samples, as many as the motion allows. The misfit of the baseline tire is averaged, since it
is smoother than the force; the motion is taken in the middle of each block. A block with a reversal within a sample
counts only where the misfit is the same before and after the reversal. All comparisons are made in units of the noise
of the averaged misfit.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property

import numpy as np
from numpy.typing import NDArray
from radialtire import CATALOGUE, CHANNELS, Channel, TireModel
from radialtire.effect import PLACES
from radialtire.model import READING_NOISE

from ..preprocessing.data_checks import are_rare, compared, spikes
from ..preprocessing.gauge import destepped, staircase_step
from ..preprocessing.motion import Motion, followed_turns, motion_of, through_turns
from ..preprocessing.noise import (
    SHARE_OF_STEP,
    Noise,
    NoiseFloor,
    Scalar,
    noise_floor,
    noise_of,
)
from ..preprocessing.samples import Recorded
from ..simulation.kept_stages import KeptStages
from ..simulation.simulate import SmoothedMotion, simulate, smoothed_motion

FloatArray = NDArray[np.float64]
BoolArray = NDArray[np.bool_]


@dataclass(frozen=True)
class Scales:
    """The scales of the recordings, by which priors are scaled; all positive.

    force [N]: peak; travel [m]: span of the deflection; duration [s]: of the longest recording; interval [s]: between
    samples; rate [m/s], acceleration [m/s^2]: root mean squares over the counted blocks; gauge [m]: noise of the
    deflection reading; channels: level of each channel in its SI unit, by its name
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

FEWEST_BLOCKS = 600
"""Fewest blocks of a recording that has as many samples."""

TURN = 0.5
"""Largest phase [rad] of the motion within a block; its angular frequency is taken as acceleration over rate."""

STEPS_LEFT = 0.3
"""Part of a gauge's steps that remains in the deflection after the steps are removed; averaging does not reduce it,
because it is smooth over a step."""

SECANTS = 40
"""Number of parts of the deflection's span over which the stiffness is computed."""

COUNTED = 0.5
"""Least part of the blocks with a resolved motion, a majority; with fewer, all blocks count."""


@dataclass(frozen=True)
class Experiment:
    """One recording in blocks; arrays (n,).

    time [s], deflection [m], rate [m/s], acceleration [m/s^2], surface_radius [m]: in the middle of each block
    baseline [N]: force of the baseline tire there; misfit [N]: recorded force minus that of the baseline, averaged over
    the block; counts: whether a block is compared; noise [N]: standard deviation of the noise of the averaged misfit
    least_noise [N]: noise that the steps of the force reading cause at least; resting [N]: the part of it that
    neighbouring blocks have in common, where the force rests on a step for longer than a block
    floor: noise floor of the samples; gauge [m]: noise of the deflection reading; size: samples of a block
    interval [s]: between blocks; reading: noise of the samples [N]
    measured: the recorded channels by their names, averaged over the blocks
    left_out [N] (n,): distortion by averaging over blocks that was subtracted from the misfit, see `Samples.left_out`
    """

    name: str
    time: FloatArray
    deflection: FloatArray
    rate: FloatArray
    acceleration: FloatArray
    surface_radius: FloatArray
    baseline: FloatArray
    misfit: FloatArray
    counts: BoolArray
    noise: float
    least_noise: float
    resting: float
    floor: NoiseFloor
    gauge: float
    size: int
    interval: float
    reading: Noise
    measured: Mapping[str, FloatArray] = field(default_factory=dict)
    left_out: FloatArray | float = 0.0


@dataclass(frozen=True)
class Dataset:
    """All recordings of a diagnosis and the baseline tire."""

    experiments: tuple[Experiment, ...]
    tire: TireModel
    scales: Scales

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
        return float(np.sqrt(np.mean((self.stacked([e.baseline for e in self.experiments]) + read) ** 2)))

    @cached_property
    def radii(self) -> tuple[float, ...]:
        """Radii [m] of the surfaces, the flattest first."""
        found = np.unique(np.concatenate([np.unique(e.surface_radius) for e in self.experiments]))
        return tuple(sorted((float(r) for r in found), key=lambda r: abs(1.0 / r)))

    def stacked(self, values: Sequence[FloatArray]) -> FloatArray:
        """Return forces (n,) or (n, k) [N] of each experiment in units of its noise, counted blocks in a row."""
        return np.concatenate([v[e.counts] / e.noise for e, v in zip(self.experiments, values, strict=True)])

    def gathered(self, values: Sequence[FloatArray]) -> FloatArray:
        """Return any values (n,) of each experiment at the counted blocks in a row."""
        return np.concatenate([v[e.counts] for e, v in zip(self.experiments, values, strict=True)])

    def averaged(self, values: Sequence[FloatArray]) -> list[FloatArray]:
        """Return the means over the blocks of values at each sample of the recordings."""
        pairs = zip(values, self.experiments, strict=True)
        return [_Blocks(e.size, e.time.size).mean(v) for v, e in pairs]

    def apart(self, values: FloatArray) -> list[FloatArray]:
        """Return values at the counted blocks (m,) recording by recording."""
        ends = np.cumsum([int(e.counts.sum()) for e in self.experiments])
        return np.split(values, ends[:-1])

    @cached_property
    def _stages(self) -> tuple[KeptStages, ...]:
        return tuple(KeptStages(e) for e in self.experiments)

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
        return replace(self, experiments=tuple(changed))

    def with_noise(self, noises: Sequence[Noise]) -> Dataset:
        """Return the dataset with another noise [N] of each averaged misfit."""
        found = []
        for e, noise in zip(self.experiments, noises, strict=True):
            reading = Noise(_of_samples(noise, e), noise.memory * e.size) if noise.memory > 1 else e.reading
            found.append(replace(e, noise=max(noise.level, e.least_noise), reading=reading))
        return replace(self, experiments=tuple(found))

    def only(self, kept: Sequence[BoolArray]) -> Dataset:
        """Return the dataset in which only blocks count whose samples are all in `kept` (n,), one array per recording;
        the motion is that of the whole recordings.
        """
        found = []
        for e, k in zip(self.experiments, kept, strict=True):
            counts = e.counts & k[: e.counts.size * e.size].reshape(-1, e.size).all(axis=1)
            found.append(replace(e, counts=counts))
        return replace(self, experiments=tuple(e for e in found if e.counts.any()))


def _of_samples(averaged: Noise, experiment: Experiment) -> float:
    """Return the noise [N] of a sample, from that of the averages and the part that averaging removed."""
    taken_out = max(experiment.reading.level**2 - experiment.noise**2, 0.0)
    return float(np.sqrt(averaged.level**2 + taken_out))


def dataset_of(
    recordings: Sequence[Recorded],
    tire: TireModel,
    readings: Sequence[Noise] | None = None,
) -> Dataset:
    """Return the recordings in blocks, with the misfit of `tire`, the baseline.

    readings: noise of the samples of each recording, if it is known; blocks are at least as long as its memory
    """
    total = sum(r.time.size for r in recordings)
    size = max(1, -(-total // BLOCKS))
    least = size * BLOCKS // MOST_BLOCKS
    known: Sequence[Noise | None] = readings or [None] * len(recordings)
    experiments = tuple(
        _experiment(r, tire, (least, size), n) for r, n in zip(recordings, known, strict=True)
    )
    gauge = float(np.median([e.gauge for e in experiments]))
    return Dataset(
        experiments,
        replace(tire, reading_noise=min(gauge, READING_NOISE.maximum)),
        _scales(experiments, recordings),
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
    motions = tuple(smoothed_motion(r, motion_of(r.time, _read(r)[0])) for r in recordings)
    return Samples(tuple(recordings), motions, tuple(simulate(tire, m, m) for m in motions))


def arranged(tire: TireModel, effects: Sequence[tuple[str, tuple[float, ...]]]) -> TireModel:
    """Return `tire` with the effects of these names and values, in the order of the signal path."""
    chosen = {e.name: (e, v) for e, v in tire.effects} | {n: (CATALOGUE[n], v) for n, v in effects}
    names = list(CATALOGUE)
    order = sorted(chosen.values(), key=lambda p: (PLACES.index(p[0].place), names.index(p[0].name)))
    return replace(tire, effects=tuple(order))


def _read(recording: Recorded) -> tuple[FloatArray, float]:
    """Return the deflection [m] without the steps of its gauge, and the step [m], 0 where there is none."""
    step = staircase_step(recording.deflection)
    read = destepped(recording.time, recording.deflection, step) if step > 0.0 else recording.deflection
    return read, step


@dataclass(frozen=True)
class _Blocks:
    """Blocks of `size` neighbouring samples, `count` of them; the samples that fill no whole block are left out."""

    size: int
    count: int

    def of(self, values: NDArray[Scalar]) -> NDArray[Scalar]:
        """Return the values (n,) of the samples as those of the blocks (count, size)."""
        return values[: self.count * self.size].reshape(-1, self.size)

    def mean(self, values: FloatArray) -> FloatArray:
        """Return the mean of the values over each block."""
        return np.asarray(self.of(values).mean(axis=1))

    def middle(self, values: FloatArray) -> FloatArray:
        """Return the values in the middle of each block.

        The middle of an even block lies between two samples; taking one of them would be a lag of half a sample.
        """
        blocks = self.of(values)
        return np.asarray(0.5 * (blocks[:, (self.size - 1) // 2] + blocks[:, self.size // 2]))


def _experiment(
    recording: Recorded, tire: TireModel, sizes: tuple[int, int], reading: Noise | None
) -> Experiment:
    """Return a recording in blocks; sizes: least and most samples of a block; reading: noise of a sample, if known."""
    time, interval = recording.time, float(np.median(np.diff(recording.time)))
    read, step = _read(recording)
    motion = motion_of(time, read)
    gauge = 0.0 if step > 0.0 else motion.noise
    moved = smoothed_motion(recording, motion)
    baseline = simulate(replace(tire, reading_noise=min(gauge, READING_NOISE.maximum)), moved, moved)
    misfit = recording.force - baseline
    reading = reading or noise_of(misfit, interval, motion.deflection, motion.rate, motion.acceleration)
    lone = spikes(misfit)
    turns = followed_turns(misfit, motion.resolved, reading.level)
    turns &= ~(lone & are_rare(lone[turns]))
    resolved = motion.resolved & ~lone
    blocks = _blocks(motion, resolved, sizes, interval, reading)
    counts: BoolArray = np.asarray(blocks.of(resolved | turns).all(axis=1))
    if counts.mean() < COUNTED:
        counts = np.ones_like(counts)
    (followed,) = compared([recording])
    counts &= blocks.of(followed).all(axis=1)
    rate, acceleration = through_turns(time, motion.rate, motion.acceleration, turns)
    measured = {name: blocks.mean(values) for name, values in moved.measured.items()}
    averaged = SmoothedMotion(
        blocks.middle(time),
        blocks.middle(motion.deflection),
        blocks.of(recording.surface_radius)[:, blocks.size // 2],
        blocks.middle(rate),
        blocks.middle(acceleration),
        measured,
    )
    averaged_misfit = blocks.mean(misfit)
    # Changes as quick as the blocks are told from noise later, by the residual of the saturated model.
    of_blocks = noise_of(
        averaged_misfit,
        interval * blocks.size,
        averaged.deflection,
        averaged.rate,
        averaged.acceleration,
    )
    noise = min(reading.level * np.sqrt(min(reading.memory / blocks.size, 1.0)), of_blocks.level)
    force_step = staircase_step(recording.force)
    least_noise, resting = _rounding(recording.force, force_step, blocks.size)
    return Experiment(
        recording.name,
        averaged.time,
        averaged.deflection,
        averaged.rate,
        averaged.acceleration,
        averaged.surface_radius,
        simulate(tire, averaged, averaged),
        averaged_misfit,
        counts,
        max(noise, least_noise, 1e-6 * float(np.ptp(recording.force)), 1e-300),
        least_noise,
        resting,
        noise_floor(reading.level, _stiffness(motion.deflection, baseline), gauge, step, force_step),
        gauge,
        blocks.size,
        interval * blocks.size,
        reading,
        measured,
    )


def _blocks(
    motion: Motion, resolved: BoolArray, sizes: tuple[int, int], interval: float, noise: Noise
) -> _Blocks:
    """Return blocks as long as the motion allows; sizes: least and most samples; interval [s]; noise: of a sample."""
    quick = float(np.sqrt(np.mean(motion.acceleration[resolved] ** 2)))
    slow = float(np.sqrt(np.mean(motion.rate[resolved] ** 2)))
    longest = TURN * slow / max(quick * interval, 1e-300)
    least, most = sizes
    # Blocks within the memory of their noise would not be independent of each other.
    most = max(min(most, resolved.size // FEWEST_BLOCKS), noise.memory)
    size = int(max(1, least, min(most, longest)))
    return _Blocks(size, resolved.size // size)


def _rounding(force: FloatArray, step: float, size: int) -> tuple[float, float]:
    """Return the rounding error [N] of the average over a block of `size` samples of a force read in steps [N], and the
    part of it that neighbouring blocks have in common.

    A slow force rests on a step for many samples: averaging does not reduce their rounding error.
    """
    moving = float(np.mean(np.abs(np.diff(force)) > 0.5 * step))
    error = step * SHARE_OF_STEP
    shared = float(np.sqrt(max(1.0 - size * moving, 0.0)))
    return error / float(np.sqrt(max(size * moving, 1.0))), error * shared


def _stiffness(deflection: FloatArray, force: FloatArray) -> FloatArray:
    """Return the tangent [N/m] of the baseline force over the deflection, from its means on an even grid."""
    low, span = float(deflection.min()), float(np.ptp(deflection))
    which = np.minimum(((deflection - low) / max(span, 1e-300) * SECANTS).astype(int), SECANTS - 1)
    count = np.bincount(which, minlength=SECANTS)
    held = count > 0
    x, f = (np.bincount(which, v, SECANTS)[held] / count[held] for v in (deflection, force))
    grid = low + span * (np.arange(SECANTS) + 0.5) / SECANTS
    return np.asarray(np.interp(deflection, grid, np.gradient(np.interp(grid, x, f), grid)))


def _scales(experiments: Sequence[Experiment], recordings: Sequence[Recorded]) -> Scales:
    rate = np.concatenate([e.rate[e.counts] for e in experiments])
    acceleration = np.concatenate([e.acceleration[e.counts] for e in experiments])
    force = np.concatenate([np.abs(r.force) for r in recordings])
    deflection = np.concatenate([e.deflection for e in experiments])
    return Scales(
        force=max(float(np.quantile(force, 0.999)), 1e-12),
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
