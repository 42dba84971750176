"""A verdict with the forces that belong to it -> the content of diagnosis.json, and what the report says besides."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..recordings.recording import Recording
from ..report.titles import newtons
from .verdict import ResidualModel, Verdict

FloatArray = NDArray[np.float64]

TIRE, FMU, DIAGNOSIS, REPORT, TEST = (
    "tire.json",
    "BicycleTire.fmu",
    "diagnosis.json",
    "report.html",
    "separating_test.csv",
)
"""The files of a diagnosis, in its folder."""


@dataclass(frozen=True)
class Replayed:
    """Recordings with the forces [N] that the believed tire simulates and the corrected FMU gives; one array each."""

    recordings: Sequence[Recording]
    before: Sequence[FloatArray]
    after: Sequence[FloatArray]

    def rmse(self, forces: Sequence[FloatArray]) -> float | None:
        """Return the root mean square error [N] of `forces` over all recordings together; None without any."""
        if not self.recordings:
            return None
        squares = [np.square(r.force - f) for r, f in zip(self.recordings, forces, strict=True)]
        return float(np.sqrt(np.mean(np.concatenate(squares))))


def contract_of(verdict: Verdict, fitted: Replayed, held_out: Replayed) -> dict[str, Any]:
    """Return the content of diagnosis.json, schema 1, with the errors of the corrected FMU itself.

    The held-out errors are those of the recordings held out; without any, those of the part that the diagnosis left
    out of a fit of its own (`held_out_by` says which). A number that is not known is null.
    """
    content: dict[str, Any] = dict(verdict.to_contract())
    content["fit"] = {
        **content["fit"],
        "before": fitted.rmse(fitted.before),
        "after": fitted.rmse(fitted.after),
    }
    content["held_out_by"] = content["fit"].pop("held_out_by")
    if held_out.recordings:
        content["fit"] |= {
            "held_out_before": held_out.rmse(held_out.before),
            "held_out_after": held_out.rmse(held_out.after),
        }
    told = dict(content["verdict"])
    if told["separating_test"] is not None:
        told["separating_test"] = {**told["separating_test"], "file": TEST}
    content["verdict"] = told
    content |= {"tire": TIRE, "corrected_fmu": FMU, "report": REPORT}
    return dict(_finite(content))


def beside(verdict: Verdict) -> dict[str, Any]:
    """Return what `write_report` can take besides the contract (see there)."""
    test = verdict.test
    return {
        "evidence": [
            {
                "effects": list(e.names),
                "log_evidence": e.log_evidence,
                "misfit": math.sqrt(max(e.chi_square, 0.0)),
                "remark": _remark(number, e.log_evidence),
            }
            for number, e in enumerate(verdict.evidence)
        ],
        "reasons": [r.reason for r in verdict.alternatives],
        "correction": [_correction(c) for c in verdict.residual_models],
        "waveform": None
        if test is None
        else {"time": test.test.time.tolist(), "deflection": test.test.deflection.tolist()},
    }


def _remark(number: int, log_evidence: float) -> str:
    if number == 0:
        return "the verdict"
    return "" if math.isfinite(log_evidence) else "a part too small, or of a sign it cannot have"


def _correction(found: ResidualModel) -> dict[str, Any]:
    if found.r2 > 0.0:
        repeats = (
            f"It repeats: it explains {100.0 * found.r2:.0f} % of what is left on blocks of time not seen."
        )
    else:
        repeats = "It does not repeat on blocks of time not seen: do not use it."
    if math.isfinite(found.after):
        repeats += f" With it the error is {newtons(found.after)}"
        unseen = math.isfinite(found.held_out_after)
        repeats += f", and {newtons(found.held_out_after)} on what was not fitted." if unseen else "."
    return {
        "by": found.by,
        "unit": found.unit,
        "x": found.at.tolist(),
        "force": found.force.tolist(),
        "std": None,
        "repeats": repeats,
    }


def _finite(value: Any) -> Any:
    """Return plain Python values that JSON can carry: null for numbers that are none."""
    if isinstance(value, Mapping):
        return {str(k): _finite(v) for k, v in value.items()}
    if isinstance(value, (list, tuple)):
        return [_finite(v) for v in value]
    if isinstance(value, np.generic):
        value = value.item()
    if isinstance(value, float) and not math.isfinite(value):
        return None
    return value
