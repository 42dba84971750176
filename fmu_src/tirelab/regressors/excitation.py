"""Which effects the recorded motion and channels can show, judged without the force.

Effects with traits that the motion cannot distinguish from others are left out. An effect that changes a channel, as a
leak changes the pressure, must show in it. Each channel of all recordings together is modelled by least squares as

    y = level of the recording + sum of the courses of the effects that change it + rest,

where the courses of an effect are its leading time series, from draws of its parameters. An effect is refuted where its
courses explain next to nothing. An effect that reads the channel needs a channel that was set to several values: at one
deflection and direction, levels and rest must vary, and more than from one deflection to another. A pressure that only
swings with each stroke does not: then everything that depends on the deflection would be attributed to it.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from radialtire import CATALOGUE, CHANNELS, Effect, TireModel

from ..preprocessing.noise import NEGLIGIBLE, STILL
from ..preprocessing.turns import branches
from ..simulation.simulate import History, elastic_stage, respond_series
from .dataset import Dataset, Experiment
from .draws import drawn
from .signature import ALIKE, DRAWS, LAW, Signature, baseline_of, likeness, size_of

FloatArray = NDArray[np.float64]

Cells = NDArray[np.int_]

COURSES, COURSE_DRAWS = 2, DRAWS // 2
"""Number of courses of an effect, and of the draws from which they are computed: those of the plain form only."""


@dataclass(frozen=True)
class ChannelEvidence:
    """What the channels show of the effects.

    impossible: effects that the channels refute, or that need a channel that was not recorded; unvaried: effects that
    read a channel which was the same at every visit of a deflection, each with the sentence that says so; varied:
    channels that were set to several values
    """

    impossible: frozenset[str]
    unvaried: Mapping[str, str]
    varied: frozenset[str] = frozenset()


def channel_evidence(dataset: Dataset, cells: Sequence[Cells]) -> ChannelEvidence:
    """Return what the channels show; cells: of deflection and direction for each recording's blocks, -1 in a
    reversal.
    """
    impossible: set[str] = set()
    unvaried: dict[str, str] = {}
    varied: set[str] = set()
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
            for e in (changing if _is_read(dataset, channel.name) else ())
            if not (seen[e.name][0] > NEGLIGIBLE and seen[e.name][1] > NEGLIGIBLE * channel.resolution)
        }
        within, between = _spreads(value - followed, np.concatenate(cells))
        if within < max(channel.resolution, between):
            alike = _spreads(value, np.concatenate(cells))[0] < channel.resolution
            how = "was the same whenever a deflection was visited" if alike else "changed in one course only"
            same = f"the {channel.name} {how}: record at a second {channel.name}"
            unvaried |= {e.name: same for e in readers}
        else:
            varied.add(channel.name)
    return ChannelEvidence(frozenset(impossible), unvaried, frozenset(varied))


def _is_read(dataset: Dataset, channel: str) -> bool:
    """Return whether a channel was read, and not typed in: a reading is never quite the same all the time."""
    return any(np.ptp(e.measured[channel]) > 0.0 for e in dataset.experiments)


def _followed(
    value: FloatArray, effects: Sequence[Effect], dataset: Dataset
) -> tuple[FloatArray, dict[str, tuple[float, float]]]:
    """Return the part of a channel that all courses explain within the recordings, and for each effect two numbers: the
    part of the variance that it explains beyond the effects unlike it, and the size of its course, 0 where the fitted
    course has the opposite sign.
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
    """Return the leading courses of an effect's factor over all recordings, the first with the sign that the effect
    has.
    """
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
    """Return the function that subtracts the mean of each recording from the values of all of them in a row."""
    ends = np.cumsum([e.time.size for e in experiments])[:-1]
    return lambda values: np.concatenate([part - part.mean() for part in np.split(values, ends)])


def _spreads(values: FloatArray, cell: Cells) -> tuple[float, float]:
    """Return the standard deviations of the values within cells and of the cells' means; the cell -1 does not count."""
    inside = cell >= 0
    if not inside.any():
        return 0.0, 0.0
    own, place = values[inside], cell[inside]
    mean = (np.bincount(place, own) / np.maximum(np.bincount(place), 1))[place]
    return size_of(own - mean), float(np.std(mean))


