"""The article's claims held against its law, under both readings of E0, as a table, CSV and JSON."""

from __future__ import annotations

import csv
import io
import json
from dataclasses import dataclass

from radialtire import SECOND_READING, Hull1996
from rich import box
from rich.table import Table

from .checks import Finding
from .claims import CLAIMS, Claim

READINGS = (
    ("E0 = 0.2519 /cm", Hull1996()),
    ("E0 = 0.02519 /cm", Hull1996(convex_coefficient_decay=SECOND_READING)),
)
"""The two readings of 5a's `e(-2519*Rb)`; see `radialtire.hull1996` for the evidence."""

REPRODUCED, NOT_REPRODUCED, NOT_COMPUTABLE = "reproduced", "not reproduced", "not computable"


@dataclass(frozen=True)
class Outcome:
    """A claim and what each reading of READINGS gives for it."""

    claim: Claim
    findings: tuple[Finding | None, ...]

    @property
    def verdicts(self) -> tuple[str, ...]:
        """The verdict under each reading."""
        return tuple(
            NOT_COMPUTABLE if f is None else REPRODUCED if f.agrees else NOT_REPRODUCED for f in self.findings
        )

    @property
    def depends_on_reading(self) -> bool:
        """Whether the readings give different numbers."""
        return len(set(self.findings)) > 1


def check_article() -> tuple[Outcome, ...]:
    """Return every claim with what the law gives for it."""
    return tuple(
        Outcome(claim, tuple(None if claim.check is None else claim.check(law) for _, law in READINGS))
        for claim in CLAIMS
    )


def to_csv(outcomes: tuple[Outcome, ...]) -> str:
    """Return `outcomes` as CSV, one claim a row."""
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    heads = [f"{word}, {reading}" for reading, _ in READINGS for word in ("computed", "verdict")]
    writer.writerow(["claim", "section", "printed", *heads, "remark"])
    for o in outcomes:
        pairs = zip(o.findings, o.verdicts, strict=True)
        cells = [
            cell for finding, verdict in pairs for cell in ("" if finding is None else finding.text, verdict)
        ]
        writer.writerow([o.claim.name, o.claim.section, o.claim.printed, *cells, o.claim.remark])
    return text.getvalue()


def to_json(outcomes: tuple[Outcome, ...]) -> str:
    """Return `outcomes` as JSON."""
    content = [
        {
            "claim": o.claim.name,
            "section": o.claim.section,
            "printed": o.claim.printed,
            "readings": {
                reading: {
                    "computed": None if finding is None else finding.text,
                    "value": None if finding is None else finding.value,
                    "verdict": verdict,
                }
                for (reading, _), finding, verdict in zip(READINGS, o.findings, o.verdicts, strict=True)
            },
            "remark": o.claim.remark,
        }
        for o in outcomes
    ]
    return json.dumps(content, indent=2, ensure_ascii=False, allow_nan=False) + "\n"


def to_table(outcomes: tuple[Outcome, ...]) -> Table:
    """Return `outcomes` as a table for the terminal; remarks stand below what is not plainly reproduced."""
    table = Table(box=box.SIMPLE_HEAD, show_lines=False, expand=True)
    for head, ratio in (("printed", 5), ("computed", 6), ("verdict", 2)):
        table.add_column(head, ratio=ratio)
    for o in outcomes:
        findings, verdicts = o.findings, o.verdicts
        if o.depends_on_reading:
            for i, ((reading, _), finding, verdict) in enumerate(
                zip(READINGS, findings, verdicts, strict=True)
            ):
                text = "" if finding is None else finding.text
                table.add_row("" if i else o.claim.printed, f"{reading}: {text}", verdict, end_section=False)
        else:
            table.add_row(o.claim.printed, "" if findings[0] is None else findings[0].text, verdicts[0])
        if o.claim.remark:
            table.add_row("", f"[dim]{o.claim.remark}[/dim]", "")
    return table


def summary(outcomes: tuple[Outcome, ...]) -> str:
    """Return the sentence that counts the verdicts under each reading."""
    counts = []
    for i, (reading, _) in enumerate(READINGS):
        verdicts = [o.verdicts[i] for o in outcomes]
        parts = [f"{verdicts.count(v)} {v}" for v in (REPRODUCED, NOT_REPRODUCED, NOT_COMPUTABLE)]
        counts.append(f"with {reading}: {', '.join(parts)}")
    return f"{len(outcomes)} claims; " + "; ".join(counts)
