"""A shifted zero of the deflection."""

from __future__ import annotations

import numpy as np
import pytest
from driving import drive, only
from published import hull1996 as article
from radialtire import CATALOGUE, TireModel


def test_it_shifts_the_curve() -> None:
    x = np.linspace(-0.005, 0.03, 50)
    time = np.arange(x.size) * 0.1
    shifted = drive(only("deflection_offset", offset=1e-3), time, x)
    assert np.array_equal(shifted, drive(TireModel(), time, x + 1e-3))


def test_the_articles_offset_is_its_preload() -> None:
    # 1 mm, printed with one digit, is 22 N on flat ground: 1.04 mm
    force = drive(only("deflection_offset", offset=1.04 * article.OFFSET), [0.0], [0.0])
    assert force[0] == pytest.approx(article.PRELOAD, abs=0.1)


def test_a_tire_that_touched_late_has_no_force_before() -> None:
    force = drive(only("deflection_offset", offset=-1e-3), [0.0, 1.0, 2.0], [0.5e-3, 1e-3, 1.5e-3])
    assert list(force[:2]) == [0.0, 0.0]
    assert force[2] > 0.0


def test_it_is_what_the_gap_of_a_part_is() -> None:
    assert CATALOGUE["deflection_offset"].holds_gap
    assert not CATALOGUE["deflection_lag"].holds_gap
