"""Where simulation and recording differ: the residual over time, deflection, rate, and over two of them at once."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from types import MappingProxyType
from typing import Any

import numpy as np
from markupsafe import Markup
from matplotlib.axes import Axes
from matplotlib.colors import LinearSegmentedColormap
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch
from numpy.typing import NDArray

from ..errors import TirelabError
from .course import loading, rate_of
from .loops import VISIBLE, Case
from .numbers import cells_link, curves_link
from .palette import PAGE, PLAIN, Palette
from .svg import drawing, inline_svg
from .thinning import COLUMNS, envelope
from .words import number

FloatArray = NDArray[np.float64]

BINS, FINE = 32, 64
"""Bins of a coordinate, and of the deflection, which needs finer ones: each shows a mean."""

CELLS = (40, 28)
"""Cells of a map, across and up."""

NARROWEST = 0.1
"""Rates that differ by less than this part of themselves share a bin."""

FEWEST = 5
"""A bin or cell with fewer samples stays empty."""

DIVERGING = LinearSegmentedColormap.from_list(
    "over_and_under",
    [
        (0.0, (0.00, 0.36, 0.68, 1.0)),
        (0.25, (0.25, 0.58, 0.86, 0.9)),
        (0.5, (0.55, 0.57, 0.60, 0.16)),
        (0.75, (0.93, 0.52, 0.18, 0.9)),
        (1.0, (0.72, 0.27, 0.00, 1.0)),
    ],
)
"""Blue below, orange above: distinct for every kind of colour vision; nearly transparent about zero."""


@dataclass(frozen=True)
class Misfit:
    """All recordings end to end: continued time [s], deflection [m], rate [m/s], residuals [N].

    ends: samples at which a recording ends
    """

    time: FloatArray
    deflection: FloatArray
    rate: FloatArray
    loading: NDArray[np.bool_]
    before: FloatArray
    after: FloatArray
    ends: tuple[int, ...]

    @property
    def alike(self) -> bool:
        """Whether the correction changes nothing that a picture could show."""
        return bool(np.max(np.abs(self.before - self.after)) <= VISIBLE * np.max(np.abs(self.before)))


def misfit_of(cases: Sequence[Case]) -> Misfit:
    """Return the misfit of the recordings, put end to end with a sampling step between."""
    times, rates, start = [], [], 0.0
    for case in cases:
        own = case.recording.time - case.recording.time[0]
        times.append(own + start)
        start += float(own[-1]) + case.recording.sampling_interval
        rates.append(rate_of(case.recording.time, case.recording.deflection))
    return Misfit(
        np.concatenate(times),
        np.concatenate([c.recording.deflection for c in cases]),
        np.concatenate(rates),
        np.concatenate([loading(r) for r in rates]),
        np.concatenate([c.recording.force - c.before for c in cases]),
        np.concatenate([c.recording.force - c.after for c in cases]),
        tuple(int(n) for n in np.cumsum([len(c.recording) for c in cases])),
    )


def plot_residuals(cases: Sequence[Case], noise: float, axes: Axes | None, over: str) -> Axes:
    """Draw the residuals over a coordinate, with a legend, on `axes` or on those of a new figure, and return them.

    noise [N]: of one sample; over: one of OVER. Raises TirelabError for another one.
    """
    if over not in OVER:
        raise TirelabError(f"residuals cannot be drawn over {over!r}; choose one of {', '.join(OVER)}")
    drawn: Axes = Figure(layout="constrained").subplots() if axes is None else axes
    m = misfit_of(cases)
    OVER[over](drawn, m, noise, PLAIN)
    handles = [Line2D([], [], color=colour, label=label) for _, colour, label in _courses(m, PLAIN)]
    drawn.legend(handles=[*handles, Patch(color=PLAIN.band, label="noise of one sample")], frameon=False)
    return drawn


def draw_over_time(m: Misfit, noise: float, mark: str) -> Markup:
    """Return the residual over time, every sample in it, before and after."""
    with drawing() as (figure, axes):
        _over_time(axes, m, noise, PAGE)
        return inline_svg(figure, "Residual over time before and after the correction, with the noise.", mark)


def draw_over_deflection(m: Misfit, noise: float, mark: str) -> Markup:
    """Return the mean residual over the deflection, loading and unloading apart."""
    with drawing() as (figure, axes):
        _over_deflection(axes, m, noise, PAGE)
        alt = "Mean residual over deflection, for loading and unloading, before and after the correction."
        return inline_svg(figure, alt, mark) + curves_link("residual_over_deflection", axes)


def draw_over_rate(m: Misfit, noise: float, mark: str) -> Markup:
    """Return the mean residual over the rate of deflection."""
    with drawing() as (figure, axes):
        _over_rate(axes, m, noise, PAGE)
        alt = "Mean residual over the rate of deflection, before and after the correction."
        return inline_svg(figure, alt, mark) + curves_link("residual_over_rate", axes)


def _over_time(axes: Axes, m: Misfit, noise: float, palette: Palette) -> None:
    _noise_band(axes, noise, palette)
    for residual, colour, _ in _courses(m, palette):
        start = 0
        for end in m.ends:
            # its part of the picture's width: many recordings would else be as many pictures
            time = m.time[start:end]
            columns = max(round(COLUMNS * float(np.ptp(time) / np.ptp(m.time))), 1)
            axes.plot(*envelope(time, residual[start:end], columns), color=colour, lw=0.7)
            start = end
    _time_axis(axes, m, palette)
    axes.set(ylabel="recorded − simulated [N]", title="Over time, every sample")


def _over_deflection(axes: Axes, m: Misfit, noise: float, palette: Palette) -> None:
    edges = np.linspace(m.deflection.min(), m.deflection.max(), FINE + 1)
    _noise_band(axes, noise, palette)
    branches = (("loading", m.loading, "-", "^"), ("unloading", ~m.loading, (0, (3, 2)), "v"))
    for residual, colour, label in _courses(m, palette):
        for name, branch, style, marker in branches:
            at, mean = _means(m.deflection[branch], residual[branch], edges)
            look: dict[str, Any] = {"color": colour, "ls": style, "marker": marker, "ms": 3.2, "lw": 1.2}
            axes.plot(1e3 * at, mean, label=f"{label}, {name}", **look)
    axes.set(
        xlabel="deflection [mm]",
        ylabel="mean residual [N]",
        title="Over deflection (▲ loading, ▼ unloading)",
    )


def _over_rate(axes: Axes, m: Misfit, noise: float, palette: Palette) -> None:
    edges = _rate_edges(m.rate, BINS)
    _noise_band(axes, noise, palette)
    for residual, colour, label in _courses(m, palette):
        at, mean = _means(m.rate, residual, edges)
        axes.plot(1e3 * at, mean, color=colour, marker="o", ms=3.2, lw=1.2, label=label)
    axes.set(xlabel="rate [mm/s], unloading < 0 < loading", ylabel="mean residual [N]", title="Over the rate")
    slow, fast = 1e3 * float(np.quantile(np.abs(m.rate), 0.25)), 1e3 * float(np.max(np.abs(m.rate)))
    if fast > 20.0 * slow > 0.0:
        decade = 10.0 ** np.floor(np.log10(max(slow, 1e-3 * fast)))
        ticks = decade * 10.0 ** np.arange(np.ceil(np.log10(fast / decade)) + 1)
        axes.set_xscale("asinh", linear_width=decade)
        axes.set_xticks(
            [*-ticks[::-1], 0.0, *ticks],
            labels=[*(f"−{t:g}" for t in ticks[::-1]), "0", *(f"{t:g}" for t in ticks)],
        )
        axes.set_xticks([], minor=True)
        axes.set_xlim(-1.3 * fast, 1.3 * fast)


OVER: Mapping[str, Callable[[Axes, Misfit, float, Palette], None]] = MappingProxyType(
    {"time": _over_time, "deflection": _over_deflection, "rate": _over_rate}
)
"""The coordinates over which `plot_residuals` draws."""


def draw_slow_changes(m: Misfit, noise: float, mark: str) -> Markup:
    """Return the mean residual of whole cycles over time, which shows drift, a leak or warming."""
    blocks = max(BINS // len(m.ends), 4)
    with drawing() as (figure, axes):
        _noise_band(axes, noise, PAGE)
        for residual, colour, label in _courses(m, PAGE):
            start = 0
            for end in m.ends:
                time = m.time[start:end]
                edges = _cycles(time, m.loading[start:end], blocks)
                whole = (time >= edges[0]) & (time < edges[-1])
                at, mean = _means(time[whole], residual[start:end][whole], edges)
                axes.plot(at, mean, color=colour, marker="o", ms=3.2, lw=1.2, label=label)
                start = end
        _time_axis(axes, m, PAGE)
        axes.set(ylabel="mean residual [N]", title="Slow changes: means over whole cycles")
        alt = "Mean residual of whole cycles over time, before and after the correction."
        return inline_svg(figure, alt, mark) + curves_link("residual_of_cycles", axes)


def draw_maps(m: Misfit, noise: float, mark: str) -> tuple[list[Markup], str]:
    """Return maps of the mean residual over deflection and a second coordinate, and the name of that one."""
    grid = _grid(m, noise)
    before, _ = grid.means(m.before)
    size = np.abs(before[np.isfinite(before)])
    reach = max(float(np.quantile(size, 0.98)) if size.size else 0.0, noise)
    residuals = {"before": m.before} if m.alike else {"before": m.before, "after": m.after}
    maps = []
    for which, residual in residuals.items():
        title = "Over deflection and " + grid.name if m.alike else f"{which.capitalize()} the correction"
        mean, _ = grid.means(residual)
        with drawing(3.4) as (figure, axes):
            _draw_map(axes, grid, mean, reach)
            axes.set(title=title)
            figure.subplots_adjust(right=0.94)
            bar = figure.colorbar(axes.collections[0], ax=axes, label="mean residual [N]", aspect=30)
            bar.outline.set_visible(False)
            alt = f"Map of the mean residual over deflection and {grid.name}, {which} the correction."
            unit, factor = ("[s]", 1.0) if grid.name == "time" else ("[mm/s]", 1e3)
            across = (f"{grid.name} {unit}", factor * grid.edges)
            numbers = cells_link(f"map_{which}", 1e3 * grid.x_edges, across, mean)
            maps.append(inline_svg(figure, alt, mark + which) + numbers)
    return maps, grid.name


@dataclass(frozen=True)
class _Grid:
    """Cells over the deflection [m] and a second coordinate, the rate [m/s] or the time [s], by its `name`.

    deflection, values: the coordinates of the samples; x_edges, edges: the bounds of the cells
    """

    name: str
    deflection: FloatArray
    values: FloatArray
    x_edges: FloatArray
    edges: FloatArray

    def means(self, residual: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Return the mean residual [N] and the number of samples of each cell."""
        return _cells(self.deflection, self.values, residual, self.x_edges, self.edges)


