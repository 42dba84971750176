"""What is promised of a candidate, and where its fit starts, on a ride of 500 N s/m of damping under 5 N of noise."""

from __future__ import annotations

import numpy as np
import pytest
from tirelab.estimation.additions import additions, followed, not_followed, outside, predicted_gains
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


@pytest.mark.parametrize("size", [1.0, 1e6, 1e12])
def test_parameters_of_any_size_that_are_nearly_alike_leave_what_is_across_them(
    size: float, dataset: Dataset, signatures: tuple[Signature, ...]
) -> None:
    """Slopes of a gauge at its ceiling and of its form errors are the same columns, many times the noise."""
    damper = next(s for s in signatures if s.name == "viscous_damping")
    missing = 2.0 * damper.sizes[3] * damper.curves[3]
    depth = (dataset.deflection - dataset.deflection.mean()) / dataset.deflection.std()
    alike = size * np.column_stack([depth + 1e-9 * depth**k for k in range(12)])
    first = additions(damper, missing, alike, 1.0, dataset)[0]
    # A line over the deflection follows next to nothing of a damper.
    assert first[0] == pytest.approx(2.0 * damper.values[3][0], rel=0.02)


def test_a_candidate_follows_its_own_response_and_what_a_fitted_parameter_does_but_no_other(
    dataset: Dataset, signatures: tuple[Signature, ...], noise: Discrepancy
) -> None:
    damper, law = (next(s for s in signatures if s.name == n) for n in ("viscous_damping", "recalibration"))
    nothing = fitted(dataset, [{}], noise, noise.highest, -np.inf)
    damped = 100.0 * damper.mean
    assert not_followed(damper, damped, nothing, 1.0) == pytest.approx(0.0, abs=1e-6)
    assert not_followed(law, damped, nothing, 1.0) > 1e3
    assert not_followed(law, damped, nothing, 4.0) == pytest.approx(
        0.25 * not_followed(law, damped, nothing, 1.0)
    )
    # A thousandth of it is less than the noise and worth nothing, whoever follows it.
    assert not_followed(law, 1e-3 * damper.mean, nothing, 1.0) < 0.01
    beside = fitted(
        dataset, [{"viscous_damping": (500.0, 1.0, 0.0, 0.0, 1.0, 0.0, 0.0)}], noise, 1.0, -np.inf
    )
    assert not_followed(law, 10.0 * beside.slopes[:, 0], beside, 1.0) == pytest.approx(0.0, abs=1e-6)


def test_how_far_a_response_is_followed_is_a_cosine(
    dataset: Dataset, signatures: tuple[Signature, ...], noise: Discrepancy
) -> None:
    """Of a response and as much of a curve across it half of the power is followed: cos(45 degrees); the drift beside
    them, a few columns of 2000, turns them by hardly a hundredth.
    """
    nothing = fitted(dataset, [{}], noise, noise.highest, -np.inf)
    damper = next(s for s in signatures if s.name == "viscous_damping")
    own = damper.mean / np.linalg.norm(damper.mean)
    across = np.random.default_rng(1).standard_normal(own.size)
    across = outside(damper.columns)(across)
    across /= np.linalg.norm(across)
    assert followed(damper, own, nothing) == pytest.approx(1.0)
    assert followed(damper, across, nothing) == pytest.approx(0.0, abs=0.03)
    assert followed(damper, own + across, nothing) == pytest.approx(np.sqrt(0.5), abs=0.03)
