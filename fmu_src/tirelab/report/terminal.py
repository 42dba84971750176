"""A diagnosis in the terminal: a screenful, plain where the output is no terminal."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from rich.console import Console
from rich.table import Table
from rich.text import Text

from . import first_screen, titles, words

MOST_PLACES = 6
"""Rows of the table of places."""


def print_diagnosis(
    console: Console,
    diagnosis: Mapping[str, Any],
    out: Path,
) -> None:
    """Print the verdict, its alternatives, the errors, the places, the parameters, the next test and the files.

    diagnosis: the content of diagnosis.json
    """
    verdict, fit = diagnosis["verdict"], diagnosis["fit"]
    console.print(Text(first_screen.headline(diagnosis), style="bold"))
    console.print(Text(verdict["summary"]))
    console.print()
    errors = _table("RMS error [N]", "before", "after", "noise")
    noise = words.number(fit["noise"])
    errors.add_row("fitted", words.number(fit["before"]), words.number(fit["after"]), noise)
    if fit["held_out_before"] is not None:
        kept = (words.number(fit["held_out_before"]), words.number(fit["held_out_after"]))
        by = diagnosis.get("held_out_by", "")
        errors.add_row(f"held-out{words.held_out_part(by)}", *kept, noise)
    console.print(errors)
    console.print()

    if diagnosis["where"]:
        places = _table(
            "where they differ",
            "with the law refitted" if words.law_apart(verdict) else "",
            "share of the error",
            "mean residual [N]",
        )
        for place in words.foremost(diagnosis["where"], MOST_PLACES):
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
        title = f"{titles.full_title(effect['name'])}, without it {words.percent(effect['share'])} of the error is back"
        console.print(Text(title, style="dim"))
        if effect.get("law"):
            surfaces = _table("surface", "A before", "A after [N/cm^B]", "B before", "B after")
            for row in map(words.law_row, effect["law"]):
                surfaces.add_row(*(row[k] for k in ("surface", "A_before", "A_after", "B_before", "B_after")))
            console.print(surfaces)
            shape = sum(not words.is_of_a_surface(name) for name in effect["parameters"])
            if shape:
                console.print(
                    Text(f"and {shape} constants of its shape: the curve is in {diagnosis['report']}")
                )
        else:
            parameters = _table("", "", "")
            parameters.show_header = False
            for name, e in effect["parameters"].items():
                value = words.estimate(e["value"], e["std"], e["unit"])
                parameters.add_row(titles.effect_title(name), value, words.meaning(effect["name"], name))
            console.print(parameters)
        console.print()

    if verdict.get("corrections"):
        regressed = _table(
            "regression of the remainder over", "RMS error [N]", "held-out [N]", "explained, held-out"
        )
        for c in verdict["corrections"]:
            errors_with = (words.number(c["after"]), words.number(c["held_out_after"]))
            regressed.add_row(titles.dependence(c["by"]), *errors_with, words.percent(max(c["repeats"], 0.0)))
        console.print(regressed)
        console.print()

    if verdict.get("alternative_details"):
        others = _table("cannot be ruled out", "probability", "what decides")
        for other in words.likeliest(verdict["alternative_details"]):
            chance = "not seen" if other["probability"] is None else words.percent(other["probability"])
            others.add_row(other["difference"], chance, other["action"] or other["reason"])
        console.print(others)
        console.print()

    lacking = [f"{d['reason']}: {d['action']}" for d in verdict.get("alternative_details", []) if d["action"]]
    step = first_screen.next_step(diagnosis, lacking)
    drive = f" Drive {verdict['separating_test']['file']}." if step.drive else ""
    console.print(Text(f"What to do next: {step.action} {step.why}".rstrip() + drive))
    files = [diagnosis["report"], diagnosis["tire"], diagnosis["corrected_fmu"]]
    files += [(diagnosis.get("correction") or {}).get("system"), "diagnosis.json"]
    files += [diagnosis["data"]] if diagnosis.get("data") else []
    if verdict["separating_test"] is not None:
        files.append(verdict["separating_test"]["file"])
    console.print(Text(f"Written to {printable(str(out))}: {', '.join(filter(None, files))}"))


def printable(text: str) -> str:
    """Return `text` with a question mark for every character that could control a terminal."""
    return "".join(c if c.isprintable() else "?" for c in text)


def _table(*titles: str) -> Table:
    table = Table(box=None, pad_edge=False, padding=(0, 3, 0, 0), header_style="dim")
    for title in titles:
        table.add_column(title, overflow="fold")
    return table
