"""The small curves of an effect: what it adds, and what it adds with a parameter half as large again."""

from __future__ import annotations

import numpy as np
import pytest
from radialtire import CATALOGUE, TireModel
from tirelab.diagnosis.effect_sketch import sketch_of
from tirelab.recordings.recording import Recording

TIME = np.linspace(0.0, 60.0, 3000)
DEFLECTION = 0.02 * (1.0 - np.abs(1.0 - 2.0 * ((TIME / 4.0) % 1.0)))
RECORDING = Recording("press", TIME, DEFLECTION, np.full(3000, np.inf), 1e5 * DEFLECTION)


def tire(name: str, **given: float) -> TireModel:
    effect = CATALOGUE[name]
    return TireModel(
        effects=((effect, tuple(given.get(p.name, p.nominal_value) for p in effect.parameters)),)
    )


def test_an_offset_is_a_line_and_one_half_as_large_again() -> None:
    sketch = sketch_of("force_offset", tire("force_offset", offset=20.0), [RECORDING])
    assert sketch is not None
    assert sketch.deflection.max() == pytest.approx(0.02, rel=0.02)
    assert sketch.force == pytest.approx(np.full(sketch.force.size, 20.0))
    assert sketch.varied["offset"] == pytest.approx(np.full(sketch.force.size, 30.0))


def test_damping_is_drawn_at_the_recorded_speed() -> None:
    """20 mm in 2 s are 10 mm/s: 500 N s/m make 5 N."""
    sketch = sketch_of("viscous_damping", tire("viscous_damping", damping=500.0), [RECORDING])
    assert sketch is not None
    assert np.median(np.abs(sketch.force)) == pytest.approx(5.0, rel=0.1)


def test_what_is_slow_gets_the_length_of_a_recording() -> None:
    """A drift of 0.1 N/s adds 6 N in the 60 s of the recording."""
    sketch = sketch_of("force_drift", tire("force_drift", drift=0.1), [RECORDING])
    assert sketch is not None
    assert sketch.force[-1] == pytest.approx(6.0)


@pytest.mark.parametrize("name", list(CATALOGUE))
def test_every_effect_has_curves_without_gaps(name: str) -> None:
    sketch = sketch_of(name, tire(name), [RECORDING])
    assert sketch is not None
    assert list(sketch.varied) == [p.name for p in CATALOGUE[name].parameters]
    assert all(np.all(np.isfinite(curve)) for curve in (sketch.force, *sketch.varied.values()))


def test_what_is_not_there_has_no_sketch() -> None:
    assert sketch_of("inertia", TireModel(), [RECORDING]) is None
    assert sketch_of("force_offset", tire("force_offset", offset=1.0), []) is None


def test_a_pressure_is_drawn_at_the_recorded_one_that_is_farthest() -> None:
    """Half of the reference pressure, all of the force the air's: half of the bare force is missing."""
    half = Recording(
        "soft", TIME, DEFLECTION, RECORDING.surface_radius, RECORDING.force, pressure=np.full(3000, 1.5e5)
    )
    sketch = sketch_of("inflation_pressure", tire("inflation_pressure", gain=1.0, reference=3e5), [half])
    assert sketch is not None
    # the article's law on the flat at 2 cm: 550.9 N x 2^1.422
    assert sketch.force.min() == pytest.approx(-0.5 * 550.9 * 2.0**1.422, rel=0.05)
