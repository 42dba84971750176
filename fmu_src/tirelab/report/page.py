"""A diagnosis -> one HTML file that needs nothing else: no script, no font, no request."""

from __future__ import annotations

import importlib.metadata
import math
import platform
from collections.abc import Mapping, Sequence
from importlib import resources
from pathlib import Path
from typing import Any

import jinja2
import numpy as np
from markupsafe import Markup
from numpy.typing import NDArray
from radialtire import CATALOGUE

from ..errors import TirelabError
from ..names import REFITTED_LAW
from ..recordings.recording import Recording
from . import explore, first_screen, titles, words
from .delivered import delivered_of
from .loops import Case, draw_difference, draw_loops
from .places import Located, draw_where, shaded
from .residuals import (
    draw_maps,
    draw_over_deflection,
    draw_over_rate,
    draw_over_time,
    draw_slow_changes,
    misfit_of,
)
from .sketches import draw_correction, draw_law_changes, draw_sketch, draw_waveform

FloatArray = NDArray[np.float64]

Simulated = tuple[Sequence[Recording], Sequence[FloatArray], Sequence[FloatArray]]
"""Recordings, and their simulated forces [N] before and after the correction."""

MOST_LOOPS = 4
"""Recordings whose loops are drawn, those with the largest misfit first."""

MOST_PLACES = 8
"""Rows of the table of places."""

MOST_TOLD = 2
"""Places that the first screen tells in words."""

MOST_SETS = 15
"""Rows of the table of sets that were compared."""

BESIDE = (
    "tire_before",
    "tire_after",
    "evidence",
    "reasons",
    "correction",
    "waveform",
    "warnings",
    "command",
    "date",
    "files",
    "located",
    "law_changes",
    "sketches",
    "delivered",
)
"""What a diagnosis may have besides the content of diagnosis.json."""

VERSIONS_OF = ("tirelab", "numpy", "scipy", "numba", "fmpy", "matplotlib")


def write_report(
    path: Path,
    diagnosis: Mapping[str, Any],
    recordings: Sequence[Recording],
    before: Sequence[FloatArray],
    after: Sequence[FloatArray],
    *,
    held_out: Simulated | None = None,
) -> None:
    """Write the report of a diagnosis to `path`.

    diagnosis: the content of diagnosis.json; it may also have
        tire_before, tire_after   names of the tires
        evidence      [{"effects": [name], "log_evidence": 0 for the best, "rmse" [N], "held_out_rmse" [N] or None,
                      "misfit" in noises, "remark"}]; columns that no row has are left out
        where         as in diagnosis.json; an entry's "label" is shown in place of its span
        reasons       one sentence for each of the verdict's alternatives
        correction    regression of the unexplained remainder, one or a list of {"by", "unit", "x", "force" [N],
                      "std" [N] or None, "repeats": sentence}
        waveform      {"time" [s], "deflection" [m]} of the recommended next test
        warnings      sentences for the top of the page
        command       the command line
        date          when, as text; files: (name, SHA-256) of every file that was read
        law_changes   [{"radius" [m], "deflection" [m], "difference" [N]}]: the refitted law less the baseline's
        sketches      effect -> {"deflection" [m], "force" [N], "varied": parameter -> force [N]}
        delivered     the entry "correction" of diagnosis.json, of a correction beside a simulation
        located       residuals [N] in which the places lie, one array for each recording; without, those before
    before, after: simulated forces [N], one array for each recording; held_out: the same for the held-out
    recordings

    Raises TirelabError where an array does not fit its recording, or the file cannot be written.
    """
    text = render(diagnosis, _cases(recordings, before, after), _cases(*held_out) if held_out else [])
    try:
        path.write_text(text, encoding="utf-8", errors="backslashreplace")
    except OSError as error:
        raise TirelabError(f"{path} cannot be written ({error.strerror}); name another folder") from None


