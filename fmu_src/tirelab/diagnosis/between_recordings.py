"""Recordings that differ among themselves: of several specimens, or mounted anew each time.

No one of them is far off the others, so none contradicts them; but one tire cannot follow all, and what it leaves hides
effects that each of them shows. In the states of motion that recordings share, the residuals R_i of one fitted tire are

    R_i = m + a_i G

with m what it misses in all of them, and G the force that the tire would gain in all of them if its force were larger
in one proportion, if the force's zero were another, or if the deflection's zero were. Each of the three is fitted by
least squares; with the best one taken out of the recordings, these are explained anew.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from ..estimation.explanation import Explanation
from ..names import plain
from ..preprocessing.motion import FloatArray, IndexArray, Motion
from ..preprocessing.samples import Recorded
from ..report.titles import newtons, set_title
from ..simulation.simulate import simulate, smoothed_motion
from .contradiction import EXPLAINED, Contradiction, Explain
from .states_of_motion import in_states, states_of

ROUNDS = 100
"""Most rounds in which m and a are found in turns."""

SETTLED = 1e-4
"""Change of all a in a round, relative to their size, with which the rounds end."""

STEP = 1e-3
"""Part of the largest deflection by which the motion is shifted for the tangent of the force."""


@dataclass(frozen=True)
class Difference(Contradiction):
    """By what recordings differ among themselves.

    names: of all; effects: what explains them with the difference taken out; without [N]: error that is left then; own
    [N]: error that is left otherwise; as_if: the difference, as a sentence
    differs: what does: factor, force [N] or deflection [m]; amounts: that of each recording, from the mean of all
    """

    differs: str = ""
    amounts: tuple[float, ...] = ()

    @property
    def headline(self) -> str:
        """The message about it without figures."""
        return "The recordings differ among themselves"

    @property
    def finding(self) -> str:
        """What shows it, in sentences."""
        explained = set_title(self.effects) if self.effects else "the baseline"
        verb = "explain" if len(self.effects) > 1 else "explains"
        left, own = newtons(self.without), newtons(self.own)
        return f"{self.as_if} With that taken out, {explained} {verb} them to {left}, otherwise to {own}."

    @property
    def action(self) -> str:
        """What to do about it, as a sentence."""
        return f"Check {self.suspects} of each, or diagnose them one by one."

    def to_dict(self) -> dict[str, object]:
        """Return the entry `contradiction` of diagnosis.json."""
        own = {"differs": self.differs, "amounts": dict(zip(self.names, self.amounts, strict=True))}
        return {**super().to_dict(), **own}


@dataclass(frozen=True)
class _Difference:
    """amounts (r,): a of each recording, their mean 0; left: part of the differences' power that they leave"""

    kind: str
    amounts: FloatArray
    left: float

    def aligned(self, recording: Recorded, number: int) -> Recorded:
        """Return a recording with its difference taken out."""
        amount = float(self.amounts[number])
        if self.kind == "deflection":
            return replace(recording, deflection=recording.deflection + amount)  # type: ignore[type-var]
        force = recording.force / (1.0 + amount) if self.kind == "factor" else recording.force - amount
        return replace(recording, force=force)  # type: ignore[type-var]

    def sentence(self, names: Sequence[str]) -> str:
        """Return what differs, from the recording with the least to that with the most."""
        least, most = int(np.argmin(self.amounts)), int(np.argmax(self.amounts))
        if self.kind == "deflection":
            between = (
                f"the zero of the deflection were up to {1e3 * np.ptp(self.amounts):#.3g} mm off between them"
            )
        elif self.kind == "force":
            between = (
                f"the zero of the force were up to {newtons(float(np.ptp(self.amounts)))} off between them"
            )
        else:
            ratio = (1.0 + self.amounts[most]) / (1.0 + self.amounts[least]) - 1.0
            between = f"the force were up to {plain(100.0 * ratio, 2)} % larger in one than in another"
        return f"It is as if {between}: least in {names[least]}, most in {names[most]}."


def difference_between(
    explanation: Explanation, recordings: Sequence[Recorded], motions: Sequence[Motion], explain: Explain
) -> Difference | None:
    """Return by what the recordings differ among themselves; None where it is not that, or all are explained together.

    It is if one number for each recording takes EXPLAINED of the differences out of it, and if what explains the
    recordings then leaves less than that part of what it left before.

    explanation: of all recordings; explain: returns what explains the misfit of recordings
    """
    if len(recordings) < 2 or not explanation.remainder.unexplained:
        return None
    found = _largest_difference(explanation, recordings, motions)
    if found is None or found.left > EXPLAINED**2:
        return None
    anew = explain([found.aligned(r, i) for i, r in enumerate(recordings)])
    if anew.error >= EXPLAINED * explanation.error:
        return None
    names = tuple(r.name for r in recordings)
    return Difference(
        names,
        anew.model.names,
        anew.error,
        explanation.error,
        found.sentence(names),
        anew.model.tire.inflated,
        differs=found.kind,
        amounts=tuple(found.amounts.tolist()),
    )


def _largest_difference(
    explanation: Explanation, recordings: Sequence[Recorded], motions: Sequence[Motion]
) -> _Difference | None:
    """Return the kind of difference that leaves least, None where no states of motion are shared."""
    tire = explanation.model.tire
    step = STEP * max(float(np.abs(m.deflection).max()) for m in motions)
    moved = [smoothed_motion(r, m) for r, m in zip(recordings, motions, strict=True)]
    forces = [simulate(tire, m, m) for m in moved]
    shifted = [replace(m, deflection=m.deflection + step) for m in moved]
    tangents = [(simulate(tire, m, m) - f) / step for m, f in zip(shifted, forces, strict=True)]
    gains = {"factor": forces, "force": [np.ones_like(f) for f in forces], "deflection": tangents}
    misses = [r.force - f for r, f in zip(recordings, forces, strict=True)]
    states = states_of(recordings, motions)
    found = []
    for kind, gain in gains.items():
        fitted = _fitted(states, misses, gain)
        if fitted is not None and (kind != "factor" or fitted[0].min() > -1.0):
            found.append(_Difference(kind, *fitted))
    return min(found, key=lambda d: d.left, default=None)


def _fitted(
    states: Sequence[IndexArray], misses: Sequence[FloatArray], gains: Sequence[FloatArray]
) -> tuple[FloatArray, float] | None:
    """Return a (r,) and the part of the power of the differences that it leaves; None where no states are shared.

    states, misses, gains: of each recording the number of the state, R and G at each sample
    """
    counts, *sums = in_states(states, misses, gains)
    counts[:, (counts > 0.0).sum(axis=0) < 2] = 0.0
    if not counts.any(axis=1).all():
        return None
    missed, gain = (own / np.maximum(counts, 1.0) for own in sums)
    total = np.maximum(counts.sum(axis=0), 1.0)
    slope = np.maximum((counts * gain**2).sum(axis=1), 1e-300)
    amounts = np.zeros(len(counts))
    for _ in range(ROUNDS):
        common = (counts * (missed - amounts[:, None] * gain)).sum(axis=0) / total
        new = (counts * gain * (missed - common)).sum(axis=1) / slope
        new -= new.mean()
        done = np.abs(new - amounts).max() <= SETTLED * np.abs(new).max()
        amounts = new
        if done:
            break
    powers = []
    for a in (np.zeros_like(amounts), amounts):
        left = missed - a[:, None] * gain
        powers.append(float((counts * (left - (counts * left).sum(axis=0) / total) ** 2).sum()))
    return amounts, powers[1] / max(powers[0], 1e-300)
