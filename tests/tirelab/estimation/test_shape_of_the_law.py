"""A law of another shape beside effects that the deflection alone decides: a knee and another zero."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from drives import read, triangle
from radialtire import TireModel
from rivals import rivals
from tirelab.estimation.explanation import explain_misfit


@pytest.mark.parametrize("surfaces", [1, pytest.param(2, marks=pytest.mark.slow)])
def test_on_one_surface_a_law_of_another_shape_is_told_beside_a_knee(surfaces: int) -> None:
    """Another stiffness below 10 mm and a steeper one beyond: the tire's own law, or a rim under another law."""
    presses = []
    for n, radius in enumerate((np.inf, 0.127)[:surfaces]):
        time, deflection = triangle(samples=600, step=0.05)
        knee = 5e4 * 1e-3 * np.logaddexp(0.0, (deflection - 0.010) / 1e-3)
        A, B = TireModel().law.coefficients(radius)
        press = read(f"press {n}", time, deflection, 0.85 * A * (100.0 * deflection) ** B + knee, n)
        presses.append(replace(press, surface_radius=np.full(time.size, radius)))
    found = explain_misfit(presses, TireModel(), rivals("bottoming"), lambda stage: None)
    both = found.of(("recalibration", "bottoming"))
    assert (("recalibration",) in both.confounded) == (surfaces == 1)
    assert found.of(("recalibration",)).confounded == ()


@pytest.mark.parametrize(
    ("zero", "named"),
    [(0.4e-3, {"recalibration", "deflection_offset"}), (0.0, {"recalibration"})],
)
def test_a_zero_beside_another_law_is_no_less_likely_than_a_law_of_another_shape(
    zero: float, named: set[str]
) -> None:
    """620 (x + zero)^1.5 N; another A and B alone leave 4.6 N of it, a law of another shape next to nothing."""
    time, deflection = triangle()
    force = 620.0 * (100.0 * np.maximum(deflection + zero, 0.0)) ** 1.5
    press = read("press", time, deflection, force, 8, noise=5.0)
    found = explain_misfit([press], TireModel(), ("recalibration", "deflection_offset"), lambda stage: None)
    assert set(found.model.names) == named
