"""A diagnosis in the terminal: a screenful, plain where the output is no terminal."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from rich.console import Console
from rich.table import Table
from rich.text import Text

from . import words

MOST_PLACES = 5
"""Places that are told."""


def print_diagnosis(
    console: Console,
    diagnosis: Mapping[str, Any],
    where: Sequence[Mapping[str, Any]],
    reasons: Sequence[str],
    out: Path,
) -> None:
    """Print the verdict, where, parameters, rivals, the test, the errors and the files.

    diagnosis: the content of diagnosis.json; where: its places, those to be told first; reasons: one for each rival
    """
    verdict, fit = diagnosis["verdict"], diagnosis["fit"]
    console.print(Text(words.headline(verdict), style="bold"))
    console.print(Text(verdict["summary"]))
    console.print()
    errors = _table("error [N]", "before", "after", "noise")
    noise = words.number(fit["noise"])
    errors.add_row("fitted", words.number(fit["before"]), words.number(fit["after"]), noise)
    if fit["held_out_before"] is not None:
        kept = (words.number(fit["held_out_before"]), words.number(fit["held_out_after"]))
        by = diagnosis.get("held_out_by", "")
        errors.add_row(f"not seen by the fit{words.held_out_part(by)}", *kept, noise)
    console.print(errors)
    console.print()

    if where:
        places = _table("where they part", "", "part of the error", "mean residual [N]")
        for place in words.foremost(where, MOST_PLACES, of_one=1):
            mean = words.residual(place["mean_residual"], fit["noise"])
            places.add_row(
                words.coordinate(place["by"]),
                printable(words.span(place)),
                words.percent(place["share"]),
                mean,
            )
        console.print(places)
        console.print()

    for effect in verdict["effects"]:
        title = f"{words.effect_title(effect['name'])}, {words.percent(effect['share'])} of the error"
        console.print(Text(title, style="dim"))
        parameters = _table("", "", "")
        parameters.show_header = False
        for name, e in effect["parameters"].items():
            value = words.estimate(e["value"], e["std"], e["unit"])
            parameters.add_row(words.effect_title(name), value, words.meaning(effect["name"], name))
        console.print(parameters)
        console.print()

    for names, reason in zip(verdict["alternatives"], reasons, strict=True):
        console.print(Text(f"it could also be {words.set_title(names)}: {reason}"))
    if verdict["separating_test"] is not None:
        console.print(Text(f"the test that would tell: {verdict['separating_test']['sentence']}"))
        if verdict["separating_test"]["separation"] < words.CLEAR:
            console.print(Text(words.TOO_WEAK))
    files = [diagnosis["report"], diagnosis["tire"], diagnosis["corrected_fmu"], "diagnosis.json"]
    if verdict["separating_test"] is not None:
        files.append(verdict["separating_test"]["file"])
    console.print(Text(f"written into {printable(str(out))}: {', '.join(files)}"))


def printable(text: str) -> str:
    """Return `text` with what could steer a terminal, as the escape character, shown as a question mark."""
    return "".join(c if c.isprintable() else "?" for c in text)


def _table(*titles: str) -> Table:
    table = Table(box=None, pad_edge=False, padding=(0, 3, 0, 0), header_style="dim")
    for title in titles:
        table.add_column(title, overflow="fold")
    return table
