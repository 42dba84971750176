"""A channel that contradicts the force: without it an effect explains everything that it refutes.

A pressure that stays while the force leaks away is no proof that nothing leaks: the gauge may hang in front of a closed
valve, its value may have been typed in, or the temperature be that of the room. Where something stays unexplained, the
recordings are explained anew without one of their channels.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import Any

from radialtire import CATALOGUE, CHANNELS

from ..estimation.explanation import Explanation
from ..estimation.findings import NamedEffect
from ..preprocessing.samples import Recorded
from ..report.titles import newtons, set_title
from ..simulation.channels import measured_of
from .confidence import EITHER
from .contradiction import Contradiction

Explain = Callable[[Sequence[Recorded], Sequence[Recorded]], Explanation]
"""Explains the misfit of recordings, judged by others that are held out."""


@dataclass(frozen=True)
class ContradictingChannel(Contradiction):
    """A channel without which everything is explained.

    names: of the recordings; effects: what explains them without the channel, to the error `without` [N]; own [N]: what
    is left with it; channel: its name; refuted: those of the effects that it refutes
    """

    channel: str = ""
    refuted: tuple[str, ...] = ()

    @property
    def question(self) -> str:
        """What the confidence of the verdict is a probability of."""
        return f"That the {self.channel} is right and this is all that acts"

    @property
    def caution(self) -> str:
        """How the rest of the report is to be read."""
        return f"What is said here takes the {self.channel} as it was recorded."

    @property
    def headline(self) -> str:
        """The message about it without figures."""
        return f"The channel {self.channel} contradicts the force"

    @property
    def finding(self) -> str:
        """What shows it, in sentences."""
        verb = "explain" if len(self.effects) > 1 else "explains"
        told = f"{set_title(self.effects)} {verb} all to {newtons(self.without)} where the {self.channel} is left out"
        return (
            f"{told[0].upper()}{told[1:]}; with it {newtons(self.own)} are left, since it does not change as it would "
            f"by {set_title(self.refuted)}."
        )

    @property
    def action(self) -> str:
        """What to do about it, as a sentence."""
        return (
            f"Check that the {self.channel} was measured in the part itself; if it was not, leave it out: --columns "
            f"{self.channel}=."
        )

    @property
    def most_sure(self) -> float:
        """The largest confidence of a verdict beside it."""
        return EITHER

    def no_surer(self, effects: Sequence[NamedEffect]) -> tuple[NamedEffect, ...]:
        """Return the effects with the channel, those that are none without it at most as probable as either."""
        return tuple(
            e if e.name in self.effects else replace(e, probability=min(e.probability, EITHER))
            for e in effects
        )

    def to_dict(self) -> dict[str, object]:
        """Return the entry `contradiction` of diagnosis.json."""
        return {**super().to_dict(), "channel": self.channel, "refuted": list(self.refuted)}


def contradicting_channel(
    explanation: Explanation, recordings: Sequence[Recorded], held_out: Sequence[Recorded], explain: Explain
) -> ContradictingChannel | None:
    """Return the channel without which no more effects explain the recordings to the noise, None where there is none.

    explanation: with all channels; explain: returns what explains recordings
    """
    if not explanation.remainder.unexplained:
        return None
    channels = explanation.excitation.channels
    refuted = {*channels.impossible, *channels.unvaried}
    for name in (channel.name for channel in CHANNELS):
        affected = {
            e.name
            for e in CATALOGUE.values()
            if name in e.changes or (e.reads is not None and e.reads.channel == name)
        }
        if not affected & refuted or not all(name in measured_of(r) for r in recordings):
            continue
        other = explain(*([_without(r, name) for r in several] for several in (recordings, held_out)))
        found = tuple(n for n in other.model.names if n in affected & refuted)
        # What stays unexplained with the channel is one more that acts.
        if found and not other.remainder.unexplained and len(other.effects) <= len(explanation.effects) + 1:
            names = tuple(r.name for r in recordings)
            errors = other.error_left, explanation.error_left
            return ContradictingChannel(names, other.model.names, *errors, channel=name, refuted=found)
    return None


def _without(recording: Recorded, channel: str) -> Recorded:
    """Return a recording, and what was recorded before it, without one of its channels."""
    changed: Any = recording
    if channel not in measured_of(recording):
        return recording
    if (history := getattr(recording, "history", None)) is not None:
        changed = replace(changed, history=_without(history, channel))
    return replace(changed, **{channel: None})  # type: ignore[no-any-return]
