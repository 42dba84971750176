"""Signatures hold the forms that an effect can take on a motion."""

from __future__ import annotations

import numpy as np
import pytest
from radialtire import CATALOGUE, Recalibrated, TireModel
from tirelab.estimation.problem import law_start, problem_of
from tirelab.recordings.recording import Recording
from tirelab.regressors.dataset import Dataset, arranged, dataset_of
from tirelab.regressors.draws import at_reading, quantile
from tirelab.regressors.law import EXPONENT, FACTOR, LAW, REFERENCE, SHAPE, candidates, law_signature
from tirelab.regressors.noise_floor import Noise
from tirelab.regressors.signature import in_other_noise, signature_of, signatures_of, size_of
from tirelab.simulation.simulate import simulate

NOISE = 2.0


@pytest.fixture(scope="module")
def dataset() -> Dataset:
    """Three speeds over 22 mm on the flat, twice each; 2 N of noise beside a misfit of 5 % of the force."""
    time = np.arange(0.0, 60.0, 0.01)
    frequency = np.select([time < 30.0, time < 50.0], [0.1, 0.3], 1.0)
    phase = np.cumsum(frequency) * 0.01
    x = 0.011 * (1.0 - np.cos(2.0 * np.pi * phase))
    silent = Recording("speeds", time, x, np.full(time.size, np.inf), np.zeros(time.size))
    force = 1.05 * simulate(TireModel(), silent)
    noise = NOISE * np.random.default_rng(11).normal(size=time.size)
    return dataset_of([Recording("speeds", time, x, silent.surface_radius, force + noise)], TireModel())


def left_by(columns: np.ndarray, curve: np.ndarray) -> float:
    """Part of a curve's root mean square that no sum of the columns follows."""
    rest = curve - columns @ np.linalg.lstsq(columns, curve, rcond=None)[0]
    return size_of(rest) / size_of(curve)


def test_every_effect_that_this_motion_drives_has_a_signature(dataset: Dataset) -> None:
    found = {s.name for s in signatures_of(candidates(), dataset)}
    # Nothing is near the end of a range here: what only acts there may be silent.
    local = {n for n in CATALOGUE if "localized" in CATALOGUE[n].traits}
    # Nor was any channel recorded beside the motion.
    read = {
        n for n in CATALOGUE if CATALOGUE[n].reads is not None and CATALOGUE[n].reads.reference is not None
    }
    assert found >= set(candidates()) - local - read


def test_draws_have_the_size_one_and_the_values_that_made_them(dataset: Dataset) -> None:
    signature = signature_of("viscous_damping", dataset)
    assert signature is not None
    np.testing.assert_allclose(np.sqrt(np.mean(signature.curves**2, axis=1)), 1.0)
    again = arranged(dataset.tire, [("viscous_damping", signature.values[0])])
    np.testing.assert_allclose(dataset.response(again), signature.curves[0] * signature.sizes[0], rtol=1e-9)


@pytest.mark.parametrize(
    "name", ["viscous_damping", "rate_independent_hysteresis", "pressure_leak", "inertia"]
)
def test_a_value_that_was_not_drawn_lies_in_the_span_of_a_signature(name: str, dataset: Dataset) -> None:
    signature = signature_of(name, dataset)
    assert signature is not None
    effect = CATALOGUE[name]
    middle = tuple(
        quantile(p, 0.4, dataset.scales) if p.prior and not p.optional else p.start for p in effect.parameters
    )
    curve = dataset.response(arranged(dataset.tire, [(name, middle)]))
    assert left_by(signature.columns, curve) < 0.05


def test_a_change_of_a_and_b_lies_in_the_span_of_the_laws_signature(dataset: Dataset) -> None:
    tire = TireModel(Recalibrated(TireModel().law, ((np.inf, 0.03, 0.02),)))
    assert left_by(law_signature(dataset).columns, dataset.response(tire)) < 0.01


def test_the_laws_signature_is_what_a_refitted_law_can_do(dataset: Dataset) -> None:
    """Its columns are the derivatives of the delivered law by its parameters, on the axes of their priors.

    The change of B acts on ln(x / 1 cm) there and on ln(x / x_ref) here: the rest is a change of A.
    """
    problem = problem_of(dataset, {LAW: law_start(dataset)}, plain=False)
    origin, step = np.zeros(len(problem.parameters)), 1e-4
    slopes = [
        (problem.residual(origin) - problem.residual(origin + step * row)) / step
        for row in np.eye(origin.size)
    ]
    reference = at_reading(CATALOGUE[SHAPE].parameters[REFERENCE], dataset.scales)
    slopes[1] = slopes[1] - EXPONENT * np.log(reference / 0.01) / FACTOR * slopes[0]
    signature = law_signature(dataset)
    unit = size_of(FACTOR * dataset.stacked([e.baseline for e in dataset.experiments]))
    np.testing.assert_allclose(signature.basis * unit, np.column_stack(slopes), atol=2e-3 * unit)


def test_a_law_that_waves_lies_in_the_span_of_its_signature(dataset: Dataset) -> None:
    """What no change of A and B follows: heights of opposite signs."""
    shape = (0.0, 0.0, at_reading(CATALOGUE[SHAPE].parameters[REFERENCE], dataset.scales))
    waves = arranged(dataset.tire, [(SHAPE, (*shape, 0.02, -0.02, 0.02, -0.02, 0.02))])
    assert left_by(law_signature(dataset).columns, dataset.response(waves)) < 0.01


def test_in_other_noise_a_signature_explains_the_same_newtons(dataset: Dataset) -> None:
    signature = signature_of("viscous_damping", dataset)
    assert signature is not None
    louder = dataset.with_noise([Noise(2.0 * e.noise, 1) for e in dataset.experiments])
    other = in_other_noise(signature, dataset, louder)
    np.testing.assert_allclose(
        other.curves * other.sizes[:, None] * 2.0, signature.curves * signature.sizes[:, None], rtol=1e-9
    )
