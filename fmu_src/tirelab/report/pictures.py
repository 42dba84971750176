"""The pictures of the page: loops of the recordings, and courses and maps of the residual."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from .loops import Case, draw_difference, draw_loops
from .residuals import (
    draw_maps,
    draw_over_deflection,
    draw_over_rate,
    draw_over_time,
    draw_slow_changes,
    misfit_of,
)

MOST_LOOPS = 4
"""Recordings whose loops are drawn, those with the largest misfit first."""


def loops(fitted: Sequence[Case], held_out: Sequence[Case]) -> dict[str, Any]:
    """The pictures of the loops: of the recording with the largest misfit a pair, of the others one each."""
    order = sorted(fitted, key=lambda c: -c.excess)
    worst = order[0]
    pair = [
        draw_loops(worst, which, f"p{which[0]}", f"Force over deflection, recorded and simulated, {which}.")
        for which in (("before",) if worst.alike else ("before", "after"))
    ]
    chosen = [("fitted", c) for c in order[1:]] + [("held-out", c) for c in held_out]
    alt = "Force over deflection, recorded and simulated before and after the correction."
    others = [
        (kind, case.recording.name, draw_loops(case, "both", f"o{i}x", alt))
        for i, (kind, case) in enumerate(chosen[: MOST_LOOPS - 1])
    ]
    return {
        "name": worst.recording.name,
        "pair": pair,
        "difference": draw_difference(worst, "df"),
        "alike": all(c.alike for c in fitted),
        "others": others,
        "missing": len(chosen) - len(others),
        "several": len(chosen) > 0,
    }


def residuals(cases: Sequence[Case], noise: float) -> dict[str, Any]:
    """The pictures of the residual with the noise [N], and the name of the maps' second coordinate."""
    misfit = misfit_of(cases)
    maps, second = draw_maps(misfit, noise, "m")
    return {
        "lines": [
            draw_over_time(misfit, noise, "t"),
            draw_over_deflection(misfit, noise, "d"),
            draw_over_rate(misfit, noise, "r"),
            draw_slow_changes(misfit, noise, "s"),
        ],
        "maps": maps,
        "second": second,
        "alike": misfit.alike,
    }
