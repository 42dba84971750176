"""What the recorded motion and channels can show, before any force is looked at.

Traits of effects that the motion cannot tell from others are left out. An effect that changes a channel (a leak the
pressure) must show in it. Each channel of all recordings together is

    y = level of the recording + sum of the courses of the effects that change it + rest,

by least squares, with each effect's courses from draws of its parameters. An effect is refuted where its courses add
next to nothing. An effect that reads the channel needs one that was set to several values: levels and rest must differ
at one deflection in one direction, and more so than from one to another, as the pressure does that swings with each
stroke. Or everything that depends on both would pass for it.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from radialtire import CATALOGUE, CHANNELS, Effect, TireModel

from ..preprocessing.noise import NEGLIGIBLE, STILL
from ..simulation.simulate import History, elastic_stage, respond_series
from .dataset import Dataset, Experiment
from .signature import DRAWS, drawn, size_of

FloatArray = NDArray[np.float64]

Cells = NDArray[np.int_]

COURSES, COURSE_DRAWS = 2, DRAWS // 2
"""Courses of an effect, and the draws that they are the leading ones of: those of the plain form alone."""

AS_GOOD = 0.75
"""Part of what an effect explains that another must explain to stand for it."""

ALIKE = float(np.sqrt(AS_GOOD))
"""Cosine of the leading courses of two effects beyond which either may stand for the other."""


@dataclass(frozen=True)
class ChannelEvidence:
    """impossible: effects that the channels speak against, or that need one that is not there; unvaried: effects that
    read a channel which was the same at every visit of a deflection, and the sentence that says so.
    """

    impossible: frozenset[str]
    unvaried: Mapping[str, str]


def channel_evidence(dataset: Dataset, cells: Sequence[Cells]) -> ChannelEvidence:
    """Return what the channels show; cells: deflection and direction of each recording's blocks, -1: where it turns."""
    impossible: set[str] = set()
    unvaried: dict[str, str] = {}
    for channel in CHANNELS:
        readers = [e for e in CATALOGUE.values() if e.reads is not None and e.reads.channel == channel.name]
        if any(channel.name not in e.measured for e in dataset.experiments):
            impossible |= {e.name for e in readers if e.reads is not None and e.reads.reference is not None}
            continue
        level = dataset.scales.channels[channel.name]
        value = np.concatenate([e.measured[channel.name] for e in dataset.experiments]) / level
        changing = [e for e in CATALOGUE.values() if channel.name in e.changes]
        followed, seen = _followed(value, changing, dataset)
        impossible |= {
            e.name
            for e in changing
            if not (seen[e.name][0] > NEGLIGIBLE and seen[e.name][1] > NEGLIGIBLE * channel.resolution)
        }
        within, between = _spreads(value - followed, np.concatenate(cells))
        if within < max(channel.resolution, between):
            same = (
                f"the {channel.name} was the same whenever a deflection was visited: record at a second one"
            )
            unvaried |= {e.name: same for e in readers}
    return ChannelEvidence(frozenset(impossible), unvaried)


def _followed(
    value: FloatArray, effects: Sequence[Effect], dataset: Dataset
) -> tuple[FloatArray, dict[str, tuple[float, float]]]:
    """Return what all courses explain of a channel within the recordings, and of each effect the part of the variance
    that it adds to those that are unlike it, and the size of its course: 0 where it goes the other way.
    """
    centred = _centring(dataset.experiments)
    target = centred(value)
    total = max(float(target @ target), 1e-300)
    columns = {e.name: np.stack([centred(c) for c in _courses(e, dataset)], axis=1) for e in effects}

    def fitted(names: Sequence[str]) -> tuple[float, dict[str, FloatArray]]:
        if not names:
            return total, {}
        matrix = np.concatenate([columns[name] for name in names], axis=1)
        answer = np.linalg.lstsq(matrix, target, rcond=1e-9)[0]
        parts = {n: columns[n] @ answer[COURSES * i : COURSES * (i + 1)] for i, n in enumerate(names)}
        return float(np.sum((target - matrix @ answer) ** 2)), parts

    seen = {}
    for name, own in columns.items():
        others = [n for n in columns if n != name and abs(_cosine(columns[n][:, 0], own[:, 0])) < ALIKE]
        less, (more, parts) = fitted(others)[0], fitted([*others, name])
        onward = float(parts[name] @ own[:, 0]) > 0.0
        seen[name] = ((less - more) / total, size_of(parts[name]) if onward else 0.0)
    return sum(fitted(list(columns))[1].values(), np.zeros_like(value)), seen


