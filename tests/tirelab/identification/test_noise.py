"""An autocorrelation that was corrected beyond what any noise can have."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.linalg import toeplitz
from tirelab.identification.noise import _possible


def test_one_that_grows_is_made_one_that_a_noise_can_have() -> None:
    """1, 0.99, -0.5 ...: of three samples in a row the first two are nearly the same, so the next two have to be."""
    impossible = np.array([1.0, 0.99, -0.5, 0.2, 0.0, 0.0, 0.0, 0.0])
    assert np.linalg.eigvalsh(toeplitz(impossible))[0] < -0.5
    possible = _possible(impossible)
    assert possible[0] == 1.0
    assert np.linalg.eigvalsh(toeplitz(possible))[0] > -1e-12


@pytest.mark.parametrize("memory", [0.0, 0.5, -0.5])
def test_one_that_fades_stays_as_it_is(memory: float) -> None:
    correlation = memory ** np.arange(40.0)
    assert _possible(correlation) == pytest.approx(correlation, abs=1e-9)
