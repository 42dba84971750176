"""What every effect would add to the force on each motion of a menu, and the products of all of it.

Each effect is drawn a few times from its priors; a draw is made so strong that its largest response within the limits
of the rig is a stated part of the peak force, and taken as linear in that size. Everything that a plan needs to know of
a motion are the products of these curves with each other over its rows, in units of the noise: products of several
motions add up, since the tire begins each recording at rest.

Where the rig holds several pressures the tire's force follows them with a usual gain (the effect that reads the
pressure, nominal), which is not known: what it changes within its prior is a column that every model has. That effect
itself is drawn as the others are, on the tire without it, and judged beside models that have no such column.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray
from radialtire import CATALOGUE, CHANNELS, Effect, TireModel

from ..errors import TirelabError
from ..names import plain
from ..regressors.dataset import Dataset, Scales, arranged
from ..regressors.draws import drawn, strengthened
from ..regressors.excitation import excitation_of
from ..regressors.experiment import Experiment
from ..regressors.signature import FACTOR, LAW, SILENT, candidates, law_signature, size_of
from ..simulation.simulate import simulate
from .force_limit import depth_within
from .menu import LENGTHS, Drive, experiment_of, menu, peak_force
from .rig import Rig

FloatArray = NDArray[np.float64]

DRAWS = 8
"""Draws of an effect."""

SIZED_AT = 0.02
"""Size at which responses are computed, largest response over peak force: in the middle of 1 to 5 %."""

HELD = next(e for e in CATALOGUE.values() if e.reads is not None and e.reads.reference is not None)
"""The effect that only another value of a held channel shows: the force's gain with the pressure."""

PRIOR_OF_LAW = "prior of the law"
"""The columns of the law's signature at its declared standard deviations."""

PRIOR_OF_GAIN = "prior of the gain"
"""The column of a standard deviation of the gain with the pressure, which is there where several are held."""

SLOW_NOISE = "slow noise"
"""The column of the slow part of the noise. It is like no response: what counts is its sum of squares."""

SLOW_BELOW = 1.0
"""Frequency [Hz] below which an amplifier's noise rises as 1 / f over its white noise."""


@dataclass(frozen=True)
class Responses:
    """Products (n, n) of all columns on each drive, in units of the noise.

    places: of each effect its draws, at the size 1 (largest response: the peak force), of the law its prior, and of the
    slow noise one column
    silent: effects that have no response within these limits; peak [N]: the largest force
    mixed: whether each drive passes its deflections at more than one speed
    """

    drives: tuple[Drive, ...]
    grams: tuple[FloatArray, ...]
    places: Mapping[str, slice]
    silent: tuple[str, ...]
    peak: float
    mixed: tuple[bool, ...]

    @property
    def names(self) -> tuple[str, ...]:
        """Effects that respond, and the law."""
        others = (PRIOR_OF_LAW, PRIOR_OF_GAIN, SLOW_NOISE)
        return tuple(name for name in self.places if name not in others)


def responses_of(
    drives: Sequence[Drive], tire: TireModel, rig: Rig, progress: Callable[[str], None]
) -> Responses:
    """Return the products of the responses of all effects and of a refitted law on the drives."""
    bare = replace(tire, effects=tuple((e, v) for e, v in tire.effects if e.name != HELD.name))
    tire, more = _at_pressures(tire, rig)
    experiments = [experiment_of(d, tire, rig.noise) for d in drives]
    peak = peak_force(drives, tire)
    dataset = Dataset(tuple(experiments), tire, _scales(experiments, rig, peak))
    progress("sizing the effects")
    sets = _sized_sets(_of_motion(), dataset, peak)
    held = _of_held(drives, bare, rig, dataset) if more else None
    if held is not None:
        sets |= _sized_sets((HELD.name,), held, peak)
    progress("simulating the effects on every motion")
    law = law_signature(dataset)
    prior = law.basis * size_of(FACTOR * dataset.stacked([e.baseline for e in experiments]))
    changes = _law_draws(prior, dataset, peak)
    widths = {name: len(values) for name, values in sets.items()}
    widths |= {LAW: changes.shape[1], PRIOR_OF_LAW: prior.shape[1]} | ({PRIOR_OF_GAIN: 1} if more else {})
    places = _places(widths | {SLOW_NOISE: 1})
    grams, begin = [], 0
    for number, experiment in enumerate(experiments):
        part = replace(dataset, experiments=(experiment,))
        end = begin + int(experiment.counts.sum())
        columns = []
        for name, found in sets.items():
            of = part
            if held is not None and name == HELD.name:
                of = replace(held, experiments=(held.experiments[number],))
            columns += [of.response(arranged(of.tire, [(name, values)])) / size for values, size in found]
        gain = [part.response(other) for other in more]
        whole = np.column_stack([*columns, changes[begin:end], prior[begin:end], *gain])
        own = np.zeros((whole.shape[1] + 1,) * 2)
        own[:-1, :-1] = whole.T @ whole
        own[-1, -1] = slow_noise(experiment)
        grams.append(own)
        begin = end
    silent = tuple(name for name in _of_motion() if name not in sets)
    parts = (replace(dataset, experiments=(e,)) for e in experiments)
    mixed = tuple(not excitation_of(part).one_speed for part in parts)
    return Responses(tuple(drives), tuple(grams), places, silent, peak, mixed)


