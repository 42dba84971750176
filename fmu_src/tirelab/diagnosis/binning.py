"""The coordinates of the samples, divided into bins: time, deflection, rate, surface, cycle and others."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from radialtire import FLAT_RADIUS

from ..names import plain
from ..preprocessing.motion import BoolArray, FloatArray, IndexArray
from ..preprocessing.samples import RawDataset, RawExperiment, Recorded

BINS = 800
"""Most bins of a continuous coordinate, with about equal numbers of samples: eight in a span of 1 % of them."""

MOST_SURFACES = 12
"""More radii than these (terrain) are a continuous coordinate; a report then names this many, evenly over the
curvature."""

NARROWEST = 1.0 / 2000.0
"""Least width of a bin, as a part of the coordinate's range between its first and last percent."""


@dataclass(frozen=True)
class Axis:
    """A coordinate cut into bins.

    bin_of: bin of each sample; start, stop: bounds of each bin; parts: first bin of each part, then the number of bins;
    no span reaches across the end of a part; label: returns that of a span from its first and last bin; slow: whether
    samples are compared with those of the same deflection and direction; recordings: name for each part, or None
    """

    by: str
    unit: str
    bin_of: IndexArray
    start: FloatArray
    stop: FloatArray
    parts: tuple[int, ...]
    label: Callable[[int, int], str]
    slow: bool = False
    recordings: tuple[str, ...] | None = None


def axes_of(recordings: Sequence[Recorded], dataset: RawDataset, kept: Sequence[IndexArray]) -> list[Axis]:
    """Return every coordinate of the recordings; kept: of each recording, indices of the samples among its rows."""
    records = [(record.sampled, own) for record, own in zip(dataset.experiments, kept, strict=True)]

    def joined(value: Callable[[RawExperiment], FloatArray]) -> FloatArray:
        return np.concatenate([value(record)[own] for record, own in records])

    axes = [
        _even("deflection", "m", joined(lambda r: r.motion.deflection)),
        _even("rate", "m/s", joined(lambda r: r.motion.rate)),
        _even("acceleration", "m/s^2", joined(lambda r: r.motion.acceleration)),
        _force(joined(lambda r: r.elastic(r.motion.deflection)), joined(lambda r: r.force)),
        _even("history", "m", joined(lambda r: r.motion.deepest), slow=True),
        _time(recordings, records),
        _classes("direction", joined(lambda r: r.motion.direction), {-1.0: "unloading", 1.0: "loading"}),
    ]
    cycle = joined(lambda r: r.motion.cycle) + 1.0
    if cycle.max() > 1.0:
        axes.append(_cycles(cycle))
    radius = np.concatenate(
        [
            r.surface_radius[record.rows][own]
            for r, record, own in zip(recordings, dataset.experiments, kept, strict=True)
        ]
    )
    axes.append(_surfaces(radius))
    if len(recordings) > 1:
        number = np.concatenate([np.full(own.size, i + 1.0) for i, own in enumerate(kept)])
        axes.append(_classes("recording", number, {i + 1.0: r.name for i, r in enumerate(recordings)}))
    return axes


def _nothing(first: int, last: int) -> str:
    return ""


def _even(by: str, unit: str, values: FloatArray, slow: bool = False) -> Axis:
    bin_of, start, stop = _bins(values)
    return Axis(by, unit, bin_of, start, stop, (0, start.size), _nothing, slow)


def _force(elastic: FloatArray, recorded: FloatArray) -> Axis:
    """Return the axis of the force: binned by that of the baseline, which has no noise, with bounds of the recorded
    one.
    """
    bin_of, start, stop = _bounded(_bins(elastic)[0], recorded)
    return Axis("force", "N", bin_of, start, stop, (0, start.size), _nothing)