def _grid(m: Misfit, noise: float) -> _Grid:
    """Return the cells over that second coordinate, rate or time, which orders the residual before the correction."""
    x_edges = np.linspace(m.deflection.min(), m.deflection.max(), CELLS[0] + 1)
    grids = [
        _Grid("rate", m.deflection, m.rate, x_edges, _rate_edges(m.rate, CELLS[1])),
        _Grid("time", m.deflection, m.time, x_edges, np.linspace(m.time[0], m.time[-1], CELLS[1] + 1)),
    ]

    def ordered(grid: _Grid) -> float:
        mean, count = grid.means(m.before)
        return float(np.nansum(mean**2 * count)) - noise**2 * int(np.sum(np.isfinite(mean)))

    return max(grids, key=ordered)


def _draw_map(axes: Axes, grid: _Grid, mean: FloatArray, reach: float) -> None:
    """Draw the mean residuals [N] of the cells; reach [N]: where the colours end."""
    rows = grid.edges if grid.name == "time" else np.arange(grid.edges.size)
    axes.pcolormesh(
        1e3 * grid.x_edges, rows, mean.T, cmap=DIVERGING, vmin=-reach, vmax=reach, rasterized=True
    )
    axes.grid(False)
    axes.set(xlabel="deflection [mm]")
    if grid.name == "time":
        axes.set_ylabel("time [s]")
        return
    at = _row_rates(grid.values, grid.edges)
    ticks = np.unique(np.linspace(0, at.size - 1, 8).round().astype(int))
    axes.set_yticks(ticks + 0.5, labels=[number(1e3 * at[t], 2) for t in ticks])
    axes.set_ylabel("rate [mm/s]")


