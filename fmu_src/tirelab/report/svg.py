"""A matplotlib figure as SVG that stands in the page: its colours follow light and dark, its text the page's font."""

from __future__ import annotations

import io
import itertools
import re
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import asdict
from html import escape
from typing import Any

import matplotlib as mpl
from markupsafe import Markup
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from .palette import PAGE

_VARIABLES = {colour: f"var(--{name})" for name, colour in asdict(PAGE).items()}
"""The variable of the page's style sheet for each stand-in."""

WIDTH = 4.6
"""Width of a figure [in]: two stand side by side on a desktop, one fills a phone with its text still legible."""

MARGINS = (0.145, 0.975)
"""Left and right edge of the axes: margins found by matplotlib for each picture would double the time."""

BESIDE_TICKS, CHARACTER = 26.0, 6.5
"""Room [pt] beside an axis for its label and ticks, and for each character of a number there."""

_SETTINGS: dict[Any, Any] = {
    "svg.fonttype": "none",
    "svg.hashsalt": "tirelab",
    "text.parse_math": False,
    "axes.unicode_minus": True,
    "font.size": 10.0,
    "axes.edgecolor": PAGE.ink,
    "axes.labelcolor": PAGE.ink,
    "axes.titlesize": 10.5,
    "axes.titleweight": "bold",
    "axes.titlelocation": "left",
    "axes.linewidth": 0.7,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.facecolor": "none",
    "figure.facecolor": "none",
    "savefig.facecolor": "none",
    "text.color": PAGE.ink,
    "xtick.color": PAGE.ink,
    "ytick.color": PAGE.ink,
    "grid.color": PAGE.grid,
    "grid.linewidth": 0.6,
    "axes.grid": True,
    "axes.axisbelow": True,
    "path.simplify": False,
    "agg.path.chunksize": 0,
}

_path = re.compile(r' d="[^"]*"')
_numbers = re.compile(r"(\d\.\d\d)\d+")
_dropped = re.compile(
    r"<\?xml.*?\?>|<!DOCTYPE.*?>|<!--.*?-->|<metadata>.*?</metadata>|<style.*?</style>| xmlns(?::\w+)?=\"[^\"]*\"",
    re.DOTALL,
)
_identity = re.compile(r' id="([^"]+)"')
_reference = re.compile(r'url\(#([^)]+)\)|href="#([^"]+)"')


@contextmanager
def drawing(height: float = 3.2) -> Iterator[tuple[Figure, Axes]]:
    """Give a figure `height` [in] high with its axes, in the page's style; draw inside the context."""
    with mpl.rc_context(_SETTINGS):
        figure = Figure(figsize=(WIDTH, height))
        figure.subplots_adjust(
            left=MARGINS[0], right=MARGINS[1], bottom=0.5 / height, top=1.0 - 0.27 / height
        )
        yield figure, figure.subplots()


def inline_svg(figure: Figure, alt: str, mark: str) -> Markup:
    """Return the figure as an SVG element with the description `alt` for a screen reader.

    mark: a word that no other figure of the page has, to keep their inner references apart
    """
    _make_room(figure)
    buffer = io.StringIO()
    figure.savefig(buffer, format="svg", dpi=160, metadata={"Date": None})
    text = _dropped.sub("", buffer.getvalue())
    for stand_in, variable in _VARIABLES.items():
        text = text.replace(stand_in, variable)
    # Only in paths: the digits of a picture's scale are worth its whole width.
    text = _path.sub(lambda path: _numbers.sub(r"\1", path[0]), text)
    used = {name for pair in _reference.findall(text) for name in pair if name}
    numbered = dict(zip(sorted(used), (f"{mark}{i}" for i in itertools.count()), strict=False))
    text = _identity.sub(lambda m: f' id="{numbered[m[1]]}"' if m[1] in numbered else "", text)
    for name, short in numbered.items():
        text = text.replace(f"url(#{name})", f"url(#{short})").replace(f'href="#{name}"', f'href="#{short}"')
    text = re.sub(r"<svg [^>]*?viewBox=\"([^\"]+)\"[^>]*>", _opening(alt), text.strip(), count=1)
    return Markup(re.sub(r">\s+<", "><", text))


def _make_room(figure: Figure) -> None:
    """Move the edges of the axes so far in that their numbers and labels stay inside the figure."""
    axes, *bars = figure.axes
    left = max(_room(axes), MARGINS[0])
    figure.subplots_adjust(left=left)
    if not bars:
        figure.subplots_adjust(right=_right_of_last_number(axes, left))
    for bar in bars:
        bar.apply_aspect()
        edge, right = bar.get_position().x1, figure.subplotpars.right
        if edge > 1.0 - _room(bar):
            figure.subplots_adjust(right=left + (right - left) * (1.0 - _room(bar) - left) / (edge - left))


def _right_of_last_number(axes: Axes, left: float) -> float:
    """Return the right edge of the axes with which the last number below them ends inside the figure."""
    low, high = sorted(axes.get_xlim())
    ticks = [tick for tick in axes.xaxis.get_majorticklocs() if low <= tick <= high]
    if not ticks or not max(ticks) > low:
        return MARGINS[1]
    number = axes.xaxis.get_major_formatter().format_ticks(ticks)[ticks.index(max(ticks))]
    half = 0.5 * CHARACTER * len(number) / (72.0 * WIDTH)
    return min(MARGINS[1], float(left + (1.0 - half - left) * (high - low) / (max(ticks) - low)))


def _room(axes: Axes) -> float:
    """Return the part of the figure's width that numbers, ticks and label of the vertical axis take."""
    return (BESIDE_TICKS + CHARACTER * _longest_number(axes)) / (72.0 * WIDTH)


def _longest_number(axes: Axes) -> int:
    """Return the characters of the longest number that stands beside the vertical axis."""
    low, high = sorted(axes.get_ylim())
    ticks = [tick for tick in axes.yaxis.get_majorticklocs() if low <= tick <= high]
    return max(map(len, axes.yaxis.get_major_formatter().format_ticks(ticks)), default=0)


def _opening(alt: str) -> str:
    label = escape(alt).replace("\\", r"\\")
    return rf'<svg viewBox="\1" role="img" aria-label="{label}">'
