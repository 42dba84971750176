"""A recording in one line, and as a small table for a notebook."""

from __future__ import annotations

import math
from collections.abc import Sequence
from html import escape

import numpy as np
from numpy.typing import NDArray

FloatArray = NDArray[np.float64]

MOST_RADII = 3
"""With more surface radii than these, only their number and range are shown."""

IN_METRES = 10.0
"""Radii from this one on [m] are shown in metres, those of bumps in centimetres."""


def facts(
    time: FloatArray, deflection: FloatArray, surface_radius: FloatArray, force: FloatArray
) -> tuple[tuple[str, str], ...]:
    """Return what a reader wants to know first, as pairs of a name and a text."""
    return (
        ("samples", f"{len(time)}"),
        ("duration", f"{_rounded(float(time[-1] - time[0]), 3)} s"),
        ("deflection", _range(1000.0 * float(deflection.min()), 1000.0 * float(deflection.max())) + " mm"),
        ("surface", surface_text(surface_radius)),
        ("force", f"up to {_rounded(float(force.max()), 4)} N"),
    )


def one_line(name: str, pairs: Sequence[tuple[str, str]]) -> str:
    """Return `Recording('slow', 1200 samples, 60 s, 0 to 25.1 mm, flat, up to 2007 N)`."""
    texts = [f"{text} samples" if what == "samples" else text for what, text in pairs]
    return f"Recording({', '.join([repr(name), *texts])})"


def html_table(name: str, rows: Sequence[tuple[str, str]]) -> str:
    """Return a table of two columns under a name; every text is escaped."""
    body = "".join(
        f'<tr><th style="text-align:left">{escape(what)}</th><td style="text-align:left">{escape(text)}</td></tr>'
        for what, text in rows
    )
    return f'<table><caption>Recording "{escape(name)}"</caption><tbody>{body}</tbody></table>'


def surface_text(surface_radius: FloatArray) -> str:
    """Return the surfaces [m] in words: flat, radius 25.4 cm, or how many radii there are."""
    radii = np.unique(surface_radius)
    if len(radii) > MOST_RADII:
        return f"{len(radii)} surface radii"
    return ", ".join("flat" if np.isinf(r) else f"radius {_length(r)}" for r in radii)


def _length(radius: float) -> str:
    return f"{100.0 * radius:.4g} cm" if abs(radius) < IN_METRES else f"{radius:.4g} m"


def _range(low: float, high: float) -> str:
    """Return both ends to a hundredth of what is between them or better: the noise of a start at zero is not shown."""
    decimals = 2 - math.floor(math.log10(high - low)) if high > low else 6
    return " to ".join(f"{round(value, decimals) + 0.0:g}" for value in (low, high))


def _rounded(value: float, digits: int) -> str:
    return f"{float(f'{value:.{digits}g}'):g}"