def render(diagnosis: Mapping[str, Any], fitted: Sequence[Case], held_out: Sequence[Case]) -> str:
    """Return the text of the report."""
    diagnosis = {**dict.fromkeys(BESIDE), **diagnosis}
    verdict = diagnosis["verdict"]
    here = resources.files(__package__)
    environment = jinja2.Environment(
        autoescape=True, undefined=jinja2.StrictUndefined, trim_blocks=True, lstrip_blocks=True
    )
    environment.globals |= {"words": words, "titles": titles}
    environment.filters |= {"number": words.number, "percent": words.percent}
    page = environment.from_string((here / "report.html.jinja").read_text(encoding="utf-8"))
    reasons = list(diagnosis["reasons"] or [])
    return page.render(
        script=explore.script(),
        explored=explore.explored(
            [("fitted", c) for c in fitted] + [("held-out", c) for c in held_out],
            float(diagnosis["fit"]["noise"]),
            all(c.alike for c in fitted),
        ),
        first=_first_screen(diagnosis, fitted, reasons),
        style=explore.style() + Markup((here / "report.css").read_text(encoding="utf-8")),
        diagnosis=diagnosis,
        delivered=delivered_of(diagnosis),
        verdict=verdict,
        effects=[_effect(effect, diagnosis["sketches"] or {}) for effect in verdict["effects"]],
        alternatives=_alternatives(verdict),
        unseen=any(d["probability"] is None for d in verdict.get("alternative_details") or ()),
        law_curves=draw_law_changes(diagnosis["law_changes"], "law") if diagnosis["law_changes"] else None,
        fit=_fit(diagnosis["fit"], diagnosis.get("held_out_by", ""), fitted, held_out),
        loops=_loops(fitted, held_out),
        maps=_maps(fitted, float(diagnosis["fit"]["noise"])),
        places=(places := words.foremost(diagnosis["where"], MOST_PLACES)),
        law_apart=words.law_apart(verdict),
        more_places=len(diagnosis["where"]) - len(places),
        evidence=_evidence(diagnosis["evidence"] or []),
        test=_test(verdict["separating_test"], diagnosis["waveform"]),
        corrections=_corrections(diagnosis["correction"]),
        regressions=[
            (titles.dependence(c["by"]), c["after"], c["held_out_after"])
            for c in sorted(verdict.get("corrections", []), key=lambda c: -c["repeats"])[:1]
            if c["after"] is not None
        ],
        sources=[("fitted", c.recording) for c in fitted] + [("held-out", c.recording) for c in held_out],
        versions=_versions(),
    )


def _cases(
    recordings: Sequence[Recording], before: Sequence[FloatArray], after: Sequence[FloatArray]
) -> list[Case]:
    if not len(recordings) == len(before) == len(after):
        raise TirelabError(
            f"{len(recordings)} recordings have {len(before)} and {len(after)} simulated forces; give one of each"
        )
    for recording, *forces in zip(recordings, before, after, strict=True):
        for force in forces:
            if force.shape != recording.force.shape or not np.all(np.isfinite(force)):
                raise TirelabError(
                    f"the simulated force of {recording.name} must be one finite value for each of its "
                    f"{len(recording)} samples; simulate it again"
                )
    return [Case(r, b, a) for r, b, a in zip(recordings, before, after, strict=True)]


def _first_screen(
    diagnosis: Mapping[str, Any], fitted: Sequence[Case], reasons: Sequence[str]
) -> dict[str, Any]:
    """What the first screen shows: see `first_screen`."""
    verdict, noise = diagnosis["verdict"], float(diagnosis["fit"]["noise"])
    residuals = diagnosis["located"]
    if not residuals or [len(r) for r in residuals] != [len(c.recording) for c in fitted]:
        residuals = [c.recording.force - c.before for c in fitted]
    located = [
        Located(c.recording, np.asarray(r, float), c.before) for c, r in zip(fitted, residuals, strict=True)
    ]
    where = words.foremost(diagnosis["where"], MOST_PLACES)
    worst = max(located, key=lambda at: float(np.sum(at.residual**2)))
    places = shaded(where, worst)
    test = verdict["separating_test"] or {}
    return {
        "headline": first_screen.headline(diagnosis),
        "lead": first_screen.lead(diagnosis),
        "sure": first_screen.sureness(verdict),
        "undecided": first_screen.undecided(verdict),
        "figures": first_screen.figures(diagnosis),
        "picture": draw_where(worst, places, noise, "where"),
        "recording": worst.recording.name if len(located) > 1 else "",
        "places": [
            (words.coordinate(p["by"]), words.span(p), p["share"]) for p in (places or where)[:MOST_TOLD]
        ],
        "is_shaded": bool(places),
        "next": (step := first_screen.next_step(diagnosis, reasons)),
        "drive": test.get("file") if step.drive else None,
        "links": [
            (title, name)
            for title, name in (
                *delivered_of(diagnosis).files,
                ("Drive file", test.get("file")),
                ("Data of the plots", diagnosis.get("data")),
                ("Numbers", "diagnosis.json" if diagnosis.get("tire") else None),
            )
            if name
        ],
    }


