"""Text tables whose columns stand between spaces: found, and turned into tables with tabs between them."""

from __future__ import annotations

import re
from collections.abc import Sequence

from .table import RecordingError, is_comment
from .table_search import CONFIRMED, SEARCHED, is_value

TAB = "\t"

_WORDS = (
    re.compile(r"\S+(?: \S+)*"),  # two spaces or more between columns
    re.compile(r"[^\s\[(]+(?:\s?[\[(][^\])]*[\])])?"),  # time [s] force [N]
    re.compile(r"[^\s\[(][^\[(]*[\[(][^\])]*[\])]"),  # load cell [N] travel of piston [mm]
    re.compile(r"\S+"),
)
"""How the names of columns may stand in a line, the surest first."""


def spaced_columns(lines: Sequence[str]) -> int:
    """Return how many columns stand between spaces; 0 where another mark separates them, or none.

    Every cell of the rows is a number or a time; the longest run of such rows of one width is the table.
    """
    best = run = width = last = 0
    for line in lines[:SEARCHED]:
        cells = [] if is_comment(line) or ";" in line or TAB in line else line.split()
        if len(cells) < 2 or not all(is_value(cell) for cell in cells):
            run = 0 if line.strip() else run
            continue
        run = run + 1 if run and len(cells) == last else 1
        last = len(cells)
        if run > best:
            best, width = run, last
    return width if best >= CONFIRMED else 0


def with_tabs(line: str, columns: int) -> str:
    """Return a line of a table with tabs between its cells; a line of text that has not so many cells, as it is."""
    bare = line.rstrip("\r\n")
    end = line[len(bare) :]
    mark = "# " if is_comment(bare) else ""
    text = bare.strip().lstrip("# ") if mark else bare.strip()
    for words in _WORDS:
        cells = words.findall(text)
        if len(cells) == columns:
            return mark + TAB.join(cells) + end
    return line


def block_with_tabs(block: bytes, columns: int) -> bytes:
    """Return rows of numbers with tabs in place of the spaces between them.

    Errors: RecordingError where a line has another number of cells, since nobody can tell which one is missing.
    """
    rows = [line.split() for line in block.split(b"\n")]
    if not {0, columns}.issuperset(map(len, rows)):
        raise RecordingError("a row has another number of cells")
    return b"\n".join(map(b"\t".join, rows))