def _courses(m: Misfit, palette: Palette) -> list[tuple[FloatArray, str, str]]:
    """Return the residuals to draw, each with its colour and its label."""
    if m.alike:
        return [(m.before, palette.before, "simulated")]
    return [(m.before, palette.before, "before"), (m.after, palette.after, "after")]


def _cycles(time: FloatArray, loading: NDArray[np.bool_], most: int) -> FloatArray:
    """Return times [s] that bound whole cycles, at most `most` spans; even spans where there are few cycles."""
    starts = np.flatnonzero(~loading[:-1] & loading[1:]) + 1
    if loading[0]:
        starts = np.append(0, starts)
    if starts.size < 4:
        return np.linspace(time[0], time[-1], most + 1)
    return np.asarray(time[starts[np.unique(np.linspace(0, starts.size - 1, most + 1).astype(int))]])


def _time_axis(axes: Axes, m: Misfit, palette: Palette) -> None:
    for end in m.ends[:-1]:
        axes.axvline(m.time[end], color=palette.ink, lw=0.8, ls=(0, (2, 2)))
    axes.set_xlabel("time, recordings one after another [s]" if len(m.ends) > 1 else "time [s]")
    axes.set_xlim(m.time[0] - 0.01 * m.time[-1], 1.01 * m.time[-1])


