"""The samples for the interactive views of a report, thinned and packed so that the page stays small."""

from __future__ import annotations

import base64
import hashlib
from collections.abc import Sequence
from dataclasses import dataclass
from importlib import resources
from typing import Any

import numpy as np
from markupsafe import Markup
from numpy.typing import NDArray

from .loops import Case

FloatArray = NDArray[np.float64]

BYTES_EACH = 16
"""Bytes of a page for one sample: a time of 4 bytes and four channels of 2, as text."""

EXTREMES = 6
"""Samples that a bucket keeps: least and largest of the force and of both residuals."""

SPARE = EXTREMES + 2
"""Samples of a recording at most beyond its part: of one more bucket, the first and the last."""

TRIES, FULL = 4, 0.95
"""So often the samples are chosen until this part of the room is used."""

LEVELS = 65_535
"""Steps between the least and the largest value of a channel: 0.03 N where the force goes to 2000 N."""


@dataclass(frozen=True)
class Script:
    """The text of the page's one script, and its hash for the content security policy."""

    text: Markup
    hash: str


def explored(cases: Sequence[tuple[str, Case]], noise: float, alike: bool, most: int) -> dict[str, Any]:
    """Return what the script reads: plain values, to be written as JSON that cannot leave its element.

    cases: what each recording was used for, and the recording; noise [N]; alike: whether the correction changes nothing
    most: about so many samples of all recordings together, but a few of each
    """
    total = sum(len(case.recording) for _, case in cases)
    chosen = _filled([case for _, case in cases], most)
    packed = [_packed(used, case, kept) for (used, case), kept in zip(cases, chosen, strict=True)]
    kept = sum(p["kept"] for p in packed)
    return {"noise": noise, "alike": alike, "total": total, "kept": kept, "recordings": packed}


def _filled(cases: Sequence[Case], most: int) -> list[NDArray[np.intp]]:
    """Return samples of each case, `most` together as nearly as a few tries make it: extremes may coincide."""
    total = sum(len(case.recording) for case in cases)
    room, asked, chosen = most + SPARE * len(cases), most, [chosen_samples(case, 0) for case in cases]
    for _ in range(TRIES):
        tried = [chosen_samples(case, asked * len(case.recording) // max(total, 1)) for case in cases]
        count = sum(kept.size for kept in tried)
        if count > room:
            break
        chosen = tried
        if count >= min(total, round(FULL * most)):
            break
        asked = round(asked * most / count)
    return chosen


def chosen_samples(case: Case, most: int) -> NDArray[np.intp]:
    """Return at most about `most` indices of samples, in their order: all, or the extremes of even buckets.

    Every bucket keeps the least and the largest of the force and of the residuals before and after.
    """
    count = len(case.recording)
    if count <= max(most, EXTREMES):
        return np.arange(count)
    buckets = max(most // EXTREMES, 1)
    size = -(-count // buckets)
    force = case.recording.force
    indices = []
    for values in (force, force - case.before, force - case.after):
        padded = np.append(values, np.full(-count % size, values[-1])).reshape(-1, size)
        first = np.arange(padded.shape[0]) * size
        indices += [first + padded.argmin(axis=1), first + padded.argmax(axis=1)]
    kept = np.concatenate([*indices, [0, count - 1]])
    return np.unique(np.minimum(kept, count - 1))


def script() -> Script:
    """Return the plotting library and the views as one script."""
    here = resources.files(__package__)
    library = (here / "uplot" / "uPlot.iife.min.js").read_text(encoding="utf-8")
    views = (here / "explore.js").read_text(encoding="utf-8")
    text = f"\n{library}\n{views}"
    digest = base64.b64encode(hashlib.sha256(text.encode("utf-8")).digest()).decode("ascii")
    return Script(Markup(text), f"sha256-{digest}")


def style() -> Markup:
    """Return the style sheet of the plotting library."""
    here = resources.files(__package__)
    return Markup((here / "uplot" / "uPlot.min.css").read_text(encoding="utf-8"))


def _packed(used: str, case: Case, kept: NDArray[np.intp]) -> dict[str, Any]:
    r = case.recording
    return {
        "name": r.name.encode("utf-8", "backslashreplace").decode("utf-8"),
        "used": used,
        "kept": int(kept.size),
        "thinned": bool(kept.size < len(r)),
        "time": _text((r.time[kept] - r.time[0]).astype("<f4")),
        "deflection": _channel(1e3 * r.deflection[kept]),
        "force": _channel(r.force[kept]),
        "before": _channel(case.before[kept]),
        "after": _channel(case.after[kept]),
    }


def _channel(values: FloatArray) -> dict[str, Any]:
    """Return values as steps above the least one, rounded."""
    low, span = float(values.min()), float(np.ptp(values))
    step = span / LEVELS if span > 0.0 else 1.0
    return {"low": low, "step": step, "data": _text(np.round((values - low) / step).astype("<u2"))}


def _text(values: NDArray[Any]) -> str:
    return base64.b64encode(values.tobytes()).decode("ascii")
