"""What FMI 3.0 allows in which state, each call of the standard in each of them."""

from __future__ import annotations

from collections.abc import Callable
from ctypes import byref, c_bool, c_double, c_size_t, c_ubyte, c_uint, c_void_p
from pathlib import Path
from typing import Any

import pytest
from fmpy.fmi3 import FMU3Model, FMU3Slave
from native_fmi3 import DAMPED, FORCE, RANGE, opened

IN_EACH_STATE = """
EnterInitializationMode        |x|-|-|-||x|-|-|-|-
ExitInitializationMode         |-|x|-|-||-|x|-|-|-
EnterEventMode                 |-|-|-|-||-|-|-|x|-
EnterContinuousTimeMode        |-|-|-|-||-|-|x|-|-
UpdateDiscreteStates           |-|-|-|-||-|-|x|-|-
CompletedIntegratorStep        |-|-|-|-||-|-|-|x|-
SetTime                        |-|-|-|-||-|-|1|x|-
SetContinuousStates            |-|-|-|-||-|-|-|x|-
GetContinuousStates            |-|-|-|-||-|x|x|x|x
GetContinuousStateDerivatives  |-|-|-|-||-|x|x|x|x
GetNominalsOfContinuousStates  |-|-|-|-||-|x|x|x|x
GetEventIndicators             |-|-|-|-||-|x|x|x|x
GetNumberOfContinuousStates    |-|-|-|-||x|2|x|2|2
GetNumberOfEventIndicators     |-|-|-|-||x|2|x|2|2
DoStep                         |-|-|x|-||-|-|-|-|-
Terminate                      |-|-|x|-||-|-|x|x|-
GetFloat64                     |x|x|x|x||x|x|x|x|x
SetFloat64                     |x|x|x|-||x|x|x|x|-
GetBoolean                     |x|x|x|x||x|x|x|x|x
SetBoolean                     |x|x|x|-||x|x|x|-|-
GetDirectionalDerivative       |-|x|x|x||-|x|x|x|x
SetDebugLogging                |x|x|x|x||x|x|x|x|x
GetFMUState                    |x|x|x|x||x|x|x|x|x
SetFMUState                    |x|x|x|x||x|x|x|x|x
FreeFMUState                   |x|x|x|x||x|x|x|x|x
SerializedFMUStateSize         |x|x|x|x||x|x|x|x|x
SerializeFMUState              |x|x|x|x||x|x|x|x|x
DeserializeFMUState            |x|x|x|x||x|x|x|x|x
Reset                          |x|x|x|x||x|x|x|x|x
"""
"""FMI 3.0.2, sections 2.3, 3.2 and 4.2; Co-Simulation: instantiated, Initialization Mode, Step Mode, terminated; Model
Exchange: instantiated, Initialization Mode, Event Mode, Continuous-Time Mode, terminated. Taken here beyond them, which
harms nobody: 1 the time in Event Mode, as of FMI 2.0; 2 the numbers, which never change."""

TYPES = (
    "Int8",
    "UInt8",
    "Int16",
    "UInt16",
    "Int32",
    "UInt32",
    "Int64",
    "UInt64",
    "String",
    "Binary",
    "Clock",
)
"""Of which the tire has no variable; no variable is got and set where Booleans are."""

STATES = (
    *((FMU3Slave, state) for state in ("instantiated", "initialization", "step", "terminated")),
    *(
        (FMU3Model, state)
        for state in ("instantiated", "initialization", "event", "continuous", "terminated")
    ),
)


def table() -> dict[str, list[str]]:
    """The marks of every call, by its name."""
    lines = (line.replace("||", "|").split("|") for line in IN_EACH_STATE.strip().splitlines())
    marks = {name.strip(): [*row] for name, *row in lines}
    return marks | {f"{verb}{kind}": marks[f"{verb}Boolean"] for kind in TYPES for verb in ("Get", "Set")}


