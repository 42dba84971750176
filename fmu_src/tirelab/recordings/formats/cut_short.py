"""A file that was cut within its last number: 147 where every other row has two decimals, and no line end."""

from __future__ import annotations

import csv
import re
from collections import deque
from collections.abc import Sequence
from pathlib import Path

from .encoding import BY_BYTES
from .layout import Layout
from .spaced import with_tabs

TAIL = 65_536
"""How much of the end of the file [B] is compared with its last line."""

FEWEST, MOST = 50, 1000
"""Rows of which the cells have to agree, and how many are looked at."""

_LINE_ENDS = (b"\n", b"\r")
_WIDEST = 4  # bytes of a letter in UTF-32


def cut_cell(path: Path, layout: Layout) -> tuple[int, str] | None:
    """Return the column and the text of the last cell, where the file ends within its number; else None.

    That is so where no line end follows, and it has fewer decimals, or digits of an exponent, than the column has in
    any other of the last rows.
    """
    with path.open("rb") as file:
        size = file.seek(0, 2)
        file.seek(max(0, size - _WIDEST))
        end = file.read()
        if any(mark in end for mark in _LINE_ENDS):
            return None
        file.seek(max(0, size - TAIL))
        tail = file.read()
    lines: Sequence[str]
    if layout.encoding in BY_BYTES:
        lines = tail.decode(layout.encoding, "replace").splitlines()[0 if size <= TAIL else 1 :]
    else:
        with path.open(encoding=layout.encoding, errors="replace") as text:
            lines = list(deque(text, MOST))
    last, *others = [_cells(line, layout) for line in reversed(lines[-MOST:])] or [[]]
    index = len(last) - 1
    if not last or index >= len(layout.headers):
        return None
    fine = _fineness(last[index], layout)
    column = [_fineness(row[index], layout) for row in others if len(row) > index]
    known = [one for one in column if one is not None]
    if fine is None or len(known) < FEWEST:
        return None
    cut = fine[0] < min(one[0] for one in known) or fine[1] < min(one[1] for one in known)
    return (index, last[index].strip()) if cut else None


def _cells(line: str, layout: Layout) -> list[str]:
    text = with_tabs(line, len(layout.headers)) if layout.spaced else line
    try:
        return next(csv.reader([text.rstrip("\r\n")], delimiter=layout.separator), [])
    except csv.Error:
        return []


def _fineness(cell: str, layout: Layout) -> tuple[int, int] | None:
    """Return how many decimals a number has and how many digits its exponent; None for a cell that is no number."""
    mark = "," if layout.style.decimal_comma else r"\."
    found = re.fullmatch(rf"\s*[+-]?[\d ]*(?:{mark}(\d*))?(?:[eE][+-]?(\d*))?\s*", cell)
    if found is None or not any(map(str.isdigit, cell)):
        return None
    return len(found[1] or ""), len(found[2] or "")
