"""A recording that contradicts the others: driven as they are, it has a force that no set of effects makes of theirs.

A recording is suspected where its misfit differs from that of the others in the same states of motion: surface,
direction, deflection and speed. The others are then explained anew without it. It contradicts them if they are
explained much better alone, and if their tire is far off it where it is driven as they are. It may be of another tire,
pressure or zero, or have another past: another zero of a gauge or a factor on its force is named where that alone makes
it agree. So may a held-out recording, whether a set was refused by it or not.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np
from radialtire import TireModel
from scipy.optimize import minimize_scalar

from ..estimation.explanation import Explanation
from ..estimation.findings import NamedEffect
from ..preprocessing.data_checks import compared
from ..preprocessing.motion import BoolArray, FloatArray, IndexArray, Motion, motion_of
from ..preprocessing.noise import NEGLIGIBLE
from ..preprocessing.samples import Recorded, is_timed
from ..report.titles import newtons, set_title
from ..simulation.simulate import SmoothedMotion, simulate, smoothed_motion
from .held_out import rmse
from .states_of_motion import driven_alike, in_states, places_of, states_of, ways_of

EXPLAINED = 0.5
"""A recording contradicts the others only if what explains them leaves less than this part of what all recordings
together are left with, and less than this part of what it leaves of that recording."""

BEYOND_NOISE = 3.0
"""Least error of that tire on the recording, over its noise floor and the form errors of its effects together."""

ANEW = 0.1
"""Budget: part of that of a ranking with which the others are explained anew: to leave half as much needs little."""

SUSPECTED = 2
"""Budget: most recordings without which the others are explained anew, the one furthest apart first."""

Explain = Callable[[Sequence[Recorded]], Explanation]


@dataclass(frozen=True)
class Contradiction:
    """A recording that contradicts the others.

    names: its name, or both names where there are two recordings; effects: what explains the others; without [N]: error
    that this leaves of them; own [N]: error that it leaves of the recording, where it is driven as they are
    as_if: what alone would make the recording agree, as a sentence; empty where nothing of it does
    inflated: whether they are of tires, which have a pressure, and not of parts
    other: the name of the other one where there is one only; one_series: whether they are parts of one file, so that
    gauges and specimen are the same; held_out: whether it is held out, so that the verdict is that of the others
    named: whether the verdict beside it names an effect
    """

    names: tuple[str, ...]
    effects: tuple[str, ...]
    without: float
    own: float
    as_if: str = ""
    inflated: bool = True
    other: str = ""
    one_series: bool = False
    held_out: bool = False
    named: bool = True

    @property
    def question(self) -> str:
        """What the confidence of the verdict is a probability of."""
        if self.held_out:
            return "That it holds for the fitted ones"
        return f"That {'one explanation holds for' if self.named else 'no known effect explains'} all of them"

    @property
    def is_all(self) -> bool:
        """Whether nothing else is to be said of the fitted recordings together."""
        return not (self.held_out or self.named)

    @property
    def caution(self) -> str:
        """How the rest of the report is to be read."""
        if self.held_out:
            return "What is said here is of the fitted recordings alone."
        return "What is said here of all of them is no more than a guess."

    @property
    def headline(self) -> str:
        """The message about it without figures."""
        if len(self.names) > 1:
            return f"Recordings {' and '.join(self.names)} contradict each other"
        return f"Recording {self.names[0]} contradicts {self.other or 'the others'}"

    @property
    def finding(self) -> str:
        """What shows it, in sentences."""
        explained = set_title(self.effects) if self.effects else "the baseline"
        left, own = newtons(self.without), newtons(self.own)
        if len(self.names) > 1:
            whom, missed, where = "one", "the other", "they are driven alike"
        else:
            whom, missed, where = "the others", self.names[0], "it is driven as they are"
            if self.other:
                whom, where = self.other, "they are driven alike"
        verb, misses = ("explain", "miss") if len(self.effects) > 1 else ("explains", "misses")
        found = f"{explained} {verb} {whom} to {left} and {misses} {missed} by {own} where {where}."
        return " ".join(filter(None, (f"{found[0].upper()}{found[1:]}", self.as_if)))

    @property
    def suspects(self) -> str:
        """What may be another one in each recording."""
        return "tire, pressure and zero" if self.inflated else "part and zero"

    @property
    def action(self) -> str:
        """What to do about it, as a sentence."""
        apart = "them" if len(self.names) > 1 else self.names[0]
        if self.one_series:
            return (
                f"Look for what slipped, yielded, cracked or drifted between them, or diagnose {apart} apart."
            )
        return f"Check {self.suspects} of each, and what it had been through, or diagnose {apart} apart."

    @property
    def most_sure(self) -> float:
        """The largest confidence of a verdict beside it."""
        return 1.0

    def no_surer(self, effects: Sequence[NamedEffect]) -> tuple[NamedEffect, ...]:
        """Return the effects of that verdict, each at most as probable as it lets them be."""
        return tuple(effects)

    @property
    def sentences(self) -> str:
        """The whole message about it."""
        return f"{self.headline}. {self.finding} {self.action}"

    def to_dict(self) -> dict[str, object]:
        """Return the entry `contradiction` of diagnosis.json."""
        return {
            "recordings": list(self.names),
            "effects_of_the_others": list(self.effects),
            "others_after": self.without,
            "own_after": self.own,
            "headline": self.headline,
            "finding": self.finding,
            "action": self.action,
            "question": self.question,
            "caution": self.caution,
        }


def contradiction_of(
    explanation: Explanation,
    recordings: Sequence[Recorded],
    motions: Sequence[Motion],
    before: Sequence[FloatArray],
    explain: Explain,
) -> Contradiction | None:
    """Return the recording that contradicts the others, None where there is none or all are explained together.

    explanation: of all recordings; before [N]: misfit of the baseline in each; explain: returns what explains the
    misfit of some of them
    """
    if len(recordings) < 2 or not explanation.remainder.unexplained:
        return None
    together = min(e.error for e in (explanation, *map(explanation.of, explanation.in_order(1))))
    states, places = states_of(recordings, motions), places_of(recordings, motions)
    ways = ways_of(places, motions)
    apart = _apart(before, states)
    found: list[tuple[float, Contradiction]] = []
    for number in np.argsort(-apart)[:SUSPECTED].tolist():
        if apart[number] < EXPLAINED * together:
            break
        recording, level = recordings[number], explanation.floors[number].level
        others = explain([r for i, r in enumerate(recordings) if i != number])
        alike = driven_alike(states, places, ways, number)[0] & explanation.compared[number]
        if others.error >= EXPLAINED * together or alike.mean() < NEGLIGIBLE:
            continue
        moved = smoothed_motion(recording, motions[number])
        own = min(missed(others.model.tire, recording, m, alike) for m in (None, moved))
        forms = others.model.missed(moved)
        if own > max(others.error / EXPLAINED, BEYOND_NOISE * float(np.hypot(level, forms))):
            names = [r.name for r in recordings] if len(recordings) == 2 else [recording.name]
            as_if = _as_if(recording, moved, others.model.tire, alike, own)
            one = Contradiction(
                *(tuple(names), others.model.names, others.error, own, as_if, others.model.tire.inflated),
                one_series=_of_one_series(recordings),
            )
            found.append((others.error, one))
        if not others.remainder.unexplained:
            break
    return min(found, key=lambda one: one[0])[1] if found else None


@dataclass(frozen=True)
class Driven:
    """A held-out recording beside the fitted ones.

    moved: its smoothed motion; alike, otherwise: its compared samples that a fitted recording, or another held-out one,
    drives alike, and those that it drives otherwise (see `driven_alike`)
    """

    recording: Recorded
    moved: SmoothedMotion
    alike: BoolArray
    otherwise: BoolArray

    def missed_by(self, tire: TireModel, samples: BoolArray) -> float:
        """Return the error [N] of a tire on some samples, of the readings or the smoothed motion, where it is less.

        What begins in motion is not followed at once, and what follows noise of the reading is not of the part.
        """
        return min(missed(tire, self.recording, m, samples) for m in (None, self.moved))


def driven(recordings: Sequence[Recorded], held_out: Sequence[Recorded]) -> list[Driven]:
    """Return the held-out recordings with how they are driven beside `recordings`."""
    every = [*recordings, *held_out]
    motions = [motion_of(r.time, r.deflection, timed=is_timed([r])) for r in every]
    states, places = states_of(every, motions), places_of(every, motions)
    ways = ways_of(places, motions)
    found = []
    for number, (recording, seen) in enumerate(
        zip(held_out, compared(held_out), strict=True), len(recordings)
    ):
        alike, otherwise = driven_alike(states, places, ways, number)
        found.append(
            Driven(recording, smoothed_motion(recording, motions[number]), alike & seen, otherwise & seen)
        )
    return found


def contradiction_held_out(
    explanation: Explanation, recordings: Sequence[Recorded], held_out: Sequence[Driven]
) -> Contradiction | None:
    """Return the held-out recording that would agree if one zero or factor of its own were another; None where there
    is none.

    explanation: fitted to `recordings`
    """
    level = float(np.sqrt(np.mean([floor.level**2 for floor in explanation.floors])))
    model = explanation.model
    for kept in held_out:
        if kept.alike.mean() < NEGLIGIBLE:
            continue
        own = kept.missed_by(model.tire, kept.alike)
        beyond = BEYOND_NOISE * float(np.hypot(level, model.missed(kept.moved)))
        if own > max(explanation.error / EXPLAINED, beyond):
            as_if = _as_if(kept.recording, kept.moved, model.tire, kept.alike, own)
            if as_if:
                return Contradiction(
                    *(
                        (kept.recording.name,),
                        model.names,
                        explanation.error,
                        own,
                        as_if,
                        model.tire.inflated,
                    ),
                    other=recordings[0].name if len(recordings) == 1 else "",
                    one_series=_of_one_series([*recordings, kept.recording]),
                    held_out=True,
                )
    return None


def missed(tire: TireModel, recording: Recorded, moved: SmoothedMotion | None, alike: BoolArray) -> float:
    """Return the error [N] of a tire on some samples of a recording, given its deflection as read or smoothed."""
    force = simulate(tire, recording) if moved is None else simulate(tire, moved, moved)
    return rmse([(recording.force - force)[alike]])


def _of_one_series(recordings: Sequence[Recorded]) -> bool:
    """Return whether all are parts of what was recorded in one go: ranges of one file, all but the first with what was
    recorded before them; trials that stand in one file have nothing before them.
    """
    sources = {str(getattr(recording, "source", None)) for recording in recordings}
    begun = sum(getattr(recording, "history", None) is not None for recording in recordings)
    return len(sources) == 1 and begun >= len(recordings) - 1


def _apart(misfits: Sequence[FloatArray], states: Sequence[IndexArray]) -> FloatArray:
    """Return by how much the mean misfit of each recording differs from that of the others in the states that they
    share, root mean square [N] over their samples; 0 where they share none.
    """
    counts, sums = in_states(states, misfits)
    other_counts, other_sums = counts.sum(axis=0) - counts, sums.sum(axis=0) - sums
    shared = np.where(other_counts > 0.0, counts, 0.0)
    differences = sums / np.maximum(counts, 1.0) - other_sums / np.maximum(other_counts, 1.0)
    powers = np.sum(shared * differences**2, axis=1) / np.maximum(shared.sum(axis=1), 1.0)
    return np.asarray(np.sqrt(powers))


def _as_if(recording: Recorded, moved: SmoothedMotion, tire: TireModel, alike: BoolArray, own: float) -> str:
    """Return the one change of a recording that makes it agree with the tire of the others, or where none does another
    zero and another stiffness together, as another part has them; empty where these do not either.

    It agrees if less than EXPLAINED is left of the error `own` [N].
    """
    read = recording.force[alike]
    reach = 0.5 * float(np.ptp(moved.deflection))

    def shifted(by: float) -> FloatArray:
        nearer = replace(moved, deflection=moved.deflection - by)
        return np.asarray(simulate(tire, nearer, nearer)[alike])

    def times(force: FloatArray) -> float:
        return float(force @ read) / max(float(force @ force), 1e-300)

    def at_best(left: Callable[[FloatArray], float]) -> tuple[float, float]:
        found = minimize_scalar(lambda by: left(shifted(by)), bounds=(-reach, reach), method="bounded")
        return float(found.fun), float(found.x)

    def zero(by: float) -> str:
        return f"the zero of the deflection of {recording.name} were {1e3 * abs(by):#.3g} mm off"

    force = shifted(0.0)
    offset, factor = float(np.mean(read - force)), times(force)
    left, shift = at_best(lambda there: rmse([read - there]))
    changes = [
        (left, zero(shift)),
        (
            rmse([read - force - offset]),
            f"the zero of the force of {recording.name} were {newtons(abs(offset))} off",
        ),
    ]
    if factor > 0.0:  # no part's force is that of another one turned round
        by = "pressure or tire" if tire.inflated else "part"
        told = f"the force of {recording.name} were {_more(factor)}, by another {by}"
        changes.append((rmse([read - factor * force]), told))
    left, change = min(changes)
    if left >= EXPLAINED * own:  # another part has another zero, too
        left, shift = at_best(lambda there: rmse([read - times(there) * there]))
        factor = times(shifted(shift))
        if factor <= 0.0:
            return ""
        change = f"{zero(shift)} and its force {_more(factor)}"
    return f"It is as if {change}." if left < EXPLAINED * own else ""


def _more(factor: float) -> str:
    """Return in words by how much a force is larger: "12 % more"."""
    percent = 100.0 * abs(factor - 1.0)
    return f"{percent:{'.0f' if percent > 100.0 else '.2g'}} % {'more' if factor > 1.0 else 'less'}"
