"""What we can and cannot say: the effects found, how sure, what else it could be and why, what stays unexplained."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np
from radialtire import TireModel

from ..preprocessing.kinematics import FloatArray
from .discriminating_test import SeparatingTest
from .localization import Span
from .titles import UNKNOWN


@dataclass(frozen=True)
class Estimate:
    """A parameter's value with its standard deviation and unit."""

    value: float
    std: float
    unit: str


@dataclass(frozen=True)
class NamedEffect:
    """An effect that was left out: its parameters, and the share of the squared misfit that it accounts for."""

    name: str
    parameters: Mapping[str, Estimate]
    share: float


@dataclass(frozen=True)
class Rival:
    """Another set of effects that the recordings cannot rule out: log evidence below the verdict's, and why."""

    names: tuple[str, ...]
    log_odds: float
    reason: str


@dataclass(frozen=True)
class Evidence:
    """One set that was compared: log evidence over that of the verdict, chi square per sample, effects' sizes.

    size, unique: root mean square of each effect's part, and of what no other one in the set can stand for, over the
    noise
    """

    names: tuple[str, ...]
    log_evidence: float
    chi_square: float
    size: tuple[float, ...]
    unique: tuple[float, ...]


@dataclass(frozen=True)
class Correction:
    """What was learned of something beyond the catalogue: force [N] over one coordinate, and that it repeats.

    by: coordinate; at: its values in `unit`; force [N]; repeats: part of the misfit on blocks of time held out that the
    correction learned on the others explains, negative where it does not repeat
    after, held_out_after: RMSE [N] of the corrected tire with the force added, on what was fitted and what was not
    """

    by: str
    unit: str
    at: FloatArray = field(repr=False)
    force: FloatArray = field(repr=False)
    repeats: float = 0.0
    after: float = float("nan")
    held_out_after: float = float("nan")

    def to_contract(self) -> dict[str, object]:
        """Return an entry of `corrections` in diagnosis.json; the curve itself is in the report."""
        return {
            "by": self.by,
            "unit": self.unit,
            "repeats": self.repeats,
            "after": _number(self.after),
            "held_out_after": _number(self.held_out_after),
        }


@dataclass(frozen=True)
class Fit:
    """Noise and root mean square errors [N]; held_out_by: what was held out (see `held_out.HeldOut`).

    held_out_cleared: held_out_after where the tire is told the motion without the noise of its reading
    """

    noise: float
    before: float
    after: float
    held_out_before: float
    held_out_after: float
    held_out_by: str
    held_out_cleared: float = float("nan")


@dataclass(frozen=True)
class Verdict:
    """The answer of a diagnosis.

    effects: what is missing, empty where nothing is; confidence: 0 to 1; rivals: other sets, likeliest first
    unexplained: whether something acts that no effect explains, by `unexplained_by` (coordinates)
    summary: sentences for a reader; where: places of the misfit before the correction, of what the corrected law leaves
    of it where other effects are missing too; tire: the corrected one
    evidence: all sets that were compared to the end; separating_test: what would tell a rival apart, None where no
    motion within the rig's limits does (the summary then says so)
    compared: number of sets compared; evaluations: simulations of whole recordings in the final fit
    """

    effects: tuple[NamedEffect, ...]
    confidence: float
    rivals: tuple[Rival, ...]
    unexplained: bool
    unexplained_by: tuple[str, ...]
    corrections: tuple[Correction, ...]
    summary: str
    where: tuple[Span, ...]
    fit: Fit
    tire: TireModel
    evidence: tuple[Evidence, ...]
    separating_test: SeparatingTest | None
    compared: int
    evaluations: int

    @property
    def names(self) -> tuple[str, ...]:
        """Names of the effects, with "unknown" where something stays unexplained."""
        return (*(e.name for e in self.effects), *((UNKNOWN,) if self.unexplained else ()))

    def to_contract(self) -> dict[str, object]:
        """Return the content of diagnosis.json but for the names of the files beside it.

        What was learned of something unknown is told under "corrections", which is absent where nothing is unknown.
        """
        learned = {"corrections": [c.to_contract() for c in self.corrections]} if self.corrections else {}
        return {
            "schema": 1,
            "verdict": {
                "effects": [
                    {
                        "name": e.name,
                        "parameters": {
                            p: {"value": v.value, "std": v.std, "unit": v.unit}
                            for p, v in e.parameters.items()
                        },
                        "share": e.share,
                    }
                    for e in self.effects
                ],
                "confidence": self.confidence,
                "alternatives": [list(r.names) for r in self.rivals],
                "unexplained": self.unexplained,
                "summary": self.summary,
                "separating_test": None
                if self.separating_test is None
                else self.separating_test.to_contract(),
                **learned,
            },
            "where": [s.to_contract() for s in self.where],
            "fit": {
                "noise": self.fit.noise,
                "before": self.fit.before,
                "after": self.fit.after,
                "held_out_before": _number(self.fit.held_out_before),
                "held_out_after": _number(self.fit.held_out_after),
                "held_out_by": self.fit.held_out_by,
            },
        }


def _number(value: float) -> float | None:
    return float(value) if np.isfinite(value) else None
