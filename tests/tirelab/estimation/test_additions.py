"""What is promised of a candidate, and where its fit starts, on a ride of 500 N s/m of damping under 5 N of noise."""

from __future__ import annotations

import numpy as np
import pytest
from tirelab.estimation.additions import additions, predicted_gains
from tirelab.estimation.fit import fitted
from tirelab.regressors.dataset import Dataset
from tirelab.regressors.signature import Signature
from tirelab.selection.search import Discrepancy


def test_the_largest_promise_is_that_of_what_is_there(
    dataset: Dataset, signatures: tuple[Signature, ...], noise: Discrepancy
) -> None:
    nothing = fitted(dataset, [{}], noise, noise.highest, -np.inf)
    found = dict(zip([s.name for s in signatures], predicted_gains(signatures, nothing, noise), strict=True))
    assert max(found, key=found.__getitem__) == "viscous_damping"
    # A law of the deflection follows nothing of a force of the rate, and may not gain by that.
    assert found["recalibration"] < 0.1 * found["viscous_damping"]


def test_a_candidate_begins_at_the_drawn_form_and_size_that_come_nearest(
    dataset: Dataset, signatures: tuple[Signature, ...]
) -> None:
    damper = next(s for s in signatures if s.name == "viscous_damping")
    drawn = 3
    missing = 2.0 * damper.sizes[drawn] * damper.curves[drawn]
    first = additions(damper, missing, np.zeros((missing.size, 0)), 1.0, dataset)[0]
    # Damping is linear: twice the response has twice the coefficient, and the same form beside it.
    assert first[0] == pytest.approx(2.0 * damper.values[drawn][0], rel=1e-6)
    assert first[1:] == pytest.approx(damper.values[drawn][1:])
