"""A plan as files: a table of each drive, and a picture of the drives and of what they tell apart."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import polars as pl
from matplotlib.axes import Axes
from matplotlib.colors import LinearSegmentedColormap
from matplotlib.figure import Figure
from numpy.typing import NDArray

from ..names import in_seconds, plain
from ..regressors.signature import LAW
from ..report.palette import PLAIN
from ..report.titles import short_title
from .choice import TOLD
from .menu import Drive
from .plan import RecordingPlan, file_name

FloatArray = NDArray[np.float64]
BoolArray = NDArray[np.bool_]

PICTURE = "plan.png"

DRAWN = 4000
"""Most samples of a drive that are drawn."""

READABLE = 0.75
"""Probability whose shade is dark enough for white figures."""

BAR = (0.5, 0.6, 0.7, 0.8, 0.9, 1.0)
"""Probabilities at the colour bar. Half is a guess between two."""

_SHADES = LinearSegmentedColormap.from_list("told", ["#ffffff", PLAIN.after])


def write_drive(drive: Drive, path: Path) -> None:
    """Write the columns time [s], deflection [mm], surface_radius [cm] (flat: inf) and, if held, pressure [kPa]."""
    columns = {
        "time [s]": np.round(drive.time, 9),
        "deflection [mm]": np.round(1e3 * drive.deflection, 6),
        "surface_radius [cm]": np.round(100.0 * drive.surface_radius, 6),
    }
    if drive.pressure is not None:
        columns["pressure [kPa]"] = np.full(drive.time.size, round(drive.pressure / 1e3, 6))
    pl.DataFrame(columns).write_csv(path)


def write_plan(plan: RecordingPlan, folder: Path) -> None:
    """Write every drive and the picture into a folder."""
    for number, drive in enumerate(plan.drives, 1):
        write_drive(drive, folder / file_name(number, drive))
    draw_plan(plan, folder / PICTURE)


def draw_plan(plan: RecordingPlan, path: Path) -> None:
    """Draw the drives over time, and beside them the probability that each effect is told from each other one."""
    count = max(len(plan.drives), 1)
    table, hopeless, truths, alternatives = _matrix(plan)
    height = max(1.15 * count + 0.8, 0.3 * len(truths) + 2.4)
    figure = Figure(figsize=(13.5, height), layout="constrained", facecolor="white")
    left, right = figure.subfigures(1, 2, width_ratios=(1.0, 1.25), squeeze=False)[0]
    axes = left.subplots(count, 1, squeeze=False)[:, 0]
    for axis, (number, drive) in zip(axes, enumerate(plan.drives, 1), strict=False):
        step = max(1, drive.time.size // DRAWN)
        axis.plot(
            drive.time[::step], 1e3 * drive.deflection[::step], lw=0.8, color=PLAIN.after, rasterized=True
        )
        held = "" if drive.pressure is None else f", {plain(drive.pressure / 1e5, 3)} bar"
        axis.set_title(
            f"{number}  {drive.name}, {drive.surface}{held}: {in_seconds(drive.duration)} s, to "
            f"{plain(1e3 * drive.fastest, 3)} mm/s",
            loc="left",
            fontsize=9,
        )
        axis.set_ylabel("mm", fontsize=8)
        axis.tick_params(labelsize=8)
        axis.spines[["top", "right"]].set_visible(False)
    axes[-1].set_xlabel("time [s]", fontsize=8)
    _draw_matrix(right.subplots(), table, hopeless, truths, alternatives, plan)
    figure.savefig(path, dpi=110)


def _matrix(plan: RecordingPlan) -> tuple[FloatArray, BoolArray, list[str], list[str]]:
    """Return the probability of each pair, NaN where it was not asked for, whether nothing that is driven tells the two
    apart, and the names of rows and columns.
    """
    truths = list(dict.fromkeys(a.question.truth for a in plan.answers))
    pairs = [(a.question.truth, _alternative_name(a.question.alternative), a) for a in plan.answers]
    order = [*truths, *(alternative for _, alternative, _ in pairs)]
    alternatives = list(dict.fromkeys(name for name in order if any(name == r for _, r, _ in pairs)))
    table = np.full((len(truths), len(alternatives)), math.nan)
    hopeless = np.zeros(table.shape, dtype=bool)
    for truth, alternative, answer in pairs:
        place = truths.index(truth), alternatives.index(alternative)
        table[place], hopeless[place] = answer.probability, not answer.possible
    return table, hopeless, truths, alternatives


def _alternative_name(alternative: frozenset[str]) -> str:
    """Return the name that stands for an alternative; a refitted law stands beside every effect but is none of them."""
    effects = sorted(alternative - {LAW}) if len(alternative) > 1 else sorted(alternative)
    return " + ".join(short_title(n) if len(effects) > 1 else n for n in effects) or "nothing"


def _draw_matrix(
    axis: Axes,
    table: FloatArray,
    hopeless: BoolArray,
    truths: list[str],
    alternatives: list[str],
    plan: RecordingPlan,
) -> None:
    axis.set_facecolor(PLAIN.band)  # shows through where nothing was asked
    image = axis.imshow(table, cmap=_SHADES, vmin=BAR[0], vmax=BAR[-1], aspect="auto")
    axis.set_yticks(range(len(truths)), [short_title(n) for n in truths], fontsize=8)
    axis.set_xticks(
        range(len(alternatives)), [short_title(n) for n in alternatives], fontsize=8, rotation=60, ha="right"
    )
    for (i, j), value in np.ndenumerate(table):
        if math.isfinite(value) and value < TOLD:
            colour = PLAIN.ink if value < READABLE else "white"
            text = f"{100.0 * value:.0f}{'*' if hopeless[i, j] else ''}"
            axis.text(j, i, text, ha="center", va="center", fontsize=7, color=colour)
    axis.set_ylabel("true")
    axis.set_xlabel("taken for")
    axis.set_title(
        f"probability [%] of the right answer at {plain(100.0 * plan.size, 3)} % of {plan.peak:.0f} N\n"
        f"(written where below {100.0 * TOLD:.0f} %, *: whatever is driven; grey: not asked)",
        loc="left",
        fontsize=9,
    )
    bar = axis.get_figure().colorbar(image, ax=axis, shrink=0.6)  # type: ignore[union-attr]
    bar.set_ticks(BAR, labels=["50 % or less", *(f"{100.0 * tick:.0f} %" for tick in BAR[1:])])