def _cosine(a: FloatArray, b: FloatArray) -> float:
    return float(a @ b) / max(float(np.sqrt((a @ a) * (b @ b))), 1e-300)


def _courses(effect: Effect, dataset: Dataset) -> list[FloatArray]:
    """Return the leading courses of an effect's factor over all recordings, the first one in the effect's own sense."""
    sets, _ = drawn(effect, dataset.scales, COURSE_DRAWS)
    tire = TireModel(dataset.tire.law, tested_range=None)
    histories = [elastic_stage(tire, e, e)[0] for e in dataset.experiments]
    curves = np.array([_factor(effect, tuple(values), histories) for values in sets])
    curves = curves[np.isfinite(curves).all(axis=1)] - 1.0
    size = np.sqrt(np.mean(curves**2, axis=1))
    curves = curves[size > 0.0] / size[size > 0.0, None]
    if not len(curves):
        return [np.zeros(sum(e.time.size for e in dataset.experiments))] * COURSES
    courses = np.linalg.svd(curves, full_matrices=False)[2][:COURSES]
    sense = 1.0 if float(courses[0] @ curves.mean(axis=0)) > 0.0 else -1.0
    return list(sense * courses)


def _factor(effect: Effect, values: tuple[float, ...], histories: Sequence[History]) -> FloatArray:
    return np.concatenate([respond_series(effect, values, np.ones_like(h.time), h) for h in histories])


def _centring(experiments: Sequence[Experiment]) -> Callable[[FloatArray], FloatArray]:
    """Return the function that takes the mean of each recording off values of all of them in a row."""
    ends = np.cumsum([e.time.size for e in experiments])[:-1]
    return lambda values: np.concatenate([part - part.mean() for part in np.split(values, ends)])


def _spreads(values: FloatArray, cell: Cells) -> tuple[float, float]:
    """Return the standard deviations of values within the cells and of the cells' means; a cell of -1 is none."""
    inside = cell >= 0
    if not inside.any():
        return 0.0, 0.0
    own, place = values[inside], cell[inside]
    mean = (np.bincount(place, own) / np.maximum(np.bincount(place), 1))[place]
    return size_of(own - mean), float(np.std(mean))


CELLS = 12
"""Parts of the deflection's span in which two visits are visits of the same deflection."""

SPEEDS = 0.5
"""Spread of the speed, at one deflection in one direction, over its mean, below which there is one speed."""

UNDER_WAY = 0.5
"""Speed over its root mean square above which the direction is sure, between rest (0) and the usual speed (1): a
channel may change with it."""

NO_EVIDENCE = ChannelEvidence(frozenset(), {})
"""That of recordings whose channels were not looked at."""


@dataclass(frozen=True)
class Excitation:
    """returns: part of the variance of time between visits of the same deflection in the same direction; speeds: spread
    of the speed there; timed: whether the samples' times are known; surfaces: how many were pressed on; channels: what
    the recorded channels show.
    """

    returns: float
    speeds: float
    timed: bool = True
    surfaces: int = 1
    channels: ChannelEvidence = NO_EVIDENCE

    @property
    def one_speed(self) -> bool:
        """Whether each deflection is passed at one speed only."""
        return self.speeds < SPEEDS

    def hidden(self, name: str) -> str:
        """Return why an effect of this name cannot be shown, or ""."""
        if name in self.channels.unvaried:
            return self.channels.unvaried[name]
        traits = CATALOGUE[name].traits
        if not self.timed and {"rate", "slow"} & set(traits):
            return "the recording has no time"
        if "slow" in traits and self.returns < NEGLIGIBLE:
            return "no deflection was visited again: time cannot be told from deflection and direction"
        return ""

    def reasons(self, names: Sequence[str]) -> dict[str, str]:
        """Return why, of all the effects that cannot be shown."""
        return {name: why for name in names if (why := self.hidden(name))}

    def alike(self, name: str) -> tuple[str, ...]:
        """Return the effects that this motion cannot tell from one of this name: loops, where each deflection is passed
        at one speed.
        """
        if self.speeds >= SPEEDS or "loop" not in CATALOGUE[name].traits:
            return ()
        loops = (n for n, effect in CATALOGUE.items() if "loop" in effect.traits and n != name)
        return tuple(n for n in loops if not self.hidden(n))

    def within_law(self, name: str) -> bool:
        """Whether a law of another shape could be all that an effect of this name is: it depends on the deflection
        alone, which on one surface is all that a law can be; not on a channel that was read beside it.
        """
        return self.surfaces == 1 and of_deflection(name)


