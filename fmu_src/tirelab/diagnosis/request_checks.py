"""What a diagnosis refuses before its work would be lost: files given twice, samples that two parts share, fitted
readings that are held out again, a motion that no tire can follow, a folder that cannot be written.

Each check raises TirelabError with one sentence and returns nothing. What a request cannot show is told, not refused:
times that were made up, deflections that only held-out recordings reach, a tire that pulls.
"""

from __future__ import annotations

import os
from collections.abc import Sequence
from pathlib import Path

import numpy as np
from radialtire import TireModel
from radialtire.model import DEFLECTION_HIGHEST

from ..errors import TirelabError
from ..names import plain
from ..preprocessing.noise import NEGLIGIBLE
from ..preprocessing.samples import surface_numbers, within
from ..recordings.pieces import split_piece
from ..recordings.pulling import pull_of
from ..recordings.recording import Recording
from ..recordings.zero import quantity_text, refuse_too_deep


def check_once(files: Sequence[Path]) -> None:
    """Raise TirelabError where a file is given twice."""
    seen = set()
    for file in files:
        if file.resolve() in seen:
            raise TirelabError(
                f"{file} is given twice; give each recording once, either to fit or to hold out"
            )
        seen.add(file.resolve())


def check_apart(read: Sequence[tuple[Path, Recording]]) -> None:
    """Raise TirelabError where two pieces of one file share samples: each sample is fitted or held out, once."""
    for i, (file, one) in enumerate(read):
        for other_file, other in read[:i]:
            same = one.source is not None and other.source is not None and one.source.samefile(other.source)
            piece, other_piece = split_piece(file)[1], split_piece(other_file)[1]
            if not same or piece.part != other_piece.part:
                continue
            rows, other_rows = piece.rows, other_piece.rows
            # The clock of tests below one another begins anew in each.
            if rows and other_rows and (rows[1] < other_rows[0] or other_rows[1] < rows[0]):
                continue
            if one.time[0] <= other.time[-1] and other.time[0] <= one.time[-1]:
                first, last = max(one.time[0], other.time[0]), min(one.time[-1], other.time[-1])
                count = int(np.sum((one.time >= first) & (one.time <= last)))
                shared = (
                    f"{plain(first, 6)} to {plain(last, 6)} s"
                    if one.timed
                    else f"{count} sample{'s' * (count > 1)}"
                )
                raise TirelabError(
                    f"{other_file} and {file} share {shared}; give each part of a file once "
                    "(a range includes both ends)"
                )


def without_time(recordings: Sequence[Recording]) -> list[str]:
    """Return a sentence where times were made up."""
    if not (names := [recording.name for recording in recordings if not recording.timed]):
        return []
    return [
        f"the time of {', '.join(names)} was not measured: seconds count samples here, and nothing of rate, time or "
        "acceleration was judged"
    ]


def beyond_fitted(fitted: Sequence[Recording], kept: Sequence[Recording]) -> list[str]:
    """Return a sentence for each held-out recording of which more than NEGLIGIBLE is not `within` the fitted
    deflections: there its error is one of the law, which nothing showed.
    """
    numbers = surface_numbers([r.surface_radius for r in (*fitted, *kept)])
    placed = [(r.deflection, n) for r, n in zip((*fitted, *kept), numbers, strict=True)]
    known = within(placed[: len(fitted)], placed[len(fitted) :]) if kept else []
    least = min(float(recording.deflection.min()) for recording in fitted)
    most = max(float(recording.deflection.max()) for recording in fitted)
    return [
        f"{100.0 * share:.0f} % of {r.name} lie beyond the deflections fitted on their surface, "
        f"{plain(1e3 * least, 3)} to {plain(1e3 * most, 3)} mm in all: there the law is extrapolated, and its error "
        "says nothing of the effects"
        for r, share in zip(kept, (1.0 - float(k.mean()) for k in known), strict=True)
        if share > NEGLIGIBLE
    ]


def pulls_told(recordings: Sequence[Recording], tire: TireModel) -> list[str]:
    """Return a sentence for each recording in which a tire pulls, or a part whose law begins where it is pressed, which
    no effect lets them do; a part that is held at both ends may.
    """
    told = []
    pressed = "a part that is only pressed" if tire.is_part else "a tire"
    held = (
        "if it is held at both ends, identify it with a law that pulls, as --part power_preload or --part linear"
        if tire.is_part
        else "if this is a part that is held at both ends, identify it with --part"
    )
    for r in () if tire.two_sided else recordings:
        if least := pull_of(r.force):
            zero = quantity_text("force", float(f"{least:.3g}"))
            told.append(
                f"the force of {r.name} goes down to {plain(least, 3)} N, and {pressed} does not pull: if the load "
                f"cell was not zeroed, give what it reads without load, as in --zero force={zero}; {held}"
            )
    return told


def check_depth(fitted: Sequence[Recording], kept: Sequence[Recording], baseline: TireModel) -> None:
    """Raise TirelabError for deflections that would fail when all is done: none above 0, unless the baseline is a part
    held at both ends, or one beyond the wheel's radius, unless it has no wheel.
    """
    if not baseline.two_sided and max(float(recording.deflection.max()) for recording in fitted) <= 0.0:
        least = float(f"{min(float(recording.deflection.min()) for recording in fitted):.3g}")
        zero = f", such as --zero deflection={quantity_text('deflection', least)}" if least < 0.0 else ""
        raise TirelabError(
            f"{', '.join(r.name for r in fitted)}: no deflection is above 0, and only what happens above it can be "
            "diagnosed; for a part that is pulled turn both signs, --columns deflection=-NAME,force=-NAME, or give "
            f"what the gauge reads when nothing is loaded{zero}"
        )
    if baseline.deflection_highest == DEFLECTION_HIGHEST:
        refuse_too_deep(r.whole for r in (*fitted, *kept))


def check_folder(out: Path) -> None:
    """Raise TirelabError where `out` cannot become a folder to write into: before the work, not after it."""
    there = next(path for path in (out.absolute(), *out.absolute().parents) if path.exists())
    if not there.is_dir() or not os.access(there, os.W_OK):
        why = "is not writable" if there.is_dir() else "is a file"
        raise TirelabError(f"{out} cannot be written, {there} {why}; name another folder with --out")
