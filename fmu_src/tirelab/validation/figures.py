"""The figures of a proof."""

from __future__ import annotations

import io
import math
from collections.abc import Mapping, Sequence

import matplotlib as mpl
import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from .acceptance_criteria import NOISE_FLOOR_MARGIN
from .calibration import reliability
from .metrics import ANY_EFFECT, NO_NAME, Point, naming
from .score import Score

BLUE, LIGHT_BLUE, ORANGE, GREY = "#1f6f9f", "#93c4e0", "#d9731a", "#777777"

CURVES_PER_ROW = 4


def svg(figure: Figure, name: str) -> str:
    """Return a figure as an `<svg>` element without metadata, with its text as text; ids are derived from `name`."""
    text = io.StringIO()
    with mpl.rc_context({"svg.fonttype": "none", "svg.hashsalt": name}):
        figure.savefig(
            text, format="svg", metadata={"Creator": None, "Date": None, "Format": None, "Type": None}
        )
    return text.getvalue()[text.getvalue().index("<svg") :]


def confusion_matrix(table: Mapping[str, Mapping[str, float]]) -> Figure:
    """Draw how often each hidden effect (row) was given each name (column); the colour is the part of the row."""
    order = sorted({*table, *(name for row in table.values() for name in row)}, key=_last)
    rows = [name for name in order if name in table]
    counts = np.array([[table[row].get(column, 0.0) for column in order] for row in rows])
    counts = counts.reshape(len(rows), len(order))
    size = 0.36 * len(order) + 2.4
    figure = Figure(figsize=(size + 1.0, 0.36 * len(rows) + 2.4), layout="constrained")
    axes = figure.subplots()
    parts = counts / np.maximum(counts.sum(axis=1, keepdims=True), 1e-9)
    if counts.size:
        axes.imshow(parts, cmap="Blues", vmin=0.0, vmax=1.0, aspect="auto")
    for i, j in np.argwhere(counts > 0.0):
        right = rows[i] == order[j]
        colour = "white" if parts[i, j] > 0.6 else ("black" if right else ORANGE)
        axes.text(j, i, f"{counts[i, j]:.3g}", ha="center", va="center", fontsize=8, color=colour)
    axes.set_xticks(range(len(order)), [_words(name) for name in order], rotation=60, ha="right", fontsize=8)
    axes.set_yticks(range(len(rows)), [_words(name) for name in rows], fontsize=8)
    axes.set(xlabel="named", ylabel="hidden")
    axes.tick_params(length=0)
    axes.spines[:].set_visible(False)
    return figure


def naming_curves(curves: Mapping[str, Sequence[Point]]) -> Figure:
    """Draw how often each effect was named over its size, with 95 % intervals."""
    lines = math.ceil(max(len(curves), 1) / CURVES_PER_ROW)
    figure = Figure(figsize=(11.0, 1.9 * lines + 0.5), layout="constrained")
    grid = figure.subplots(lines, CURVES_PER_ROW, sharex=True, sharey=True, squeeze=False).ravel()
    for axes, (effect, points) in zip(grid, curves.items(), strict=False):
        _rates(axes, points)
        count = sum(p.rate.trials for p in points)
        axes.set_title(f"{_words(effect)} ({count})", fontsize=9)
        _over_sizes(axes)
    for axes in grid[len(curves) :]:
        axes.set_visible(False)
    figure.supxlabel("size of the effect over the noise", fontsize=9)
    figure.supylabel("how often it was named", fontsize=9)
    return figure


def reliability_diagram(points: Sequence[Point]) -> Figure:
    """Draw how often verdicts were exact over their stated confidence."""
    figure = Figure(figsize=(4.6, 4.4), layout="constrained")
    _reliability(figure.subplots(), points)
    return figure


def effect_reliability_diagram(points: Sequence[Point]) -> Figure:
    """Draw how often named effects were there over their stated probability."""
    figure = Figure(figsize=(4.6, 4.4), layout="constrained")
    axes = figure.subplots()
    _reliability(axes, points)
    axes.set(
        xlabel="stated probability of an effect\n(above each bar: number of effects)",
        ylabel="part of the named effects that was there",
    )
    return figure


def held_out_errors(scores: Sequence[Score]) -> Figure:
    """Draw the held-out RMSE over the noise floor, corrected against baseline tire, one point for each trial."""
    figure = Figure(figsize=(5.8, 4.4), layout="constrained")
    _held_out(figure.subplots(), scores)
    return figure


def overview(scores: Sequence[Score], title: str) -> Figure:
    """Draw the proof in one figure: naming over size, held-out errors, reliability."""
    figure = Figure(figsize=(13.0, 4.6), layout="constrained")
    named, errors, confidence = figure.subplots(1, 3)
    _rates(named, naming(scores).get(ANY_EFFECT, []))
    _over_sizes(named)
    named.set(xlabel="size of a hidden effect over the noise", ylabel="how often it was named")
    _held_out(errors, scores)
    _reliability(confidence, reliability(scores))
    figure.suptitle(title, fontsize=10)
    return figure


