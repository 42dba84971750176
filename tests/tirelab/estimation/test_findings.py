"""Uncertainties of fitted parameters.

What is left beyond the noise: its size and share by definition, and what it depends on.
"""

from __future__ import annotations

from dataclasses import replace
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from drives import damped, flat_force
from radialtire import CATALOGUE, PowerLaw, TireModel
from tirelab.diagnosis.diagnose import diagnose
from tirelab.estimation.findings import (
    Remainder,
    _covariance,
    estimates_of,
    of_the_written_tire,
    remainder_of,
    significances_of,
)
from tirelab.estimation.fit import Fit, fitted
from tirelab.estimation.problem import with_readings
from tirelab.recordings.recording import Recording
from tirelab.regressors.dataset import dataset_of
from tirelab.selection.search import discrepancy_of


def test_the_covariance_is_that_of_the_posterior() -> None:
    """(S^T S + 1)^-1, by the textbook's formula where that is well conditioned, for more and for fewer samples."""
    for samples in (40, 3):
        slopes = np.random.default_rng(1).normal(size=(samples, 5))
        np.testing.assert_allclose(
            _covariance(slopes), np.linalg.inv(slopes.T @ slopes + np.eye(5)), rtol=1e-9, atol=1e-12
        )


def test_no_variance_is_negative_where_the_data_know_a_sum_far_better_than_its_parts() -> None:
    """Two equal columns of 1e9: the sum is known, of the difference the prior is all: variance 1/2 for each."""
    alike = 1e9 * np.ones((50, 2)) / np.sqrt(50.0)
    found = _covariance(np.column_stack([alike, np.linspace(0.0, 1e-3, 50)]))
    assert np.all(np.diag(found) > 0.0)
    np.testing.assert_allclose(np.diag(found)[:2], 0.5, rtol=1e-6)


def test_a_parameter_is_known_no_better_than_the_equation_that_it_is_of() -> None:
    """A dashpot of 5000 N s/m beside 5 N of noise, which alone would give it to a thousandth."""
    verdict = diagnose([damped(6, damping=5000.0)], catalogue=["viscous_damping"])
    found = verdict.effects[0].parameters["damping"]
    declared = CATALOGUE["viscous_damping"].form_error
    assert declared < found.std / found.value < 2.0 * declared


DATASET = dataset_of([damped(6, samples=4000)], TireModel())
SIZE = DATASET.misfit.size
WHITE = np.random.default_rng(8).normal(size=SIZE)


def left(values: np.ndarray, form_error: float = 0.0, beyond_forms: float | None = None) -> Any:
    power = float(values @ values)
    return SimpleNamespace(
        problem=SimpleNamespace(dataset=DATASET),
        residual=values,
        power=power,
        form_error=form_error,
        beyond_forms=power if beyond_forms is None else beyond_forms,
    )


def test_noise_alone_is_no_remainder() -> None:
    found = remainder_of(left(WHITE / np.sqrt(np.mean(WHITE**2))))
    # The sum of squares is rounded, and the size is its root.
    assert found.size < 1e-6
    assert found.depends == ()
    assert not found.unexplained


def test_share_and_size_are_those_of_what_is_beyond_the_noise() -> None:
    found = remainder_of(left(np.full(SIZE, 3.0)))
    missed = float(DATASET.misfit @ DATASET.misfit) - SIZE
    assert found.share == pytest.approx(min(8.0 * SIZE / missed, 1.0))
    (e,) = DATASET.experiments
    assert found.force == pytest.approx(np.sqrt(8.0) * e.noise)
    assert found.size == pytest.approx(np.sqrt(8.0) * e.noise / e.floor.level)


