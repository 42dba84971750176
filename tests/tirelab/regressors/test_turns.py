"""Turns of the motion within a sample."""

from __future__ import annotations

import numpy as np
from tirelab.regressors.turns import followed_turns, through_turns

NOISE = 1.0


def corners() -> tuple[np.ndarray, np.ndarray]:
    """Which of 40 samples are resolved, with turns at 10 to 11 and at 30, and a misfit without anything in it."""
    resolved = np.ones(40, dtype=bool)
    resolved[[10, 11, 30]] = False
    return resolved, np.zeros(40)


def test_what_acts_within_the_turn_alone_counts() -> None:
    resolved, misfit = corners()
    misfit[[10, 11, 30]] = -25.0
    assert followed_turns(misfit, resolved, NOISE).tolist() == (~resolved).tolist()


def test_what_depends_on_the_direction_does_not() -> None:
    """Friction and viscous damping change their sign with that of the rate."""
    resolved, misfit = corners()
    misfit[:10], misfit[12:30], misfit[31:] = 25.0, -25.0, 25.0
    assert not followed_turns(misfit, resolved, NOISE).any()


def test_each_turn_is_judged_by_itself() -> None:
    resolved, misfit = corners()
    misfit[:10] = 25.0
    assert np.flatnonzero(followed_turns(misfit, resolved, NOISE)).tolist() == [30]


def test_a_misfit_that_rises_with_the_deflection_counts() -> None:
    """The samples before and after are not read at the same deflection: they differ by less than a sample's rise."""
    resolved, misfit = corners()
    misfit[:10] = 20.0 * np.arange(10.0)
    misfit[12:22] = 190.0 - 20.0 * np.arange(10.0)
    misfit[10:12] = 199.0
    assert followed_turns(misfit, resolved, NOISE)[10:12].all()


def test_a_turn_at_the_end_of_a_recording_does_not_count() -> None:
    resolved = np.ones(12, dtype=bool)
    resolved[[1, 10, 11]] = False
    assert not followed_turns(np.zeros(12), resolved, NOISE).any()


def test_through_a_turn_the_rate_changes_evenly() -> None:
    """A triangle of 2 m/s: from 2 to -2 m/s within three steps of 0.1 s is -40/3 m/s^2."""
    time = 0.1 * np.arange(10)
    rate = np.where(np.arange(10) < 5, 2.0, -2.0)
    turns = np.zeros(10, dtype=bool)
    turns[[4, 5]] = True
    through, acceleration = through_turns(time, rate, np.zeros(10), turns)
    np.testing.assert_allclose(through[3:7], [2.0, 2.0 / 3.0, -2.0 / 3.0, -2.0], rtol=1e-12)
    np.testing.assert_allclose(acceleration[4:6], -40.0 / 3.0, rtol=1e-12)
    assert acceleration[[3, 6]].tolist() == [0.0, 0.0]
    assert rate[4] == 2.0
