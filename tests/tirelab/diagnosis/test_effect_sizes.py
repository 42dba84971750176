"""How large an effect is in the force, from limits that can be written down."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from radialtire import CATALOGUE, Hull1996, TireModel
from tirelab.diagnosis.effect_sizes import effect_size, load_of, without
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
    bent = tire(elastic_shape=(0.05, 0.0, 0.0125, *[0.0] * 5))
    assert without(REFITTED_LAW, bent, TireModel()).effects == ()


def test_the_load_is_the_root_mean_square_of_the_force() -> None:
    assert load_of([RECORDING]) == pytest.approx(300.0)
    assert load_of([]) is None
    assert effect_size("force_offset", tire(force_offset=(1.0,)), TireModel(), []) is None
