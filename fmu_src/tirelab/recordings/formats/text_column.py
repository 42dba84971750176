"""Columns of text that hold numbers or clock times, as a data frame has them that was read without their marks."""

from __future__ import annotations

import numpy as np
import polars as pl
from numpy.typing import NDArray

from .clock import Clock, ClockError, is_clock
from .number_style import style_of
from .table import BLANK_WORDS

FloatArray = NDArray[np.float64]

LOOKED_AT = 500
"""So many cells are looked at for how numbers are written."""


def numbers_of_text(texts: pl.Series, channel: str) -> FloatArray | None:
    """Return the numbers that a column of text holds, NaN for blanks; of the time also seconds from clock times.

    Numbers may have decimal commas and marks between thousands, as in a file. None where a cell is neither.
    """
    plain = texts.str.strip_chars().str.replace(r"^\x{2212}", "-")
    filled = plain.filter(plain.is_not_null() & ~plain.str.to_lowercase().is_in(sorted(BLANK_WORDS)))
    head = filled.head(LOOKED_AT).to_list()
    if channel == "time" and head and all(map(is_clock, head)):
        try:
            return Clock().seconds(texts)
        except ClockError:
            return None
    style = style_of(head, ";")
    if style.thousands:
        grouped = plain.str.contains(style.pattern).fill_null(False)
        plain = plain.zip_with(~grouped, plain.str.replace_all(style.thousands, "", literal=True))
    if style.decimal_comma:
        if plain.str.contains(".", literal=True).any():
            return None
        plain = plain.str.replace(",", ".", literal=True)
    values = plain.cast(pl.Float64, strict=False)
    blanks = len(plain) - len(filled)
    return values.fill_null(float("nan")).to_numpy() if values.null_count() <= blanks else None