def calls(unit: Any) -> dict[str, Callable[[], int]]:
    """Every call with arguments that are right, by its name; each returns the status."""
    saved, size, bytes_ = c_void_p(), c_size_t(), (c_ubyte * 100_000)()
    unit.dll.fmi3GetFMUState(c_void_p(unit.component), byref(saved))
    unit.dll.fmi3SerializedFMUStateSize(c_void_p(unit.component), saved, byref(size))
    unit.dll.fmi3SerializeFMUState(c_void_p(unit.component), saved, bytes_, size)
    states, one, value = c_size_t(len(unit.description.derivatives)), c_size_t(1), (c_double * 8)()
    flags = [c_bool() for _ in range(5)]
    library, instance = unit.dll, c_void_p(unit.component)
    force, deflection, in_range = (c_uint * 1)(FORCE), (c_uint * 1)(0), (c_uint * 1)(RANGE)
    (given,) = (v.valueReference for v in unit.description.modelVariables if v.name == "motion_given")
    arguments: dict[str, tuple[Any, ...]] = {
        "EnterInitializationMode": (c_bool(), c_double(), c_double(), c_bool(), c_double()),
        "UpdateDiscreteStates": (*map(byref, flags), byref(c_double())),
        "CompletedIntegratorStep": (c_bool(True), byref(flags[0]), byref(flags[1])),
        **dict.fromkeys(
            (
                "SetContinuousStates",
                "GetContinuousStates",
                "GetContinuousStateDerivatives",
                "GetNominalsOfContinuousStates",
            ),
            (value, states),
        ),
        "GetEventIndicators": (value, one),
        "GetNumberOfContinuousStates": (byref(c_size_t()),),
        "GetNumberOfEventIndicators": (byref(c_size_t()),),
        "SetTime": (c_double(),),
        "SetBoolean": ((c_uint * 1)(given), one, (c_bool * 1)(), one),
        "SetDebugLogging": (c_bool(), c_size_t(), None),
        "DoStep": (c_double(), c_double(0.1), c_bool(True), *map(byref, flags[:3]), byref(c_double())),
        "GetFloat64": (force, one, value, one),
        "SetFloat64": (deflection, one, value, one),
        "GetBoolean": (in_range, one, (c_bool * 1)(), one),
        "GetDirectionalDerivative": (force, one, deflection, one, (c_double * 1)(1.0), one, value, one),
        "GetFMUState": (byref(c_void_p()),),
        "SetFMUState": (saved,),
        "FreeFMUState": (byref(saved),),
        "SerializedFMUStateSize": (saved, byref(size)),
        "SerializeFMUState": (saved, bytes_, size),
        "DeserializeFMUState": (bytes_, size, byref(c_void_p())),
        **{
            f"{verb}{kind}": (None, c_size_t(), None, c_size_t()) for kind in TYPES for verb in ("Get", "Set")
        },
        **dict.fromkeys(("GetBinary", "SetBinary"), (None, c_size_t(), None, None, c_size_t())),
    }

    def act(name: str) -> Callable[[], int]:
        return lambda: int(getattr(library, f"fmi3{name}")(instance, *arguments.get(name, ())))

    return {name: act(name) for name in table()}


@pytest.mark.parametrize(("kind", "state"), STATES)
def test_each_call_in_each_state(tmp_path: Path, kind: type, state: str) -> None:
    column = STATES.index((kind, state))
    with opened(DAMPED, tmp_path, kind) as unit:
        for name, marks in table().items():
            unit.reset()
            if state != "instantiated":
                unit.enterInitializationMode()
                if state != "initialization":
                    unit.exitInitializationMode()
                if state == "continuous":
                    unit.updateDiscreteStates()
                    unit.enterContinuousTimeMode()
                if state == "terminated":
                    unit.terminate()
            unit.messages.clear()
            status = calls(unit)[name]()
            refused = any("is not allowed in the state" in message for message in unit.messages)
            assert refused == (marks[column] == "-"), (name, state, unit.messages)
            assert status == (3 if marks[column] == "-" else 0), (name, state, status, unit.messages)
