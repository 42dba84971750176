"""The search finds its way where a first guess misleads it."""

import numpy as np
import pytest
from drives import flat_force, read, ride, triangle
from tirelab.diagnosis import diagnose


@pytest.mark.parametrize("samples", [600, 1200, 3000])
@pytest.mark.parametrize("height", [20.0, 150.0])
def test_a_zero_that_drifts_is_neither_lift_off_nor_noise(height, samples):
    # The reading passes zero while the tire is loaded: where it does, the tire seems to have left the ground. Two
    # swings and a half in 12 to 60 s are slow, and four to thirty times the noise of 5 N.
    time, deflection = triangle(samples)
    wander = height * np.sin(2.0 * np.pi * 2.5 * time / time[-1] + 1.0)
    verdict = diagnose([read("triangle", time, deflection, flat_force(deflection) + wander, 21)])
    assert verdict.names == ("unknown",)
    assert verdict.fit.noise == pytest.approx(5.0, rel=0.1)


def test_two_zeros_that_are_off_are_not_taken_for_another_tire():
    time, deflection, _ = ride(22)
    force = flat_force(deflection + 1e-3) + 40.0
    verdict = diagnose([read("ride", time, deflection, force, 22)])
    either = [set(verdict.names), *(set(r.names) for r in verdict.rivals)]
    assert {"deflection_offset", "force_offset"} in either
