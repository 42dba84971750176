"""The residual over its coordinates: what a mean, a map and a legend show."""

from __future__ import annotations

import base64
import csv
import io
import re
from dataclasses import replace

import numpy as np
import pytest
from matplotlib.figure import Figure
from tirelab.errors import TirelabError
from tirelab.recordings.recording import Recording
from tirelab.report.loops import Case
from tirelab.report.residuals import (
    OVER,
    draw_maps,
    draw_over_deflection,
    draw_over_rate,
    draw_slow_changes,
    misfit_of,
    plot_residuals,
)

SAMPLES = 4000
TIME = np.arange(SAMPLES) * 0.01
DEFLECTION = 0.01 * (1.0 - np.cos(0.8 * np.pi * TIME))
RATE = 0.008 * np.pi * np.sin(0.8 * np.pi * TIME)
LAW = 9e4 * DEFLECTION


def case(missing: np.ndarray, after: np.ndarray | None = None, name: str = "r") -> Case:
    """A recording with a force that the simulation misses, and what the correction adds (all of it)."""
    recording = Recording(name, TIME, DEFLECTION, np.full(SAMPLES, np.inf), LAW + missing)
    return Case(recording, LAW, LAW + (missing if after is None else after))


def lines(over: str, *cases: Case) -> list[tuple[np.ndarray, np.ndarray]]:
    axes = plot_residuals(cases, 1.0, None, over)
    return [line.get_data() for line in axes.lines if len(line.get_xdata()) > 2]


def test_a_force_of_the_rate_is_a_line_over_the_rate() -> None:
    (at, before), (_, after) = lines("rate", case(500.0 * RATE))
    # The mean rate of a bin and the mean of a force in proportion to it stay in proportion.
    assert before == pytest.approx(0.5 * at, abs=0.05)
    assert after == pytest.approx(0.0, abs=1e-9)


def test_loading_and_unloading_are_apart_over_the_deflection() -> None:
    (_, up), (_, down), *_ = lines("deflection", case(np.where(RATE > 0.0, 10.0, -4.0)))
    # The turns, where the direction changes within a bin, are left out.
    assert up[3:-3] == pytest.approx(10.0)
    assert down[3:-3] == pytest.approx(-4.0)


def test_recordings_follow_each_other_in_time() -> None:
    m = misfit_of([case(np.ones(SAMPLES)), case(3.0 * np.ones(SAMPLES), name="s")])
    assert m.ends == (SAMPLES, 2 * SAMPLES)
    assert np.all(np.diff(m.time) > 0.0)
    assert m.time[SAMPLES] == pytest.approx(TIME[-1] + 0.01)
    assert m.before[:SAMPLES] == pytest.approx(1.0)
    assert m.before[SAMPLES:] == pytest.approx(3.0)


def test_a_correction_too_small_to_see_is_not_drawn() -> None:
    """The correction of an unexplained ripple drew "before and after" twice over the same picture."""
    force = 30.0 * np.sin(DEFLECTION / 1e-3)
    almost = case(force, after=0.005 * force)
    assert almost.alike
    assert misfit_of([almost]).alike
    assert len(lines("deflection", almost)) == 2
    assert not case(force, after=0.05 * force).alike
    maps, _ = draw_maps(misfit_of([almost]), 1.0, "m")
    assert len(maps) == 1


def test_a_map_takes_the_coordinate_that_orders_the_residual() -> None:
    assert draw_maps(misfit_of([case(500.0 * RATE)]), 1.0, "m")[1] == "rate"
    assert draw_maps(misfit_of([case(20.0 * np.sin(0.1 * TIME))]), 1.0, "m")[1] == "time"


def table(picture: str) -> list[dict[str, str]]:
    (data,) = re.findall(r'href="data:text/csv;base64,([^"]+)"', picture)
    return list(csv.DictReader(io.StringIO(base64.b64decode(data).decode())))


def test_the_numbers_behind_a_picture_can_be_saved() -> None:
    m = misfit_of([case(500.0 * RATE)])
    rows = table(draw_over_rate(m, 1.0, "r"))
    assert {row["curve"] for row in rows} == {"before", "after"}
    for row in rows:
        told = 0.5 * float(row["rate [mm/s], unloading < 0 < loading"]) if row["curve"] == "before" else 0.0
        assert float(row["mean residual [N]"]) == pytest.approx(told, abs=0.05)
    assert {row["curve"] for row in table(draw_over_deflection(m, 1.0, "d"))} == {
        f"{which}, {branch}" for which in ("before", "after") for branch in ("loading", "unloading")
    }
    assert table(draw_slow_changes(m, 1.0, "s"))
    (before, after), name = draw_maps(m, 1.0, "m")
    assert name == "rate"
    cells = table(before)
    assert len(cells) == len(table(after)) > 100
    for cell in cells:
        low, high = (0.5 * float(cell[f"rate [mm/s] {end}"]) for end in ("from", "to"))
        assert low - 0.1 <= float(cell["mean residual [N]"]) <= high + 0.1
        assert float(cell["deflection from [mm]"]) < float(cell["to [mm]"])


def test_every_coordinate_draws_on_the_axes_that_are_given() -> None:
    for over in OVER:
        axes = Figure().subplots()
        assert plot_residuals([case(500.0 * RATE)], 1.0, axes, over) is axes
        assert axes.get_legend() is not None
    with pytest.raises(TirelabError, match="choose one of time, deflection, rate"):
        plot_residuals([case(RATE)], 1.0, None, "depth")


def test_a_still_recording_is_drawn_without_a_warning() -> None:
    still = case(np.ones(SAMPLES))
    flat = replace(still, recording=replace(still.recording, deflection=np.full(SAMPLES, 0.01)))
    assert len(lines("rate", flat)) <= 2
