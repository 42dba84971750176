"""Specimens of other stiffness, or mounted with another zero each, are said to differ, and what all of them show."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import pytest
from radialtire import PowerLaw, TireModel
from tirelab.diagnosis.between_recordings import Difference, difference_between
from tirelab.estimation.explanation import Explanation, explain_misfit
from tirelab.preprocessing.motion import motion_of
from tirelab.preprocessing.samples import Recorded
from tirelab.recordings.recording import Recording

TIRE = TireModel(PowerLaw(550.0, 1.42), tested_range=None)

NOISE = 2.0


def pressed(
    name: str, seed: int, factor: float = 1.0, *, zero: float = 0.0, offset: float = 0.0, ripple: float = 0.0
) -> Recording:
    """Three cycles of a tire F = 550 x^1.42 with 3000 N s/m of damping: its force times `factor`, plus `offset` [N],
    with another zero [m] of the deflection, and `ripple` [N] that depends on the time alone.
    """
    time = np.linspace(0.0, 36.0, 1200)
    phase = 2.0 * np.pi * time / 12.0
    x, rate = 0.011 * (1.05 - np.cos(phase)), 0.011 * 2.0 * np.pi / 12.0 * np.sin(phase)
    force = (
        factor * (550.0 * (100.0 * x) ** 1.42 + 3000.0 * rate) + offset + ripple * np.sin(7.3 * time + seed)
    )
    force += np.random.default_rng(seed).normal(0.0, NOISE, time.size)
    return Recording(name, time, x - zero, np.full(time.size, np.inf), force)


def explain(several: Sequence[Recorded]) -> Explanation:
    return explain_misfit(several, TIRE, ["viscous_damping"], lambda stage: None)


def difference(*several: Recording) -> Difference | None:
    motions = [motion_of(r.time, r.deflection) for r in several]
    return difference_between(explain(several), several, motions, explain)


def test_specimens_of_other_stiffness_differ_and_show_their_damping() -> None:
    found = difference(pressed("a", 1, 0.9), pressed("b", 2, 1.0), pressed("c", 3, 1.1))
    assert found is not None
    assert found.headline == "The recordings differ among themselves"
    # 1.1 / 0.9 = 1.222
    assert (
        found.as_if
        == "It is as if the force were up to 22 % larger in one than in another: least in a, most in c."
    )
    assert found.effects == ("viscous_damping",)
    assert found.without == pytest.approx(NOISE, rel=0.15)
    assert found.own > 5.0 * found.without
    assert "With that taken out, viscous damping explains them to" in found.finding
    assert found.action == "Check tire, pressure and zero of each, or diagnose them one by one."
    told = found.to_dict()
    assert told["recordings"] == ["a", "b", "c"]
    assert told["differs"] == "factor"
    # 0.9, 1 and 1.1, of which the mean is 1
    assert told["amounts"] == {
        name: pytest.approx(v, abs=0.01) for name, v in zip("abc", (-0.1, 0.0, 0.1), strict=True)
    }


def test_the_zero_of_the_deflection_may_differ() -> None:
    found = difference(pressed("a", 1), pressed("b", 2, zero=3e-4), pressed("c", 3, zero=-2e-4))
    assert found is not None
    # 0.3 and -0.2 mm, from the tangents at the mean of the three: known to 2 % and better
    assert found.as_if.startswith(
        (
            "It is as if the zero of the deflection were up to 0.50",
            "It is as if the zero of the deflection were up to 0.49",
        )
    )
    assert found.as_if.endswith("least in c, most in b.")


def test_the_zero_of_the_force_may_differ() -> None:
    found = difference(pressed("a", 1, offset=-30.0), pressed("b", 2), pressed("c", 3, offset=30.0))
    assert found is not None
    assert "the zero of the force were up to 60" in found.as_if


def test_what_is_alike_in_all_recordings_is_no_difference() -> None:
    """They are explained alike by damping, up to a ripple of 20 N in each that follows no motion."""
    alike = [pressed("a", 1, ripple=20.0), pressed("b", 2, ripple=20.0), pressed("c", 3, ripple=20.0)]
    assert explain(alike).remainder.unexplained
    assert difference(*alike) is None


def test_recordings_that_are_explained_are_not_compared() -> None:
    assert difference(pressed("a", 1), pressed("b", 2)) is None
