"""A verdict as a small HTML table, for a notebook."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from markupsafe import Markup

from . import first_screen, titles, words

_TABLE = Markup(
    '<table style="border-collapse:collapse;color:inherit;background:transparent">'
    '<caption style="text-align:left;font-weight:bold;color:inherit;padding-bottom:4px">{caption}</caption>'
    "<tbody>{rows}</tbody></table>"
)

_ROW = Markup(
    '<tr style="border-top:1px solid rgba(128,128,128,0.4);background:transparent">'
    '<th scope="row" style="text-align:left;vertical-align:top;font-weight:normal;opacity:0.7">{title}</th>'
    '<td style="text-align:left;padding-left:12px">{text}</td></tr>'
)
"""Colours come from the notebook, light or dark."""


def verdict_table(diagnosis: Mapping[str, Any]) -> str:
    """Return a table of the content of diagnosis.json: verdict, errors, parameters, alternatives, next test."""
    verdict, fit = diagnosis["verdict"], diagnosis["fit"]
    rows = [
        (
            "confidence",
            f"{words.percent(verdict['confidence'])}: {words.confidence_word(verdict['confidence'])}",
        ),
        ("RMS error", f"{_change(fit['before'], fit['after'])}; the noise is {words.number(fit['noise'])} N"),
    ]
    if fit["held_out_before"] is not None:
        held_out = _change(fit["held_out_before"], fit["held_out_after"])
        rows.append(("held-out RMS error", f"{held_out}{words.held_out_part(diagnosis['held_out_by'])}"))
    rows += [
        (
            titles.full_title(effect["name"]),
            ", ".join(
                f"{titles.effect_title(name)} {words.estimate(e['value'], e['std'], e['unit'])}"
                for name, e in effect["parameters"].items()
            ),
        )
        for effect in verdict["effects"]
    ]
    if verdict["alternatives"]:
        names = [titles.set_title(names) for names in verdict["alternatives"]]
        rows.append(("alternative models", titles.listed(names, "or")))
    if verdict["separating_test"] is not None:
        rows.append(("recommended next test", verdict["separating_test"]["sentence"]))
    body = Markup("").join(_ROW.format(title=title, text=text) for title, text in rows)
    return str(_TABLE.format(caption=first_screen.headline(diagnosis), rows=body))


def _change(before: float, after: float | None) -> str:
    return f"{words.number(before)} N → {words.number(after)} N"
