"""A part's force that no power of the deflection follows: a cubic spline along forces, nothing at no deflection."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from driving import drive, values_of
from numpy.typing import NDArray
from radialtire import CATALOGUE, PowerLaw, TireModel
from scipy.interpolate import BSpline

LAW = PowerLaw(200.0, 1.3)
FORCES = np.random.default_rng(5).uniform(-80.0, 80.0, 10)


def part(lowest: float, highest: float, forces: NDArray[np.float64] = FORCES) -> TireModel:
    values = {f"force_{i + 1}": float(force) for i, force in enumerate(forces)}
    effect = CATALOGUE["part_shape"]
    shape = values_of(effect, lowest=lowest, highest=highest, **values)
    return TireModel(LAW, ((effect, shape),), two_sided=True, preload=30.0, inflated=False)


def added(tire: TireModel, x: np.ndarray) -> np.ndarray:
    """What it adds to the force of the law."""
    time = np.arange(float(x.size))
    return np.asarray(drive(tire, time, x) - drive(replace(tire, effects=()), time, x))


@pytest.mark.parametrize(("lowest", "highest"), [(-0.006, 0.018), (0.0, 0.02), (0.004, 0.012)])
def test_the_curve_is_a_cubic_spline_and_constant_beyond_its_ends(lowest: float, highest: float) -> None:
    x = np.linspace(-0.01, 0.025, 701)
    spline = BSpline(lowest + (highest - lowest) / 7.0 * np.arange(-3.0, 11.0), FORCES, 3)
    curve, at_zero = (spline(np.clip(where, lowest, highest)) for where in (x, 0.0))
    np.testing.assert_allclose(added(part(lowest, highest), x), curve - at_zero, atol=1e-9)


def test_forces_on_a_line_make_a_line() -> None:
    x = np.linspace(-0.005, 0.015, 41)
    line = part(-0.005, 0.015, 30.0 * np.arange(10.0))
    np.testing.assert_allclose(added(line, x), 30.0 * 7.0 * x / 0.02, atol=1e-9)


def test_its_ends_lie_wherever_a_part_may_be_deflected() -> None:
    furthest = part(0.0, 1.0).deflection_highest
    line = part(-furthest, furthest, 30.0 * np.arange(10.0))
    x = np.array([-0.9, 0.0, 0.9]) * furthest
    np.testing.assert_allclose(added(line, x), 30.0 * 7.0 * x / (2.0 * furthest), rtol=1e-9, atol=1e-9)


def test_with_no_deflection_there_is_the_preload_alone() -> None:
    assert drive(part(-0.01, 0.01), [0.0], [0.0])[0] == pytest.approx(30.0, abs=1e-12)


def test_what_softens_the_law_softens_the_curve_too() -> None:
    """Half the force is lost at once far below the largest deflection, whatever gives it."""
    tire = part(-0.01, 0.02)
    softening = CATALOGUE["mullins_softening"]
    soft = replace(tire, effects=(*tire.effects, (softening, values_of(softening, share=0.5, ratio=0.005))))
    time, x = np.arange(3.0), np.array([0.0, 0.02, 0.004])
    assert drive(soft, time, x)[2] - 30.0 == pytest.approx(0.5 * (drive(tire, time, x)[2] - 30.0), rel=1e-9)


def test_a_tire_in_the_air_has_no_force() -> None:
    tire = replace(part(0.0, 0.02), two_sided=False, preload=0.0)
    assert drive(tire, np.arange(2.0), np.array([-0.001, 0.0])).tolist() == [0.0, 0.0]
