"""The elastic laws of parts, which are no power of the deflection."""

from __future__ import annotations

import numpy as np
import pytest
from concealed.part_laws import PartLaw, drawn_part_law

STROKE = np.linspace(-1.0, 1.0, 2001)
DRAWN = [drawn_part_law(np.random.default_rng(seed)) for seed in range(60)]


@pytest.mark.parametrize("law", DRAWN)
def test_its_stiffness_is_that_of_a_spring(law: PartLaw) -> None:
    """In units of that at small deflections or of the first stage, where five is the second at most; an exponential
    over 0.3 of the stroke is stiffer by exp(1 / 0.3) at its end, a softening one as much as 4 exp(-2 / 0.3) less.
    """
    slope = np.gradient(law(STROKE), STROKE)
    assert slope.min() > 0.9 * 4.0 * np.exp(-2.0 / 0.3)
    assert slope.max() < 1.1 * np.exp(1.0 / 0.3)


def test_most_laws_are_far_from_a_straight_line() -> None:
    beside = []
    for law in DRAWN:
        force = law(STROKE)
        line = np.polyval(np.polyfit(STROKE, force, 1), STROKE)
        beside.append(np.std(force - line) / np.std(force))
    assert np.median(beside) > 0.05
    assert max(beside) > 0.3


def test_the_same_generator_draws_the_same_law() -> None:
    one, other = (drawn_part_law(np.random.default_rng(7))(STROKE) for _ in range(2))
    assert np.array_equal(one, other)
