"""The correction judged on held-out data."""

import numpy as np
import pytest
from drives import damped, ride
from tirelab.diagnosis.diagnose import diagnose


def test_the_fit_does_not_use_the_held_out_recording(unequal_verdict):
    """Damping of 500 N s/m in the fitted recording, 200 in the held-out one, the last.

    Fitted to the first alone the correction is 300 too strong on the second, where the baseline misses 200. Fitted to
    both it would be 350, as far off as the baseline. Beside it are 5 N of noise and 5 um at a stiffness of 80 kN/m.
    """
    assert unequal_verdict.names == ("viscous_damping",)
    assert unequal_verdict.fit.held_out_by == "recording ride 2"
    rate = float(np.sqrt(np.mean(ride(2)[2] ** 2)))
    assert unequal_verdict.fit.held_out_before == pytest.approx(
        np.sqrt(5.0**2 + 0.4**2 + (200.0 * rate) ** 2), rel=0.03
    )
    assert unequal_verdict.fit.held_out_after == pytest.approx(
        np.sqrt(5.0**2 + 0.4**2 + (300.0 * rate) ** 2), rel=0.03
    )


def test_the_end_of_a_single_recording_is_held_out():
    verdict = diagnose([damped(3)])
    # 29.995 s of which the first 70 % are fitted.
    assert verdict.fit.held_out_by == "time block 21-30 s"
    assert verdict.fit.held_out_after < 0.5 * verdict.fit.held_out_before


def test_given_recordings_are_preferred(damped_run):
    assert damped_run.verdict.fit.held_out_by == "recordings given"


def test_where_nothing_is_missing_both_errors_are_the_noise(complete_verdict):
    assert complete_verdict.names == ()
    assert complete_verdict.fit.held_out_after == complete_verdict.fit.held_out_before
    assert complete_verdict.fit.held_out_after == pytest.approx(5.0, rel=0.05)
