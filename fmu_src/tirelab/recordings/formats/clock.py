"""Times that are written as dates and clock times, as seconds from the first."""

from __future__ import annotations

import re

import numpy as np
import polars as pl
from numpy.typing import NDArray

FloatArray = NDArray[np.float64]

_CLOCK = re.compile(
    r"\s*(?:\d{1,4}[-./](?:\d{1,2}|[A-Za-z]{3})[-./]\d{1,4}[T ]\s*)?"
    r"\d{1,4}:\d{2}(?::\d{2})?(?:[.,]\d+|:\d{3})?\s*(?:[AaPp][Mm])?\s*"
    r"(?:Z|UTC|GMT|[+-]\d{2}(?::?\d{2})?)?\s*"
)
_ZONE = r"\s*(?:Z|UTC|GMT|[+-]\d{2}(?::?\d{2})?)$"
_OFFSET = r"([+-])(\d{2})(?::?(\d{2}))?$"
"""The hours and minutes by which a clock is ahead of UTC: at a change of summer time they change in a recording."""
_MILLISECONDS = r"(:\d{2}:\d{2}):(\d{3})$"
"""11:10:00:771, as controllers of testing machines write milliseconds."""

_DATES = (
    "%Y-%m-%d",
    "%Y/%m/%d",
    "%Y.%m.%d",
    "%d.%m.%Y",
    "%d/%m/%Y",
    "%m/%d/%Y",
    "%d-%m-%Y",
    "%m-%d-%Y",
    "%d-%b-%Y",
)
_TIMES = ("%H:%M:%S%.f", "%H:%M", "%I:%M:%S%.f %p", "%I:%M %p")
_STAMPS = tuple(f"{date} {time}" for date in _DATES for time in _TIMES)
_OF_DAY = ("%I:%M:%S%.f %p", "%I:%M %p")
"""Times of day without a date; those that count to 24 are read as durations."""

_DURATION = r"^(?:(\d+):)?(\d{1,3}):(\d{1,2}(?:\.\d+)?)$"


class ClockError(ValueError):
    """A text that is no time like the others: its index."""

    def __init__(self, index: int) -> None:
        super().__init__(f"text {index} is no time")
        self.index = index


def is_clock(text: str) -> bool:
    """Whether a text is a time of day, with a date or without: 14:05:00.1, 2025-06-03T14:05:00, 03.06.2025 14:05."""
    return ":" in text and _CLOCK.fullmatch(text) is not None


class Clock:
    """Reads the times of one column piece by piece: the way they are written and the first one are kept.

    form: how they are written, once it is found; start [ns]: the first time; notes: where the form was chosen
    """

    def __init__(self) -> None:
        self.form = ""
        self.start: int | None = None
        self.notes: list[str] = []
        self._direct = ""  # the form as it is written, where nothing has to be brought into form first

    def seconds(self, texts: pl.Series) -> FloatArray:
        """Return the seconds from the first time that was ever read; NaN where there is no text.

        Errors: ClockError for a text that is no time, or one written in another way than those before.
        """
        if self._direct and self.start is not None:
            instants = _instants(texts, self._direct)
            if not instants.null_count():
                return np.asarray((instants.to_numpy() - self.start) / 1e9, dtype=np.float64)
        plain = texts.cast(pl.String).str.strip_chars()
        plain = pl.select(
            pl.when(plain.str.to_lowercase().is_in(["", "nan", "na", "null"])).then(None).otherwise(plain)
        ).to_series()
        present = plain.is_not_null()
        ahead = _ahead(plain)
        plain = plain.str.replace(_ZONE, "").str.replace(r"(\d)T", "$1 ")
        plain = plain.str.replace(",", ".", literal=True).str.replace(r"\s+", " ")
        plain = plain.str.replace(_MILLISECONDS, "$1.$2")
        if not self.form:
            self.form = self._form_of(plain.drop_nulls())
            if "T" in str(texts.drop_nulls().head(1).to_list()) and self.form != "duration":
                self._direct = self.form.replace(" ", "T", 1)
            elif self.form != "duration":
                self._direct = self.form
        instants = (
            _instants(plain, self.form) if self.form else pl.Series([None] * len(plain), dtype=pl.Int64)
        )
        instants -= ahead
        wrong = (present & instants.is_null()).arg_true()
        if len(wrong):
            raise ClockError(int(wrong[0]))
        if self.start is None and instants.null_count() < len(instants):
            self.start = int(instants.drop_nulls()[0])
        filled = instants.fill_null(0).to_numpy() - (self.start or 0)
        return np.where(present.to_numpy(), filled / 1e9, np.nan)

    def _form_of(self, plain: pl.Series) -> str:
        """Return the form that reads the most texts, and of those that do the one of the shortest recording."""
        found: list[tuple[int, int, str]] = []
        for form in (*_STAMPS, *_OF_DAY, "duration"):
            instants = _instants(plain, form)
            read = len(instants) - instants.null_count()
            if read:
                low, high = instants.min(), instants.max()
                assert isinstance(low, int)
                assert isinstance(high, int)
                found.append((-read, high - low, form))
        if not found:
            return ""
        found.sort()
        best = found[0]
        others = [form for read, span, form in found if read == best[0] and span != best[1]]
        if others:
            self.notes.append(
                f"dates read as {_words(best[2])}, not as {_words(others[0])}: the shorter recording"
            )
        return best[2]


def _ahead(plain: pl.Series) -> pl.Series:
    """Return how far [ns] the clock of each time is ahead of UTC; 0 where that is not written."""
    sign, hours, minutes = (plain.str.extract(_OFFSET, group).alias(str(group)) for group in (1, 2, 3))
    seconds = hours.cast(pl.Int64) * 3600 + minutes.cast(pl.Int64).fill_null(0) * 60
    ahead: pl.Series = pl.select(pl.when(sign == "-").then(-seconds).otherwise(seconds)).to_series()
    return ahead.fill_null(0) * 1_000_000_000


def _instants(plain: pl.Series, form: str) -> pl.Series:
    """Return the times [ns] that a form reads, null where it does not."""
    if form == "duration":
        parts = plain.str.extract_groups(_DURATION).struct.unnest()
        hours, minutes, seconds = (parts.to_series(i).cast(pl.Float64) for i in range(3))
        total = hours.fill_null(0.0) * 3600.0 + minutes * 60.0 + seconds
        # 12:34 alone may be hours and minutes, or minutes and seconds
        certain = hours.is_not_null() | plain.str.contains(".", literal=True)
        nanoseconds = (total * 1e9).round().cast(pl.Int64)
        found: pl.Series = pl.select(pl.when(certain).then(nanoseconds).otherwise(None)).to_series()
        return found
    if form in _OF_DAY:
        plain, form = "2000-01-01 " + plain, f"%Y-%m-%d {form}"
    try:
        instants: pl.Series = plain.str.to_datetime(form, strict=False, time_unit="ns").cast(pl.Int64)
    except pl.exceptions.PolarsError:
        return pl.Series([None] * len(plain), dtype=pl.Int64)
    return instants


def _words(form: str) -> str:
    """Return the order of a date as people write it: day.month.year."""
    names = {"%Y": "year", "%m": "month", "%b": "month", "%d": "day"}
    date = form.split(" ")[0]
    for code, name in names.items():
        date = date.replace(code, name)
    return date
