"""A recording in which something changes at once: a specimen slips or tears, an amplifier is switched.

An effect that changes slowly with the time, a leak or a drift, follows a step in part, and then seems sure. So where
something stays unexplained, what the set leaves without its slow effects is divided at up to MOST moments into ranges,
each with a mean of its own of one of three: a factor on the force, a zero of the deflection, a zero of the force. The
moments are found one by one, each where it leaves least. Ranges are such a change if they are likelier than the set by
more than NEAR, of EFFECTIVE samples and with the moment and the size of each step as parameters (BIC), and as much
likelier than a polynomial in time with as many parameters, which follows what changes slowly in a form of its own.

A step lies between whole cycles, and in none that goes further than all before it: the first loading of a part to a
deflection differs from all later ones by itself.
"""

from __future__ import annotations

import itertools
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np
from radialtire import CATALOGUE

from ..estimation.explanation import NEAR, Explanation
from ..estimation.findings import NamedEffect
from ..names import plain
from ..preprocessing.motion import BoolArray, FloatArray, Motion
from ..preprocessing.noise import STILL
from ..preprocessing.samples import Recorded, is_timed
from ..report.titles import newtons, set_title
from ..selection.search import EFFECTIVE
from ..simulation.simulate import simulate, smoothed_motion
from .confidence import EITHER
from .contradiction import EXPLAINED, Contradiction

MOST = 3
"""Budget: most steps in one recording; more of them would follow a slow change as a staircase."""

SHIFT = 1e-3
"""Part of the deflection's span by which the tangent of the force is found."""

ROUNDING = 1e-9
"""Part of a recording's sum of squares below which that of a range is rounding: there a factor on no force acts."""


@dataclass(frozen=True)
class SuddenChange(Contradiction):
    """Something that changes at once in one recording.

    names: of the recording; effects: the set; without, own [N]: what the steps and the set leave of the recordings;
    moments: where it changes, in words, the largest step first; change: that step, in words; slow: the effects of
    the set that the steps replace; several: whether there are other recordings
    """

    moments: tuple[str, ...] = ()
    change: str = ""
    slow: tuple[str, ...] = ()
    several: bool = False

    @property
    def question(self) -> str:
        """What the confidence of the verdict is a probability of."""
        return "That this is all that acts beside it"

    @property
    def is_all(self) -> bool:
        """Whether nothing else is to be said of the fitted recordings together."""
        return False

    @property
    def caution(self) -> str:
        """How the rest of the report is to be read."""
        if not self.slow:
            return "What is said here is of the whole recording, with the change in it."
        return f"What is said here takes the change for {set_title(self.slow)}."

    @property
    def headline(self) -> str:
        """The message about it without figures."""
        where = f" of {self.names[0]}" if self.several else ""
        return f"Something changes at once at {self.moments[0]}{where}"

    @property
    def finding(self) -> str:
        """What shows it, in sentences."""
        again = f", and again at {' and '.join(self.moments[1:])}" if len(self.moments) > 1 else ""
        verb = "leave" if len(self.effects) > 1 else "leaves"
        told = set_title(self.effects) if self.effects else "the baseline"
        return (
            f"It is as if {self.change} from there on{again}: that leaves {newtons(self.without)} where {told} "
            f"{verb} {newtons(self.own)}."
        )

    @property
    def action(self) -> str:
        """What to do about it, as a sentence."""
        moment = self.moments[0]
        ranges = f", FILE@:{moment} and FILE@{moment}:".replace(" s", "s") if moment.endswith(" s") else ""
        return (
            f"Look for what slipped, tore or was switched at {moment}, and diagnose the ranges before and after it "
            f"apart{ranges}."
        )

    @property
    def most_sure(self) -> float:
        """The largest confidence of a verdict beside it."""
        return EITHER if self.slow else 1.0

    def no_surer(self, effects: Sequence[NamedEffect]) -> tuple[NamedEffect, ...]:
        """Return the effects, those that the steps replace at most as probable as either."""
        return tuple(
            replace(e, probability=min(e.probability, EITHER)) if e.name in self.slow else e for e in effects
        )

    def to_dict(self) -> dict[str, object]:
        """Return the entry `contradiction` of diagnosis.json."""
        return {**super().to_dict(), "moments": list(self.moments), "slow": list(self.slow)}


