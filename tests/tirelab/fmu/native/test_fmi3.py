"""The FMI 3.0 twin of the native FMU in fmpy: the numbers of FMI 2.0 bit by bit, and what it refuses."""

from __future__ import annotations

import math
from ctypes import c_bool, c_char_p, c_double, c_size_t, c_uint, c_void_p
from pathlib import Path

import fmpy
import numpy as np
import pytest
from click.testing import CliRunner
from fmpy import simulate_fmu
from fmpy.fmi1 import FMICallException
from fmpy.fmi3 import FMU3Model
from native_fmi3 import DAMPED, FLAT, FORCE, RANGE, STIFFNESS, begun, opened
from native_tires import NOISE, drive, stepped, tires
from radialtire import CATALOGUE, Recalibrated, TireModel
from tirelab.cli.build import command
from tirelab.fmu.native.pack import build_native_fmu


@pytest.mark.parametrize("number", range(45))
def test_the_same_bits_as_in_python(tmp_path: Path, number: int) -> None:
    """Every law and effect, plain and with options, and random sets, on drives with air, reversals and pauses."""
    chosen = [*tires(8)]
    if number >= len(chosen):
        pytest.skip("there are fewer tires")
    _, tire = chosen[number]
    moments = drive(600, number)
    expected = stepped(tire, moments)
    with opened(tire, tmp_path) as unit:
        begun(unit, *moments[0])
        forces, before = unit.getFloat64([FORCE]), moments[0][2]
        for x, radius, time in moments[1:]:
            unit.setFloat64([0, 1], [x, radius])
            unit.doStep(before, time - before)
            forces += unit.getFloat64([FORCE])
            before = time
    assert forces == expected


def motion() -> np.ndarray:
    """One second of 3 Hz with the wheel in the air now and then, with rate and acceleration."""
    t = np.linspace(0.0, 1.0, 501)
    w = 6.0 * np.pi
    x = 0.008 + 0.012 * np.sin(w * t)
    names = ("time", "deflection", "surface_radius", "deflection_rate", "deflection_acceleration")
    columns = (t, x, np.full(t.size, 0.3), 0.012 * w * np.cos(w * t), -0.012 * w * w * np.sin(w * t))
    return np.rec.fromarrays(columns, names=names)  # type: ignore[no-any-return, no-untyped-call]


@pytest.mark.parametrize("kind", ["CoSimulation", "ModelExchange"])
@pytest.mark.parametrize("tire", [TireModel(), DAMPED], ids=["bare", "damped"])
def test_fmpy_simulates_both_versions_alike(tmp_path: Path, tire: TireModel, kind: str) -> None:
    """fmpy's own simulation, with CVode in Model Exchange: not one bit differs between FMI 2.0 and 3.0."""
    found = []
    for fmi in (2, 3):
        fmu = build_native_fmu(tire, tmp_path / str(fmi), fmi=fmi).path
        given = motion()
        if not tire.differentiates:
            given = given[["time", "deflection", "surface_radius"]]
        found.append(
            simulate_fmu(
                str(fmu),
                fmi_type=kind,
                input=given,
                output=["radial_force", "radial_stiffness", "in_tested_range"],
                stop_time=1.0,
                output_interval=0.01,
                relative_tolerance=1e-6,
            )
        )
    assert len(found[0]) > 100
    for name in found[0].dtype.names or ():
        np.testing.assert_array_equal(found[0][name], found[1][name], err_msg=name)
    assert np.ptp(found[0]["radial_force"]) > 500.0


@pytest.mark.parametrize("fmi", [2, 3])
def test_both_stay_small(tmp_path: Path, fmi: int) -> None:
    """Also with every effect, whose names and parameters stand in the description."""
    *_, (_, every) = tires(0)
    table = tuple((0.2 + 0.01 * i, 0.1, 0.01) for i in range(40))
    refitted = TireModel(law=Recalibrated(every.law, table), effects=every.effects, reading_noise=NOISE)
    for name, tire in (("bare", TireModel()), ("every", every), ("refitted on 40 surfaces", refitted)):
        fmu = build_native_fmu(tire, tmp_path / name, fmi=fmi).path
        assert fmpy.read_model_description(str(fmu)).fmiVersion == f"{fmi}.0"
        assert fmu.stat().st_size < 220_000


