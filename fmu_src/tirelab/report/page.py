"""A diagnosis -> one HTML file that needs nothing else: no script, no font, no request."""

from __future__ import annotations

import importlib.metadata
import platform
from collections.abc import Mapping, Sequence
from functools import partial
from importlib import resources
from pathlib import Path
from typing import Any

import jinja2
import numpy as np
from markupsafe import Markup
from numpy.typing import NDArray

from ..errors import TirelabError
from ..recordings.recording import Recording
from . import explore, titles, words
from .alternatives_table import alternatives
from .delivered import delivered_of
from .error_table import errors
from .header import header
from .left_out import corrections, effect_shown
from .loops import Case
from .models_compared import models_compared
from .next_test import next_test
from .pictures import loops, residuals
from .shape_sketch import shape_sketch
from .sketches import draw_law_changes

FloatArray = NDArray[np.float64]

Simulated = tuple[Sequence[Recording], Sequence[FloatArray], Sequence[FloatArray]]
"""Recordings, and their simulated forces [N] before and after the correction."""

MOST_BYTES = 1_990_000
"""Of a page: what the rest of it leaves of them is for samples."""

MOST_PLACES = 8
"""Rows of the table of places."""

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
        evidence      [{"effects": [name], "log_evidence": 0 for the verdict, "rmse" [N], "held_out_rmse" [N] or None,
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
    environment.filters |= {"number": words.number, "percent": words.percent, "unbroken": words.unbroken}
    page = environment.from_string((here / "report.html.jinja").read_text(encoding="utf-8"))
    reasons = list(diagnosis["reasons"] or [])
    sketches = {**(diagnosis["sketches"] or {}), **shape_sketch(diagnosis)}
    used = [("fitted", c) for c in fitted] + [("held-out", c) for c in held_out]
    alike = all(c.alike for c in fitted)

    def explored(most: int) -> dict[str, Any]:
        return explore.explored(used, float(diagnosis["fit"]["noise"]), alike, most)

    written = partial(
        page.render,
        script=explore.script(),
        first=header(diagnosis, fitted, reasons),
        style=explore.style() + Markup((here / "report.css").read_text(encoding="utf-8")),
        diagnosis=diagnosis,
        delivered=delivered_of(diagnosis),
        verdict=verdict,
        effects=[
            effect_shown(effect, sketches, delivered_of(diagnosis).kind) for effect in verdict["effects"]
        ],
        alternatives=alternatives(verdict),
        unseen=any(d["probability"] is None for d in verdict.get("alternative_details") or ()),
        law_curves=draw_law_changes(diagnosis["law_changes"], "law") if diagnosis["law_changes"] else None,
        fit=errors(diagnosis["fit"], diagnosis.get("held_out_by", ""), fitted, held_out),
        loops=loops(fitted, held_out),
        maps=residuals(fitted, float(diagnosis["fit"]["noise"])),
        places=(places := words.foremost(diagnosis["where"], MOST_PLACES)),
        law_apart=words.law_apart(verdict),
        more_places=len(diagnosis["where"]) - len(places),
        evidence=models_compared(diagnosis["evidence"] or []),
        test=next_test(verdict["separating_test"], diagnosis["waveform"]),
        corrections=corrections(diagnosis["correction"]),
        sources=[(kind, c.recording) for kind, c in used],
        versions=_versions(),
    )
    bare = len(written(explored=explored(0)).encode("utf-8", "backslashreplace"))
    return written(explored=explored(max(MOST_BYTES - bare, 0) // explore.BYTES_EACH))


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


def _versions() -> str:
    found = [f"Python {platform.python_version()}"]
    for name in VERSIONS_OF:
        try:
            found.append(f"{name} {importlib.metadata.version(name)}")
        except importlib.metadata.PackageNotFoundError:
            found.append(f"{name} (not installed as a package)")
    return ", ".join(found)
