"""The FMU of a correction: deflection in and out, the additional force, and its limits."""

import math
from pathlib import Path

import fmpy
import numpy as np
import pytest
from drives import ride
from radialtire import CATALOGUE, PowerLaw, TireModel
from tirelab.errors import TirelabError
from tirelab.fmu.build import Correction, build_correction
from tirelab.fmu.replay import driven

LAW = PowerLaw(coefficient=1000.0, exponent=1.0)
"""100 kN/m."""

COMPLIANCE, OFFSET = 1e-6, 0.001


def test_a_spring_in_series_and_an_offset_move_the_deflection(tmp_path: Path) -> None:
    """x_t = (x + 1 mm) / (1 + k / kappa), of two springs in a row; the additional force is what a drift adds."""
    parts = {
        "deflection_offset": {"offset": OFFSET},
        "series_compliance": {"compliance": COMPLIANCE},
        "force_drift": {"drift": 3.0},
    }
    effects = tuple(
        (e, tuple(parts[e.name].get(p.name, p.start) for p in e.parameters))
        for e in CATALOGUE.values()
        if e.name in parts
    )
    corrected = TireModel(law=LAW, effects=effects)
    time, x, _ = ride(3, samples=500)
    inputs = {"deflection": x, "surface_radius": np.full(x.size, math.inf), "simulated_force": 1e5 * x}
    drift = 3.0 * (time - time[0])
    inside = (x + OFFSET) / (1.0 + 1e5 * COMPLIANCE)

    fmu = build_correction(Correction(TireModel(law=LAW), corrected, math.inf, True), tmp_path / "moved").path
    np.testing.assert_allclose(driven(fmu, time, inputs, "tire_deflection"), inside, rtol=1e-9)
    np.testing.assert_allclose(driven(fmu, time, inputs, "additional_force"), drift, atol=1e-6)
    np.testing.assert_allclose(driven(fmu, time, inputs, "corrected_force"), 1e5 * x + drift, rtol=1e-9)

    fmu = build_correction(
        Correction(TireModel(law=LAW), corrected, math.inf, False), tmp_path / "added"
    ).path
    np.testing.assert_array_equal(driven(fmu, time, inputs, "tire_deflection"), x)
    np.testing.assert_allclose(
        driven(fmu, time, inputs, "additional_force"), 1e5 * (inside - x) + drift, atol=1e-6
    )


def test_what_no_tire_can_meet_is_refused_with_one_message(tmp_path: Path) -> None:
    fmu = build_correction(Correction(TireModel(law=LAW), TireModel(law=LAW), math.inf, False), tmp_path).path
    time = np.array([0.0, 0.1, 0.2])
    flat = {"surface_radius": np.full(3, math.inf), "simulated_force": np.zeros(3)}
    with pytest.raises(TirelabError, match=r"refused sample 1 .*deflection = 22 m is not allowed"):
        driven(fmu, time, {"deflection": np.array([0.0, 22.0, 0.0]), **flat}, "corrected_force")


def test_a_radius_of_zero_is_that_of_the_start(tmp_path: Path) -> None:
    """Hosts such as fmpy's for SSP give 0 before they have the first value."""
    fmu = build_correction(Correction(TireModel(law=LAW), TireModel(), -0.5, False), tmp_path).path
    time, x = np.array([0.0, 0.1]), np.array([0.01, 0.012])
    same = [
        driven(fmu, time, {"deflection": x, "surface_radius": np.full(2, radius)}, "additional_force")
        for radius in (0.0, -0.5)
    ]
    np.testing.assert_array_equal(*same)


def test_a_saved_state_goes_on_where_it_was(tmp_path: Path) -> None:
    damping = CATALOGUE["viscous_damping"]
    tire = TireModel(law=LAW, effects=((damping, damping.nominal),))
    path = build_correction(Correction(TireModel(law=LAW), tire, math.inf, False), tmp_path).path
    description = fmpy.read_model_description(str(path))
    fmu = fmpy.instantiate_fmu(fmpy.extract(str(path), tmp_path / "out"), description, "CoSimulation")
    fmu.setupExperiment(startTime=0.0)
    fmu.enterInitializationMode()
    fmu.setReal([0], [0.01])
    fmu.exitInitializationMode()

    def on(sample: int) -> float:
        fmu.setReal([0], [0.01 + 0.001 * sample])
        fmu.doStep(0.01 * (sample - 1), 0.01)
        return float(fmu.getReal([4])[0])

    on(1)
    state = fmu.getFMUState()
    first = [on(2), on(3)]
    fmu.setFMUState(state)
    assert [on(2), on(3)] == first
    assert first[1] == pytest.approx(damping.nominal[0] * 0.1, rel=0.2)
    fmu.terminate()
    fmu.freeInstance()
