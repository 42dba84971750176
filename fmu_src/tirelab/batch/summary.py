"""The summary of many verdicts as CSV, as a page and as a table: what is missing, where, how often, how surely."""

from __future__ import annotations

import csv
import importlib.resources
import io
from collections import Counter
from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path
from typing import Any
from urllib.parse import quote

import jinja2
from markupsafe import Markup
from rich.table import Table

from ..diagnosis.diagnosis_file import NOTHING, Names, Stated, StatedPlace
from ..report.titles import difference, effect_title
from ..report.words import number

HEADINGS = (
    "name",
    "missing",
    "unexplained",
    "confidence",
    "alternatives",
    "noise [N]",
    "before [N]",
    "after [N]",
    "largest part in",
)
"""Columns of the summary for every verdict."""


MOST = 3
"""Alternatives of a verdict that the page names; the CSV has all of them."""


@dataclass(frozen=True)
class Item:
    """One item of a batch: its name, and the recordings that are diagnosed together."""

    name: str
    recordings: tuple[Path, ...]

    @property
    def folder(self) -> str:
        """Name of its folder; a name with slashes gives one level too."""
        return self.name.replace("/", "~")


@dataclass(frozen=True)
class Row:
    """One row of the summary: the verdict, or the sentence why there is none."""

    item: Item
    verdict: Stated | None
    error: str | None

    @property
    def names(self) -> Names:
        """What is missing; {"none"} where nothing is, empty where there is no verdict."""
        return frozenset() if self.verdict is None else self.verdict.names


@dataclass(frozen=True)
class Count:
    """How often an effect is missing, the mean confidence of the verdicts that name it, and the items."""

    name: str
    times: int
    confidence: float
    where: tuple[str, ...]


@dataclass(frozen=True)
class BatchResult:
    """All verdicts, and the files that were skipped, since they are no recordings."""

    rows: tuple[Row, ...]
    skipped: tuple[Path, ...]

    @property
    def failures(self) -> tuple[Row, ...]:
        """The rows without a verdict."""
        return tuple(row for row in self.rows if row.verdict is None)

    @property
    def counts(self) -> tuple[Count, ...]:
        """What is missing, the most frequent first."""
        times = Counter(name for row in self.rows for name in row.names)
        found = []
        for name, count in sorted(times.items(), key=lambda item: (-item[1], item[0])):
            rows = [row for row in self.rows if name in row.names]
            confidence = sum(row.verdict.confidence for row in rows if row.verdict is not None) / count
            found.append(Count(name, count, confidence, tuple(row.item.name for row in rows)))
        return tuple(found)


def summary_csv(result: BatchResult, out: Path) -> str:
    """Return the summary as CSV, one line for each item; forces in N."""
    text = io.StringIO()
    lines = csv.writer(text, lineterminator="\r\n")
    lines.writerow([*HEADINGS, "recordings", "report", "error"])
    for row in result.rows:
        s = row.verdict
        known: list[object] = [""] * (len(HEADINGS) - 1)
        if s is not None:
            known = [_words(s.names), "yes" if s.unexplained else "no", f"{s.confidence:.3f}"]
            known += ["; ".join(_words(names) for names in s.alternatives)]
            known += [_number(s.fit.get(name)) for name in ("noise", "before", "after")]
            known += [_region(s)]
        files = "; ".join(str(path) for path in row.item.recordings)
        lines.writerow([_safe(v) for v in (row.item.name, *known, files, _report(row, out), row.error or "")])
    return text.getvalue()


def summary_content(result: BatchResult, out: Path) -> dict[str, Any]:
    """Return the summary as one JSON document; forces in N, None where there is no verdict."""
    items = []
    for row in result.rows:
        s = row.verdict
        known: dict[str, Any] | None = None
        if s is not None:
            known = {
                "effects": sorted(s.names - NOTHING),
                "unexplained": s.unexplained,
                "confidence": s.confidence,
                "alternatives": [sorted(names - NOTHING) for names in s.alternatives],
                "fit": {name: s.fit.get(name) for name in ("noise", "before", "after")},
            }
        files = [str(path) for path in row.item.recordings]
        report = _report(row, out) or None
        items.append(
            {
                "name": row.item.name,
                "recordings": files,
                "verdict": known,
                "report": report,
                "error": row.error,
            }
        )
    counts = [{"effect": c.name, "times": c.times, "confidence": c.confidence} for c in result.counts]
    return {"items": items, "missing": counts, "skipped": [str(path) for path in result.skipped]}


