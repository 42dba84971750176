"""Which sets a motion cannot tell apart from the chosen one, with stand-ins for their fits."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import pytest
from tirelab.estimation.explanation import _confounded


@pytest.mark.parametrize(
    ("left", "behind", "confounded"),
    [(90.0, 11.5, True), (100.0, 30.0, True), (101.0, 11.5, False), (110.0, 2.0, True)],
)
def test_a_form_with_fewer_parameters_is_no_proof_against_one_that_leaves_as_little(
    left: float, behind: float, confounded: bool
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
    assert _confounded(chosen, ranking, motion) == ((damping,) if confounded else ())
