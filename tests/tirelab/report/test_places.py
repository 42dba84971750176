"""The samples of a place, and which places are shaded."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from tirelab.recordings.recording import Recording
from tirelab.report.places import Located, draw_where, inside, shaded

TIME = np.arange(200) * 0.01
"""Two triangles of 1 s to 10 mm, so loading and unloading at 20 mm/s."""
DEFLECTION = 0.01 * (1.0 - np.abs(1.0 - 2.0 * (TIME % 1.0)))
SURFACE = np.where(TIME < 1.0, np.inf, -0.381)
RECORDING = Recording("press", TIME + 5.0, DEFLECTION, SURFACE, 1e5 * DEFLECTION)
AT = Located(RECORDING, np.zeros(200), 1e5 * DEFLECTION)


def place(by: str, start: Any, stop: Any, **more: Any) -> dict[str, Any]:
    return {"by": by, "from": start, "to": stop, "unit": "1", "share": 0.5, **more}


@pytest.mark.parametrize(
    ("entry", "expected"),
    [
        (place("deflection", 0.004, 0.006), (DEFLECTION >= 0.004) & (DEFLECTION <= 0.006)),
        (place("force", 400.0, 600.0), (DEFLECTION >= 0.004) & (DEFLECTION <= 0.006)),
        (place("time", 5.0, 5.5), TIME <= 0.5),
        (place("time", 5.0, 5.5, recording="another"), TIME < 0.0),
        (place("time", 5.0, 5.5, recording="press"), TIME <= 0.5),
        (place("radius", "inf", "inf"), TIME < 1.0),
        (place("radius", -0.381, -0.381), TIME >= 1.0),
        (place("history", 0.01, 0.01), TIME >= 0.5),
    ],
)
def test_samples_of_a_place(entry: dict[str, Any], expected: np.ndarray) -> None:
    # Bounds of decimal fractions may fall on either side of a sample.
    assert np.sum(inside(entry, AT) != expected) <= 2


def test_directions_and_rates_follow_the_motion() -> None:
    middle = np.abs((TIME % 0.5) - 0.25) < 0.2
    loads = inside(place("direction", 1.0, 1.0), AT)
    assert np.array_equal(loads[middle], (TIME % 1.0 < 0.5)[middle])
    fast = inside(place("rate", 0.015, 0.025), AT)
    assert np.array_equal(fast[middle], (TIME % 1.0 < 0.5)[middle])


def test_what_cannot_be_drawn_is_none() -> None:
    assert inside(place("acceleration", 0.0, 1.0), AT) is None
    assert inside(place("deflection", "odd", 1.0), AT) is None


def test_the_first_coordinate_that_says_something_is_shaded() -> None:
    everywhere, nowhere = place("deflection", 0.0, 1.0), place("rate", 5.0, 6.0)
    first, second = place("time", 5.0, 5.2), place("time", 6.0, 6.2)
    other = place("deflection", 0.004, 0.006)
    where = [place("acceleration", 0.0, 1.0), everywhere, nowhere, first, other, second]
    assert shaded(where, AT) == [first, second]
    assert shaded([everywhere], AT) == []
    loads, unloads = place("direction", 1.0, 1.0), place("direction", -1.0, -1.0)
    assert shaded([unloads, loads], AT) == [unloads]  # both would shade the whole picture


def test_the_picture_reaches_as_far_as_its_places_and_says_what_it_draws() -> None:
    """Another recording went deeper: the place ends beyond the one that is drawn."""
    plain = draw_where(AT, [], 1.0, "a")
    deep = draw_where(AT, [place("deflection", 0.004, 0.03)], 1.0, "a")
    assert (">30<" in plain, ">30<" in deep) == (False, True)
    assert ">noise<" in plain
    assert ">mean<" in plain


def test_a_band_of_deflection_is_shaded_and_other_places_by_their_samples() -> None:
    plain = draw_where(AT, [], 1.0, "a")
    band = draw_where(AT, [place("deflection", 0.004, 0.006)], 1.0, "a")
    assert plain.count("var(--before)") == 0
    assert band.count("var(--before)") > 0