def within_force(rig: Rig, tire: TireModel) -> Rig:
    """Return a rig whose stroke ends where a believed tire reaches the largest force of the rig, whatever is driven.

    Raises TirelabError where the tire is beyond that force before it is pressed.
    """
    held, _ = _at_pressures(tire, rig)

    def peak(stroke: float) -> float:
        drives = menu(replace(rig, stroke=stroke), LENGTHS[:1])
        return max((float(np.abs(simulate(held, d)).max()) for d in drives), default=0.0)

    stroke = depth_within(rig.force, rig.stroke, peak)
    if not stroke:
        raise TirelabError(
            f"the force of {tire.name} is beyond {plain(rig.force, 4)} N before it is pressed; give a larger --force"
        )
    return replace(rig, stroke=stroke)


def slow_noise(experiment: Experiment) -> float:
    """Return the sum of squares of the slow noise over the samples compared, in units of the noise of one.

    An amplifier's noise has the power of white noise times 1 + SLOW_BELOW / f at each frequency f from that of the
    whole recording up to half the sampling rate. Averaged over a row, slow noise stays while the rest falls.
    """
    step = experiment.interval / experiment.size
    duration = experiment.interval * experiment.time.size
    part = 2.0 * step * SLOW_BELOW * np.log(duration / (2.0 * step))
    return float(part * experiment.size * experiment.counts.sum())


def _at_pressures(tire: TireModel, rig: Rig) -> tuple[TireModel, tuple[TireModel, ...]]:
    """Return the tire whose force follows the pressures that the rig holds, and it with another gain; with fewer than
    two pressures the tire as it is, and none.
    """
    if len(rig.pressures) < 2:
        return tire, ()
    own = {effect.name: values for effect, values in tire.effects}
    assert HELD.reads is not None
    first = [rig.pressures[0] if p.name == HELD.reads.reference else p.nominal_value for p in HELD.parameters]
    values = own.get(HELD.name, tuple(first))
    other = [
        v - p.prior.spread if p.role == "strength" and p.prior is not None else v
        for p, v in zip(HELD.parameters, values, strict=True)
    ]
    both = (arranged(tire, [(HELD.name, tuple(given))]) for given in (values, other))
    return next(both), (next(both),)


def _of_held(drives: Sequence[Drive], bare: TireModel, rig: Rig, dataset: Dataset) -> Dataset:
    """Return the drives on the tire whose force does not follow the pressure, about the rig's first pressure."""
    assert HELD.reads is not None
    experiments = tuple(experiment_of(d, bare, rig.noise) for d in drives)
    channels = {**dataset.scales.channels, HELD.reads.channel: rig.pressures[0]}
    return Dataset(experiments, bare, replace(dataset.scales, channels=channels))


def _places(widths: Mapping[str, int]) -> dict[str, slice]:
    places, begin = {}, 0
    for name, width in widths.items():
        places[name] = slice(begin, begin + width)
        begin += width
    return places


def _of_motion() -> tuple[str, ...]:
    """Return the effects that a motion can show: one that needs a channel shows itself where that is set anew."""
    return tuple(n for n in candidates() if (reads := CATALOGUE[n].reads) is None or reads.reference is None)


Sized = list[tuple[tuple[float, ...], float]]


def _sized_sets(names: Sequence[str], dataset: Dataset, peak: float) -> dict[str, Sized]:
    """Return of each effect its draws and their sizes: largest response on any motion over the peak force."""
    found = {}
    for name in names:
        sets, _ = drawn(CATALOGUE[name], dataset.scales, DRAWS)
        sized = [_sized(CATALOGUE[name], values, dataset, peak) for values in sets]
        heard = [(tuple(values), size) for values, size in sized if size > SILENT]
        if len(heard) > 1:
            found[name] = heard
    return found


def _sized(effect: Effect, values: list[float], dataset: Dataset, peak: float) -> tuple[list[float], float]:
    roles = [p.role for p in effect.parameters]
    if "limit" in roles:  # a ceiling acts by what is above it
        values = [(1.0 - SIZED_AT) * peak if r == "limit" else v for r, v in zip(roles, values, strict=True)]
    size = 0.0
    for _ in range(3):
        size = _largest(arranged(dataset.tire, [(effect.name, tuple(values))]), dataset.experiments) / peak
        if not np.isfinite(size):
            return values, 0.0
        if size <= 0.0 or "strength" not in roles or 0.5 < size / SIZED_AT < 2.0:
            break
        values = strengthened(effect, values, SIZED_AT / size)
    return values, size


def _largest(tire: TireModel, experiments: Sequence[Experiment]) -> float:
    """Return the largest change of the force [N] at any compared row."""
    return max(float(np.abs(simulate(tire, e, e) - e.baseline)[e.counts].max()) for e in experiments)


def _law_draws(prior: FloatArray, dataset: Dataset, peak: float) -> FloatArray:
    """Return changes of the law drawn from its prior, of the size 1."""
    draws = prior @ np.random.default_rng(1).standard_normal((prior.shape[1], DRAWS))
    noise = dataset.gathered([np.full(e.time.size, e.noise) for e in dataset.experiments])
    return np.asarray(draws / (np.abs(draws * noise[:, None]).max(axis=0) / peak))


def _scales(experiments: Sequence[Experiment], rig: Rig, peak: float) -> Scales:
    rate = np.concatenate([e.rate[e.counts] for e in experiments])
    acceleration = np.concatenate([e.acceleration[e.counts] for e in experiments])
    return Scales(
        force=peak,
        travel=rig.stroke,
        duration=max(float(e.time[-1] - e.time[0]) for e in experiments),
        interval=rig.sampling,
        rate=max(float(np.sqrt(np.mean(rate**2))), 1e-12),
        acceleration=max(float(np.sqrt(np.mean(acceleration**2))), 1e-12),
        gauge=1e-12,
        channels={channel.name: channel.usual for channel in CHANNELS},
    )
