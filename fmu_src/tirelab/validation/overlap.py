"""How well the region of a localized effect was found: overlap of the stated region with the true one.

J = |stated and true| / |stated or true|   (Jaccard index of spans of one coordinate, 0 to 1)
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..diagnosis.diagnosis_file import StatedPlace
from ..recordings.recording import Recording
from ..recordings.units import UnitError, conversion

STATED_PART = 0.8
"""Part of the stated squared error along a coordinate; the spans that hold it, the largest first, are the region."""

SI_UNITS = {"time": "s", "deflection": "m", "force": "N", "rate": "m/s"}
"""SI unit of the coordinates along which the rig states regions; a direction has none."""

Span = tuple[float, float]


@dataclass(frozen=True)
class RegionScore:
    """Overlap for one localized effect along one coordinate; 0 where the verdict states no region along it."""

    effect: str
    by: str
    overlap: float


def region_scores(
    where: Sequence[Mapping[str, Any]], stated: Sequence[StatedPlace], recordings: Sequence[Recording]
) -> tuple[RegionScore, ...]:
    """Return the overlap for every effect and coordinate in the answer's `where`.

    The stated region along a coordinate is the union of its stated spans in falling order of their share of the
    squared error, until they hold `STATED_PART` of the sum. The overlap is the mean over the recordings with samples
    in the true region; a span stated without a recording applies to each of them. A direction is found or not: 1 or 0.
    """
    groups: dict[tuple[str, str], dict[str, list[Mapping[str, Any]]]] = {}
    for region in where:
        by_recording = groups.setdefault((str(region["effect"]), str(region["by"])), {})
        by_recording.setdefault(str(region["recording"]), []).append(region)
    by_name = {f"{r.name}.csv": r for r in recordings}
    scores = []
    for (effect, by), by_recording in groups.items():
        overlaps = []
        for name, regions in by_recording.items():
            spans = [
                p for p in stated if p.by == by and p.recording in (None, name, name.removesuffix(".csv"))
            ]
            if by == "direction":
                overlaps.append(_direction_overlap(str(regions[0]["from"]), spans))
            else:
                values = _coordinate(by, by_name[name])
                true = _inside(values, [_span(region["from"], region["to"]) for region in regions])
                if true.any():
                    overlaps.append(_jaccard(true, _inside(values, _stated_region(spans, by))))
        if overlaps:
            scores.append(RegionScore(effect, by, float(np.mean(overlaps))))
    return tuple(scores)


def _direction_overlap(true: str, spans: Sequence[StatedPlace]) -> float:
    if not spans:
        return 0.0
    strongest = max(spans, key=lambda p: p.share)
    ends = (strongest.begin, strongest.end)
    if any(isinstance(end, str) for end in ends):
        return float(true in ends)
    # as a number, unloading is negative
    middle = sum(float(end) for end in ends if end is not None)
    return float((middle < 0.0) == (true == "unloading"))


def _stated_region(spans: Sequence[StatedPlace], by: str) -> list[Span]:
    whole = sum(p.share for p in spans)
    region: list[Span] = []
    held = 0.0
    for span in sorted(spans, key=lambda p: -p.share):
        if held >= STATED_PART * whole:
            break
        held += span.share
        factor = _factor_to_si(span.unit, by)
        if factor is not None and not isinstance(span.begin, str) and not isinstance(span.end, str):
            low, high = _span(span.begin, span.end)
            region.append((factor * low, factor * high))
    return region


def _factor_to_si(unit: str, by: str) -> float | None:
    try:
        found = conversion(unit, SI_UNITS[by])
    except UnitError:
        return None
    return float(found.multiply / found.divide)


def _coordinate(by: str, recording: Recording) -> NDArray[np.float64]:
    if by == "rate":
        # over twenty steps, so that the gauge's noise does not drown it
        half = min(10, (len(recording) - 1) // 2)
        padded = [np.pad(v, half, mode="edge") for v in (recording.deflection, recording.time)]
        change, interval = (v[2 * half :] - v[: v.size - 2 * half] for v in padded)
        return np.asarray(change / interval)
    known = {"time": recording.time, "deflection": recording.deflection, "force": recording.force}
    return known[by]


def _span(begin: float | None, end: float | None) -> Span:
    return -np.inf if begin is None else float(begin), np.inf if end is None else float(end)


def _inside(values: NDArray[np.float64], spans: Sequence[Span]) -> NDArray[np.bool_]:
    """The samples that lie in one of the spans."""
    inside = np.zeros(values.shape, dtype=bool)
    for low, high in spans:
        inside |= (low <= values) & (values <= high)
    return inside


def _jaccard(first: NDArray[np.bool_], second: NDArray[np.bool_]) -> float:
    either = int(np.sum(first | second))
    return float(np.sum(first & second) / either) if either else 0.0
