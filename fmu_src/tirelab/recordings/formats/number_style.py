"""How the numbers of a text file are written: which mark is decimal, and which parts thousands."""

from __future__ import annotations

import re
from collections.abc import Iterable
from dataclasses import dataclass
from functools import cached_property

DECIMAL_COMMA = re.compile(r"\s*[+-]?\d*,\d+(?:[eE][+-]?\d+)?\s*", re.ASCII)
MAYBE_THOUSANDS = re.compile(r"\s*[+-]?[1-9]\d{0,2},\d{3}\s*", re.ASCII)

EXPONENTS = ("D+", "D-", "d+", "d-")
"""What is in every text with a number in the double precision of Fortran."""

FORMULA = '="'
"""What is in every text with a cell that a spreadsheet is told to leave as it is: ="0.00"."""

BYTE_ORDER_MARK = "\N{ZERO WIDTH NO-BREAK SPACE}"

_PLAIN = re.compile(r"[+-]?\d*[.,]\d+(?:[eE][+-]?\d+)?", re.ASCII)
_MINUS = re.compile("\N{MINUS SIGN}(?=[\\d.,])")
_EXPONENT = re.compile(r"(?<![\w.])([+-]?(?:\d+[.,]?\d*|[.,]\d+))[dD](?=[+-]\d{1,3}(?![\w.]))", re.ASCII)
_FORMULA = re.compile(r'"=""([^"]*)"""|(?<!\w)="([^"]*)"')
_SPACES = " \u00a0\u202f\u2009'\u2019"
_CERTAIN = (
    (".", ",", re.compile(r"[+-]?[1-9]\d{0,2}(?:\.\d{3})+,\d+")),
    (",", ".", re.compile(r"[+-]?[1-9]\d{0,2}(?:,\d{3})+\.\d+")),
    (".", ",", re.compile(r"[+-]?[1-9]\d{0,2}(?:\.\d{3}){2,}")),
    (",", ".", re.compile(r"[+-]?[1-9]\d{0,2}(?:,\d{3}){2,}")),
)
_SPACED = re.compile(rf"[+-]?[1-9]\d{{0,2}}([{_SPACES}])\d{{3}}(?:\1\d{{3}})*(?:[.,]\d+)?")


@dataclass(frozen=True)
class NumberStyle:
    """The decimal mark, a comma or a point, and the mark between thousands, none where it is empty."""

    decimal_comma: bool = False
    thousands: str = ""

    @cached_property
    def pattern(self) -> str:
        """A regular expression of a whole number with thousands marks."""
        decimal = "," if self.decimal_comma else r"\."
        return rf"^\s*[+-]?[1-9]\d{{0,2}}(?:{re.escape(self.thousands)}\d{{3}})+(?:{decimal}\d+)?\s*$"

    @cached_property
    def _compiled(self) -> re.Pattern[str]:
        return re.compile(self.pattern, re.ASCII)

    def ungrouped(self, text: str) -> str:
        """Return a number without its thousands marks; any other text as it is."""
        if self.thousands and self.thousands in text and self._compiled.match(text):
            return text.replace(self.thousands, "")
        return text

    def explains(self, cells: Iterable[str]) -> bool:
        """Whether no number among the cells, read without this style, is another one with it: 0.512 and 1.512."""
        marked = [text for text in map(str.strip, cells) if self.thousands in text and _PLAIN.fullmatch(text)]
        return not marked or (self.thousands != "." and all(map(self._compiled.match, marked)))


_ZEROS = re.compile(r"^\0+(?=\r?$)", re.MULTILINE)
"""A line of zero bytes, which Python's csv before 3.11 does not take."""


def with_plain_marks(text: str) -> str:
    """Return a text whose numbers have the minus of a keyboard, not that of typography, and the exponent mark E where
    Fortran writes D: 1.5D+01. Files that were joined have byte order marks within them, which are left out, and cells
    that a spreadsheet is to leave as they are, ="0.00", are between quotes alone. A line of zero bytes is an empty one.
    """
    text = _ZEROS.sub("", text) if "\0" in text else text
    text = _FORMULA.sub(r'"\1\2"', text) if FORMULA in text else text
    text = text.replace(BYTE_ORDER_MARK, "") if BYTE_ORDER_MARK in text else text
    text = _MINUS.sub("-", text) if "\N{MINUS SIGN}" in text else text
    return _EXPONENT.sub(r"\1E", text) if any(mark in text for mark in EXPONENTS) else text


def maybe_grouped(separator: str) -> re.Pattern[str]:
    """Return what is in every line with a number whose mark between thousands leaves no doubt, and in few others."""
    bare, quoted = (
        rf"[1-9]\d{{0,2}}(?:[{marks}]\d{{3}}[{marks}]\d|[{_SPACES}]\d{{3}})"
        for marks in (f".{_SPACES}", f".,{_SPACES}")
    )
    # where commas separate the columns, a number with a comma stands between quotes
    return re.compile(rf'{bare}|"\s*[+-]?{quoted}' if separator == "," else quoted, re.ASCII)


def style_of(cells: Iterable[str]) -> NumberStyle:
    """Return how numbers are written, from cells of which at least one leaves no doubt.

    `1.234,5` has a decimal comma and points between thousands, `1,234.5` the reverse; a lone `1,234` may be either,
    and `0,5` or `12,34` is a decimal comma; where commas separate the columns, such a cell stands between quotes.
    """
    commas = False
    for cell in cells:
        text = cell.strip()
        if len(text) > 4:
            for thousands, decimal, pattern in _CERTAIN:
                if pattern.fullmatch(text):
                    return NumberStyle(decimal == ",", thousands)
            if spaced := _SPACED.fullmatch(text):
                return NumberStyle("," in text or commas, spaced[1])
        # where commas separate the columns, one within a cell stood between quotes
        if not commas and _is_decimal_comma(cell):
            commas = True
    return NumberStyle(commas)


def _is_decimal_comma(cell: str) -> bool:
    return bool(DECIMAL_COMMA.fullmatch(cell)) and not MAYBE_THOUSANDS.fullmatch(cell)
