"""The columns of form errors have the size that was declared; those of a drift follow what is slower than strokes."""

from __future__ import annotations

import numpy as np
import pytest
from radialtire import CATALOGUE, TireModel
from tirelab.estimation.forms import drifts, form_errors, smooth_functions
from tirelab.names import REFITTED_LAW
from tirelab.recordings.recording import Recording
from tirelab.regressors.dataset import Dataset, dataset_of
from tirelab.regressors.signature import HEIGHTS, form_error, size_of
from tirelab.simulation.simulate import simulate


def driven(radii: tuple[float, ...] = (np.inf,)) -> Dataset:
    """Sines of 20 mm at a quarter of a hertz on some surfaces, with white noise on the tire's own force."""
    noise = np.random.default_rng(5)
    recordings = []
    for number, radius in enumerate(radii):
        time = 0.01 * np.arange(1600)
        x = 0.01 * (1.0 - np.cos(2.0 * np.pi * 0.25 * time)) + 1e-6 * noise.normal(size=time.size)
        silent = Recording(f"{number}", time, x, np.full(time.size, radius), np.zeros(time.size))
        force = simulate(TireModel(), silent) + noise.normal(size=time.size)
        recordings.append(Recording(f"{number}", time, x, silent.surface_radius, force))
    return dataset_of(recordings, TireModel())


def mean_square(columns: np.ndarray) -> float:
    return float(np.mean(np.sum(columns**2, axis=1)))


@pytest.mark.parametrize("radii", [(np.inf,), (np.inf, 0.3)])
def test_the_functions_have_the_mean_square_one_together(radii: tuple[float, ...]) -> None:
    assert mean_square(smooth_functions(driven(radii))) == pytest.approx(1.0, rel=1e-9)


def test_the_discrepancy_of_an_effect_has_its_declared_part_of_its_size() -> None:
    dataset = driven()
    name = next(iter(CATALOGUE))
    curve = np.full(dataset.misfit.size, 20.0)
    columns = form_errors({name: curve}, dataset, smooth_functions(dataset))[name]
    assert np.sqrt(mean_square(columns)) == pytest.approx(20.0 * form_error(name), rel=1e-9)


def test_the_discrepancy_of_the_law_is_sized_by_what_the_law_changes_and_shaped_by_the_force() -> None:
    dataset = driven()
    curve = np.full(dataset.misfit.size, 20.0)
    columns = form_errors({REFITTED_LAW: curve}, dataset, smooth_functions(dataset))[REFITTED_LAW]
    assert np.sqrt(mean_square(columns)) == pytest.approx(20.0 * form_error(REFITTED_LAW), rel=1e-9)
    force = dataset.stacked([e.baseline for e in dataset.experiments])
    lightest, largest = np.abs(columns[np.argmin(force)]).max(), np.abs(columns[np.argmax(force)]).max()
    assert lightest < 0.01 * largest


def test_nothing_has_no_discrepancy() -> None:
    dataset = driven()
    assert form_errors({}, dataset, smooth_functions(dataset)) == {}


def missed(columns: np.ndarray, curve: np.ndarray) -> float:
    """Part of a curve's root mean square that no sum of the columns follows."""
    return size_of(curve - columns @ np.linalg.lstsq(columns, curve, rcond=None)[0]) / size_of(curve)


def test_a_drift_is_as_large_as_the_misfit() -> None:
    dataset = driven((np.inf, 0.3))
    assert np.sqrt(mean_square(drifts(dataset))) == pytest.approx(size_of(dataset.misfit), rel=1e-9)


def test_a_drift_follows_what_is_slower_than_the_strokes_of_each_recording_and_not_the_strokes() -> None:
    """Four cycles in each recording are eight strokes, and as many hats."""
    dataset = driven((np.inf, 0.3))
    columns = drifts(dataset)
    assert columns.shape[1] == 2 * 8
    share = dataset.gathered([(e.time - e.time[0]) / (e.time[-1] - e.time[0]) for e in dataset.experiments])
    second = dataset.gathered([np.full(e.time.size, float(i)) for i, e in enumerate(dataset.experiments)])
    assert missed(columns, second * np.sin(2.0 * np.pi * share)) < 0.1
    assert missed(columns, dataset.deflection - dataset.deflection.mean()) > 0.8


def test_in_one_stroke_no_drift_can_be_told_from_the_deflection() -> None:
    time = np.linspace(0.0, 20.0, 2000)
    x = 1e-3 * time
    force = simulate(TireModel(), Recording("s", time, x, np.full(time.size, np.inf), 0.0 * time))
    noise = np.random.default_rng(3).normal(size=time.size)
    ramp = Recording("ramp", time, x, np.full(time.size, np.inf), force + noise)
    assert drifts(dataset_of([ramp], TireModel())).shape[1] == 0


@pytest.mark.parametrize("begins_at", [0.0, np.pi])
def test_in_one_cycle_no_drift_can_be_told_from_deflection_and_direction(begins_at: float) -> None:
    """From the bottom or from the top; of two cycles it can."""
    columns = []
    for cycles in (1, 2):
        time = np.linspace(0.0, 20.0 * cycles, 1000 * cycles)
        x = 0.01 * (1.0 - np.cos(2.0 * np.pi * time / 20.0 + begins_at))
        noise = np.random.default_rng(3).normal(size=time.size)
        driven = Recording("c", time, x, np.full(time.size, np.inf), 900.0 + noise)
        columns.append(drifts(dataset_of([driven], TireModel())).shape[1])
    assert columns[0] == 0
    assert columns[1] >= 3


def test_in_a_hold_no_drift_can_be_told_from_what_relaxes() -> None:
    """The gauge trembles by a thousandth of the stroke of the other recording."""
    time = np.linspace(0.0, 20.0, 2000)
    noise = np.random.default_rng(3)
    ramp = Recording(
        "ramp", time, 1e-3 * time, np.full(time.size, np.inf), 900.0 + noise.normal(size=time.size)
    )
    still = 0.02 + 2e-5 * np.sin(time) + 1e-6 * noise.normal(size=time.size)
    hold = Recording("hold", time, still, np.full(time.size, np.inf), 900.0 + noise.normal(size=time.size))
    assert drifts(dataset_of([ramp, hold], TireModel())).shape[1] == 0


def test_a_drift_is_no_finer_than_a_law() -> None:
    time = 0.01 * np.arange(6000)
    x = 0.01 * (1.0 - np.cos(2.0 * np.pi * 0.5 * time))
    noise = np.random.default_rng(3).normal(size=time.size)
    cycles = Recording("cycles", time, x, np.full(time.size, np.inf), 20.0 + noise)
    assert drifts(dataset_of([cycles], TireModel())).shape[1] == HEIGHTS
