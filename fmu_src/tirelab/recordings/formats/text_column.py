"""Columns of text that hold numbers or clock times, as a data frame has them that was read without their marks."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import replace

import numpy as np
import polars as pl
from numpy.typing import NDArray

from .cell_units import column_unit, taken_from_cells
from .clock import Clock, ClockError, is_clock
from .number_style import style_of, with_plain_marks
from .table import BLANK_WORDS, Header
from .table_search import is_units, unit_below

FloatArray = NDArray[np.float64]

LOOKED_AT = 500
"""Number of cells from which it is found how numbers are written."""


class TextFault(ValueError):
    """A cell that is not what most others of its column are: its index from 0, and what it should be."""

    def __init__(self, index: int, kind: str) -> None:
        super().__init__(f"cell {index} is no {kind}")
        self.index = index
        self.kind = kind


def headers_of_text(
    headers: Sequence[Header], columns: Sequence[pl.Series | None]
) -> tuple[tuple[Header, ...], int, tuple[str, ...]]:
    """Return headers with what texts below them say, how many rows of units stand above the numbers, and notes.

    columns: the beginning at least of each that is known; texts say units in a first row, behind every number, or
    that they are clock times
    """
    first = [column[0] if column is not None and len(column) else None for column in columns]
    texts = [text if isinstance(text, str) else "" for text in first]
    found, notes, above = list(headers), list[str](), 0
    # a cell that is no text speaks against a row of units, an empty one does not
    if is_units(texts) and not any(cell is not None and not isinstance(cell, str) for cell in first):
        above = 1
        found = [replace(h, unit=unit_below(h.unit, text)) for h, text in zip(found, texts, strict=True)]
        notes.append("units taken from sample 1, below the names")
    heads = [_head(column, above) for column in columns]
    for index, cells in enumerate(heads):
        unit = column_unit([with_plain_marks(cell.strip()) for cell in cells])
        if unit:
            found[index] = replace(found[index], unit=unit, cell_unit=unit)
        elif cells and is_clock(cells[0]):
            found[index] = replace(found[index], unit="s", dated=True)
    in_cells = [h.cell_unit for h in found if h.cell_unit]
    return tuple(found), above, (*notes, taken_from_cells(in_cells)) if in_cells else tuple(notes)


def _head(column: pl.Series | None, above: int) -> list[str]:
    """Return the first texts of a column of text; none of any other column."""
    if column is None or column.dtype != pl.String:
        return []
    return column[above : above + LOOKED_AT].drop_nulls().to_list()


def numbers_of_text(texts: pl.Series, channel: str, cell_unit: str = "") -> FloatArray | None:
    """Return the numbers that a column of text holds, NaN for blanks; of the time also seconds from clock times.

    Numbers may have decimal commas and marks between thousands, as in a file; cell_unit: what stands behind each of
    them, which is taken off. None where most cells are neither. Errors: TextFault where a few are not.
    """
    plain = texts.str.strip_chars().str.replace(r"^\x{2212}", "-")
    measured = plain.is_not_null() & ~plain.str.to_lowercase().is_in(sorted(BLANK_WORDS))
    if cell_unit:
        # null for a number without the unit, which is none then; blanks stay
        plain = plain.str.extract(rf"^(.*\d)\s*{re.escape(cell_unit)}$").zip_with(measured, plain)
    head = plain.filter(measured).drop_nulls().head(LOOKED_AT).to_list()
    if channel == "time" and head and all(map(is_clock, head)):
        try:
            return Clock().seconds(texts)
        except ClockError as fault:
            raise TextFault(fault.index, "time") from None
    style = style_of(head)
    if style.thousands:
        grouped = plain.str.contains(style.pattern).fill_null(False)
        plain = plain.zip_with(~grouped, plain.str.replace_all(style.thousands, "", literal=True))
    if style.decimal_comma:
        pointed = plain.str.contains(".", literal=True).fill_null(False)
        if pointed.any():
            few = 2 * int(pointed.sum()) < int(measured.sum())
            odd = pointed if few else plain.str.contains(",", literal=True).fill_null(False)
            raise TextFault(int(odd.arg_max() or 0), "number")
        plain = plain.str.replace(",", ".", literal=True)
    values = plain.cast(pl.Float64, strict=False)
    wrong = values.is_null() & measured
    if wrong.any():
        if 2 * int(wrong.sum()) >= int(measured.sum()):
            return None
        raise TextFault(int(wrong.arg_max() or 0), "number")
    return np.asarray(values.fill_null(float("nan")).to_numpy(), dtype=np.float64)
