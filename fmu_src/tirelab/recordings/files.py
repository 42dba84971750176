"""Which files are the recordings where files and folders are given: one rule for every command.

A file that is given by its own name is always a recording: one that cannot be read is refused when it is read. Of a
folder the recordings are taken in the order of their names, without those of its subfolders. A text file or a workbook
of the folder is skipped, with a note, where it is certain that it is no recording: no column has the name or the unit
of a channel, and it has no more than a few rows of numbers (a README.txt, a list of tests). A file that may be a
recording and has a fault is not skipped: it is refused when it is read.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

from ..errors import TirelabError
from .formats import LOADERS, TEXT_SUFFIXES, Header, RecordingError, open_table
from .formats.excel import ExcelTable
from .matching import match_channels, recognised
from .metadata import read_sidecar
from .origin import Origin
from .pieces import split_piece
from .side_by_side import SeveralTrials
from .units import measures

HEAD = 65_536
"""How much of a text file [B] is searched for a row of numbers."""

MEASURED_ROWS = 20
"""Fewest rows of numbers that make a file a recording, whatever its columns are called."""

HIDDEN = (".", "~$")
"""Files that start like this are of the system or of an open workbook, and are left out without a note."""

_NUMBER = re.compile(r"[+-]?(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?")
_NOT_TEXT = re.compile(rb"[\x00-\x08\x0e-\x1a\x1c-\x1f]")


@dataclass(frozen=True)
class Skipped:
    """A file of a folder that is no recording, and why; as a text it is the note for the user."""

    path: Path
    reason: str

    def __str__(self) -> str:
        return f"{self.path.name} skipped: it is no recording ({self.reason})"


def recording_files(
    given: Iterable[Path | str], columns: Mapping[str, str] | None = None
) -> tuple[tuple[Path, ...], tuple[Skipped, ...]]:
    """Return the files of the recordings, and the files of folders that were skipped.

    Parameters
    given     files and folders; a file is kept as it is given, whether or not it is there
    columns   channel -> column as the user names them: a file that has one of them is a recording

    A file in which several tests stand side by side gives one recording for each: FILE@trial1, FILE@trial2.
    Errors: TirelabError for a folder without a recording.
    """
    files: list[Path] = []
    skipped: list[Skipped] = []
    for place in map(Path, given):
        if place.is_dir():
            inside, others = folder_recordings(place, columns)
            if not inside:
                raise TirelabError(_nothing_in(place, others))
            files += inside
            skipped += others
        else:
            files.append(place)
    return tuple(piece for file in files for piece in _trials_of(file, columns)), tuple(skipped)


def _trials_of(file: Path, columns: Mapping[str, str] | None) -> tuple[Path, ...]:
    """Return a file as FILE@trial1, FILE@trial2, ... where several tests stand side by side in it; else as it is."""
    path, piece = split_piece(file)
    if piece.trial is not None or not path.is_file():
        return (file,)
    try:
        sidecar = read_sidecar(path, trial=1, sheet=piece.sheet)
        table = open_table(path, sidecar.skip_rows, piece.sheet)
        match_channels(
            Origin(path.name), table.headers, table.time_axis, {**sidecar.columns, **(columns or {})}
        )
    except SeveralTrials as several:
        rest = file.name.removeprefix(path.name)
        return tuple(file.with_name(f"{path.name}@trial{n}{rest}") for n in range(1, several.trials + 1))
    except RecordingError:
        pass  # refused with its reason when it is read
    return (file,)


def folder_recordings(
    folder: Path, columns: Mapping[str, str] | None = None
) -> tuple[tuple[Path, ...], tuple[Skipped, ...]]:
    """Return the recordings directly in a folder, by name, and the files with a known suffix that are none."""
    files: list[Path] = []
    skipped: list[Skipped] = []
    for file in sorted(folder.iterdir()):
        if file.suffix.lower() not in LOADERS or file.name.startswith(HIDDEN) or not file.is_file():
            continue
        reason = why_no_recording(file, columns)
        if reason is None:
            files.append(file)
        else:
            skipped.append(Skipped(file, reason))
    return tuple(files), tuple(skipped)


def why_no_recording(file: Path, columns: Mapping[str, str] | None = None) -> str | None:
    """Return why a file is certainly no recording, or None where it is one, damaged perhaps."""
    is_text = file.suffix.lower() in TEXT_SUFFIXES
    if not is_text and LOADERS[file.suffix.lower()] is not ExcelTable:
        return None
    rows = _rows_of_numbers(file) if is_text else None
    named = {**read_sidecar(file, trial=1).columns, **(columns or {})}
    try:
        headers = open_table(file).headers
    except RecordingError:
        return "it holds text and no table" if rows == 0 else None
    found = recognised(headers, named)
    if len(found) > 1:
        return None
    if rows == 0:
        return "it holds text and no row of numbers"
    by_number = any(column.lstrip("+- ").startswith("#") for column in named.values())
    without_names = all(header.text == f"#{number}" for number, header in enumerate(headers, 1))
    if found or by_number or without_names or any(map(_states_unit, headers)):
        return None
    if rows is not None and rows >= MEASURED_ROWS:
        return None
    return "no column has the name or the unit of a channel"


def _states_unit(header: Header) -> bool:
    return header.unit is not None and any(measures(header.unit, si) for si in ("s", "m", "N"))


def _rows_of_numbers(file: Path) -> int | None:
    """Return how many lines of the first 64 KiB are rows of two numbers or more; None for what is no text."""
    try:
        with file.open("rb") as stream:
            head = stream.read(HEAD)
    except OSError:
        return None
    if not head or _NOT_TEXT.search(head):
        return None
    return sum(map(_is_row_of_numbers, head.decode("utf-8", errors="replace").splitlines()))


def _is_row_of_numbers(line: str) -> bool:
    cells = [cell.strip().strip('"') for cell in re.split("[;,\t]", line)]
    words = line.split()
    numbers = sum(_NUMBER.fullmatch(cell) is not None for cell in cells)
    return numbers > 1 or (len(words) > 1 and all(map(_NUMBER.fullmatch, words)))


def _nothing_in(folder: Path, skipped: Sequence[Skipped]) -> str:
    because = f" ({'; '.join(str(file) for file in skipped[:3])})" if skipped else ""
    return f"{folder} holds no recording{because}; a recording ends in one of {', '.join(LOADERS)}"