def _effect(effect: Mapping[str, Any], sketches: Mapping[str, Any]) -> dict[str, Any]:
    name = effect["name"]
    known = CATALOGUE.get(name)
    sketch = sketches.get(name)
    return {
        "title": titles.effect_title(name),
        "size": words.number(effect.get("size")) if effect.get("size") is not None else "",
        "statement": words.LAW_STATEMENT if name == REFITTED_LAW else "",
        "tell_tale": known.tell_tale if known else "",
        "imitators": titles.listed([titles.effect_title(n) for n in known.imitators]) if known else "",
        "source": known.source if known else "",
        "share": effect["share"],
        "law": [words.law_row(row) for row in effect.get("law", [])],
        "sketched": sketch is not None,
        "parameters": [
            (
                titles.effect_title(parameter),
                words.estimate(e["value"], e["std"], e["unit"]),
                words.interval(e["value"], e["std"], e["unit"], words.bounds(name, parameter)),
                words.meaning(name, parameter),
                draw_sketch(sketch, parameter) if sketch else "",
            )
            for parameter, e in effect["parameters"].items()
            if not (effect.get("law") and words.is_of_a_surface(parameter))
        ],
    }


def _alternatives(verdict: Mapping[str, Any]) -> list[dict[str, Any]]:
    """The alternatives by their reasons, each of them once: what decides, and the sets as differences."""
    names = [effect["name"] for effect in verdict["effects"]]
    details = verdict.get("alternative_details") or [
        {"difference": titles.difference(names, other), "probability": None, "reason": "", "action": ""}
        for other in verdict["alternatives"]
    ]
    groups: dict[tuple[str, str], list[tuple[str, str]]] = {}
    for d in words.likeliest(details):
        chance = "not seen" if d["probability"] is None else words.percent(d["probability"])
        groups.setdefault((d["reason"], d["action"]), []).append((d["difference"], chance))
    return [
        {"reason": words.sentence(reason), "action": words.sentence(action), "sets": sets}
        for (reason, action), sets in groups.items()
    ]


def _rmse(cases: Sequence[Case], which: str) -> float:
    squares = [np.square(c.recording.force - getattr(c, which)) for c in cases]
    return float(np.sqrt(np.mean(np.concatenate(squares))))


def _fit(
    fit: Mapping[str, Any], held_out_by: str, fitted: Sequence[Case], held_out: Sequence[Case]
) -> dict[str, Any]:
    """The rows of the table of errors [N], and the scale of its bars."""
    rows: list[tuple[str, str | None, float, float]] = [("Fitted", None, fit["before"], fit["after"])]
    if fit["held_out_before"] is not None:
        by = words.held_out_part(held_out_by)
        rows.append((f"Held-out{by}", None, fit["held_out_before"], fit["held_out_after"]))
    for kind, cases in (("fitted", fitted), ("held-out", held_out)):
        if len(cases) > 1:
            rows += [(kind, c.recording.name, _rmse([c], "before"), _rmse([c], "after")) for c in cases]
    finite = [v for *_, before, after in rows for v in (before, after) if math.isfinite(v)]
    return {"rows": rows, "noise": fit["noise"], "full": 1.08 * max([*finite, fit["noise"], 1e-9])}