def test_the_description_names_what_the_binary_has(tmp_path: Path) -> None:
    """The variables of FMI 2.0 with their references, then time and the contact; states by their references."""
    two, three = (
        fmpy.read_model_description(str(build_native_fmu(DAMPED, tmp_path / str(fmi), fmi=fmi).path))
        for fmi in (2, 3)
    )
    same = [(v.name, v.valueReference) for v in two.modelVariables]
    found = [(v.name, v.valueReference) for v in three.modelVariables]
    assert found[:-2] == same
    assert [name for name, _ in found[-2:]] == ["time", "contact_deflection"]
    assert [d.variable.name for d in three.derivatives] == [d.variable.name for d in two.derivatives]
    assert [e.variable.name for e in three.eventIndicators] == ["contact_deflection"]
    with opened(DAMPED, tmp_path / "opened") as unit:
        begun(unit, 0.01, FLAT, 2.5)
        time, contact = (reference for _, reference in found[-2:])
        assert unit.getFloat64([time, contact, 0]) == [2.5, 0.01, 0.01]
        with pytest.raises(FMICallException):
            unit.getFloat64([contact + 1])
        assert "is no Real variable of this tire" in unit.messages[-1]


def test_the_command_writes_it(tmp_path: Path) -> None:
    """The Python FMU is FMI 2.0 only, and says so."""
    run = CliRunner().invoke
    done = run(command, ["--native", "--fmi", "3", "--out", str(tmp_path)])
    assert done.exit_code == 0, done.output
    assert "FMI 3.0 Co-Simulation and Model Exchange, valid" in done.output
    refused = run(command, ["--fmi", "3", "--out", str(tmp_path)])
    assert refused.exit_code != 0
    assert "add --native for FMI 3.0" in refused.output


def test_a_state_comes_back_from_its_bytes(tmp_path: Path) -> None:
    effect = CATALOGUE["rate_independent_hysteresis"]
    with opened(TireModel(effects=((effect, effect.nominal),)), tmp_path) as unit:
        begun(unit, 0.01, FLAT)
        saved = unit.getFMUState()
        there = unit.serializeFMUState(saved)

        def onward() -> list[float]:
            unit.setFloat64([0], [0.02])
            unit.doStep(0.0, 0.1)
            return unit.getFloat64([FORCE])  # type: ignore[no-any-return]

        first = onward()
        again = unit.deserializeFMUState(there)
        unit.setFMUState(again)
        assert unit.getFloat64([FORCE]) != first
        assert onward() == first
        broken = bytes([there[0] ^ 1]) + there[1:]
        with pytest.raises(FMICallException):
            unit.deserializeFMUState(broken)
        for state in (saved, again):
            unit.freeFMUState(state)


def test_derivatives_of_the_law(tmp_path: Path) -> None:
    """dF/dx = A B x^(B-1), in newtons a metre: 550.9 * 1.422 * 2^0.422 N/cm at 2 cm on flat ground."""
    with opened(TireModel(), tmp_path) as unit:
        begun(unit, 0.02, FLAT)
        slope = 100.0 * 550.9 * 1.422 * 2.0**0.422
        assert unit.getFloat64([STIFFNESS])[0] == pytest.approx(slope, rel=1e-12)
        assert unit.getDirectionalDerivative([FORCE], [0], [1.0]) == [pytest.approx(slope, rel=1e-12)]


def test_a_radius_of_zero_and_an_unknown_variable(tmp_path: Path) -> None:
    with opened(TireModel(), tmp_path) as unit:
        begun(unit, 0.01, FLAT)
        unit.setFloat64([1], [0.0])
        with pytest.raises(FMICallException):
            unit.doStep(0.0, 0.1)
        assert "surface_radius = 0 m is not allowed" in unit.messages[-1]
        for reference in (RANGE, 99, 2**32 - 1):
            with pytest.raises(FMICallException):
                unit.setFloat64([reference], [1.0])
        assert len(unit.messages) == 4


@pytest.mark.parametrize("value", [math.nan, math.inf, 22.0])
def test_inputs_that_no_tire_has(tmp_path: Path, value: float) -> None:
    """One message, nothing changes, and a good value goes on, as with FMI 2.0."""
    with opened(TireModel(), tmp_path) as unit:
        begun(unit, 0.01, FLAT)
        unit.setFloat64([0], [value])
        with pytest.raises(FMICallException):
            unit.doStep(0.0, 0.1)
        (message,) = unit.messages
        assert f"deflection = {value:.17g} m is not allowed" in message
        unit.setFloat64([0], [0.01])
        unit.doStep(0.0, 0.1)
        assert unit.getFloat64([FORCE]) == [pytest.approx(550.9, rel=1e-12)]


