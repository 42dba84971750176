"""The acceptance criteria of a proof as a table for the terminal."""

from __future__ import annotations

from rich.table import Table

from .page import Proof, interval, value_text

VERDICTS = {True: "[green]pass[/]", False: "[red]fail[/]", None: "not measured"}


def criteria_table(proof: Proof) -> Table:
    """Return every figure with its interval, its limit, and whether it passes."""
    table = Table(title=f"{len(proof.scores)} blind trials, seed {proof.seed}", title_justify="left")
    for heading in ("figure", "measured", "95 % interval", "limit", ""):
        table.add_column(heading)
    for criterion in proof.criteria:
        table.add_row(
            criterion.figure,
            value_text(criterion.measured),
            interval(criterion.measured),
            f"{'>=' if criterion.at_least else '<='} {criterion.limit:g}",
            VERDICTS[criterion.passes],
        )
    return table
