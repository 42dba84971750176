"""The acceptance criteria of a proof as a table for the terminal."""

from __future__ import annotations

from rich.table import Table

from .calibration import skills
from .metrics import RIGHT_BEFORE, RIGHT_WITH, discriminations
from .page import REDRAWN, Proof, interval, judged, value_text
from .wide_kinds import PARTS, kind_criteria

FIGURE_WIDTH = 40
"""Characters of the first column, so that no row is broken elsewhere because of how many trials there were."""

COLOURS = {"pass": "[green]pass[/]", "fail": "[red]fail[/]"}


def criteria_table(proof: Proof) -> Table:
    """Return every figure with its interval, its limit, and whether it passes."""
    table = Table(title=f"{len(proof.scores)} blind trials, seed {proof.seed}", title_justify="left")
    table.add_column("figure", width=FIGURE_WIDTH)
    for heading in ("measured", "95 % interval", "limit", ""):
        table.add_column(heading)
    for criterion in proof.criteria:
        table.add_row(
            criterion.figure,
            value_text(criterion.measured),
            interval(criterion.measured),
            f"{'>=' if criterion.at_least else '<='} {criterion.limit:g}",
            COLOURS.get(judged(criterion), judged(criterion)),
        )
    return table


def lines(proof: Proof) -> list[str]:
    """Return what the table leaves open: how many answers the rig accepts, calibration, and when trials are redrawn."""
    found = proof.answers
    tested = discriminations(proof.scores)
    before, after = tested[RIGHT_BEFORE], tested[RIGHT_WITH]
    parts = [f"{c.figure}: {value_text(c.measured)}" for c in kind_criteria(proof.scores, PARTS)]
    ruled = [
        f"By the rig's own fits: more than one answer in {value_text(found.several_as_derived)}; exact in "
        f"{value_text(found.exact_as_derived)}, on trials with one answer alone in "
        f"{value_text(found.exact_single_as_derived)}."
    ]
    return [
        *parts,
        f"More than one answer counts as right in {value_text(found.several)}; right on trials with one answer alone "
        f"in {value_text(found.exact_single)}, {interval(found.exact_single)}.",
        *(ruled if proof.drawn else []),
        f"Alternatives per verdict: {value_text(found.alternatives)}.",
        *(
            [
                f"With the recommended recording right in {value_text(after)}, before it in {value_text(before)}."
            ]
            if after.trials
            else []
        ),
        *(
            f"Brier skill of the {what} over the constant rate: {value_text(value)}, {interval(value)}."
            for what, value in skills(proof.scores).items()
        ),
        REDRAWN,
    ]