def _loops(fitted: Sequence[Case], held_out: Sequence[Case]) -> dict[str, Any]:
    """The pictures of the loops: of the recording with the largest misfit a pair, of the others one each."""
    order = sorted(fitted, key=lambda c: -c.excess)
    worst = order[0]
    pair = [
        draw_loops(worst, which, f"p{which[0]}", f"Force over deflection, recorded and simulated, {which}.")
        for which in (("before",) if worst.alike else ("before", "after"))
    ]
    chosen = [("fitted", c) for c in order[1:]] + [("held-out", c) for c in held_out]
    alt = "Force over deflection, recorded and simulated before and after the correction."
    others = [
        (kind, case.recording.name, draw_loops(case, "both", f"o{i}x", alt))
        for i, (kind, case) in enumerate(chosen[: MOST_LOOPS - 1])
    ]
    return {
        "name": worst.recording.name,
        "pair": pair,
        "difference": draw_difference(worst, "df"),
        "alike": all(c.alike for c in fitted),
        "others": others,
        "missing": len(chosen) - len(others),
        "several": len(chosen) > 0,
    }


def _maps(cases: Sequence[Case], noise: float) -> dict[str, Any]:
    misfit = misfit_of(cases)
    maps, second = draw_maps(misfit, noise, "m")
    return {
        "lines": [
            draw_over_time(misfit, noise, "t"),
            draw_over_deflection(misfit, noise, "d"),
            draw_over_rate(misfit, noise, "r"),
            draw_slow_changes(misfit, noise, "s"),
        ],
        "maps": maps,
        "second": second,
        "alike": misfit.alike,
    }


_EVIDENCE_COLUMNS = (
    ("log_evidence", "Log evidence, relative to the best"),
    ("misfit", "Residual / noise"),
    ("rmse", "RMS error [N]"),
    ("held_out_rmse", "Held-out RMS error [N]"),
    ("remark", "Remark"),
)


def _evidence(rows: Sequence[Mapping[str, Any]]) -> dict[str, Any]:
    columns = [
        (key, title) for key, title in _EVIDENCE_COLUMNS if any(row.get(key) is not None for row in rows)
    ]
    shown = [
        (
            titles.set_title(row["effects"]),
            [row.get(key) or "" if key == "remark" else words.number(row.get(key), 3) for key, _ in columns],
        )
        for row in rows[:MOST_SETS]
    ]
    return {"columns": columns, "rows": shown, "more": max(len(rows) - MOST_SETS, 0)}


_TEST_FACTS = (
    ("waveform", "Motion", "", ""),
    ("surfaces", "Surface", "", ""),
    ("amplitude", "Largest deflection", "m", ""),
    ("rate_max", "Fastest rate", "m/s", ""),
    ("duration", "Duration", "s", ""),
    ("separation", "Predicted difference", "1", "times the noise, over all samples"),
    ("file", "File for the rig", "", ""),
)


def _test(test: Mapping[str, Any] | None, waveform: Mapping[str, Any] | None) -> dict[str, Any] | None:
    if test is None:
        return None
    facts = []
    for key, title, unit, remark in _TEST_FACTS:
        value = test.get(key)
        if value is None:
            continue
        if key == "surfaces":
            text = titles.listed([words.surface(radius) for radius in value])
        elif isinstance(value, (int, float)):
            factor, name = words.scaled(unit)
            text = words.with_unit(words.number(factor * value), remark or name)
        else:
            text = str(value)
        facts.append((title, text))
    drawn = draw_waveform(waveform["time"], waveform["deflection"], "w") if waveform else None
    return {
        "sentence": test.get("sentence", ""),
        "facts": facts,
        "picture": drawn,
    }


def _corrections(found: Mapping[str, Any] | Sequence[Mapping[str, Any]] | None) -> list[dict[str, Any]]:
    corrections = [found] if isinstance(found, Mapping) else list(found or [])
    shown = []
    for i, c in enumerate(corrections):
        by = titles.dependence(c["by"])
        picture = draw_correction(
            by.removeprefix("the "), c["unit"], c["x"], c["force"], c.get("std"), f"c{i}x"
        )
        shown.append({"by": by, "repeats": c["repeats"], "picture": picture})
    return shown


def _versions() -> str:
    found = [f"Python {platform.python_version()}"]
    for name in VERSIONS_OF:
        try:
            found.append(f"{name} {importlib.metadata.version(name)}")
        except importlib.metadata.PackageNotFoundError:
            found.append(f"{name} (not installed as a package)")
    return ", ".join(found)
