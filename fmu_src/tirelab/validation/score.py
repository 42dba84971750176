"""The score of one trial: what was said against what was hidden."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass
from typing import Any, Literal

from ..diagnosis.diagnosis_file import NOTHING, Names, Stated
from ..names import UNKNOWN
from .held_out import Errors, HeldOut
from .overlap import PlaceScore

OPEN = "open"
"""The kind of trial whose effect no catalogue names."""

Told = Literal["told right", "told wrong", "still rivals", "no test", "failed"]


@dataclass(frozen=True)
class Separation:
    """What became of rivals when the suggested test was run on the rig and diagnosed along with the recordings.

    rivals: how many sets were named before; truth_among: whether the truth was one of them
    outcome: "told right" (one set, the truth, none of the earlier rivals beside it), "told wrong" (one set, another),
    "still rivals", "no test" (none was suggested), or "failed" (the rig refused it, or the second diagnosis failed)
    """

    rivals: int
    truth_among: bool
    outcome: Told


@dataclass(frozen=True)
class Score:
    """The score of one trial.

    kind: what was hidden, see `concealed.KINDS`; right: the sets that count as right, the true one first
    verdict: the set named ({"none"}: nothing is missing), None where the diagnosis failed; error: why it failed
    alternatives: the rivals named; confidence: as stated, None where the diagnosis failed
    sizes: size of everything hidden over the noise (RMS over the samples to which it is confined)
    seconds: what the diagnosis took
    """

    trial: str
    kind: str
    right: tuple[Names, ...]
    verdict: Names | None
    alternatives: tuple[Names, ...]
    confidence: float | None
    error: str | None
    sizes: Mapping[str, float]
    places: tuple[PlaceScore, ...]
    held_out: HeldOut | None
    separation: Separation | None
    seconds: float

    @property
    def exact(self) -> bool:
        """Whether the verdict is one of the sets that count as right, nothing missing, nothing added."""
        return self.verdict in self.right

    @property
    def among(self) -> bool:
        """Whether the verdict or one of its stated rivals is a set that counts as right."""
        return self.exact or any(names in self.right for names in self.alternatives)

    @property
    def open(self) -> bool:
        """Whether something outside of the catalogue was hidden."""
        return self.kind == OPEN

    @property
    def recognised(self) -> bool:
        """Whether the verdict says that something stays unexplained, whatever else it names."""
        return self.verdict is not None and UNKNOWN in self.verdict

    @property
    def false_alarm(self) -> bool:
        """Whether something is said to be missing where nothing was hidden; a failed diagnosis raises no alarm."""
        return self.kind == "none" and self.verdict is not None and not self.exact

    @property
    def added(self) -> Names:
        """The names in the verdict that belong to no set that counts as right."""
        if self.verdict is None:
            return frozenset()
        return self.verdict - NOTHING - frozenset().union(*self.right)

    @property
    def reference(self) -> Names:
        """The right set that the verdict is compared with: the one it names, else the true one."""
        return self.verdict if self.exact and self.verdict is not None else self.right[0]

    def name_of(self, effect: str) -> str:
        """Return the name that a right verdict has for something hidden: "unknown" where no catalogue names it."""
        return effect if effect in frozenset().union(*self.right) else UNKNOWN

    def demands(self, effect: str) -> bool:
        """Whether every set that counts as right names the effect, so that the recordings can show it."""
        return all(self.name_of(effect) in names for names in self.right)

    def named(self, effect: str) -> bool:
        """Whether the verdict names an effect."""
        return self.verdict is not None and self.name_of(effect) in self.verdict

    def to_json(self) -> dict[str, Any]:
        """Return the score as what JSON knows; `from_json` gives it back."""
        return {
            **{name: getattr(self, name) for name in ("trial", "kind", "confidence", "error", "seconds")},
            "right": [sorted(names) for names in self.right],
            "verdict": None if self.verdict is None else sorted(self.verdict),
            "alternatives": [sorted(names) for names in self.alternatives],
            "sizes": dict(self.sizes),
            "places": [asdict(place) for place in self.places],
            "held_out": None if self.held_out is None else asdict(self.held_out),
            "separation": None if self.separation is None else asdict(self.separation),
            "exact": self.exact,
            "among": self.among,
        }

    @classmethod
    def from_json(cls, content: Mapping[str, Any]) -> Score:
        """Return the score that `to_json` told."""
        return cls(
            trial=content["trial"],
            kind=content["kind"],
            right=tuple(map(frozenset, content["right"])),
            verdict=None if content["verdict"] is None else frozenset(content["verdict"]),
            alternatives=tuple(map(frozenset, content["alternatives"])),
            confidence=content["confidence"],
            error=content["error"],
            sizes=content["sizes"],
            places=tuple(PlaceScore(**place) for place in content["places"]),
            held_out=_held_out(content["held_out"]),
            separation=None if content["separation"] is None else Separation(**content["separation"]),
            seconds=content["seconds"],
        )


def _held_out(content: Mapping[str, Any] | None) -> HeldOut | None:
    if content is None:
        return None
    return HeldOut(Errors(**content["alike"]), Errors(**content["other"]), content["fmu_difference"])


def right_sets(answer: Mapping[str, Any]) -> tuple[Names, ...]:
    """Return the sets that count as right in an opened answer, the true one first."""
    return tuple(map(frozenset, answer["right"]))


def sizes_over_noise(answer: Mapping[str, Any]) -> dict[str, float]:
    """Return how large each hidden effect is over the noise, by its name in an opened answer."""
    return {name: float(size["raw"]) for name, size in answer["sizes"].items()}


def separation(right: Sequence[Names], first: Stated, second: Stated | None) -> Separation:
    """Return what became of the rivals of the `first` verdict in the `second` one (None: there is none)."""
    truth = right[0]
    before = {first.names, *first.alternatives}
    outcome: Told = "no test" if first.separating_test is None else _told(truth, before, second)
    return Separation(len(before), truth in before, outcome)


def _told(truth: Names, before: set[Names], second: Stated | None) -> Told:
    if second is None:
        return "failed"
    if set(second.alternatives) & before - {second.names}:
        return "still rivals"
    return "told right" if second.names == truth else "told wrong"
