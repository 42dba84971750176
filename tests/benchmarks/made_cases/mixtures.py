"""Two to four causes at once."""

from __future__ import annotations

import numpy as np

from .case import Bench, Drawn, case
from .materials import decaying, friction, law
from .oscillations import THREE, sines
from .presses import HELD, PRESS, one


@case("rate_independent_hysteresis + viscoelastic_relaxation")
def friction_and_relaxation(bench: Bench) -> Drawn:
    """A loop of 10 % and a time constant of 4 s, two holds of 20 s."""
    x = HELD.deflection
    force = law(x)
    slow = 0.08 * decaying(force, HELD.step, 4.0)
    return one(bench, HELD, np.maximum(force + slow + 0.05 * force * friction(x, 6e-4), 0.0))


@case("deflection_offset + viscous_damping")
def damping_and_zero_of_the_gauge(bench: Bench) -> Drawn:
    """250 N s/m, and 0.5 mm too much."""
    return sines(bench, THREE, lambda m: law(m.deflection - 5e-4) + 250.0 * m.rate)


@case("recalibration + rate_independent_hysteresis")
def friction_beside_another_law(bench: Bench) -> Drawn:
    """A loop of 10 % beside a polynomial of the second degree."""
    x = PRESS.deflection
    return one(bench, PRESS, (30e3 * x + 1.1e6 * x**2) * (1.0 + 0.05 * friction(x, 6e-4)))


@case("deflection_offset + rate_independent_hysteresis + saturation + viscous_damping")
def four_at_once(bench: Bench) -> Drawn:
    """0.5 mm too much, a loop of 10 %, 250 N s/m and a ceiling at 520 N."""
    return sines(
        bench,
        THREE,
        lambda m: np.minimum(
            law(m.deflection - 5e-4) * (1.0 + 0.05 * friction(m.deflection, 6e-4)) + 250.0 * m.rate, 520.0
        ),
    )
