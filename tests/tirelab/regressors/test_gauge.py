"""The motion behind a gauge that steps: straight lines between the middles of its stays."""

from __future__ import annotations

import numpy as np
from tirelab.regressors.gauge import destepped


def test_a_ramp_read_in_steps_is_a_ramp_again() -> None:
    time = np.linspace(0.0, 10.0, 1001)
    ramp, step = 1e-3 * time, 1e-4
    read = step * np.round(ramp / step)
    inside = slice(60, -60)  # the first and the last stay have no middle of their own
    found = destepped(time, read, step)
    assert np.abs(found - ramp)[inside].max() < 0.06 * step
    assert np.abs(read - ramp)[inside].max() > 0.45 * step


def test_no_reading_is_moved_by_more_than_half_a_step() -> None:
    time = np.linspace(0.0, 10.0, 1001)
    read = 1e-4 * np.round(10.0 * np.sin(time))
    assert np.abs(destepped(time, read, 1e-4) - read).max() <= 0.5e-4 + 1e-15


def test_a_rest_on_one_level_stays_there() -> None:
    time = np.linspace(0.0, 10.0, 100)
    np.testing.assert_array_equal(destepped(time, np.full(100, 3e-3), 1e-4), np.full(100, 3e-3))
