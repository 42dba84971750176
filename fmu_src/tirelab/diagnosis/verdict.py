"""The verdict: the effects that are missing, how sure, the alternatives and why, and what stays unexplained."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
from radialtire import TireModel

from ..engine.findings import Alternative, Evidence, NamedEffect
from ..names import UNKNOWN
from ..preprocessing.kinematics import FloatArray
from .discriminating_test import DiscriminatingTest
from .localization import Span


@dataclass(frozen=True)
class ResidualModel:
    """A regression of a residual that no effect explains: force [N] over one coordinate, and whether it repeats.

    by: coordinate; at: its values in `unit`; force [N]; r2: cross-validated R^2 over blocks of time, negative where the
    curve does not repeat
    after, held_out_after: RMSE [N] of the corrected tire with the force added, on fitted and on held-out data
    """

    by: str
    unit: str
    at: FloatArray = field(repr=False)
    force: FloatArray = field(repr=False)
    r2: float = 0.0
    after: float = float("nan")
    held_out_after: float = float("nan")

    def to_contract(self) -> dict[str, object]:
        """Return an entry of `corrections` in diagnosis.json; the curve itself is in the report."""
        return {
            "by": self.by,
            "unit": self.unit,
            "repeats": self.r2,
            "after": _number(self.after),
            "held_out_after": _number(self.held_out_after),
        }


@dataclass(frozen=True)
class Fit:
    """Noise and root mean square errors [N]; held_out_by: what was held out (see `held_out.HeldOut`).

    held_out_noise_free: held_out_after where the tire is given the noise-free deflection
    """

    noise: float
    before: float
    after: float
    held_out_before: float
    held_out_after: float
    held_out_by: str
    held_out_noise_free: float = float("nan")


@dataclass(frozen=True)
class Verdict:
    """The answer of a diagnosis.

    effects: what is missing, empty where nothing is; confidence: 0 to 1; alternatives: other sets, likeliest first
    unexplained_by: coordinates on which something depends that no effect explains; residual_models: regressions of it
    summary: sentences for a reader; where: places of the misfit before the correction, of what the corrected law leaves
    of it where other effects are missing too; tire: the corrected one
    evidence: all sets that were compared to the end; test: what would tell an alternative from the verdict, None where
    no motion within the rig's limits does (the summary then says so)
    compared: number of sets compared; evaluations: simulations of whole recordings in the final fit
    """

    effects: tuple[NamedEffect, ...]
    confidence: float
    alternatives: tuple[Alternative, ...]
    unexplained_by: tuple[str, ...]
    residual_models: tuple[ResidualModel, ...]
    summary: str
    where: tuple[Span, ...]
    fit: Fit
    tire: TireModel
    evidence: tuple[Evidence, ...]
    test: DiscriminatingTest | None
    compared: int
    evaluations: int

    @property
    def unexplained(self) -> bool:
        """Whether something acts that no effect explains."""
        return bool(self.unexplained_by)

    @property
    def names(self) -> tuple[str, ...]:
        """Names of the effects, with "unknown" where something stays unexplained."""
        return (*(e.name for e in self.effects), *((UNKNOWN,) if self.unexplained else ()))

    def to_contract(self) -> dict[str, object]:
        """Return the content of diagnosis.json but for the names of the files beside it.

        The regressions of something unknown stand under "corrections", which is absent where nothing is unknown.
        """
        regressed = (
            {"corrections": [c.to_contract() for c in self.residual_models]} if self.residual_models else {}
        )
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
                "alternatives": [list(r.names) for r in self.alternatives],
                "unexplained": self.unexplained,
                "summary": self.summary,
                "separating_test": None if self.test is None else self.test.to_contract(),
                **regressed,
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