CELLS = 12
"""Number of parts of the deflection's span; visits of one part count as visits of the same deflection."""

SPEEDS = 0.5
"""Standard deviation over mean of the speed, at one deflection and direction, below which there is one speed only."""

UNDER_WAY = 0.5
"""Speed over its root mean square above which the direction is certain, halfway between rest (0) and the usual speed
(1)."""

NO_EVIDENCE = ChannelEvidence(frozenset(), {})
"""For recordings whose channels were not examined."""


@dataclass(frozen=True)
class Excitation:
    """What the recorded motion and channels can show.

    returns: part of the variance of time between visits of the same deflection and direction; speeds: standard
    deviation over mean of the speed there; timed: whether the times of the samples are known; surfaces: their number;
    channels: what the recorded channels show; single_valued: effects that are functions of the deflection here, all of
    them where no deflection is passed twice and all at one speed
    """

    returns: float
    speeds: float
    timed: bool = True
    surfaces: int = 1
    channels: ChannelEvidence = NO_EVIDENCE
    single_valued: frozenset[str] = frozenset()

    @property
    def one_speed(self) -> bool:
        """Whether each deflection is passed at one speed only."""
        return self.speeds < SPEEDS

    def hidden(self, name: str) -> str:
        """Return why an effect cannot be shown; empty where it can."""
        if name in self.channels.unvaried:
            return self.channels.unvaried[name]
        traits = CATALOGUE[name].traits
        if not self.timed and {"rate", "slow"} & set(traits):
            return "the recording has no time"
        if "slow" in traits and self.returns < NEGLIGIBLE:
            return (
                "no deflection was visited again, so time cannot be told from deflection and direction: "
                "drive the same motion again"
            )
        return ""

    def reasons(self, names: Sequence[str]) -> dict[str, str]:
        """Return the effects of `names` that cannot be shown, each with the reason."""
        return {name: why for name in names if (why := self.hidden(name))}

    def alike(self, name: str) -> tuple[str, ...]:
        """Return the effects that this motion cannot distinguish from one: those that make loops, where each deflection
        is passed at one speed only.
        """
        if self.speeds >= SPEEDS or "loop" not in CATALOGUE[name].traits:
            return ()
        loops = (n for n, effect in CATALOGUE.items() if "loop" in effect.traits and n != name)
        return tuple(n for n in loops if not self.hidden(n))

    def of_deflection(self, name: str) -> bool:
        """Whether an effect depends on deflection and surface only, as a law does: in every motion, or in this one, as
        a mass does at one frequency, and everything in a single pull at one speed.
        """
        return always_of_deflection(name) or name in self.single_valued

    def within_law(self, name: str) -> bool:
        """Whether a law of another shape can imitate an effect: on one surface, one of the deflection alone can be
        imitated, unless it also depends on a channel.
        """
        return self.surfaces == 1 and self.of_deflection(name)


def always_of_deflection(name: str) -> bool:
    """Whether an effect depends on deflection and surface only, whatever the motion, and on no channel."""
    return "static" in CATALOGUE[name].traits and CATALOGUE[name].reads is None


def misread(signatures: Sequence[Signature], anew: Dataset) -> frozenset[str]:
    """Return the effects of which other readings of the same motion give another response (see `ALIKE`).

    The noise of the deflection makes such a response, and through the stiffness the force shows that noise too: the
    acceleration that is read of a slow press is the rounding of its gauge, and a mass would be found in it.
    anew: the recordings by other readings (`Dataset.read_anew`)
    """
    beside = baseline_of(anew)
    return frozenset(
        s.name for s in signatures if s.name != LAW and not s.silent and likeness(s, anew, beside) < ALIKE
    )


def acts_on_reading(name: str) -> bool:
    """Whether an effect acts on the force that is read, behind the tire or the part."""
    return CATALOGUE[name].place == "reading"


