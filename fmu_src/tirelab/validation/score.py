"""The score of one trial: the verdict against the answer."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass, field
from typing import Any, Literal, get_args

from ..diagnosis.diagnosis_file import NOTHING, Names, Stated
from ..names import UNKNOWN
from .held_out import Errors, HeldOut
from .overlap import RegionScore

OPEN = ("open", "outside")
"""The kinds of trial whose effect no catalogue names."""

Outcome = Literal["decided rightly", "decided wrongly", "undecided", "no test", "failed"]
OUTCOMES: tuple[Outcome, ...] = get_args(Outcome)


@dataclass(frozen=True)
class Discrimination:
    """What the recommended test decided: the rig ran it, and its recording was diagnosed together with the others.

    alternatives: number of sets stated before, the verdict among them; truth_among: whether the truth was one of them
    outcome: "decided rightly" (the verdict is the truth, no earlier set is left beside it), "decided wrongly" (it is
    another set), "undecided", "no test" (none was recommended), or "failed" (the rig refused the test, or the second
    diagnosis failed)
    right_after: whether the verdict with its recording is one of the right sets; None where there is none
    """

    alternatives: int
    truth_among: bool
    outcome: Outcome
    right_after: bool | None = None


@dataclass(frozen=True)
class Score:
    """The score of one trial.

    kind: what was hidden, see `concealed.KINDS`; right: the sets that count as right, the true one first
    verdict: the set named ({"none"}: nothing is missing), None where the diagnosis failed; error: why it failed
    alternatives: the alternatives stated; confidence: as stated, None where the diagnosis failed
    sizes: size of every hidden effect over the noise (RMS over the samples in which it is active)
    seconds: duration of the diagnosis
    derived: the sets that count as right by the rig's own fits (`concealed.derived_right`), empty where as in `right`
    probabilities: of every named effect, as stated; remainder: its size over the noise, as stated
    fitted: errors on the recordings that were diagnosed, None where there is no verdict
    same: probability of the alternatives that leave the same of the recordings as the verdict, as stated, together
    """

    trial: str
    kind: str
    right: tuple[Names, ...]
    verdict: Names | None
    alternatives: tuple[Names, ...]
    confidence: float | None
    error: str | None
    sizes: Mapping[str, float]
    regions: tuple[RegionScore, ...]
    held_out: HeldOut | None
    discrimination: Discrimination | None
    seconds: float
    derived: tuple[Names, ...] = ()
    probabilities: Mapping[str, float] = field(default_factory=dict)
    remainder: float | None = None
    fitted: Errors | None = None
    same: float = 0.0

    @property
    def exact(self) -> bool:
        """Whether the verdict is one of the sets that count as right, nothing missing, nothing added."""
        return self.verdict in self.right

    @property
    def among(self) -> bool:
        """Whether the verdict or one of its stated alternatives is a set that counts as right."""
        return self.exact or any(names in self.right for names in self.alternatives)

    @property
    def exact_as_derived(self) -> bool:
        """Whether the verdict is one of the sets that count as right by the rig's own fits."""
        return self.verdict in (self.derived or self.right)

    @property
    def single_answer(self) -> bool:
        """Whether one set alone counts as right."""
        return len(self.right) == 1

    @property
    def single_answer_as_derived(self) -> bool:
        """Whether one set alone counts as right by the rig's own fits."""
        return len(self.derived or self.right) == 1

    @property
    def open(self) -> bool:
        """Whether something outside the catalogue was hidden, and nothing else."""
        return self.kind in OPEN

    @property
    def beyond_catalogue(self) -> bool:
        """Whether something outside the catalogue was hidden, alone or beside known effects."""
        return any(UNKNOWN in names for names in self.right)

    @property
    def recognised(self) -> bool:
        """Whether the verdict states that something is unexplained, whatever else it names."""
        return self.verdict is not None and UNKNOWN in self.verdict

    @property
    def false_alarm(self) -> bool:
        """Whether the verdict names something where nothing was hidden; a failed diagnosis raises no alarm."""
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
        """Return the name of a hidden effect in a right verdict: "unknown" where no catalogue names it."""
        return effect if effect in frozenset().union(*self.right) else UNKNOWN

    def demands(self, effect: str) -> bool:
        """Whether every set that counts as right names the effect: the recordings show it."""
        return all(self.name_of(effect) in names for names in self.right)

    def named(self, effect: str) -> bool:
        """Whether the verdict names an effect."""
        return self.verdict is not None and self.name_of(effect) in self.verdict

    def to_json(self) -> dict[str, Any]:
        """Return the score as JSON data; `from_json` reads it back."""
        return {
            **{name: getattr(self, name) for name in ("trial", "kind", "confidence", "error", "seconds")},
            "right": [sorted(names) for names in self.right],
            "verdict": None if self.verdict is None else sorted(self.verdict),
            "alternatives": [sorted(names) for names in self.alternatives],
            "sizes": dict(self.sizes),
            "regions": [asdict(region) for region in self.regions],
            "held_out": None if self.held_out is None else asdict(self.held_out),
            "discrimination": None if self.discrimination is None else asdict(self.discrimination),
            "derived": [sorted(names) for names in self.derived],
            "probabilities": dict(self.probabilities),
            "remainder": self.remainder,
            "fitted": None if self.fitted is None else asdict(self.fitted),
            "same": self.same,
            "exact": self.exact,
            "among": self.among,
        }

    @classmethod
    def from_json(cls, content: Mapping[str, Any]) -> Score:
        """Return the score that `to_json` wrote."""
        return cls(
            trial=content["trial"],
            kind=content["kind"],
            right=tuple(map(frozenset, content["right"])),
            verdict=None if content["verdict"] is None else frozenset(content["verdict"]),
            alternatives=tuple(map(frozenset, content["alternatives"])),
            confidence=content["confidence"],
            error=content["error"],
            sizes=content["sizes"],
            regions=tuple(RegionScore(**region) for region in content["regions"]),
            held_out=_held_out(content["held_out"]),
            discrimination=None
            if content["discrimination"] is None
            else Discrimination(**content["discrimination"]),
            seconds=content["seconds"],
            derived=tuple(map(frozenset, content["derived"])),
            probabilities=content["probabilities"],
            remainder=content["remainder"],
            fitted=None if content["fitted"] is None else Errors(**content["fitted"]),
            same=content.get("same", 0.0),
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


def discrimination(right: Sequence[Names], first: Stated, second: Stated | None) -> Discrimination:
    """Return what the `second` verdict (None: there is none) decided about the alternatives of the `first`."""
    truth = right[0]
    before = {first.names, *first.alternatives}
    outcome: Outcome = "no test" if first.separating_test is None else _outcome(truth, before, second)
    tested = first.separating_test is not None and second is not None
    return Discrimination(
        len(before), truth in before, outcome, second.names in right if tested and second else None
    )


def _outcome(truth: Names, before: set[Names], second: Stated | None) -> Outcome:
    if second is None:
        return "failed"
    if set(second.alternatives) & before - {second.names}:
        return "undecided"
    return "decided rightly" if second.names == truth else "decided wrongly"
