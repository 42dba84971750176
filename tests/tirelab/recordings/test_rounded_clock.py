"""Times that were even before they were written with few digits are even again; a clock that is not stays as it is."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import polars as pl
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from radialtire import PowerLaw, TireModel
from tirelab.diagnosis.diagnose import diagnose
from tirelab.recordings.recording import Recording, RecordingError, read_recording
from tirelab.recordings.rounded_clock import evened, lost_in_single

NUMBER = np.arange(3000)
EVEN = NUMBER / 300.0


def digits(values: np.ndarray, count: int) -> np.ndarray:
    return np.array([float(f"{value:.{count}g}") for value in values])


@pytest.mark.parametrize(
    "written",
    [
        np.round(EVEN, 3),
        np.floor(1000.0 * EVEN) / 1000.0,
        np.round(1000.0 * EVEN),
        digits(1.0 + EVEN, 5),
        np.round(1.7e9 + EVEN, 3),
    ],
    ids=["ms", "cut to ms", "in ms", "five digits", "since 1970"],
)
def test_rounded_times_are_even_again(written: np.ndarray) -> None:
    """The steps are those before; where time begins is known to the rounding only."""
    found = evened(written, NUMBER)
    assert found is not None
    per_second = 1000.0 if written[-1] > 1e3 and written[-1] < 1e6 else 1.0
    # Each end of the line may be a unit off, of which there are 10 000.
    assert np.diff(found) / per_second == pytest.approx(1.0 / 300.0, rel=1e-4)
    assert found[0] == written[0]


def test_the_number_of_the_row_tells_where_samples_are_missing() -> None:
    kept = np.flatnonzero(np.random.default_rng(1).uniform(size=NUMBER.size) > 0.3)
    found = evened(np.round(EVEN[kept], 3), kept)
    assert found is not None
    assert np.diff(found) == pytest.approx(np.diff(EVEN[kept]), rel=1e-4)


@pytest.mark.parametrize("unit", [1e-3, 1e-6, 0.0])
def test_a_clock_that_is_not_even_stays_as_it_is(unit: float) -> None:
    """Samples that come 0.4 ms early or late: more than the digits hide, at any number of digits."""
    early = np.sort(EVEN + np.random.default_rng(2).uniform(-4e-4, 4e-4, EVEN.size))
    written = np.round(early / unit) * unit if unit else early
    assert evened(written, NUMBER) is None


@pytest.mark.parametrize(
    "written",
    [
        EVEN,
        np.round(EVEN, 6),
        np.round(EVEN[:9], 3),
        np.round(EVEN, 2),
        np.where(NUMBER < 1500, EVEN, EVEN + 10.0).round(3),
        np.full(3000, np.nan),
        np.append(np.round(EVEN[:-1], 3), np.inf),
    ],
    ids=["even", "even to a microsecond", "few", "times repeat", "a pause", "no numbers", "infinite"],
)
def test_what_needs_no_or_allows_no_answer_is_left(written: np.ndarray) -> None:
    assert evened(written, NUMBER[: written.size]) is None


@settings(max_examples=60, deadline=None)
@given(rate=st.floats(20.0, 900.0), begin=st.floats(0.0, 1e4), count=st.integers(10, 400))
def test_whatever_was_rounded_is_found_within_its_last_digit(rate: float, begin: float, count: int) -> None:
    written = np.round(begin + np.arange(count) / rate, 3)
    found = evened(written, np.arange(count))
    if found is None:
        # Then it was even as written, or nearly so.
        assert np.ptp(np.diff(written)) <= 1e-3 * np.diff(written).min() or np.diff(written).min() <= 0.0
    else:
        assert np.ptp(np.diff(found)) < 1e-9
        assert np.abs(found - written).max() <= 1.001e-3


def damper(path: Path, *, digits: int, seed: int) -> Recording:
    """A spring of 10 N/mm beside a damper of 1000 N s/m, driven by a sweep, sampled at 300 Hz."""
    phase = 2.0 * np.pi * (0.5 * EVEN + 0.125 * EVEN**2)
    speed = 2.0 * np.pi * (0.5 + 0.25 * EVEN)
    deflection = 0.011 - 0.010 * np.cos(phase)
    noise = np.random.default_rng(seed).normal(size=EVEN.size)
    force = 1e4 * deflection + 1000.0 * 0.010 * np.sin(phase) * speed + noise
    table = np.column_stack([np.round(EVEN, digits), 1e3 * deflection, force])
    header = "time [s],deflection [mm],force [N]"
    np.savetxt(path, table, fmt=["%.9g", "%.6f", "%.4f"], delimiter=",", header=header, comments="")
    return read_recording(path, radius="flat")


def test_a_file_says_that_its_times_were_rounded(tmp_path: Path) -> None:
    rounded = damper(tmp_path / "ms.csv", digits=3, seed=1)
    assert np.ptp(np.diff(rounded.time)) < 1e-9
    assert rounded.sampling_interval == pytest.approx(1.0 / 300.0, rel=1e-4)
    assert any("rounded" in note for note in rounded.notes)
    exact = damper(tmp_path / "exact.csv", digits=9, seed=1)
    assert not any("rounded" in note for note in exact.notes)


@pytest.mark.slow
def test_a_damper_is_found_whatever_the_digits_of_the_clock(tmp_path: Path) -> None:
    """Read at the written times, the speed was wrong by up to a third from sample to sample."""
    recording = damper(tmp_path / "ms.csv", digits=3, seed=2)
    verdict = diagnose(recording, TireModel(PowerLaw(100.0, 1.0), two_sided=True))
    assert [effect.name for effect in verdict.effects] == ["viscous_damping"]
    assert verdict.fit.after == pytest.approx(1.0, rel=0.1)


@pytest.mark.parametrize(
    ("first", "size", "step"),
    [(1.7e9, 1.0, 128.0), (1.7e12, 1e-3, 131.072), (1.7e5, 1.0, 1.0 / 64.0), (0.0, 1.0, 0.0)],
)
def test_times_that_single_precision_cannot_part(first: float, size: float, step: float) -> None:
    written = (first + EVEN / size).astype(np.float32).astype(np.float64)
    assert lost_in_single(written, size) == (step if step > 0.01 else 0.0)
    assert lost_in_single(first + EVEN / size, size) == 0.0


@pytest.mark.parametrize("written", [np.floor(EVEN), 1e5 + np.floor(EVEN), np.full(300, 5.0)])
def test_a_coarse_clock_did_not_lose_its_steps_in_single_precision(written: np.ndarray) -> None:
    assert lost_in_single(written, 1.0) == 0.0


def test_a_file_of_such_times_is_read_with_its_rate_alone(tmp_path: Path) -> None:
    path = tmp_path / "a.parquet"
    columns = {"time [s]": 1.7e9 + EVEN, "deflection [mm]": 10.0 - 10.0 * np.cos(EVEN), "force [N]": EVEN}
    pl.DataFrame({name: values.astype(np.float32) for name, values in columns.items()}).write_parquet(path)
    with pytest.raises(RecordingError, match=r"times of this size are 128 s apart.*: --sampling RATE$"):
        read_recording(path, radius="flat")
    assert read_recording(path, radius="flat", sampling="300Hz").duration == pytest.approx(EVEN[-1])
