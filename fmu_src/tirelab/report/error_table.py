"""The errors of all recordings and of each, with the scale of their bars."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from . import words
from .loops import Case


def _rmse(cases: Sequence[Case], which: str) -> float:
    squares = [np.square(c.recording.force - getattr(c, which)) for c in cases]
    return float(np.sqrt(np.mean(np.concatenate(squares))))


def errors(
    fit: Mapping[str, Any], held_out_by: str, fitted: Sequence[Case], held_out: Sequence[Case]
) -> dict[str, Any]:
    """The rows of the table of errors [N], and the scale of its bars."""
    rows: list[tuple[str, str | None, float, float]] = [("Fitted", None, fit["before"], fit["after"])]
    if fit["held_out_before"] is not None:
        by = words.held_out_part(held_out_by)
        rows.append((f"Held-out{by}", None, fit["held_out_before"], fit["held_out_after"]))
    for kind, cases in (("fitted", fitted), ("held-out", held_out)):
        if len(cases) > 1:
            rows += [(kind, c.recording.name, _rmse([c], "before"), _rmse([c], "after")) for c in cases]
    finite = [v for *_, before, after in rows for v in (before, after) if math.isfinite(v)]
    return {"rows": rows, "noise": fit["noise"], "full": 1.08 * max([*finite, fit["noise"], 1e-9])}