@pytest.mark.parametrize(
    ("time", "width", "word"),
    [
        (0.5, -0.1, "communicationStepSize = -0.1"),
        (0.5, math.nan, "communicationStepSize = nan s"),
        (0.5, math.inf, "communicationStepSize = inf s"),
        (0.0, 0.1, "currentCommunicationPoint = 0 s"),
        (1.0, 0.1, "currentCommunicationPoint = 1 s"),
        (math.nan, 0.1, "currentCommunicationPoint = nan s"),
    ],
)
def test_a_step_of_no_length_or_from_elsewhere_is_refused(
    tmp_path: Path, time: float, width: float, word: str
) -> None:
    """And the next one that is right is made."""
    with opened(TireModel(), tmp_path) as unit:
        begun(unit, 0.01, FLAT)
        unit.doStep(0.0, 0.5)
        with pytest.raises(FMICallException):
            unit.doStep(time, width)
        (message,) = unit.messages
        assert word in message
        unit.doStep(0.5, 0.1)


def test_a_step_past_the_stop_time_is_refused(tmp_path: Path) -> None:
    """FMI 3.0, 2.3.2: fmi3Error where the environment tries to compute past stopTime."""
    with opened(TireModel(), tmp_path) as unit:
        unit.enterInitializationMode(startTime=0.0, stopTime=0.2)
        unit.exitInitializationMode()
        unit.doStep(0.0, 0.1)
        unit.doStep(0.1, 0.1)
        with pytest.raises(FMICallException):
            unit.doStep(0.2, 0.1)
        (message,) = unit.messages
        assert "after stopTime = 0.20000000000000001 s" in message


def test_the_simulation_ends_after_a_refusal(tmp_path: Path) -> None:
    fmu = build_native_fmu(TireModel(), tmp_path, fmi=3).path
    with pytest.raises(FMICallException):
        simulate_fmu(str(fmu), fmi_type="CoSimulation", start_values={"deflection": math.nan})


def test_another_fmus_token_is_refused(tmp_path: Path) -> None:
    with pytest.raises(Exception, match="instantiate"), opened(TireModel(), tmp_path, token="{another}"):
        pass


def test_a_solvers_states_can_be_set_as_variables(tmp_path: Path) -> None:
    """FMI 3.0.2, 3.2.1: fmi3SetFloat64 of continuous states in Continuous-Time Mode; not in Co-Simulation."""
    with opened(DAMPED, tmp_path, FMU3Model) as unit:
        (state, *_) = (d.variable.derivative.valueReference for d in unit.description.derivatives)
        begun(unit, 0.01, FLAT)
        unit.updateDiscreteStates()
        unit.enterContinuousTimeMode()
        before = unit.getFloat64([FORCE, state])
        unit.setFloat64([state], [before[1] - 100.0])
        assert unit.getFloat64([state]) == [before[1] - 100.0]
        row = (c_double * 8)()
        unit.getContinuousStates(row, 8)
        assert before[1] - 100.0 in list(row)
    with opened(DAMPED, tmp_path) as unit:
        begun(unit, 0.01, FLAT)
        with pytest.raises(FMICallException):
            unit.setFloat64([state], [0.0])


@pytest.mark.parametrize("logging", [True, False])
def test_what_is_discarded_is_told_where_the_host_wants_to_hear(tmp_path: Path, logging: bool) -> None:
    """FMI 3.0.2, 2.3.1: with loggingOn = false only errors; what a solver tries in vain is none."""
    with opened(TireModel(), tmp_path, FMU3Model, logging=logging) as unit:
        begun(unit, 0.01, FLAT)

        def told() -> int:
            unit.setFloat64([0], [22.0])
            unit.messages.clear()
            assert (
                unit.dll.fmi3GetFloat64(
                    c_void_p(unit.component), (c_uint * 1)(FORCE), c_size_t(1), (c_double * 1)(), c_size_t(1)
                )
                == 2
            )
            return len(unit.messages)

        assert told() == int(logging)
        one = (c_char_p * 1)(b"logStatusDiscard")
        assert unit.dll.fmi3SetDebugLogging(c_void_p(unit.component), c_bool(True), c_size_t(1), one) == 0
        assert told() == 1
        assert unit.dll.fmi3SetDebugLogging(c_void_p(unit.component), c_bool(False), c_size_t(0), None) == 0
        assert told() == 0
        with pytest.raises(FMICallException):
            unit.exitInitializationMode()
        assert len(unit.messages) == 1
