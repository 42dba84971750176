"""Cases made by hand of which the truth is exact: what an engineer may hand in, each with one cause or a few."""

from __future__ import annotations

from . import instruments, mixtures, oscillations, parts, presses, repeats
from .case import Case, Drawn, cases_of

CASES: dict[str, Case] = {
    case.name: case
    for module in (presses, oscillations, mixtures, instruments, parts, repeats)
    for case in cases_of(module)
}

__all__ = ["CASES", "Case", "Drawn"]
