"""How large an effect is in the force, from limits that can be written down.

The small curves of an effect: what it adds, and what it adds with a parameter half as large again.

A refitted law by its coefficients and the curve of its difference, against the equation typed here.
"""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
from radialtire import CATALOGUE, Hull1996, TireModel
from radialtire.recalibrated import Recalibrated
from tirelab.diagnosis.effect_figures import (
    MOST_SURFACES,
    effect_size,
    law_changes,
    load_of,
    sketch_of,
    without,
)
from tirelab.estimation.findings import Estimate
from tirelab.names import REFITTED_LAW
from tirelab.recordings.recording import Recording

TIME = np.arange(4000) * 1e-3
DEFLECTION = 0.01 - 0.004 * np.cos(2.0 * np.pi * TIME)
RECORDING = Recording("sine", TIME, DEFLECTION, np.full(4000, np.inf), np.full(4000, 300.0))


def tire(**effects: tuple[float, ...]) -> TireModel:
    return TireModel(effects=tuple((CATALOGUE[name], values) for name, values in effects.items()))


def test_an_offset_is_as_large_as_it_is() -> None:
    assert effect_size("force_offset", tire(force_offset=(22.0,)), TireModel(), [RECORDING]) == pytest.approx(
        22.0
    )


def test_damping_is_as_large_as_its_mean_rate() -> None:
    """The rate of the sine has the root mean square 2 pi f a / sqrt 2."""
    values = tuple(500.0 if p.name == "damping" else p.start for p in CATALOGUE["viscous_damping"].parameters)
    expected = 500.0 * 2.0 * np.pi * 0.004 / np.sqrt(2.0)
    found = effect_size("viscous_damping", tire(viscous_damping=values), TireModel(), [RECORDING])
    assert found == pytest.approx(expected, rel=0.01)


def test_a_law_twice_as_stiff_is_as_large_as_the_first() -> None:
    law = Hull1996()
    doubled = replace(TireModel(), law=replace(law, flat_coefficient=2.0 * law.flat_coefficient))
    force = law.coefficients(np.inf)[0] * (100.0 * DEFLECTION) ** law.coefficients(np.inf)[1]
    found = effect_size(REFITTED_LAW, doubled, TireModel(), [RECORDING])
    assert found == pytest.approx(np.sqrt(np.mean(force**2)), rel=1e-9)


def test_what_the_baseline_has_stays() -> None:
    baseline = tire(force_offset=(5.0,))
    corrected = tire(force_offset=(22.0,))
    assert without("force_offset", corrected, baseline).effects == baseline.effects
    assert effect_size("force_offset", corrected, baseline, [RECORDING]) == pytest.approx(17.0)


def test_a_refitted_law_takes_its_shape_with_it() -> None:
    bent = tire(elastic_shape=(0.05, 0.0, 0.0125, *[0.0] * 10))
    assert without(REFITTED_LAW, bent, TireModel()).effects == ()


def test_the_load_is_the_root_mean_square_of_the_force() -> None:
    assert load_of([RECORDING]) == pytest.approx(300.0)
    assert load_of([]) is None
    assert effect_size("force_offset", tire(force_offset=(1.0,)), TireModel(), []) is None


PRESS_TIME = np.linspace(0.0, 60.0, 3000)
PRESSED = 0.02 * (1.0 - np.abs(1.0 - 2.0 * ((PRESS_TIME / 4.0) % 1.0)))
PRESS = Recording("press", PRESS_TIME, PRESSED, np.full(3000, np.inf), 1e5 * PRESSED)


def tire_with(name: str, **given: float) -> TireModel:
    effect = CATALOGUE[name]
    return TireModel(
        effects=((effect, tuple(given.get(p.name, p.nominal_value) for p in effect.parameters)),)
    )


def test_an_offset_is_a_line_and_one_half_as_large_again() -> None:
    sketch = sketch_of("force_offset", tire_with("force_offset", offset=20.0), [PRESS])
    assert sketch is not None
    assert sketch.deflection.max() == pytest.approx(0.02, rel=0.02)
    assert sketch.force == pytest.approx(np.full(sketch.force.size, 20.0))
    assert sketch.varied["offset"] == pytest.approx(np.full(sketch.force.size, 30.0))


def test_damping_is_drawn_at_the_recorded_speed() -> None:
    """20 mm in 2 s are 10 mm/s: 500 N s/m make 5 N."""
    sketch = sketch_of("viscous_damping", tire_with("viscous_damping", damping=500.0), [PRESS])
    assert sketch is not None
    assert np.median(np.abs(sketch.force)) == pytest.approx(5.0, rel=0.1)


def test_what_is_slow_gets_the_length_of_a_recording() -> None:
    """A drift of 0.1 N/s adds 6 N in the 60 s of the recording."""
    sketch = sketch_of("force_drift", tire_with("force_drift", drift=0.1), [PRESS])
    assert sketch is not None
    assert sketch.force[-1] == pytest.approx(6.0)


@pytest.mark.parametrize("name", list(CATALOGUE))
def test_every_effect_has_curves_without_gaps(name: str) -> None:
    sketch = sketch_of(name, tire_with(name), [PRESS])
    assert sketch is not None
    assert list(sketch.varied) == [p.name for p in CATALOGUE[name].parameters]
    assert all(np.all(np.isfinite(curve)) for curve in (sketch.force, *sketch.varied.values()))


def test_what_is_not_there_has_no_sketch() -> None:
    assert sketch_of("inertia", TireModel(), [PRESS]) is None
    assert sketch_of("force_offset", tire_with("force_offset", offset=1.0), []) is None


def test_a_pressure_is_drawn_at_the_recorded_one_that_is_farthest() -> None:
    """Half of the reference pressure, all of the force the air's: half of the bare force is missing."""
    half = Recording(
        "soft", PRESS_TIME, PRESSED, PRESS.surface_radius, PRESS.force, pressure=np.full(3000, 1.5e5)
    )
    sketch = sketch_of("inflation_pressure", tire_with("inflation_pressure", gain=1.0, reference=3e5), [half])
    assert sketch is not None
    # the article's law on the flat at 2 cm: 550.9 N x 2^1.422
    assert sketch.force.min() == pytest.approx(-0.5 * 550.9 * 2.0**1.422, rel=0.05)


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

    bent = with_effects(elastic_shape=(0.05, 0.0, 0.0125, *[0.0] * 10), force_offset=(40.0,))
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
