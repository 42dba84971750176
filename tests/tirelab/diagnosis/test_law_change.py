"""A refitted law by its coefficients and the curve of its difference, against the equation typed here."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
from radialtire import CATALOGUE, TireModel
from radialtire.recalibrated import Recalibrated
from tirelab.diagnosis.law_change import MOST_SURFACES, law_changes
from tirelab.estimation.findings import Estimate
from tirelab.recordings.recording import Recording


def pressed(radius: float, deepest: float = 0.02) -> Recording:
    time = np.linspace(0.0, 10.0, 200)
    deflection = deepest * (1.0 - np.abs(1.0 - 0.2 * time))
    return Recording("press", time, deflection, np.full(200, radius), 1e5 * deflection)


BASELINE = TireModel()
LAW = Recalibrated(surfaces=((math.inf, 0.2, -0.05), (0.127, -0.1, 0.03)))
CORRECTED = replace(BASELINE, law=LAW)
ESTIMATES = {
    "log factor on A, flat": Estimate(0.2, 0.01, "1"),
    "change of B, flat": Estimate(-0.05, 0.002, "1"),
}


def test_coefficients_before_and_after_with_their_deviations() -> None:
    convex, flat = reversed(law_changes(BASELINE, CORRECTED, ESTIMATES, [pressed(math.inf), pressed(0.127)]))
    convex, flat = (convex, flat) if convex.radius == 0.127 else (flat, convex)
    assert flat.before == pytest.approx((550.9, 1.422))
    assert flat.after == pytest.approx((550.9 * math.exp(0.2), 1.372))
    assert flat.std == pytest.approx((550.9 * math.exp(0.2) * 0.01, 0.002))
    assert convex.after[0] == pytest.approx(convex.before[0] * math.exp(-0.1))
    assert convex.std is None
    assert flat.to_dict()["radius"] == "inf"
    assert convex.to_dict()["A"] == {"before": convex.before[0], "after": convex.after[0], "std": None}


def test_the_curve_is_the_difference_of_two_powers() -> None:
    (flat,) = law_changes(BASELINE, CORRECTED, {}, [pressed(math.inf, 0.015)])
    cm = 100.0 * flat.deflection
    assert flat.deflection[-1] == pytest.approx(0.015, rel=0.02)
    expected = 550.9 * math.exp(0.2) * cm**1.372 - 550.9 * cm**1.422
    assert flat.difference == pytest.approx(expected, abs=1e-9)


def test_the_bend_belongs_to_the_law_and_friction_does_not() -> None:
    def with_effects(**values: tuple[float, ...]) -> TireModel:
        return replace(CORRECTED, effects=tuple((CATALOGUE[n], v) for n, v in values.items()))

    bent = with_effects(elastic_shape=(0.05, 0.0, 0.0125, *[0.0] * 5), force_offset=(40.0,))
    (plain,) = law_changes(BASELINE, CORRECTED, {}, [pressed(math.inf)])
    (curved,) = law_changes(BASELINE, bent, {}, [pressed(math.inf)])
    x = curved.deflection[1:]
    force = 550.9 * math.exp(0.2) * (100.0 * x) ** 1.372
    bend = np.exp(0.05 * np.log(np.maximum(x / 0.0125, 0.01)) ** 2)
    assert (curved.difference - plain.difference)[1:] == pytest.approx(force * (bend - 1.0), abs=1e-9)


def test_surfaces_go_from_concave_to_convex_and_terrain_is_thinned() -> None:
    made = law_changes(BASELINE, CORRECTED, {}, [pressed(r) for r in (0.127, math.inf, -0.3)])
    assert [change.radius for change in made] == [-0.3, math.inf, 0.127]
    terrain = law_changes(BASELINE, CORRECTED, {}, [pressed(r) for r in np.linspace(0.1, 0.9, 30)])
    assert len(terrain) == MOST_SURFACES
    assert (terrain[0].radius, terrain[-1].radius) == pytest.approx((0.9, 0.1))


def test_one_change_for_all_surfaces_counts_for_each() -> None:
    shared = {
        "log factor on A, all surfaces": Estimate(0.2, 0.01, "1"),
        "change of B, all surfaces": Estimate(0.0, 0.003, "1"),
    }
    (flat,) = law_changes(BASELINE, CORRECTED, shared, [pressed(math.inf)])
    assert flat.std is not None
    assert flat.std[1] == 0.003
