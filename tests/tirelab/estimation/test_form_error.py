"""The columns of the form errors: their size is the one that was declared, and they change an effect smoothly."""

from __future__ import annotations

import numpy as np
import pytest
from radialtire import CATALOGUE, TireModel
from tirelab.estimation.form_error import form_errors, smooth_functions
from tirelab.names import REFITTED_LAW
from tirelab.recordings.recording import Recording
from tirelab.regressors.dataset import Dataset, dataset_of
from tirelab.regressors.law import form_error
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
    columns = form_errors({name: curve}, dataset, smooth_functions(dataset))
    assert np.sqrt(mean_square(columns)) == pytest.approx(20.0 * form_error(name), rel=1e-9)


def test_the_discrepancy_of_the_law_is_sized_by_what_the_law_changes_and_shaped_by_the_force() -> None:
    dataset = driven()
    curve = np.full(dataset.misfit.size, 20.0)
    columns = form_errors({REFITTED_LAW: curve}, dataset, smooth_functions(dataset))
    assert np.sqrt(mean_square(columns)) == pytest.approx(20.0 * form_error(REFITTED_LAW), rel=1e-9)
    force = dataset.stacked([e.baseline for e in dataset.experiments])
    lightest, largest = np.abs(columns[np.argmin(force)]).max(), np.abs(columns[np.argmax(force)]).max()
    assert lightest < 0.01 * largest


def test_nothing_has_no_discrepancy() -> None:
    dataset = driven()
    assert form_errors({}, dataset, smooth_functions(dataset)).shape == (dataset.misfit.size, 0)
