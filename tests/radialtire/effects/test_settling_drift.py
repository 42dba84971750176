"""The time of a drift that settles: its first-order equation, its limits, and the switch between its two forms."""

import math

import pytest
from radialtire.effects.settling_drift import EVEN, drift_time


def test_it_solves_the_equation_of_a_rate_that_decays() -> None:
    """dT/dt = 1 - k T with T(0) = 0, stepped with the midpoint rule: its error is of order (k dt)^2, 1e-7 here."""
    settling, step, total = 0.5, 1e-3, 0.0
    for _ in range(4000):
        middle = total + 0.5 * step * (1.0 - settling * total)
        total += step * (1.0 - settling * middle)
    assert drift_time(4.0, settling) == pytest.approx(total, rel=1e-6)


def test_it_is_the_time_itself_without_settling_and_one_over_the_rate_in_the_end() -> None:
    assert drift_time(3.0, 0.0) == 3.0
    assert drift_time(1e6, 0.02) == pytest.approx(50.0, rel=1e-15)


def test_both_forms_meet() -> None:
    below, above = drift_time(1.0, EVEN), drift_time(1.0, math.nextafter(EVEN, 1.0))
    assert above == pytest.approx(below, rel=EVEN)