def excitation_of(dataset: Dataset, *, timed: bool = True) -> Excitation:
    """Return what the motion of all recordings can show; the speeds of recordings on one surface are taken together."""
    visits = [_visits(e) for e in dataset.experiments]
    returns = [_returns(e) for e in dataset.experiments]
    together: dict[float, list[_Visits]] = {}
    for experiment, own in zip(dataset.experiments, visits, strict=True):
        together.setdefault(float(np.median(experiment.surface_radius)), []).append(own)
    speeds = [
        _spread_within(np.concatenate([v.speed for v in same]), np.concatenate([v.cell for v in same]))
        for same in together.values()
    ]
    channels = channel_evidence(dataset, _common_cells(dataset.experiments))
    once = all(_passed_once(dataset.experiments, radius) for radius in together)
    single = frozenset(CATALOGUE) if once else frozenset[str]()
    return Excitation(max(returns), max(speeds), timed, len(dataset.radii), channels, single)


@dataclass(frozen=True)
class _Visits:
    """The samples of one recording that move: speed [m/s], and the cell of deflection and direction."""

    speed: FloatArray
    cell: NDArray[np.int_]


def _visits(e: Experiment) -> _Visits:
    moving = _moving(e)
    cell = _cells(e, e.rate, float(e.deflection.min()), float(e.deflection.max()))
    return _Visits(np.abs(e.rate[moving]), cell[moving])


def _returns(e: Experiment) -> float:
    """Return the part of the variance of time that is between visits of the same deflection and direction.

    A visit lasts from one reversal to the next: in a hold, where the deflection may creep, relaxation looks like a slow
    effect. Only samples that move count.
    """
    direction, cycle = branches(e.deflection, e.gauge)
    moving = _moving(e)
    cell = _cells(e, direction, float(e.deflection.min()), float(e.deflection.max()))[moving]
    visit = (cycle[moving] * 2 * CELLS + cell).astype(int)
    time = e.time[moving]
    mean = np.bincount(visit, time) / np.maximum(np.bincount(visit), 1)
    return _within(mean[visit], cell) / max(float(np.var(time)), 1e-300) if time.size else 0.0


def _passed_once(experiments: Sequence[Experiment], radius: float) -> bool:
    """Return whether hardly any deflection is passed twice on a surface, in either direction, and all at one speed.

    A jump of the speed shows what depends on it, and a rest what depends on time.
    """
    own = [e for e in experiments if float(np.median(e.surface_radius)) == radius]
    low, high = (end(end(e.deflection) for e in own) for end in (min, max))
    cells, visits, begin = [], [], 0
    for e in own:
        direction, cycle = branches(e.deflection, e.gauge)
        moving, speed = _moving(e), np.abs(e.rate)
        if np.mean(~moving) > NEGLIGIBLE or np.std(speed) > SPEEDS * np.mean(speed):
            return False
        cells.append(_cells(e, np.zeros_like(direction), low, high)[moving])
        visit = (2 * cycle + (direction > 0.0)).astype(int)[moving] + begin
        visits.append(visit)
        begin = int(visit.max(initial=begin)) + 1
    cell, visit = np.concatenate(cells), np.concatenate(visits)
    pairs = np.unique(cell * begin + visit)
    several = np.bincount(pairs // begin) > 1
    return bool(np.mean(several[cell]) < NEGLIGIBLE)


def _moving(e: Experiment, part: float = STILL) -> NDArray[np.bool_]:
    return np.asarray(np.abs(e.rate) > part * float(np.sqrt(np.mean(e.rate**2))))


def _cells(e: Experiment, direction: FloatArray, low: float, high: float) -> NDArray[np.int_]:
    """Return the cell of deflection, between two ends [m], and sign of the direction of each block."""
    span = (e.deflection - low) / max(high - low, 1e-300)
    return np.asarray(np.minimum((span * CELLS).astype(int), CELLS - 1) + CELLS * (direction > 0.0))


def _common_cells(experiments: Sequence[Experiment]) -> list[NDArray[np.int_]]:
    """Return the cells of every recording's blocks on one scale of the deflection; -1 where the tire turns."""
    low = min(float(e.deflection.min()) for e in experiments)
    high = max(float(e.deflection.max()) for e in experiments)
    return [np.where(_moving(e, UNDER_WAY), _cells(e, e.rate, low, high), -1) for e in experiments]


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
