"""What has not the size of a tire is doubted, with the unit that would fit; what has it never is."""

from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from tirelab.recordings.choices import Choices
from tirelab.recordings.inspection import inspect_recording, step_of
from tirelab.recordings.plausibility import force_begins
from tirelab.recordings.recording import Recording, RecordingError, read_recording
from tirelab.recordings.zero import force_at_least

X = 0.022 * (1.0 - np.abs(np.linspace(-1.0, 1.0, 401)))
T = np.arange(401) / 10.0


def pressed(coefficient: float, exponent: float, x: np.ndarray = X, noise: float = 3.0) -> np.ndarray:
    return coefficient * (100.0 * x) ** exponent + noise * np.random.default_rng(1).standard_normal(x.size)


@given(st.floats(150.0, 1500.0), st.floats(1.0, 1.8), st.floats(0.006, 0.05))
def test_no_tire_is_doubted(coefficient: float, exponent: float, stroke: float) -> None:
    x = X * stroke / 0.022
    recording = Recording.from_arrays(T, x, pressed(coefficient, exponent, x), "flat")
    assert recording.doubts == ()


@pytest.mark.parametrize(
    ("scale_x", "scale_f", "units", "said"),
    [
        (1.0, 1e-3, {}, "about 1000 times too small"),
        (1.0, 1e-3, {}, 'kN? Then units={"force": "kN"}'),
        (1.0, 1e3, {"force": "kN"}, 'N? Then units={"force": "N"}'),
        (0.001, 1.0, {"deflection": "mm"}, 'm? Then units={"deflection": "m"}'),
    ],
)
def test_a_wrong_thousand_is(scale_x: float, scale_f: float, units: dict[str, str], said: str) -> None:
    factor = {"mm": 1e3}.get(units.get("deflection", ""), 1.0)
    force = scale_f * pressed(900.0, 1.45)
    given_force = force / {"kN": 1e3}.get(units.get("force", ""), 1.0)
    recording = Recording.from_arrays(T, factor * scale_x * X, given_force, "flat", units=units)
    assert any(said in doubt for doubt in recording.doubts), recording.doubts


@pytest.mark.parametrize("offset", [-0.004, 0.003, 0.005, 0.012])
@pytest.mark.parametrize("exponent", [1.2, 1.45, 1.7])
def test_a_zero_that_is_off_is_found(offset: float, exponent: float) -> None:
    force = pressed(900.0, exponent)
    found = force_begins(X + offset, force, np.full(X.size, np.inf))
    assert found is not None
    assert found.begins == pytest.approx(offset, abs=4e-4)
    (doubt,) = Recording.from_arrays(T, X + offset, force, "flat").doubts
    assert "the force begins at " in doubt


def test_a_gap_before_the_force_is_found() -> None:
    x = 0.03 * (1.0 - np.abs(np.linspace(-1.0, 1.0, 2001)))
    force = pressed(900.0, 1.45, np.maximum(x - 0.008, 0.0))
    found = force_begins(x, force, np.full(x.size, np.inf))
    assert found is not None
    assert found.begins == pytest.approx(0.008, abs=3e-4)


def test_a_part_that_snaps_through_begins_where_it_was_driven_without_force() -> None:
    """Its gauge is the position of a robot: 6 mm of air from 357 mm on, then two humps that no power law follows."""
    x = np.linspace(0.357, 0.372, 3000)
    way = np.maximum(x - 0.363, 0.0) / 0.009
    force = 8.0 * np.abs(np.sin(2.0 * np.pi * way)) * (way < 1.0) + 4.0 * way
    force += 0.01 * np.random.default_rng(1).standard_normal(x.size)
    found = force_begins(x, force, np.full(x.size, np.inf))
    assert found is not None
    # a sixtieth of the stroke of 15 mm is one place
    assert found.begins == pytest.approx(0.363, abs=3e-4)
    assert found.seen
    assert found.far
    away = force_begins(x, force - 4.0, np.full(x.size, np.inf))
    assert away is None


def test_a_force_that_a_resonance_hides_is_not_taken_for_none() -> None:
    """A tire that is loaded all the time, from 10.8 mm on, whose zero is 7.5 mm off; its frame rings at times."""
    time = np.arange(0.0, 57.0, 0.005)
    x = 0.01615 - 0.00535 * np.cos(2.0 * np.pi * 0.7 * time)
    ringing = np.where(time % 20.0 < 4.0, 4000.0 * np.sin(2.0 * np.pi * 7.03 * time), 0.0)
    noise = np.random.default_rng(1).normal(0.0, 50.0, time.size)
    force = 550.9 * (100.0 * x - 0.75) ** 1.422 + ringing + noise
    least, uncertain = force_at_least(x, force)
    assert abs(least) < uncertain
    found = force_begins(x, force, np.full(x.size, np.inf))
    assert found is not None
    assert found.begins == pytest.approx(7.5e-3, abs=5e-4)
    assert not found.far


@pytest.mark.parametrize("noise", [0.0, 0.3])
@pytest.mark.parametrize("offset", [0.0, 20.0])
def test_a_steep_rise_from_no_force_is_no_force_at_the_least_deflection(offset: float, noise: float) -> None:
    """A soft specimen that is steep at first: over the first 2 mm of 666 its force is 19 N more in the mean."""
    x = np.arange(0.0, 0.666, 5e-5)
    way = [0.0, 1e-3, 0.022, 0.044, 0.067, 0.111, 0.2, 0.289, 0.333, 0.4, 0.511, 0.666]
    force = np.interp(x, way, [0, 22, 246, 312, 337, 379, 477, 598, 687, 879, 1250, 1780])
    force += offset + noise * np.random.default_rng(2).standard_normal(x.size)
    found = force_begins(x, force, np.full(x.size, np.inf))
    assert found is not None
    assert found.force == pytest.approx(offset, abs=0.1 + noise)
    assert (found.begins, found.off) == (0.0, False) if offset == 0.0 else found.off