def _over_sizes(axes: Axes) -> None:
    together = axes.get_shared_x_axes().get_siblings(axes)
    drawn = [np.asarray(line.get_xdata(), dtype=np.float64) for one in together for line in one.get_lines()]
    largest = max((float(sizes.max()) for sizes in drawn), default=0.0)
    axes.set(xscale="log", xlim=(0.8, max(150.0, 1.3 * largest)), ylim=(-0.05, 1.05))
    ticks = [tick for tick in (1, 3, 10, 30, 100, 300, 1000) if tick <= axes.get_xlim()[1]]
    axes.set_xticks(ticks, [str(tick) for tick in ticks])
    axes.minorticks_off()
    _plain(axes)


def _reliability(axes: Axes, points: Sequence[Point]) -> None:
    axes.plot([0, 1], [0, 1], color=GREY, lw=1, ls="--", label="calibrated")
    _rates(axes, points)
    for p, height in zip(points, _heights(points), strict=True):
        axes.annotate(
            f"{p.rate.trials}",
            (p.at, p.rate.interval[1]),
            (0, height),
            textcoords="offset points",
            fontsize=8,
            ha="center",
        )
    axes.set(
        xlabel="stated confidence\n(above each bar: number of verdicts)",
        ylabel="part of the verdicts that was right",
        xlim=(0, 1.03),
        ylim=(0, 1.08),
    )
    axes.legend(frameon=False, loc="lower right")
    _plain(axes)


def _heights(points: Sequence[Point]) -> list[float]:
    """Return how far [points] above its bar each count of a reliability diagram stands, so that none touches another.

    A little less than the plot has: 240 points for all confidences, 200 for all rates.
    """
    taken: list[tuple[float, float, float]] = []
    for p in points:
        at, low, half = 240.0 * p.at, 200.0 * p.rate.interval[1] + 3.0, 3.0 * len(str(p.rate.trials)) + 1.0
        beside = sorted(y for x, y, other in taken if abs(x - at) < half + other)
        for y in beside:
            if abs(y - low) < 10.0:
                low = y + 10.0
        taken.append((at, low, half))
    return [low - 200.0 * p.rate.interval[1] for (_, low, _), p in zip(taken, points, strict=True)]


def _held_out(axes: Axes, scores: Sequence[Score]) -> None:
    for outside, alike, colour, label in (
        (False, False, LIGHT_BLUE, "tests of another kind"),
        (False, True, BLUE, "tests of the diagnosed kinds"),
        (True, True, ORANGE, "the same, with something outside the catalogue"),
    ):
        held = [s.held_out for s in scores if s.beyond_catalogue is outside and s.held_out is not None]
        found = [h.alike if alike else h.other for h in held]
        if found:
            before, after = (
                [getattr(e, name) / e.reading_noise_floor for e in found] for name in ("before", "after")
            )
            axes.plot(before, after, "o", ms=4, alpha=0.8, mec="none", color=colour, label=label)
    axes.axhline(1.0 + NOISE_FLOOR_MARGIN, color=GREY, lw=1, ls="--", label="10 % above the noise floor")
    axes.axline((1.0, 1.0), slope=1.0, color=GREY, lw=1, ls=":", label="no better than before")
    axes.set(xscale="log", yscale="log")
    axes.set_xlabel("held-out RMSE of the baseline tire over the noise floor")
    axes.set_ylabel("the same of the corrected tire")
    low, high = axes.get_ylim()
    axes.set_ylim(min(low, 0.95), max(high, 2.0))
    for axis in (axes.xaxis, axes.yaxis):
        axis.set_major_formatter(mpl.ticker.FormatStrFormatter("%g"))
        axis.set_minor_formatter(mpl.ticker.LogFormatter(labelOnlyBase=False, minor_thresholds=(1.5, 0.5)))
    axes.legend(frameon=False, fontsize=8, loc="upper center", bbox_to_anchor=(0.5, -0.15), ncols=2)
    _plain(axes)


def _rates(axes: Axes, points: Sequence[Point]) -> None:
    if not points:
        return
    values = np.array([p.rate.value for p in points])
    low, high = np.array([p.rate.interval for p in points]).T
    spread = np.maximum(np.stack([values - low, high - values]), 0.0)
    axes.errorbar([p.at for p in points], values, spread, fmt="o-", ms=4, lw=1.2, capsize=2, color=BLUE)


def _plain(axes: Axes) -> None:
    axes.grid(alpha=0.3)
    axes.spines[["top", "right"]].set_visible(False)


def _words(name: str) -> str:
    return name.replace("_", " ")


def _last(name: str) -> tuple[int, str]:
    """Names in order of the alphabet, then those that are no effects."""
    return ({"recalibration": 1, "unknown": 2, "none": 3, NO_NAME: 4}.get(name, 0), name)