class _Steps(NamedTuple):
    """Steps of one recording: its number, of what (its place in `_Ranges.of`), the first samples behind them, and their
    sizes in the unit of what they are of; what they and a polynomial leave of all recordings, as mean squares in units
    of the noise.
    """

    number: int
    what: int
    places: tuple[int, ...]
    sizes: tuple[float, ...]
    left: float
    smooth: float


class _Ranges:
    """One recording, to be divided into ranges.

    left (n,): what a set leaves of its compared samples, in units of the noise; of (3, n): what a factor of one more, a
    deflection [m] and a force [N] add there, in the same units; allowed (n,): where a step may be
    """

    def __init__(self, left: FloatArray, of: FloatArray, allowed: BoolArray) -> None:
        self.left, self.of, self.allowed = left, of, allowed

    def divided(self, what: int) -> list[tuple[tuple[int, ...], tuple[float, ...], float]]:
        """Return the first samples behind one to MOST steps, their sizes, and what they leave (a sum of squares)."""
        own = self.of[what]
        products, squares = (
            np.concatenate([[0.0], np.cumsum(values)]) for values in (own * self.left, own**2)
        )
        whole = float(self.left @ self.left)
        least = ROUNDING * float(squares[-1])

        def gained(begin: int, end: int) -> float:
            return float((products[end] - products[begin]) ** 2 / max(squares[end] - squares[begin], least))

        edges, found = [0, own.size], []
        for _ in range(MOST):
            best, place = 0.0, 0
            for begin, end in itertools.pairwise(edges):
                at = np.arange(begin + 1, end)
                if not at.size:
                    continue
                sides = [
                    (products[at] - products[begin]) ** 2 / np.maximum(squares[at] - squares[begin], least),
                    (products[end] - products[at]) ** 2 / np.maximum(squares[end] - squares[at], least),
                ]
                gain = sides[0] + sides[1] - gained(begin, end)
                if gain.max() > best:
                    best, place = float(gain.max()), int(at[np.argmax(gain)])
            if not place or not self.allowed[place]:
                break
            edges = sorted([*edges, place])
            pairs = list(itertools.pairwise(edges))
            means = [(products[e] - products[b]) / max(squares[e] - squares[b], least) for b, e in pairs]
            sizes = tuple(float(after - before) for before, after in itertools.pairwise(means))
            found.append((tuple(edges[1:-1]), sizes, whole - sum(gained(b, e) for b, e in pairs)))
        return found

    def smooth(self, what: int, steps: int) -> float:
        """Return what a polynomial with as many parameters as so many steps leaves (a sum of squares)."""
        place = np.linspace(-1.0, 1.0, self.left.size)
        columns = self.of[what][:, None] * np.polynomial.legendre.legvander(place, 2 * steps)
        basis = np.linalg.qr(columns)[0]
        return float(self.left @ self.left - np.sum((basis.T @ self.left) ** 2))


def sudden_change(
    explanation: Explanation, recordings: Sequence[Recorded], motions: Sequence[Motion]
) -> SuddenChange | None:
    """Return what changes at once in one of the recordings; None where nothing does, or all is explained.

    explanation: the set that is delivered
    """
    if not explanation.remainder.unexplained:
        return None
    own = _power(explanation)
    slow = tuple(n for n in explanation.model.names if n in CATALOGUE and "slow" in CATALOGUE[n].traits)
    less = tuple(n for n in explanation.model.names if n not in slow)
    beside = [(explanation, slow[:0], 0.0)]
    if slow and explanation.was_fitted(less):
        known = sum(len(e.parameters) for e in explanation.effects if e.name in slow)
        beside.append((explanation.of(less), slow, 0.5 * known * float(np.log(EFFECTIVE))))
    found = []
    for bare, dropped, spared in beside:
        steps = _best(bare, recordings, motions)
        if steps is not None and _is_sudden(steps, own, gain := _gain(own, steps) + spared):
            found.append((gain, steps, dropped))
    if not found:
        return None
    _, steps, dropped = max(found, key=lambda one: one[0])
    return _told(explanation, recordings, steps, steps.left / own, dropped)


def _is_sudden(steps: _Steps, own: float, gain: float) -> bool:
    """Return whether steps are likelier than a set and than a curve, and leave less than EXPLAINED of what it leaves.

    own: mean square that the set leaves, in units of the noise; gain: log odds by which they are likelier than it
    """
    over_curve = 0.5 * EFFECTIVE * np.log(steps.smooth / steps.left)
    return bool(gain > NEAR and over_curve > NEAR and steps.left - 1.0 < EXPLAINED * (own - 1.0))


