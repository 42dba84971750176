"""A fit stands at the top of what its evidence says, and follows what its set can be."""

from __future__ import annotations

import numpy as np
import pytest
from drives import flat_force, read, triangle
from radialtire import CATALOGUE, PowerLaw, TireModel
from tirelab.estimation.fit import LEAST_GAIN, fitted
from tirelab.estimation.problem import law_start, with_readings
from tirelab.names import REFITTED_LAW
from tirelab.recordings.recording import Recording
from tirelab.regressors.dataset import dataset_of
from tirelab.selection.search import PRIOR_ODDS, discrepancy_of
from tirelab.simulation.simulate import simulate


def test_a_fit_stands_at_the_top_under_the_prior_of_its_evidence() -> None:
    """Relaxation on one triangle, beside a law that can follow most of it: the scale of the law's prior decides.

    The slope of the log posterior, in standard deviations of the prior, is no more than a fit may still gain.
    """
    name = "viscoelastic_relaxation"
    parameters = CATALOGUE[name].parameters
    start = tuple(p.start for p in parameters)
    time, deflection = triangle()
    bare = read("bare", time, deflection, flat_force(deflection), 1)
    tire = TireModel(effects=((CATALOGUE[name], (0.03, 2.0, *start[2:])),))
    dataset = dataset_of(
        [read("relaxing", time, deflection, simulate(tire, bare), 2, noise=1.0)], TireModel()
    )
    starts = [{REFITTED_LAW: law_start(dataset), name: with_readings(name, start, dataset)}]
    found = fitted(dataset, starts, discrepancy_of(dataset.misfit, 0.002), 10.0, -np.inf)
    assert found.law_scales
    scales = np.array([found.law_scales.get(int(g), 1.0) if g else 1.0 for g in found.problem.groups])
    widths = scales * found.problem.widths(found.positions)
    slope = found.jacobian.T @ found.residual / found.variance + found.positions / widths**2
    inside = (found.positions > found.problem.low) & (found.positions < found.problem.high)
    assert 0.5 * float(np.sum((slope * widths)[inside] ** 2)) < LEAST_GAIN


def test_a_law_that_is_no_power_beyond_a_gap_is_followed_to_the_noise() -> None:
    """A part that grows softer, 6 of the 20 mm in contact; its believed law is a power from 0.7 mm before there."""
    time = np.arange(0.0, 30.0, 0.005)
    x = 0.01 * (1.0 - np.cos(2.0 * np.pi * 0.2 * time))
    force = 900.0 * np.tanh(250.0 * np.maximum(x - 0.014, 0.0))
    offset = ((CATALOGUE["deflection_offset"], (-0.0133,)),)
    part = TireModel(PowerLaw(1350.0, 1.3), effects=offset, inflated=False, tested_range=None)
    dataset = dataset_of([read("press", time, x, force, 4, noise=0.5)], part)
    starts = [{REFITTED_LAW: law_start(dataset)}]
    found = fitted(dataset, starts, discrepancy_of(dataset.misfit, 0.002), 1e4, -np.inf)
    # In units of the noise; ten heights over the contact may leave something of the first touch.
    assert found.power / found.residual.size < 1.5


@pytest.mark.parametrize(("ripple", "count"), [(30.0, 2), (0.0, 1)])
def test_a_law_of_another_shape_is_one_hypothesis_more_where_it_is_likelier(
    ripple: float, count: int
) -> None:
    """No power of x follows the sine over the deflection; without it another factor of 1.2 is all."""
    deflection = np.linspace(0.0005, 0.02, 300)
    force = 1.2 * flat_force(deflection) + ripple * np.sin(500.0 * deflection)
    press = read("press", np.linspace(0.0, 9.0, 300), deflection, force, 5, noise=0.5)
    dataset = dataset_of([press], TireModel())
    discrepancy = discrepancy_of(dataset.misfit, 0.002)
    found = fitted(dataset, [{REFITTED_LAW: law_start(dataset)}], discrepancy, 1.0, -np.inf)
    again = fitted(dataset, [found.values], discrepancy, found.variance, -np.inf)
    for fit in (found, again):  # from a law that has the shape already, too
        assert len(fit.hypotheses) == count
        own = fit.plain if fit.plain is not None and count == 1 else fit
        assert fit.log_posterior == own.log_likelihood - count * PRIOR_ODDS


def test_a_spring_that_is_believed_and_not_there_is_refitted_to_nothing() -> None:
    """A part that moves 20 mm each way and has 1 N of noise alone, beside a believed spring of 400 N there."""
    time = np.linspace(0.0, 20.0, 2001)
    x = 0.02 * np.sin(0.5 * np.pi * time)
    noise = np.random.default_rng(2).normal(size=time.size)
    tire = TireModel(PowerLaw(200.0, 1.0), tested_range=None, two_sided=True, inflated=False)
    dataset = dataset_of([Recording("free", time, x, np.full(time.size, np.inf), noise)], tire)
    law = discrepancy_of(dataset.misfit, 0.0)
    fit = fitted(dataset, [{REFITTED_LAW: law_start(dataset)}], law, law.highest, -np.inf)
    assert fit.power < 1.1 * fit.residual.size
