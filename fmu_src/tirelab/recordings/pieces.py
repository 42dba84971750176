"""Parts of a file: one of several tests side by side, a sheet of a workbook, and a range of time or rows.

They are named behind the file: FILE@trial2@10s:20s, FILE@SHEET.
"""

from __future__ import annotations

import re
import sys
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from ..names import plain
from .formats import WORKBOOK_SUFFIXES, RecordingError
from .formats.table import quoted
from .units import UnitError, conversion

_TRIAL = re.compile(r"trial(\d{1,4})", re.IGNORECASE)
_BOUND = re.compile(r"(?P<value>[+-]?(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?)\s*(?P<unit>[A-Za-zµμ]*)")


@dataclass(frozen=True)
class Piece:
    """Which part of a file is read, all of it where nothing is said.

    trial: of tests side by side, from 1; start, stop: times such as "10s" or "2 min" (from the one up to the other,
    without it), or numbers of rows (both among those read), "" where there is no bound
    sheet: of a workbook, "" where that with the recording is found
    """

    trial: int | None = None
    start: str = ""
    stop: str = ""
    sheet: str = ""

    def within(self, start: str, stop: str) -> Piece:
        """Return this piece with bounds where it has none itself."""
        return self if self.start or self.stop else replace(self, start=start, stop=stop)

    @property
    def rows(self) -> tuple[int, int] | None:
        """The first and the last row, where it is rows that bound the piece; None where times do, or nothing."""
        bounds = [bit for bit in (self.start, self.stop) if bit]
        if not bounds or not all(bit.isdecimal() for bit in bounds):
            return None
        return int(self.start or 1), int(self.stop or sys.maxsize)

    @property
    def part(self) -> str:
        """What follows the file's name in the settings of one test: "@trial2", "@SHEET"; "" of a whole file."""
        sheet = f"@{self.sheet}" if self.sheet else ""
        return sheet + ("" if self.trial is None else f"@trial{self.trial}")

    @property
    def suffix(self) -> str:
        """What the name of its recording ends in: "@trial2", "@10s-20s"."""
        bounds = "".join(f"{self.start}-{self.stop}".split()) if self.start or self.stop else ""
        return re.sub(r"[/\\]", "-", self.part) + (f"@{bounds}" if bounds else "")


def split_piece(path: Path | str) -> tuple[Path, Piece]:
    """Return the file and the piece that a text such as `press.csv@10s:20s` names; a file of just that name goes first.

    Errors: RecordingError where what follows the @ is no piece, although the file before it is there.
    """
    whole = Path(path)
    if "@" not in whole.name or whole.exists():
        return whole, Piece()
    name, *parts = whole.name.split("@")
    file = whole.with_name(name) if name else whole
    if not name or not file.exists():
        return whole, Piece()
    return file, parse_piece("@".join(parts), str(path), file.suffix.lower() in WORKBOOK_SUFFIXES)


def parse_piece(text: str, where: str, sheets: bool = False) -> Piece:
    """Return the piece that a text names: `trial2`, `10s:20s`, `100:2000`, `trial1@:30s`.

    sheets: whether anything else is the name of a sheet. Errors: RecordingError where it is not.
    """
    piece = Piece()
    for part in text.split("@"):
        if trial := _TRIAL.fullmatch(part.strip()):
            piece = replace(piece, trial=int(trial[1]))
            continue
        start, colon, stop = (bit.strip() for bit in part.partition(":"))
        if (
            not colon
            or not all(not bit or _BOUND.fullmatch(bit) for bit in (start, stop))
            or not (start or stop)
        ):
            if sheets and part.strip():
                piece = replace(piece, sheet=f"{piece.sheet}@{part}" if piece.sheet else part.strip())
                continue
            raise RecordingError(
                f"{where}: {quoted(part)} is no part of a file; write 10s:20s (time), 100:2000 (rows) or trial2"
            )
        piece = replace(piece, start=start, stop=stop)
    return piece


def is_range(text: str) -> bool:
    """Whether a text is a range of time or rows and not the name of a file: 10s:20s, 100:2000."""
    start, colon, stop = (bit.strip() for bit in text.partition(":"))
    bounds = [bit for bit in (start, stop) if bit]
    return bool(colon and bounds) and all(map(_BOUND.fullmatch, bounds))


def samples_within(
    where: str, piece: Piece, time: NDArray[np.float64], rows: NDArray[np.int64]
) -> slice | None:
    """Return the samples of a piece, None for all of them.

    time [s], rising; rows: of each sample, the number that messages call it by, rising or all falling
    Errors: RecordingError for a unit that is no time, and for fewer than two samples.
    """
    if not (piece.start or piece.stop):
        return None
    if piece.rows is not None and rows[0] > rows[-1]:
        forward = samples_within(where, piece, time, rows[::-1])
        return None if forward is None else slice(len(rows) - forward.stop, len(rows) - forward.start)
    begin = _index(where, piece.start, time, rows, first=True) if piece.start else 0
    end = _index(where, piece.stop, time, rows, first=False) if piece.stop else len(time)
    if end < begin:
        raise RecordingError(
            f"{where}: {piece.start} to {piece.stop} ends before it begins; write the earlier bound first: "
            f"{piece.stop}:{piece.start}, or --from {piece.stop} --to {piece.start}"
        )
    if end - begin < 2:
        raise RecordingError(
            f"{where}: {piece.start or 'the start'} to {piece.stop or 'the end'} holds {max(end - begin, 0)} samples; "
            f"the recording has {plain(time[0], 6)} to {plain(time[-1], 6)} s, rows {rows[0]} to {rows[-1]}"
        )
    return slice(begin, end)


def _index(where: str, bound: str, time: NDArray[np.float64], rows: NDArray[np.int64], first: bool) -> int:
    found = _BOUND.fullmatch(bound.strip())
    if found is None:
        raise RecordingError(
            f"{where}: {quoted(bound)} is no time and no row; write 10s, 2min or a row such as 100"
        )
    if not found["unit"]:
        return int(np.searchsorted(rows, float(found["value"]), "left" if first else "right"))
    try:
        seconds = conversion(found["unit"], "s").to_si(np.array([float(found["value"])]))[0]
    except UnitError as error:
        raise RecordingError(f"{where}: {error}") from None
    # 0.3 s is the sample at 0.30000000000000004 s too; a number of 400 digits is later than all samples
    nearly = 1e-9 * max(1.0, abs(seconds)) if np.isfinite(seconds) else 0.0
    return int(np.searchsorted(time, seconds - nearly, "left"))