@pytest.mark.parametrize(
    ("radius", "said"), [(127.0, "as good as flat"), (-50.0, "as good as flat"), (2.5, "")]
)
def test_a_radius_that_is_as_good_as_flat(radius: float, said: str) -> None:
    doubts = Recording.from_arrays(T, X, pressed(900.0, 1.45), radius).doubts
    assert [said in doubt for doubt in doubts] == ([True] if said else [])


@pytest.mark.parametrize("step", [0.01, 0.5, 3.0])
def test_the_step_of_a_gauge(step: float) -> None:
    wave = 40.0 * step * np.sin(np.linspace(0.0, 20.0, 3000))
    assert step_of(np.round(wave / step) * step) == pytest.approx(step)
    assert step_of(wave + 1e-3 * np.random.default_rng(0).standard_normal(3000)) is None


@pytest.mark.parametrize("value", ["1e-320", "1e308", "-1e308"])
def test_a_damaged_number_ends_in_a_question_and_no_traceback(tmp_path: Path, value: str) -> None:
    path = tmp_path / "a.csv"
    rows = [f"{i / 10},{0.0 if value == '1e-320' else i},{i * i}" for i in range(40)]
    rows[7] = f"0.7,{value},49"
    path.write_text("\n".join(["time,deflection,force", *rows]), encoding="utf-8")
    with pytest.raises(RecordingError):
        read_recording(path, radius="flat")


@pytest.mark.parametrize(
    ("channel", "values", "unit", "said"),
    [
        (
            "pressure",
            -5.0,
            "bar",
            "from -5 to -5 bar of gauge pressure, which no bicycle tire has; check its unit",
        ),
        ("pressure", 250.0, "bar", "from 250 to 250 bar of gauge pressure"),
        ("pressure", 2.5, "kPa", "from 0.025 to 0.025 bar of gauge pressure"),
        ("temperature", 500.0, "degC", "from 500 to 500 degC, at which no rubber is tested; check its unit"),
        ("pressure", 2.5, "bar", ""),
        ("temperature", 21.0, "degC", ""),
    ],
)
def test_a_pressure_or_temperature_that_no_tire_has_is(
    tmp_path: Path, channel: str, values: float, unit: str, said: str
) -> None:
    file = tmp_path / "press.csv"
    rows = np.column_stack([T, 1e3 * X, pressed(900.0, 1.45), np.full(T.size, values)])
    header = f"time [s],deflection [mm],force [N],{channel} [{unit}]"
    np.savetxt(file, rows, delimiter=",", header=header, comments="", fmt="%.4f")
    doubts = read_recording(file, radius="flat").doubts
    assert len(doubts) == bool(said)
    assert all(said in doubt and f"column '{channel} [{unit}]'" in doubt for doubt in doubts), doubts


def test_a_stroke_that_is_all_but_nothing_is_read() -> None:
    """A tire's force at 1e-232 m is 0 in floating point: nothing can be compared with it."""
    recording = Recording.from_arrays(T, 1e-230 * X, pressed(900.0, 1.45), "flat")
    assert not any("times too" in doubt for doubt in recording.doubts)


def test_a_load_cell_that_was_not_zeroed_is_asked_about(tmp_path: Path) -> None:
    """A strip that is stretched from 0.5 to 6.5 N reads -14.5 to -8.5 N."""
    path = tmp_path / "a.csv"
    table = np.column_stack([T, 1e3 * X, 0.5 + 6.0 * X / X.max() - 15.0])
    header = "time [s],deflection [mm],force [N]"
    np.savetxt(path, table, fmt="%.4f", delimiter=",", header=header, comments="")
    signed = {"deflection": "+deflection [mm]", "force": "+force [N]"}
    (doubt,) = inspect_recording(path, Choices(part=True, columns=signed)).recording.doubts
    assert "the force is -14.5 to -8.5 N: it pulls all the time" in doubt
    assert "force=-14.5N" in doubt
    zeroed = inspect_recording(path, Choices(part=True, columns=signed, zero={"force": "-15 N"})).recording
    assert zeroed.doubts == ()
    np.testing.assert_allclose(zeroed.force, 0.5 + 6.0 * X / X.max(), atol=1e-3)


@pytest.mark.parametrize("ends", [(0.0, -1.0), (0.1, -0.9)])
def test_a_part_that_pulls_more_the_further_it_is_stretched_is_not(
    tmp_path: Path, ends: tuple[float, float]
) -> None:
    """Extension and pull are counted negative, both signs are given, and the load cell reads -0.04 kN at the start."""
    path = tmp_path / "a.csv"
    stretched = np.linspace(*ends, T.size)
    table = np.column_stack([T, 0.3 * stretched, -0.04 - 18.0 * (ends[0] - stretched)])
    np.savetxt(
        path, table, fmt="%.5f", delimiter=",", header="time [s],deflection [mm],force [kN]", comments=""
    )
    signed = {"deflection": "+deflection [mm]", "force": "+force [kN]"}
    assert inspect_recording(path, Choices(part=True, columns=signed)).recording.doubts == ()