def _bins(values: FloatArray) -> tuple[IndexArray, FloatArray, FloatArray]:
    """Return the bin of each value and the bounds of the bins, those of the values in them."""
    edges = np.unique(np.quantile(values, np.linspace(0.0, 1.0, BINS + 1)[1:-1]))
    width = NARROWEST * float(np.ptp(np.quantile(values, [0.01, 0.99])))
    kept: list[float] = []
    for edge in edges.tolist():
        if not kept or edge - kept[-1] > width:
            kept.append(edge)
    return _bounded(np.searchsorted(np.array(kept), values, side="left"), values)


def _bounded(number: IndexArray, values: FloatArray) -> tuple[IndexArray, FloatArray, FloatArray]:
    """Return the bins numbered without gaps, and the least and the greatest value in each."""
    used, bin_of = np.unique(number, return_inverse=True)
    start, stop = np.full(used.size, np.inf), np.full(used.size, -np.inf)
    np.minimum.at(start, bin_of, values)
    np.maximum.at(stop, bin_of, values)
    return bin_of, start, stop


def _classes(by: str, values: FloatArray, labels: Mapping[float, str]) -> Axis:
    """Return an axis of separate values, each a part of its own."""
    known, bin_of = np.unique(values, return_inverse=True)
    parts = tuple(range(known.size + 1))
    return Axis(by, "1", bin_of, known, known, parts, lambda a, b: labels[float(known[a])])


def _cycles(cycle: FloatArray) -> Axis:
    known, bin_of = np.unique(cycle, return_inverse=True)

    def label(a: int, b: int) -> str:
        return f"cycle {known[a]:.0f}" if a == b else f"cycles {known[a]:.0f} to {known[b]:.0f}"

    return Axis("cycle", "1", bin_of, known, known, (0, known.size), label, slow=True)


def _time(recordings: Sequence[Recorded], records: Sequence[tuple[RawExperiment, IndexArray]]) -> Axis:
    """Return the time of every recording, each a part of its own."""
    bins, starts, stops, parts = [], [], [], [0]
    for recording, (record, own) in zip(recordings, records, strict=True):
        bin_of, start, stop = _bins(record.time[own] + recording.time[0])
        bins.append(bin_of + parts[-1])
        starts.append(start)
        stops.append(stop)
        parts.append(parts[-1] + start.size)
    names = tuple(r.name for r in recordings) if len(recordings) > 1 else None
    arrays = (np.concatenate(bins), np.concatenate(starts), np.concatenate(stops))
    return Axis("time", "s", *arrays, tuple(parts), _nothing, True, names)


def _surfaces(radius: FloatArray) -> Axis:
    """Return the surfaces in the order of their curvature; few of them are parts of their own.

    Of many (terrain) a span is concave or convex or flat, so that the radii in it lie between its bounds.
    """
    flat: BoolArray = np.abs(radius) >= FLAT_RADIUS
    curvature = np.where(flat, 0.0, 1.0 / radius)
    known, bin_of = np.unique(curvature, return_inverse=True)
    if known.size <= MOST_SURFACES:
        own = _radius(known)
        each = tuple(range(known.size + 1))
        return Axis("radius", "m", bin_of, own, own, each, lambda a, b: _surface(own[a]))
    bins, starts, stops, parts = np.zeros(radius.size, dtype=np.intp), [], [], [0]
    for chosen in (curvature < 0.0, flat, curvature > 0.0):
        if chosen.any():
            own_bins, least, greatest = _bins(curvature[chosen])
            bins[chosen] = own_bins + parts[-1]
            starts.append(_radius(greatest))
            stops.append(_radius(least))
            parts.append(parts[-1] + least.size)
    start = np.concatenate(starts)
    return Axis(
        "radius",
        "m",
        bins,
        start,
        np.concatenate(stops),
        tuple(parts),
        lambda a, b: "" if np.isfinite(start[a]) else "flat",
    )


def _radius(curvature: FloatArray) -> FloatArray:
    level = curvature == 0.0
    return np.where(level, np.inf, 1.0 / np.where(level, 1.0, curvature))


def _surface(radius: float) -> str:
    if not np.isfinite(radius):
        return "flat"
    return f"{'convex' if radius > 0.0 else 'concave'}, radius {plain(abs(radius), 4)} m"
