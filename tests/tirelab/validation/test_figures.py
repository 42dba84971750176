"""The figures of a proof can be read."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from itertools import combinations

import pytest
from matplotlib.figure import Figure
from matplotlib.text import Annotation
from tirelab.validation import figures
from tirelab.validation.metrics import Point, Rate

Draw = Callable[[Sequence[Point]], Figure]


def in_the_overview(points: Sequence[Point]) -> Figure:
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(figures, "reliability", lambda scores: points)
        return figures.overview([], "a proof")


@pytest.mark.parametrize("draw", [figures.reliability_diagram, in_the_overview])
@pytest.mark.parametrize(
    "verdicts",
    [
        {0.18: (6, 18), 0.60: (10, 12), 0.75: (11, 16), 0.86: (26, 27), 0.935: (17, 18), 0.98: (106, 109)},
        {0.94: (1180, 1200), 0.95: (1180, 1200), 0.96: (1180, 1200), 0.99: (1180, 1200)},
    ],
)
def test_no_count_touches_another(draw: Draw, verdicts: Mapping[float, tuple[int, int]]) -> None:
    figure = draw([Point(0.0, 1.0, at, Rate(*found)) for at, found in verdicts.items()])
    figure.draw_without_rendering()
    counts = [text for text in figure.axes[-1].texts if isinstance(text, Annotation)]
    assert [text.get_text() for text in counts] == [str(trials) for _, trials in verdicts.values()]
    boxes = [text.get_window_extent() for text in counts]
    # some of the space of a digit is between two of them
    assert not [pair for pair in combinations(boxes, 2) if pair[0].expanded(1.1, 0.8).overlaps(pair[1])]
