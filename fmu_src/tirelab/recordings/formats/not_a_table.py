"""Text that holds numbers and is no table yet: it is refused with what makes one of it."""

from __future__ import annotations

import re
import shlex
from collections.abc import Sequence
from pathlib import Path

from .table import RecordingError
from .table_search import is_value

_SERIAL = re.compile(r"\s*\d{1,2}:\d\d:\d\d[.,]\d+ -> ")
_LABEL = r"[^\W\d]\w*(?: \w+)*\s*[:=]\s*"
_PAIR = rf"{_LABEL}[+-]?[\d.]+(?:[eE][+-]?\d+)?(?: ?[^\s\d,;|]+)?"
_LABELLED = re.compile(rf"\s*{_PAIR}(?:(?P<mark>\s*[,;\t|]\s*|\s+){_PAIR})+\s*[,;]?\s*")


def refuse_serial_monitor(path: Path, lines: Sequence[str]) -> None:
    """Refuse text of a serial monitor that put its time stamps before an arrow, with the command that fixes it."""
    if sum(_SERIAL.match(line) is not None for line in lines) <= len(lines) / 2:
        return
    text = lines[-1].partition(" -> ")[2]
    mark = next((mark for mark in (";", ",", "\t") if mark in text), " ").replace("\t", "\\t")
    raise RecordingError(
        f"{path.name}, row 1: a serial monitor wrote the time and an arrow before each row; make columns of them: "
        f"sed -i 's/ -> /{mark}/' {shlex.quote(str(path))}"
    )


def refuse_labels(path: Path, lines: Sequence[str]) -> None:
    """Refuse rows in which every number has its name before it, pos:1.2,force:35, with the command that fixes them."""
    found = [line for line in map(_LABELLED.fullmatch, lines) if line is not None]
    if len(found) <= len(lines) / 2:
        return
    labels = [label.rstrip(":= \t") for label in re.findall(_LABEL, found[0][0])]
    mark = (found[0]["mark"].strip(" ") or " ").replace("\t", "\\t")
    if mark == " " and any(" " in label for label in labels):
        return  # 0 ms Pos: 1.2 mm
    taken_off = rf"s/(^|[^[:alnum:]_.])({'|'.join(labels)})[[:space:]]*[:=][[:space:]]*/\1/g"
    table = path.with_name(f"{path.stem}.table.csv")
    raise RecordingError(
        f"{path.name}, row {lines.index(found[0][0]) + 1}: each number has its name before it; make columns of them: "
        f"(printf {shlex.quote(mark.join(labels) + chr(92) + 'n')}; sed -E {shlex.quote(taken_off)} "
        f"{shlex.quote(str(path))}) > {shlex.quote(str(table))}"
    )


def refuse_split_numbers(path: Path, above: Sequence[str], rows: Sequence[str], separator: str) -> None:
    """Refuse numbers that hold the comma which separates them too: 1,234.5 and 0,25 without quotes, below fewer names.

    Rows of as many cells as there are names stand above the first that has more, or all have twice as many.
    """
    cells = [len(line.split(separator)) for line in above]
    short = next((n for n, line in enumerate(reversed(above)) if not _is_row(line, separator)), len(above))
    named = len(above) - short - 1
    width = len(rows[0].split(separator)) if rows else 0
    if separator != "," or named < 0 or len(above[named].split()) == 0 or not 1 < cells[named] < width:
        return
    names = f"row {named + 1} names {cells[named]} columns"
    if short and set(cells[named + 1 :]) == {cells[named]}:
        raise RecordingError(
            f"{path.name}, row {len(above) + 1}: has {width} cells where {names}, as many as the rows above it hold; "
            "if commas stand between thousands, export the numbers without them, or with semicolons between the columns"
        )
    if not short and width == 2 * cells[named] and not any("." in line for line in rows):
        raise RecordingError(
            f"{path.name}, row {len(above) + 1}: has {width} cells where {names}: commas are decimal and separate the "
            "columns too, so that nobody can tell which is which; export with semicolons between the columns"
        )


def _is_row(line: str, separator: str) -> bool:
    """Whether all cells of a line are numbers."""
    return all(map(is_value, line.strip().split(separator)))
