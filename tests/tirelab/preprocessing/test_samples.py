"""The dataset of a diagnosis: rows, surfaces and the baseline law, against the article's law and by hand."""

from __future__ import annotations

import numpy as np
import pytest
from radialtire import TireModel, power_law
from tirelab.preprocessing.samples import MOST_SURFACES, ROWS, raw_dataset_of, surface_numbers, within
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
    (experiment,) = raw_dataset_of([recording], BASELINE).experiments
    np.testing.assert_allclose(experiment.elastic(recording.deflection), recording.force, rtol=1e-12)
    assert np.all(experiment.elastic(np.full(2000, -1e-3)) == 0.0)


def test_time_counts_from_the_start_and_the_rows_are_shared() -> None:
    recordings = [sine(np.inf, samples=12_000), sine(np.inf, samples=500)]
    dataset = raw_dataset_of(recordings, BASELINE)
    assert [e.number for e in dataset.experiments] == [0, 1]
    assert all(e.time[0] == 0.0 for e in dataset.experiments)
    rows = [e.rows for e in dataset.experiments]
    # 4000 for each: every third of 12 000, and all of 500.
    np.testing.assert_array_equal(rows[0], np.arange(0, 12_000, 3))
    np.testing.assert_array_equal(rows[1], np.arange(500))
    assert sum(map(len, rows)) <= ROWS


def test_the_sampled_experiment_has_the_samples_of_its_rows() -> None:
    (experiment,) = raw_dataset_of([sine(0.3, samples=20_000)], BASELINE).experiments
    sampled = experiment.sampled
    np.testing.assert_array_equal(sampled.time, experiment.time[experiment.rows])
    np.testing.assert_array_equal(sampled.motion.rate, experiment.motion.rate[experiment.rows])
    assert sampled.motion.noise == experiment.motion.noise
    np.testing.assert_array_equal(sampled.rows, np.arange(len(sampled.time)))


def test_the_largest_deflection_and_the_surfaces_are_those_of_all_recordings() -> None:
    dataset = raw_dataset_of(
        [sine(np.repeat([np.inf, 0.3], 1000), depth=22e-3), sine(-0.5, depth=15e-3)], BASELINE
    )
    assert dataset.max_deflection == pytest.approx(22e-3, rel=1e-4)
    assert set(dataset.radii) == {np.inf, 0.3, -0.5}


def test_a_surface_has_one_number_in_all_recordings() -> None:
    convex, flat, concave = 0.3, np.inf, -0.5
    one, other = surface_numbers([np.array([flat, convex]), np.array([concave, flat, convex, flat])])
    np.testing.assert_array_equal(other[[2, 1]], one[[1, 0]])
    assert other[1] == other[3]
    assert len({*one.tolist(), *other.tolist()}) == 3


def test_no_surface_of_a_terrain_is_told_from_the_others() -> None:
    radii = np.linspace(0.2, 0.9, MOST_SURFACES + 1)
    assert not np.any(surface_numbers([radii])[0])
    assert np.all(np.diff(surface_numbers([radii[1:]])[0]) == 1)


@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_what_is_hardly_beyond_the_least_deflection_is_within(sign: float) -> None:
    """A press that comes back to a hair beyond its zero; two in a hundred of the stroke are no stroke of their own."""
    fitted = (sign * np.linspace(0.0, 10.0, 50), np.zeros(50, dtype=int))
    asked = sign * np.array([-0.25, -0.15, 0.0, 5.0, 10.0, 10.15])
    (found,) = within([fitted], [(asked, np.zeros(6, dtype=int))])
    assert found.tolist() == [False, True, True, True, True, False]
    (held,) = within(
        [(np.linspace(-10.0, 10.0, 50), np.zeros(50, dtype=int))], [(asked, np.zeros(6, dtype=int))]
    )
    assert held.tolist() == [True, True, True, True, True, False]
