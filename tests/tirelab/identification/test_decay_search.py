"""A search for the constants of equations 3 and 4 that starts where a difference has vanished still finds it."""

from __future__ import annotations

import math

import numpy as np
import pytest
from radialtire import Hull1996
from tirelab.article import press as rig
from tirelab.identification.decay_search import Target, elsewhere, nearest
from tirelab.identification.forms import HullForm

FORM = HullForm(rig.SURFACES)
LAW = Hull1996()
PAIRS = np.array([LAW.coefficients(radius) for radius in rig.SURFACES])
ROOTS = np.tile(np.diag(1.0 / PAIRS.max(axis=0)), (len(PAIRS), 1, 1))
TRUTH = np.log([550.9, 337.8 / 550.9, 0.2519, 7822.0, 0.1398, 1.422, 0.2469 / 1.422, 0.1651, 0.2128, 0.0289])


@pytest.mark.parametrize("at", [1, 3, 6, 8])
@pytest.mark.parametrize("decay", [1.0, 100.0])
def test_a_vanished_difference_is_found_again(at: int, decay: float) -> None:
    # with D at the bottom of its bounds neither D nor E has a slope
    start = TRUTH.copy()
    start[at : at + 2] = FORM.bounds[0][at], math.log(decay)
    found = nearest(Target(FORM, PAIRS, ROOTS), start, 1e-14, 500)
    np.testing.assert_allclose(FORM.coefficients(found), PAIRS, rtol=1e-9)


def test_the_best_has_no_better_place_elsewhere() -> None:
    target = Target(FORM, PAIRS, ROOTS)
    assert list(elsewhere(target, TRUTH, float(np.sum(target.errors(TRUTH) ** 2)))) == []
