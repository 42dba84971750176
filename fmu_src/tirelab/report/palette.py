"""The colours of the pictures: stand-ins for the page's style sheet, and plain ones for a figure of matplotlib."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class Palette:
    """Colours of text, grid, recorded force, simulated force before and after the correction, and noise."""

    ink: str
    grid: str
    recorded: str
    before: str
    after: str
    band: str


PAGE = Palette("#010101", "#020202", "#030303", "#040404", "#050505", "#060606")
"""Stand-ins that become the variables of the page's style sheet, which has one set for light and one for dark."""

PLAIN = Palette("#1c2127", "#c4cad0", "#8c949e", "#c65f0b", "#0a6cb8", "#e6e9ec")
"""The colours of the light page, for axes that a user gives."""
