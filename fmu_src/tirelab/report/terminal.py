"""A diagnosis in the terminal: a screenful, plain where the output is no terminal."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from rich.console import Console
from rich.table import Table
from rich.text import Text

from . import first_screen, titles, words
from .delivered import delivered_of
from .look_alikes import look_alikes

MOST_PLACES = 6
"""Rows of the table of places."""


def print_diagnosis(console: Console, diagnosis: Mapping[str, Any], out: Path) -> None:
    """Print the verdict, its alternatives, the errors, the places, the parameters, the next test and the files.

    diagnosis: the content of diagnosis.json; out: the folder that was written
    """
    verdict = diagnosis["verdict"]
    console.print(Text(first_screen.headline(diagnosis), style="bold"))
    console.print(Text(verdict["summary"]))
    console.print()
    sections: list[Sequence[Table | Text]] = [[_errors(diagnosis)]]
    if diagnosis["where"]:
        sections.append([_places(diagnosis)])
    kind = delivered_of(diagnosis).kind
    sections += [_effect(effect, diagnosis["report"], kind) for effect in verdict["effects"]]
    if verdict.get("corrections"):
        sections.append([_regressions(verdict["corrections"])])
    if verdict.get("alternative_details"):
        sections.append([_alternatives(verdict["alternative_details"])])
    if outside := look_alikes(verdict):
        sections.append([_look_alikes(outside)])
    for section in sections:
        console.print(*section, sep="\n")
        console.print()
    console.print(_next_step(diagnosis))
    console.print(Text(f"Written to {printable(str(out))}: {', '.join(_files(diagnosis))}"))


def _errors(diagnosis: Mapping[str, Any]) -> Table:
    fit = diagnosis["fit"]
    errors = _table("RMS error [N]", "before", "after", "noise")
    noise = words.number(fit["noise"])
    errors.add_row("fitted", words.number(fit["before"]), words.number(fit["after"]), noise)
    if fit["held_out_before"] is not None:
        kept = (words.number(fit["held_out_before"]), words.number(fit["held_out_after"]))
        errors.add_row(f"held-out{words.held_out_part(diagnosis.get('held_out_by', ''))}", *kept, noise)
    return errors


def _places(diagnosis: Mapping[str, Any]) -> Table:
    refitted = "with the law refitted" if words.law_apart(diagnosis["verdict"]) else ""
    places = _table("where they differ", refitted, "share of the error", "mean residual [N]")
    for place in words.foremost(diagnosis["where"], MOST_PLACES):
        places.add_row(
            words.coordinate(place["by"]),
            printable(words.span(place)),
            words.percent(place["share"]),
            words.residual(place["mean_residual"], diagnosis["fit"]["noise"]),
        )
    return places


def _effect(effect: Mapping[str, Any], report: str, kind: str) -> list[Table | Text]:
    """Return an effect with its parameters, or with A and B of each surface.

    report: file with the rest of the law; kind: what is tested, "tire" or "part"
    """
    name = effect["name"]
    title = f"{titles.full_title(name)}, without it {words.percent(effect['share'])} of the error comes back"
    lines: list[Table | Text] = [Text(title, style="dim")]
    if "law" not in effect:
        parameters = _table("", "", "")
        parameters.show_header = False
        for parameter, e in effect["parameters"].items():
            value = words.estimate(e["value"], e["std"], e["unit"])
            parameters.add_row(titles.effect_title(parameter), value, words.meaning(name, parameter))
        return [*lines, parameters]
    surfaces = _table("surface", "A before", "A after [N/cm^B]", "B before", "B after")
    for row in (words.law_row(entry, kind) for entry in effect["law"]):
        surfaces.add_row(*(row[k] for k in ("surface", "A_before", "A_after", "B_before", "B_after")))
    if effect["law"]:
        lines.append(surfaces)
    others = {p: e for p, e in effect["parameters"].items() if not words.is_of_a_surface(p)}
    for constant in words.OF_A_PART:
        if (e := others.pop(constant, None)) is not None:
            lines.append(Text(f"{constant} changed by {words.estimate(e['value'], e['std'], e['unit'])}"))
    if shape := len(others):
        lines.append(Text(f"and {shape} constants of its shape: the curve is in {report}"))
    return lines


def _regressions(corrections: Sequence[Mapping[str, Any]]) -> Table:
    regressed = _table(
        "regression of the remainder over", "RMS error [N]", "held-out [N]", "explained, held-out"
    )
    for c in corrections:
        errors = (words.number(c["after"]), words.number(c["held_out_after"]))
        repeats = c["repeats"]
        explained = "not known" if repeats is None else words.percent(max(repeats, 0.0))
        regressed.add_row(titles.dependence(c["by"]), *errors, explained)
    return regressed


def _alternatives(details: Sequence[Mapping[str, Any]]) -> Table:
    others = _table("cannot be ruled out", "probability", "what decides")
    for other in words.likeliest(details):
        chance = "not seen" if other["probability"] is None else words.percent(other["probability"])
        others.add_row(other["difference"], chance, other["action"] or other["reason"])
    return others


def _look_alikes(outside: Sequence[tuple[str, str, str]]) -> Table:
    others = _table("not in the catalogue, leaves the same", "in place of", "what tells it")
    for title, what, check in outside:
        others.add_row(what, title, check)
    return others


def _next_step(diagnosis: Mapping[str, Any]) -> Text:
    verdict = diagnosis["verdict"]
    lacking = [f"{d['reason']}: {d['action']}" for d in verdict.get("alternative_details", []) if d["action"]]
    step = first_screen.next_step(diagnosis, lacking)
    drive = f" Drive {verdict['separating_test']['file']}." if step.drive else ""
    return Text(f"What to do next: {step.action} {step.why}".rstrip() + drive)


def _files(diagnosis: Mapping[str, Any]) -> list[str]:
    """Return the names of the files of a diagnosis, without those that it did not write."""
    test = diagnosis["verdict"]["separating_test"]
    files = [diagnosis["report"], diagnosis["tire"], diagnosis["corrected_fmu"]]
    files += [(diagnosis.get("correction") or {}).get("system"), "diagnosis.json", diagnosis.get("data")]
    files.append(None if test is None else test["file"])
    return [name for name in files if name]


def printable(text: str) -> str:
    """Return `text` with a question mark for every character that could control a terminal."""
    return "".join(c if c.isprintable() else "?" for c in text)


def _table(*titles: str) -> Table:
    table = Table(box=None, pad_edge=False, padding=(0, 3, 0, 0), header_style="dim")
    for title in titles:
        table.add_column(title, overflow="fold")
    return table
