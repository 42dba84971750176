"""Exports as test machines, loggers and programs write them, made of one motion whose values are known.

The structure of each is that of the machine or program it is named for; the numbers and the texts are ours.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

RATE = 10.0
"""Samples in a second."""

INCH, POUND, KILOPOND = 0.0254, 4.4482216152605, 9.80665
"""An inch [m], a pound-force [N] and a kilogram-force [N], exact by definition."""


@dataclass(frozen=True)
class Motion:
    """What was recorded: time [s], deflection [m] and force [N], compression positive."""

    time: Array
    deflection: Array
    force: Array


def pressed(seconds: float = 40.0, stroke: float = 0.020) -> Motion:
    """Return two triangles of a press on the article's tire, with friction of 4 %: the force of no sample is round."""
    time = np.arange(0.0, seconds, 1.0 / RATE)
    phase = 2.0 * time / seconds
    deflection = stroke * (1.0 - np.abs(1.0 - 2.0 * (phase - np.floor(phase))))
    law = 550.9 * (100.0 * deflection) ** 1.422
    return Motion(time, deflection, law * np.where(phase - np.floor(phase) < 0.5, 1.02, 0.98) + 0.37)


def damped(seconds: float = 20.0, stroke: float = 0.0254) -> Motion:
    """Return sines of a damper: 1500 N s/m in compression, 2500 N s/m in rebound; both channels of both signs."""
    time = np.arange(0.0, seconds, 1.0 / RATE)
    angle = 2.0 * np.pi * 0.37 * time
    speed = stroke * 2.0 * np.pi * 0.37 * np.cos(angle)
    force = np.where(speed > 0.0, 1500.0 * speed, 2500.0 * speed) + 35.0
    return Motion(time, stroke * np.sin(angle), force)


Writer = Callable[[Path, Motion], None]


@dataclass(frozen=True)
class Export:
    """One export: the name of its file and how it is written.

    signed: of a part that pulls
    """

    name: str
    write: Writer
    signed: bool = False

    @property
    def motion(self) -> Motion:
        """What was recorded."""
        return damped() if self.signed else pressed()


EXPORTS: dict[str, Export] = {}
"""By the name of the file."""


def export(name: str, signed: bool = False) -> Callable[[Writer], Writer]:
    """Register how a file is written."""

    def registered(write: Writer) -> Writer:
        EXPORTS[name] = Export(name, write, signed)
        return write

    return registered


def table(
    columns: Sequence[Array], separator: str = ",", digits: int = 5, comma: bool = False, quote: bool = False
) -> str:
    """Return rows of numbers."""
    rows = []
    for values in zip(*columns, strict=True):
        cells = [f"{value:.{digits}f}" for value in values]
        if comma:
            cells = [cell.replace(".", ",") for cell in cells]
        if quote:
            cells = [f'"{cell}"' for cell in cells]
        rows.append(separator.join(cells))
    return "\n".join(rows) + "\n"


def mm(m: Motion) -> Array:
    return 1e3 * m.deflection
