"""The dataset of a diagnosis: rows, surfaces, baseline law and scales, against the article's law and by hand."""

import numpy as np
import pytest
from radialtire import TireModel, power_law
from tirelab.preprocessing.dataset import MOST_FREE_SURFACES, PEAK_QUANTILE, ROWS, dataset_of
from tirelab.recordings.recording import Recording

BASELINE = TireModel()


def sine(
    radius: float | np.ndarray, samples: int = 2000, step: float = 0.01, depth: float = 20e-3
) -> Recording:
    time = 5.0 + step * np.arange(samples)
    deflection = 0.5 * depth * (1.0 - np.cos(2.0 * np.pi * 0.25 * time))
    radii = np.broadcast_to(np.asarray(radius, dtype=float), samples).copy()
    force = [
        power_law.force(x, *BASELINE.law.coefficients(r)) for x, r in zip(deflection, radii, strict=True)
    ]
    return Recording("sine", time, deflection, radii, np.array(force))


def test_the_baseline_law_is_the_tires() -> None:
    recording = sine(np.where(np.arange(2000) < 1000, np.inf, 0.3))
    (experiment,) = dataset_of([recording], BASELINE).experiments
    np.testing.assert_allclose(experiment.elastic(recording.deflection), recording.force, rtol=1e-12)
    assert np.all(experiment.elastic(np.full(2000, -1e-3)) == 0.0)


def test_the_stiffness_is_the_laws_slope() -> None:
    (experiment,) = dataset_of([sine(0.3)], BASELINE).experiments
    x, step = np.full(2000, 12e-3), 1e-7
    slope = (experiment.elastic(x + step) - experiment.elastic(x - step)) / (2.0 * step)
    np.testing.assert_allclose(experiment.stiffness(x), slope, rtol=1e-6)
    assert np.all(experiment.stiffness(np.full(2000, -1e-3)) == 0.0)


def test_time_counts_from_the_start_and_the_rows_are_shared() -> None:
    recordings = [sine(np.inf, samples=12_000), sine(np.inf, samples=500)]
    dataset = dataset_of(recordings, BASELINE)
    assert [e.number for e in dataset.experiments] == [0, 1]
    assert all(e.time[0] == 0.0 for e in dataset.experiments)
    rows = [e.rows for e in dataset.experiments]
    # 4000 for each: every third of 12 000, and all of 500.
    np.testing.assert_array_equal(rows[0], np.arange(0, 12_000, 3))
    np.testing.assert_array_equal(rows[1], np.arange(500))
    assert sum(map(len, rows)) <= ROWS


def test_the_sampled_experiment_has_the_samples_of_its_rows() -> None:
    (experiment,) = dataset_of([sine(0.3, samples=20_000)], BASELINE).experiments
    sampled = experiment.sampled
    np.testing.assert_array_equal(sampled.time, experiment.time[experiment.rows])
    np.testing.assert_array_equal(sampled.motion.rate, experiment.motion.rate[experiment.rows])
    assert sampled.motion.noise == experiment.motion.noise
    np.testing.assert_array_equal(sampled.rows, np.arange(len(sampled.time)))


def test_the_scales_are_the_largest_of_all_experiments() -> None:
    deep, fast = sine(np.inf, depth=22e-3), sine(np.inf, step=0.002, depth=15e-3)
    dataset = dataset_of([deep, fast], BASELINE)
    assert dataset.max_deflection == pytest.approx(22e-3, rel=1e-4)
    assert dataset.max_elastic_force == pytest.approx(float(deep.force.max()), rel=1e-3)
    assert dataset.max_force == np.quantile(deep.force, PEAK_QUANTILE)
    assert dataset.duration == pytest.approx(19.99)
    assert dataset.min_step == pytest.approx(0.002)


def test_each_surface_is_a_support_point_of_the_law() -> None:
    radii = np.repeat([np.inf, 0.3, -0.5, 0.1], 500)
    dataset = dataset_of([sine(radii)], BASELINE)
    assert set(dataset.radii) == {np.inf, 0.3, -0.5, 0.1}
    weights = dataset.experiments[0].surface
    for number, radius in enumerate(dataset.radii):
        np.testing.assert_array_equal(weights[radii == radius], np.tile(np.eye(4)[number], (500, 1)))


def test_terrain_shares_support_points_over_the_curvature() -> None:
    curvature = np.linspace(-1.0, 4.0, 2000)
    dataset = dataset_of([sine(1.0 / curvature)], BASELINE)
    assert len(dataset.radii) == MOST_FREE_SURFACES
    weights = dataset.experiments[0].surface
    np.testing.assert_allclose(weights.sum(axis=1), 1.0, rtol=1e-12)
    # Interpolating the curvature itself gives it back.
    np.testing.assert_allclose(weights @ (1.0 / np.array(dataset.radii)), curvature, atol=1e-12)
