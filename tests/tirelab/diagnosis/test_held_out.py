"""The correction judged on what it was not fitted to."""

import numpy as np
import pytest
from drives import flat_force, read, ride
from tirelab.diagnosis.diagnose import diagnose


def damped(seed, damping=500.0):
    time, deflection, rate = ride(seed)
    return read(f"ride {seed}", time, deflection, flat_force(deflection) + damping * rate, seed)


def test_of_two_recordings_the_last_one_is_held_out():
    verdict = diagnose([damped(1), damped(2)])
    assert verdict.fit.held_out_by == "recording ride 2"
    assert verdict.fit.held_out_after < 0.5 * verdict.fit.held_out_before


def test_the_end_of_a_single_recording_is_held_out():
    verdict = diagnose([damped(3)])
    # 29.995 s of which the first 70 % are fitted.
    assert verdict.fit.held_out_by == "time block 21-30 s"
    assert verdict.fit.held_out_after < 0.5 * verdict.fit.held_out_before


def test_what_is_fitted_did_not_see_what_is_held_out():
    # Damping 500 in the first recording, none in the second: fitted to the first alone it does harm on the second.
    verdict = diagnose([damped(1), damped(2, damping=0.0)])
    if verdict.names:
        assert verdict.fit.held_out_after >= 0.9 * verdict.fit.held_out_before


def test_given_recordings_are_preferred():
    verdict = diagnose([damped(1)], held_out=[damped(2)])
    assert verdict.fit.held_out_by == "recordings given"


def test_where_nothing_is_missing_both_errors_are_those_of_the_believed_tire():
    verdict = diagnose([damped(1, damping=0.0)])
    assert verdict.names == ()
    assert verdict.fit.held_out_after == pytest.approx(verdict.fit.held_out_before)
    assert np.isfinite(verdict.fit.held_out_after)
