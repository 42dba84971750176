"""The summary of many verdicts: what is missing where, how often, how sure; as CSV and as a page."""

from __future__ import annotations

import csv
import importlib.resources
import io
from collections import Counter
from dataclasses import dataclass
from pathlib import Path
from urllib.parse import quote

import jinja2
from rich.table import Table

from ..diagnosis.diagnosis_file import NOTHING, Names, Stated

HEADINGS = (
    "name",
    "missing",
    "unexplained",
    "confidence",
    "rivals",
    "noise [N]",
    "before [N]",
    "after [N]",
    "most of it in",
)
"""What the summary tells of every verdict."""


@dataclass(frozen=True)
class Item:
    """What gets one verdict: its name, and the recordings that are diagnosed together."""

    name: str
    recordings: tuple[Path, ...]

    @property
    def folder(self) -> str:
        """Name of its folder, one level deep whatever the name."""
        return self.name.replace("/", "~")


@dataclass(frozen=True)
class Row:
    """One line of the summary: the verdict, or the sentence why there is none."""

    item: Item
    stated: Stated | None
    error: str | None

    @property
    def names(self) -> Names:
        """What is missing; {"none"} where nothing is, empty where there is no verdict."""
        return frozenset() if self.stated is None else self.stated.names


@dataclass(frozen=True)
class Count:
    """How often something is missing, and how sure the verdicts are that name it (mean confidence)."""

    name: str
    times: int
    confidence: float
    where: tuple[str, ...]


@dataclass(frozen=True)
class EachResult:
    """All verdicts, and the files passed over because no recording ends like that."""

    rows: tuple[Row, ...]
    passed_over: tuple[Path, ...]

    @property
    def failures(self) -> tuple[Row, ...]:
        """The lines without a verdict."""
        return tuple(row for row in self.rows if row.stated is None)

    @property
    def counts(self) -> tuple[Count, ...]:
        """What is missing, the most frequent first."""
        times = Counter(name for row in self.rows for name in row.names)
        found = []
        for name, count in sorted(times.items(), key=lambda item: (-item[1], item[0])):
            of = [row for row in self.rows if name in row.names and row.stated is not None]
            sure = sum(row.stated.confidence for row in of if row.stated is not None) / count
            found.append(Count(name, count, sure, tuple(row.item.name for row in of)))
        return tuple(found)


def summary_csv(result: EachResult, out: Path) -> str:
    """Return the summary as CSV, one line for each item; forces in N."""
    text = io.StringIO()
    lines = csv.writer(text, lineterminator="\r\n")
    lines.writerow([*HEADINGS, "recordings", "report", "error"])
    for row in result.rows:
        s = row.stated
        known: list[object] = [""] * (len(HEADINGS) - 1)
        if s is not None:
            known = [_words(s.names), "yes" if s.unexplained else "no", f"{s.confidence:.3f}"]
            known += ["; ".join(_words(names) for names in s.alternatives)]
            known += [_number(s.fit.get(name)) for name in ("noise", "before", "after")]
            known += [_place(s)]
        files = "; ".join(str(path) for path in row.item.recordings)
        lines.writerow([_safe(v) for v in (row.item.name, *known, files, _report(row, out), row.error or "")])
    return text.getvalue()


def summary_html(result: EachResult, out: Path) -> str:
    """Return the summary as one page: what is missing how often and how sure, then every item; all text escaped."""
    source = importlib.resources.files(__package__).joinpath("summary.html.jinja").read_text(encoding="utf-8")
    environment = jinja2.Environment(autoescape=True, undefined=jinja2.StrictUndefined, trim_blocks=True)
    environment.filters |= {"names": _words, "place": _place, "number": _number}
    return environment.from_string(source).render(
        result=result, reports={row.item.name: quote(_report(row, out)) for row in result.rows}
    )


def summary_table(result: EachResult) -> Table:
    """Return what is missing, how often and how sure, for a terminal."""
    total = len(result.rows)
    table = Table(title=f"{total} recordings or folders", title_justify="left")
    for heading in ("missing", "how often", "mean confidence"):
        table.add_column(heading)
    for count in result.counts:
        name = _words(frozenset({count.name}))
        table.add_row(name, f"{count.times} of {total}", f"{100.0 * count.confidence:.0f} %")
    if result.failures:
        table.add_row("no verdict", f"{len(result.failures)} of {total}", "")
    return table


def _report(row: Row, out: Path) -> str:
    """Way from `out` to the report, with forward strokes on every system."""
    if row.stated is None or row.stated.report is None:
        return ""
    return row.stated.report.relative_to(out).as_posix()


def _place(stated: Stated) -> str:
    """The first place, in which the error is most concentrated, in words."""
    if stated.names == NOTHING or not stated.places:
        return ""
    place = stated.places[0]
    ends = [
        end if isinstance(end, str) else "" if end is None else f"{end:.4g}"
        for end in (place.begin, place.end)
    ]
    unit = "" if place.unit == "1" else f" {place.unit}"
    told = place.label or f"{ends[0]} to {ends[1]}{unit}"
    return f"{place.by} {told} ({100.0 * place.share:.0f} %)"


def in_words(stated: Stated) -> str:
    return f"{_words(stated.names)}, confidence {100.0 * stated.confidence:.0f} %"


def _words(names: Names) -> str:
    if names == NOTHING:
        return "nothing"
    return " + ".join(name.replace("_", " ") for name in sorted(names))


def _number(value: float | None) -> str:
    return "" if value is None else f"{value:.6g}"


def _safe(value: object) -> str:
    """Text that a spreadsheet does not take for a formula."""
    text = str(value)
    return f"'{text}" if text.startswith(("=", "+", "-", "@")) else text