def summary_html(result: BatchResult, out: Path) -> str:
    """Return the summary as one page: how often each effect is missing, then every item; all text escaped."""
    source = importlib.resources.files(__package__).joinpath("summary.html.jinja").read_text(encoding="utf-8")
    environment = jinja2.Environment(autoescape=True, undefined=jinja2.StrictUndefined, trim_blocks=True)
    environment.filters |= {"names": _shown, "others": _differences, "region": _region, "number": _force}
    style = importlib.resources.files("tirelab.report").joinpath("report.css").read_text(encoding="utf-8")
    return environment.from_string(source).render(
        style=Markup(style),
        result=result,
        reports={row.item.name: quote(_report(row, out)) for row in result.rows},
    )


def summary_table(result: BatchResult) -> Table:
    """Return how often each effect is missing, with the mean confidence, as a table for the terminal."""
    total = len(result.rows)
    table = Table(title=f"{total} recordings or folders", title_justify="left")
    for heading in ("missing", "how often", "mean confidence"):
        table.add_column(heading)
    for count in result.counts:
        name = _shown([count.name])
        table.add_row(name, f"{count.times} of {total}", f"{100.0 * count.confidence:.0f} %")
    if result.failures:
        table.add_row("no verdict", f"{len(result.failures)} of {total}", "")
    return table


def _report(row: Row, out: Path) -> str:
    """Path of the report relative to `out`, with forward slashes on every system."""
    if row.verdict is None or row.verdict.report is None:
        return ""
    return row.verdict.report.relative_to(out).as_posix()


def _region(verdict: Stated) -> str:
    """The first region of the verdict, in which the error is most concentrated, as text."""
    if verdict.names == NOTHING or not verdict.places:
        return ""
    region = verdict.places[0]
    span = region.label or _span(region)
    return f"{region.by} {span} ({100.0 * region.share:.0f} %)"


def _span(region: StatedPlace) -> str:
    unit = "" if region.unit == "1" else f" {region.unit}"
    begin, end = (f"{end:.4g}" if isinstance(end, float) else end for end in (region.begin, region.end))
    if begin is None and end is None:
        return "everywhere"
    if begin is None:
        return f"up to {end}{unit}"
    return f"from {begin}{unit}" if end is None else f"{begin} to {end}{unit}"


def verdict_text(verdict: Stated) -> str:
    """Return a verdict in one line."""
    return f"{_shown(verdict.names)}, confidence {100.0 * verdict.confidence:.0f} %"


def _words(names: Names) -> str:
    if names == NOTHING:
        return "nothing"
    return " + ".join(name.replace("_", " ") for name in sorted(names))


def _shown(names: Iterable[str]) -> str:
    """Return effects for a reader, as the report names them."""
    known = sorted(frozenset(names) - NOTHING)
    return " + ".join(effect_title(name) for name in known) or "nothing"


def _differences(verdict: Stated) -> str:
    """Return the first MOST alternatives as differences from the verdict, and how many more there are."""
    own = sorted(verdict.names - NOTHING)
    told = [
        difference(own, others) if (others := sorted(names - NOTHING)) else "nothing missing"
        for names in verdict.alternatives[:MOST]
    ]
    more = len(verdict.alternatives) - MOST
    return "; ".join([*told, *([f"{more} more"] if more > 0 else [])])


def _force(value: float | None) -> str:
    return "" if value is None else number(value)


def _number(value: float | None) -> str:
    return "" if value is None else f"{value:.6g}"


def _safe(value: object) -> str:
    """Text that a spreadsheet does not read as a formula."""
    text = str(value)
    return f"'{text}" if text.startswith(("=", "+", "-", "@")) else text