def _gain(own: float, steps: _Steps) -> float:
    """Return by how much steps are likelier than what leaves `own`, a mean square in units of the noise: log odds."""
    return float(0.5 * EFFECTIVE * np.log(own / steps.left) - len(steps.places) * np.log(EFFECTIVE))


def _power(explanation: Explanation) -> float:
    """Return the mean square of what a set leaves, in units of the noise."""
    parts = zip(explanation.noise_free, explanation.noises, explanation.compared, strict=True)
    return float(np.mean(np.concatenate([(r / n)[c] ** 2 for r, n, c in parts])))


def _best(bare: Explanation, recordings: Sequence[Recorded], motions: Sequence[Motion]) -> _Steps | None:
    """Return the likeliest steps beside a set; None where none is likelier than the set."""
    parts = list(zip(bare.noise_free, bare.noises, bare.compared, strict=True))
    squares = [float(np.sum((r / n)[c] ** 2)) for r, n, c in parts]
    count, whole = sum(int(np.sum(c)) for _, _, c in parts), sum(squares)
    found: _Steps | None = None
    most = 0.0
    for number, (recording, motion, (left, noise, seen)) in enumerate(
        zip(recordings, motions, parts, strict=True)
    ):
        allowed = (motion.cycle < motion.cycle.max()) & ~_further(motion)
        if not (allowed & seen).any():
            continue
        ranges = _Ranges(
            (left / noise)[seen], _added(bare, recording, motion, left, noise)[:, seen], allowed[seen]
        )
        places = np.flatnonzero(seen)
        for what in range(ranges.of.shape[0]):
            for at, sizes, own in ranges.divided(what):
                others = whole - squares[number]
                of_steps, of_curve = ((others + part) / count for part in (own, ranges.smooth(what, len(at))))
                steps = _Steps(number, what, tuple(int(places[i]) for i in at), sizes, of_steps, of_curve)
                if (gain := _gain(whole / count, steps)) > most:
                    most, found = gain, steps
    return found


def _further(motion: Motion) -> BoolArray:
    """Return which samples (n,) belong to a cycle that goes further than all before it, either way."""
    cycle = motion.cycle.astype(int)
    further = np.zeros(cycle.max() + 1, dtype=bool)
    for way in (motion.deflection, -motion.deflection):
        ends = np.full(further.size, -np.inf)
        np.maximum.at(ends, cycle, way)
        before = np.concatenate([[-np.inf], np.maximum.accumulate(ends)[:-1]])
        further |= ends > before + STILL * float(np.ptp(way))
    return np.asarray(further[cycle])


def _added(
    bare: Explanation, recording: Recorded, motion: Motion, left: FloatArray, noise: FloatArray
) -> FloatArray:
    """Return what a factor of one more, a deflection [m] and a force [N] add to each sample (3, n), over its noise."""
    moved = smoothed_motion(recording, motion)
    force = recording.force - left
    shift = SHIFT * float(np.ptp(moved.deflection))
    deeper = replace(moved, deflection=moved.deflection + shift)
    tangent = (simulate(bare.model.tire, deeper, deeper) - simulate(bare.model.tire, moved, moved)) / shift
    return np.stack([force, tangent, np.ones_like(force)]) / noise


def _told(
    explanation: Explanation,
    recordings: Sequence[Recorded],
    steps: _Steps,
    part: float,
    slow: tuple[str, ...],
) -> SuddenChange:
    """Return the change that steps are; part: of the set's mean square that they leave."""
    recording = recordings[steps.number]
    largest = int(np.argmax(np.abs(steps.sizes)))
    places = (steps.places[largest], *(at for at in steps.places if at != steps.places[largest]))
    if is_timed([recording]):
        moments = tuple(f"{plain(float(recording.time[i]), 4)} s" for i in places)
    else:
        moments = tuple(f"sample {i + 1}" for i in places)
    size = steps.sizes[largest]
    change = (
        f"the force were {100.0 * abs(size):.2g} % {'more' if size > 0.0 else 'less'}",
        f"the zero of the deflection had moved by {1e3 * abs(size):.2g} mm",
        f"the zero of the force had moved by {newtons(abs(size))}",
    )[steps.what]
    return SuddenChange(
        (recording.name,),
        explanation.model.names,
        float(np.sqrt(part)) * explanation.error_left,
        explanation.error_left,
        moments=moments,
        change=change,
        slow=slow,
        several=len(recordings) > 1,
    )
