"""The proof in short, for a terminal."""

from __future__ import annotations

from rich.table import Table

from .page import Proof, interval, told_value

VERDICTS = {True: "[green]pass[/]", False: "[red]fail[/]", None: "not measured"}


def bar_table(proof: Proof) -> Table:
    """Return every figure with its interval, its bar, and whether it is met."""
    table = Table(title=f"{len(proof.scores)} blind trials, seed {proof.seed}", title_justify="left")
    for heading in ("figure", "measured", "95 % interval", "bar", ""):
        table.add_column(heading)
    for line in proof.lines:
        table.add_row(
            line.figure,
            told_value(line.measured),
            interval(line.measured),
            f"{'>=' if line.at_least else '<='} {line.bar:g}",
            VERDICTS[line.passes],
        )
    return table
