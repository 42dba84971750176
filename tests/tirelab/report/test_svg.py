"""What becomes of a figure in the page: things stay where they were, colours follow the page, ids do not meet."""

from __future__ import annotations

import base64
import re
import struct

import numpy as np
import pytest
from matplotlib.backends.backend_agg import RendererAgg
from matplotlib.cm import ScalarMappable
from matplotlib.colors import Normalize
from tirelab.recordings.recording import Recording
from tirelab.report.loops import Case, draw_difference, draw_loops
from tirelab.report.svg import drawing, inline_svg


@pytest.fixture(scope="module")
def picture() -> str:
    time = np.arange(9000) * 1e-3
    x = 0.01 - 0.01 * np.cos(time)
    force = 9e4 * x
    case = Case(Recording("r", time, x, np.full(x.size, np.inf), force), 0.9 * force, force)
    return draw_loops(case, "after", "a", "told to those who cannot see")


def test_the_dots_lie_where_the_line_lies(picture: str) -> None:
    """They did not: the scale of their picture was cut to two decimals, and the loops ended 2 % too early."""
    image = re.search(r"<image [^>]*>", picture)
    axes = re.search(
        r'<clipPath[^>]*><rect x="([\d.]+)" y="([\d.]+)" width="([\d.]+)" height="([\d.]+)"', picture
    )
    assert image is not None
    assert axes is not None
    data = re.search(r'base64,\s*([^"]+)"', image[0])
    assert data is not None
    columns, _ = struct.unpack(">II", base64.b64decode(data[1])[16:24])
    scale = re.search(r"matrix\(([\d.]+)[ ,]", image[0]) or re.search(r"scale\(([\d.]+)[ ,]", image[0])
    assert scale is not None
    width = float(scale[1]) * columns
    # A pixel of the picture is 1/640 of its width.
    assert width == pytest.approx(float(axes[3]), rel=2e-3)


def test_colours_are_the_pages(picture: str) -> None:
    assert "var(--ink)" in picture
    assert "var(--after)" in picture
    assert not re.findall(r"#0[1-6]0[1-6]0[1-6]", picture)
    assert "told to those who cannot see" in picture


@pytest.mark.parametrize("size", [1.0, 1e3, 1e5])
def test_numbers_and_labels_stay_inside_the_picture(size: float) -> None:
    """By matplotlib's own measure of the texts, whose font is about as wide as the pages'."""
    with drawing() as (figure, axes):
        axes.plot([0.0, 1.0], [-1.02 * size, 1.02 * size])
        axes.set(ylabel="mean residual [N]")
        bar = figure.colorbar(
            ScalarMappable(Normalize(-1.02 * size, 1.02 * size)), ax=axes, label="force [N]"
        )
        figure.subplots_adjust(right=0.94)
        inline_svg(figure, "a line", "a")
        renderer = RendererAgg(int(figure.bbox.width), int(figure.bbox.height), figure.dpi)
        assert axes.get_tightbbox(renderer).x0 >= 0.0
        assert bar.ax.get_tightbbox(renderer).x1 <= figure.bbox.width


@pytest.mark.parametrize("size", [4.05e-4, 4.0, 40.4, 4e5])
def test_the_last_number_below_the_axes_stays_inside_the_picture(size: float) -> None:
    with drawing() as (figure, axes):
        axes.plot([0.0, size], [0.0, 1.0])
        axes.set_xlim(-0.05 * size, size)
        inline_svg(figure, "a line", "a")
        renderer = RendererAgg(int(figure.bbox.width), int(figure.bbox.height), figure.dpi)
        pairs = zip(axes.get_xticks(), axes.get_xticklabels(), strict=True)
        numbers = [label for tick, label in pairs if -0.05 * size <= tick <= size]
        assert max(n.get_window_extent(renderer).x1 for n in numbers) <= figure.bbox.width


def test_two_pictures_share_no_id() -> None:
    time = np.arange(50.0)
    case = Case(Recording("r", time, time / 1e4, np.full(50, np.inf), time), time, 2 * time)
    first, second = draw_difference(case, "x"), draw_difference(case, "y")
    ids = [set(re.findall(r' id="([^"]+)"', picture)) for picture in (first, second)]
    assert ids[0]
    assert not ids[0] & ids[1]