def _noise_band(axes: Axes, noise: float, palette: Palette) -> None:
    axes.axhspan(-noise, noise, color=palette.band, lw=0, zorder=0.5)
    axes.axhline(0.0, color=palette.grid, lw=1.0)


def _means(values: FloatArray, residual: FloatArray, edges: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return the mean coordinate and the mean residual of every bin with samples enough."""
    bin_of = np.clip(np.searchsorted(edges, values, side="right") - 1, 0, edges.size - 2)
    count = np.bincount(bin_of, minlength=edges.size - 1)
    full = count >= FEWEST
    at = np.bincount(bin_of, values, minlength=edges.size - 1)[full] / count[full]
    return at, np.bincount(bin_of, residual, minlength=edges.size - 1)[full] / count[full]


def _cells(
    x: FloatArray, y: FloatArray, residual: FloatArray, x_edges: FloatArray, y_edges: FloatArray
) -> tuple[FloatArray, FloatArray]:
    """Return the mean residual and the count of every cell; NaN where a cell has too few samples."""
    rows, columns = x_edges.size - 1, y_edges.size - 1
    i = np.clip(np.searchsorted(x_edges, x, side="right") - 1, 0, rows - 1)
    j = np.clip(np.searchsorted(y_edges, y, side="right") - 1, 0, columns - 1)
    cell = i * columns + j
    count = np.bincount(cell, minlength=rows * columns).astype(float)
    total = np.bincount(cell, residual, minlength=rows * columns)
    mean = np.where(count >= FEWEST, total / np.maximum(count, 1.0), np.nan)
    return mean.reshape(rows, columns), count.reshape(rows, columns)


def _row_rates(rate: FloatArray, edges: FloatArray) -> FloatArray:
    """Return the mean rate of the samples of every row; the middle where a row has none."""
    row = np.clip(np.searchsorted(edges, rate, side="right") - 1, 0, edges.size - 2)
    count = np.bincount(row, minlength=edges.size - 1)
    total = np.bincount(row, rate, minlength=edges.size - 1)
    return np.where(count > 0, total / np.maximum(count, 1), 0.5 * (edges[:-1] + edges[1:]))


def _rate_edges(rate: FloatArray, count: int) -> FloatArray:
    """Return at most `count` + 1 edges between which about as many samples lie, none closer than NARROWEST."""
    edges = np.unique(np.quantile(rate, np.linspace(0.0, 1.0, count + 1)))
    kept = [float(edges[0])]
    for edge in edges[1:-1]:
        if edge - kept[-1] > NARROWEST * max(
            abs(edge), abs(kept[-1]), NARROWEST * float(edges[-1] - edges[0])
        ):
            kept.append(float(edge))
    return np.array([*kept, np.nextafter(edges[-1], np.inf)])
