"""A held-out recording that shows what the fitted ones do not: driven otherwise, at deflections that they reached.

Nothing contradicts there, since no fitted recording says what another speed or direction does. But a verdict that
leaves such a recording as the baseline does is not the whole of it, however well it explains the fitted ones.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ..estimation.explanation import Explanation
from ..preprocessing.noise import NEGLIGIBLE
from ..preprocessing.samples import Recorded
from ..regressors.dataset import dataset_of
from ..report.titles import newtons, set_title
from .confidence import EITHER
from .contradiction import BEYOND_NOISE, EXPLAINED, Contradiction, Driven


@dataclass(frozen=True)
class Missed(Contradiction):
    """A held-out recording that is left as the baseline leaves it by what explains the fitted ones.

    names: its name; effects: what explains the fitted ones; without [N]: error that this leaves of them; own [N]: error
    that it leaves of the recording where it is driven otherwise; other: the name of the fitted one where there is one
    """

    @property
    def question(self) -> str:
        """What the confidence of the verdict is a probability of."""
        return "That this is all that acts"

    @property
    def headline(self) -> str:
        """The message about it without figures."""
        whom, verb = (self.other, "does") if self.other else ("the fitted ones", "do")
        return f"Recording {self.names[0]} shows what {whom} {verb} not"

    @property
    def finding(self) -> str:
        """What shows it, in sentences."""
        explained = set_title(self.effects) if self.effects else "the baseline"
        verb, misses = ("explain", "miss") if len(self.effects) > 1 else ("explains", "misses")
        return (
            f"{explained[0].upper()}{explained[1:]} {verb} {self.other or 'the fitted ones'} to "
            f"{newtons(self.without)} and {misses} {self.names[0]} by {newtons(self.own)}, at deflections that were "
            "fitted but where it is driven otherwise, as in speed or direction."
        )

    @property
    def action(self) -> str:
        """What to do about it, as a sentence."""
        doubt = f"If nothing explains them, check {self.suspects} of each."
        return f"Fit {self.names[0]} too: diagnose them together. {doubt}"

    @property
    def most_sure(self) -> float:
        """The largest confidence of a verdict beside it."""
        return EITHER


def missed_held_out(
    explanation: Explanation, recordings: Sequence[Recorded], held_out: Sequence[Driven]
) -> Missed | None:
    """Return the held-out recording that is missed the most where it is driven otherwise; None where none is.

    explanation: fitted to `recordings`. Missed is what has an error beyond that of the fitted ones and BEYOND_NOISE,
    and more than EXPLAINED of the baseline's: what a set explains in part, in a form of its own, it does not miss.
    """
    model, found = explanation.model, []
    for kept in held_out:
        if kept.otherwise.mean() < NEGLIGIBLE:
            continue
        own, before = (kept.missed_by(tire, kept.otherwise) for tire in (model.tire, model.baseline))
        if own <= max(explanation.error / EXPLAINED, EXPLAINED * before):
            continue
        level = dataset_of([kept.recording], model.baseline).experiments[0].floor.level
        if own > BEYOND_NOISE * float(np.hypot(level, model.missed(kept.moved))):
            found.append(
                Missed(
                    (kept.recording.name,),
                    model.names,
                    explanation.error,
                    own,
                    inflated=model.tire.inflated,
                    other=recordings[0].name if len(recordings) == 1 else "",
                    held_out=True,
                )
            )
    return max(found, key=lambda one: one.own, default=None)