def test_a_remainder_is_counted_in_newtons_over_all_samples() -> None:
    """Of two recordings alike but for a tenth of the noise, a quarter of the block, what the quiet one leaves is small.

    Ten noises left in a quiet block are one of a loud one: of its samples, a fifth of all, the mean square is 99/100.
    """
    (loud,) = DATASET.experiments
    quiet = replace(loud, noise=0.1 * loud.noise, blocks=replace(loud.blocks, size=loud.size // 4))
    dataset = replace(DATASET, experiments=(loud, quiet))
    values = np.concatenate([np.ones(SIZE), np.full(SIZE, 10.0)])
    fit = left(values)
    fit.problem = SimpleNamespace(dataset=dataset)
    part = quiet.size / (quiet.size + loud.size)
    assert remainder_of(fit).force == pytest.approx(np.sqrt(part * 0.99) * loud.noise)


def test_a_remainder_that_follows_the_deflection_is_said_to_depend_on_it_where_it_is() -> None:
    (e,) = DATASET.experiments
    x = e.deflection[e.counts]
    low, high = np.quantile(x, [0.6, 0.8])
    found = remainder_of(left(WHITE + 8.0 * ((x > low) & (x < high))))
    # The force is the deflection's: both may be first.
    by = {d.coordinate: d for d in found.depends}
    assert found.depends[0].coordinate in ("deflection", "force")
    assert low - 1e-3 < by["deflection"].begin < by["deflection"].end < high + 1e-3
    assert "time" not in by or by["deflection"].share > 2.0 * by["time"].share


def test_what_forms_account_for_is_no_unknown() -> None:
    """Root mean square 3 is 8 noises of power: with forms that explain 6 of them a quarter is left, size sqrt(2)."""
    whole = np.full(SIZE, 3.0)
    (e,) = DATASET.experiments
    unit = e.noise / e.floor.level
    found = remainder_of(left(whole, beyond_forms=3.0 * SIZE))
    assert found.of_forms == pytest.approx(0.75)
    assert found.size == pytest.approx(np.sqrt(8.0) * unit)
    # The same by forms that may miss twice the noise in every case: 4 of the 8, and 2 with what they explain.
    assert remainder_of(left(whole, form_error=2.0)).of_forms == pytest.approx(0.5)
    assert remainder_of(left(whole, form_error=2.0, beyond_forms=7.0 * SIZE)).of_forms == pytest.approx(0.75)
    assert remainder_of(left(whole, beyond_forms=0.9 * SIZE)).of_forms == 1.0


def test_a_small_share_of_the_misfit_is_unexplained_only_beyond_the_forms() -> None:
    """Five noises left, of which the forms account for 98 %: 0.7 noises. Of a tenth of the misfit no form counts."""
    assert not Remainder(0.01, 5.0, 5.0, (), of_forms=0.98).unexplained
    assert Remainder(0.01, 5.0, 5.0, (), of_forms=0.9).unexplained
    assert Remainder(0.2, 5.0, 5.0, (), of_forms=0.98).unexplained
    assert not Remainder(0.2, 0.9, 0.9, ()).unexplained


COMPARED = Remainder(0.02, 0.5, 0.5, ())


def test_what_is_left_at_turns_alone_is_a_remainder_of_the_written_tire() -> None:
    """Fifty samples of each turn miss 20 N beside noise of 1 N: mean square 20 of 2000 samples, 21 with the noise."""
    after = WHITE[:2000] / np.std(WHITE[:2000])
    after[500:550] += 20.0
    after[1500:1550] -= 20.0
    found = of_the_written_tire(COMPARED, [10.0 * after], [after], 1.0)
    assert found.force**2 == pytest.approx(20.0, rel=0.1)
    assert found.size == found.force
    assert found.share == pytest.approx(20.0 / (100.0 * 21.0 - 1.0), rel=0.1)
    assert found.uncompared == pytest.approx(1.0 - 0.25 / 20.0, rel=0.01)


def test_single_samples_that_stand_out_are_no_remainder() -> None:
    after = WHITE[:2000] / np.std(WHITE[:2000])
    after[100::200] = 100.0
    assert of_the_written_tire(COMPARED, [after], [after], 1.0) == COMPARED


def test_the_preload_of_a_part_is_no_factor_of_its_law() -> None:
    """F = 100 N + 10 N/mm x, where 10 N/mm x is believed: the mean of 1000 samples of 1 N is known to 0.03 N."""
    time = 0.02 * np.arange(1000)
    x = 0.01 * np.sin(0.4 * np.pi * time)
    force = 100.0 + 1e4 * x + np.random.default_rng(0).standard_normal(time.size)
    part = TireModel(PowerLaw(100.0, 1.0), two_sided=True, inflated=False)
    one = Recording("part", time, x, np.full(time.size, np.inf), force)
    (law,) = diagnose(one, part, catalogue=("recalibration",)).effects
    assert law.parameters["preload"].value == pytest.approx(100.0, abs=1.0)
    assert law.parameters["preload"].unit == "N"
    assert 0.03 < law.parameters["preload"].std < 1.0
    factor = law.parameters["log factor on A, flat"]
    # The force of the spring is 71 N root mean square: the slope is known to 1 / 71 / 1000 ** 0.5.
    assert factor.value == pytest.approx(0.0, abs=0.005)
    assert factor.std < 0.01


def fit_of_a_late_force() -> Fit:
    """A force that follows 20 ms late by our own low-pass, on slow cycles beside 5 N of noise, fitted with a delay."""
    time = np.arange(0.0, 20.0, 0.01)
    deflection = 0.011 * (1.0 - np.cos(2.0 * np.pi * 0.2 * time))
    force, late = flat_force(deflection), [0.0]
    for value in force[1:]:
        late.append(np.exp(-0.5) * late[-1] + (1.0 - np.exp(-0.5)) * value)
    reading = np.array(late) + 5.0 * np.random.default_rng(4).normal(size=time.size)
    flat = np.full(time.size, np.inf)
    dataset = dataset_of([Recording("late", time, deflection, flat, reading)], TireModel())
    start = {"force_lag": with_readings("force_lag", (0.01, 0.01, 0.5), dataset)}
    discrepancy = discrepancy_of(dataset.misfit, 0.01)
    return fitted(dataset, [start], discrepancy, discrepancy.usual, -np.inf)


def test_a_sum_is_known_where_its_parts_are_not() -> None:
    """A low-pass and a delay do the same to slow cycles: neither is known alone, that the force is late is sure."""
    fit = fit_of_a_late_force()
    own = {p.name: p for p in estimates_of(fit)}
    assert all(own[name].value < 2.0 * own[name].deviation for name in ("lag", "delay"))
    assert significances_of(fit)["force_lag"] > 0.999


def test_parameters_that_are_neutral_are_not_significant() -> None:
    """With V so large that the recording tells nothing, they differ from neutral as far as their prior lets them."""
    fit = replace(fit_of_a_late_force(), variance=1e12)
    assert significances_of(fit)["force_lag"] < 0.95