def of_deflection(name: str) -> bool:
    """Whether an effect depends on deflection and surface alone, as a law does, and on no channel beside them."""
    return "static" in CATALOGUE[name].traits and CATALOGUE[name].reads is None


def excitation_of(dataset: Dataset, *, timed: bool = True) -> Excitation:
    """Return what the motion of all recordings can show; on one surface they show their speeds together."""
    visits = [_visits(e) for e in dataset.experiments]
    returns = [_share_within(v.time, v.cell) for v in visits]
    together: dict[float, list[_Visits]] = {}
    for experiment, own in zip(dataset.experiments, visits, strict=True):
        together.setdefault(float(np.median(experiment.surface_radius)), []).append(own)
    speeds = [
        _spread_within(np.concatenate([v.speed for v in same]), np.concatenate([v.cell for v in same]))
        for same in together.values()
    ]
    channels = channel_evidence(dataset, _common_cells(dataset.experiments))
    return Excitation(max(returns), max(speeds), timed, len(dataset.radii), channels)


@dataclass(frozen=True)
class _Visits:
    """The samples of one recording that move: time [s], speed [m/s], and the cell of deflection and direction."""

    time: FloatArray
    speed: FloatArray
    cell: NDArray[np.int_]


def _visits(e: Experiment) -> _Visits:
    # In a hold everything that relaxes passes for something slow: only visits on the way count.
    moving = _moving(e)
    cell = _cells(e, float(e.deflection.min()), float(e.deflection.max()))
    return _Visits(e.time[moving], np.abs(e.rate[moving]), cell[moving])


def _moving(e: Experiment, part: float = STILL) -> NDArray[np.bool_]:
    return np.asarray(np.abs(e.rate) > part * float(np.sqrt(np.mean(e.rate**2))))


def _cells(e: Experiment, low: float, high: float) -> NDArray[np.int_]:
    """Return the cell of deflection, between two ends [m], and direction of each block."""
    span = (e.deflection - low) / max(high - low, 1e-300)
    return np.asarray(np.minimum((span * CELLS).astype(int), CELLS - 1) + CELLS * (e.rate > 0.0))


def _common_cells(experiments: Sequence[Experiment]) -> list[NDArray[np.int_]]:
    """Return the cells of every recording's blocks on one scale of the deflection; -1 where the tire turns."""
    low = min(float(e.deflection.min()) for e in experiments)
    high = max(float(e.deflection.max()) for e in experiments)
    return [np.where(_moving(e, UNDER_WAY), _cells(e, low, high), -1) for e in experiments]


def _share_within(values: FloatArray, cell: NDArray[np.int_]) -> float:
    """Return the part of the variance of the values that is within the cells."""
    return _within(values, cell) / max(float(np.var(values)), 1e-300) if values.size else 0.0


def _spread_within(values: FloatArray, cell: NDArray[np.int_]) -> float:
    """Return the standard deviation of the values within a cell over their mean."""
    if not values.size:
        return 0.0
    return float(np.sqrt(_within(values, cell)) / max(float(values.mean()), 1e-300))


def _within(values: FloatArray, cell: NDArray[np.int_]) -> float:
    """Return the mean variance of the values within a cell."""
    count = np.bincount(cell)
    mean = np.bincount(cell, values) / np.maximum(count, 1)
    return float(np.mean((values - mean[cell]) ** 2))
