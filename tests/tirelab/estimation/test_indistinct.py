"""Which sets the recordings cannot tell apart from the chosen one, with stand-ins for their fits."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from tirelab.estimation.indistinct import confounded, leaving_the_same


@pytest.mark.parametrize(
    ("left", "behind", "alike"),
    [(90.0, 11.5, True), (100.0, 30.0, True), (101.0, 11.5, False), (110.0, 2.0, True)],
)
def test_a_form_with_fewer_parameters_is_no_proof_against_one_that_leaves_as_little(
    left: float, behind: float, alike: bool
) -> None:
    """A lag with one constant leaves 100, a damping with seven leaves less and is far behind for that reason alone."""
    lag, damping, nothing = ("deflection_lag",), ("viscous_damping",), ()
    fits = {
        frozenset(n): SimpleNamespace(names=n, power=p)
        for n, p in ((lag, 100.0), (damping, left), (nothing, 1e4))
    }
    ranking: Any = SimpleNamespace(of=fits.get, behind=lambda fit: behind if fit.names == damping else 0.0)
    motion: Any = SimpleNamespace(alike=lambda name: damping, within_law=lambda name: False)
    chosen: Any = fits[frozenset(lag)]
    assert confounded(chosen, ranking, motion) == ((damping,) if alike else ())


def fit(
    *names: str, left: list[float], parameters: int = 1, beyond: bool = False, variance: float = 1.0
) -> Any:
    """A fit by hand that leaves these residuals, in units of the noise."""
    return SimpleNamespace(
        names=names,
        residual=np.array(left),
        held_out_residual=np.zeros(0),
        positions=np.zeros(parameters),
        variance=variance,
        out_of_range=beyond,
    )


def test_sets_leave_the_same_whose_forces_differ_by_what_noise_does() -> None:
    """Two fits of one parameter each follow two squares of noise; beyond that, one in log odds is two more squares."""
    lag = fit("deflection_lag", left=[1.0, 0.0])
    near = fit("viscous_damping", left=[1.0, 1.9])
    far = fit("inertia", left=[1.0, 2.1])
    assert leaving_the_same(lag, [lag, near, far]) == (("viscous_damping",),)


def test_beside_a_discrepancy_more_is_the_same() -> None:
    """With V = 4 a difference counts a quarter: 10 squares of which 2 are noise are one in log odds."""
    lag = fit("deflection_lag", left=[1.0, 0.0], variance=4.0)
    near = fit("viscous_damping", left=[1.0, 3.1])
    far = fit("inertia", left=[1.0, 3.2])
    assert leaving_the_same(lag, [lag, near, far]) == (("viscous_damping",),)


def test_only_another_set_of_no_more_effects_within_its_range_leaves_the_same() -> None:
    both = fit("deflection_lag", "recalibration", left=[0.0, 0.0])
    part, more = fit("deflection_lag", left=[0.0, 0.0]), fit("a", "b", "c", left=[0.0, 0.0])
    beyond = fit("force_lag", "recalibration", left=[0.0, 0.0], beyond=True)
    other = fit("viscous_damping", "recalibration", left=[0.0, 0.0])
    found = leaving_the_same(both, [both, part, more, beyond, other])
    assert found == (("viscous_damping", "recalibration"),)


def test_held_out_recordings_tell_sets_apart_that_leave_the_same_of_the_fitted_ones() -> None:
    lag, damping = (fit(n, left=[0.0]) for n in ("deflection_lag", "viscous_damping"))
    assert leaving_the_same(lag, [damping]) == (("viscous_damping",),)
    damping.held_out_residual, lag.held_out_residual = np.array([3.0]), np.array([0.0])
    assert leaving_the_same(lag, [damping]) == ()
