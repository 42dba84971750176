"""A and B of one surface are those of least RMSE of the force, loading and unloading alike."""

from __future__ import annotations

import math

import numpy as np
import pytest
from presses import on, triangle
from scipy.optimize import curve_fit
from tirelab.identification.identify import identify
from tirelab.identification.power_fit import inner_products
from tirelab.identification.surfaces import surfaces_of


def test_a_surface_has_the_least_rmse_of_the_force() -> None:
    # the same problem by another solver, from far away
    recording = triangle(0.254, noise=10.0)
    loaded = recording.deflection > 0.0
    x, force = 100.0 * recording.deflection[loaded], recording.force[loaded]
    (A, B), _ = curve_fit(lambda x, A, B: A * x**B, x, force, p0=(100.0, 2.5))
    row = identify([recording]).surfaces[0]
    # one sample more in unloading than in loading makes weights of 1.007 and 0.993
    assert row.coefficient == pytest.approx(A, rel=2e-5)
    assert row.exponent == pytest.approx(B, rel=2e-5)
    assert row.rmse == pytest.approx(np.sqrt(np.mean((force - A * x**B) ** 2)), rel=2e-3)


def test_the_rmse_is_of_the_force_and_not_of_its_logarithm() -> None:
    recording = triangle(noise=30.0)
    found = identify([recording]).surfaces[0]
    positive = (recording.deflection > 0.0) & (recording.force > 0.0)
    B, ln_A = np.polyfit(np.log(100.0 * recording.deflection[positive]), np.log(recording.force[positive]), 1)
    of_logarithm = recording.force - np.exp(ln_A) * (100.0 * recording.deflection) ** B
    assert found.rmse < 0.98 * np.sqrt(np.mean(of_logarithm**2))


def test_the_inner_products_are_those_of_numpy() -> None:
    (surface,) = surfaces_of([triangle(noise=10.0)])
    (piece,) = surface.pieces
    weight = np.where(piece.branch > 0, surface.weights[1], surface.weights[2])
    power = np.exp(1.3 * piece.log_deflection)
    rows = np.stack([power, power * piece.log_deflection, piece.force - 500.0 * power])
    np.testing.assert_allclose(inner_products(surface, 500.0, 1.3), rows * weight @ rows.T, rtol=1e-12)


def test_loading_and_unloading_count_alike_however_many_samples_they_have() -> None:
    # 100 N between the branches, unloading sampled ten times as densely: the mean of both is the law, so what is left
    # is the sampling of the ramps (1/60 of the travel); counted by samples, A would be 41 N/cm^B too low
    up, down = np.linspace(0.0, 0.025, 60), np.linspace(0.025, 0.0, 600)
    x = np.concatenate([up, down])
    force = 550.9 * (100.0 * x) ** 1.422 + np.where(np.arange(x.size) < 60, 50.0, -50.0)
    found = identify([on(math.inf, x, force)])
    assert found.surfaces[0].coefficient == pytest.approx(550.9, rel=5e-3)
    assert found.surfaces[0].exponent == pytest.approx(1.422, rel=5e-3)
    assert found.surfaces[0].loop == pytest.approx(100.0, rel=0.02)
    assert any("loading and unloading differ by 100 N" in note for note in found.notes)


def test_what_happens_in_a_hold_plays_no_part() -> None:
    x = np.concatenate([np.linspace(0.0, 0.025, 200), np.full(2000, 0.025), np.linspace(0.025, 0.0, 200)])
    force = 550.9 * (100.0 * x) ** 1.422
    relaxed = np.where(np.arange(x.size) // 200 % 11 == 0, force, 0.8 * force)
    found = identify([on(math.inf, x, relaxed)])
    # the hold's neighbourhood of 4 % of the travel goes with it
    assert found.surfaces[0].coefficient == pytest.approx(550.9, rel=1e-9)
    assert any("samples at rest between loading and unloading are not used" in note for note in found.notes)


def test_one_branch_alone_is_said() -> None:
    x = np.linspace(0.0, 0.025, 100)
    found = identify([on(math.inf, x, 550.9 * (100.0 * x) ** 1.422)])
    assert any("only one of loading and unloading was recorded" in note for note in found.notes)
