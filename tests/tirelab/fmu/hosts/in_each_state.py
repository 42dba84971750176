"""Call every function of FMI 2.0 in every state, through ctypes, in a process that cannot import the project.

Argument: an FMU. Prints {kind: {function: {state: [status, message]}}} for the kinds that the model description has;
of one with both kinds, {"KIND, calls of the other": ...} too.
"""

import json
import sys
import tempfile
import zipfile
from ctypes import (
    CDLL,
    CFUNCTYPE,
    POINTER,
    Structure,
    byref,
    c_char,
    c_char_p,
    c_double,
    c_int,
    c_size_t,
    c_uint,
    c_void_p,
    cast,
)
from pathlib import Path
from xml.etree import ElementTree

for name in ("radialtire", "tirelab", "bicycle_tire_fmu", "fmu_description", "concealed"):
    sys.modules[name] = None  # importing them from here on is an ImportError

LOGGER = CFUNCTYPE(None, c_void_p, c_char_p, c_int, c_char_p, c_char_p)


class Callbacks(Structure):
    _fields_ = [
        ("logger", LOGGER),
        ("allocate", c_void_p),
        ("free", c_void_p),
        ("finished", c_void_p),
        ("environment", c_void_p),
    ]


messages = []


@LOGGER
def log(_environment, _instance, _status, _category, text):
    messages.append(text.decode())


c_library = CDLL(None)
callbacks = Callbacks(
    log,
    cast(c_library.calloc, c_void_p),
    cast(c_library.free, c_void_p),
    None,
    None,
)
folder = Path(tempfile.mkdtemp())
with zipfile.ZipFile(sys.argv[1]) as archive:
    archive.extractall(folder)
description = ElementTree.parse(folder / "modelDescription.xml").getroot()
guid = description.get("guid").encode()
library = CDLL(str(folder / "binaries" / "linux64" / "BicycleTire.so"))
library.fmi2Instantiate.restype = c_void_p
library.fmi2Instantiate.argtypes = [c_char_p, c_int, c_char_p, c_char_p, POINTER(Callbacks), c_int, c_int]
resources = (folder / "resources").as_uri().encode()

INPUT, OUTPUT, BOOLEAN = 0, 2, 4
CO_SIMULATION, MODEL_EXCHANGE = 1, 0


class EventInfo(Structure):
    _fields_ = [(f"flag{i}", c_int) for i in range(5)] + [("time", c_double)]


def call(tire, name, *arguments):
    messages.clear()
    status = getattr(library, "fmi2" + name)(c_void_p(tire), *arguments)
    return [status, messages[0] if messages else ""]


def reals(tire, verb, reference, *values):
    row = (c_double * max(len(values), 1))(*values)
    return call(tire, verb, (c_uint * 1)(reference), c_size_t(1), row)


def start(tire):
    assert call(tire, "SetupExperiment", 0, c_double(0), c_double(0), 0, c_double(0))[0] == 0


def made(kind, state):
    """A new instance in a state."""
    tire = library.fmi2Instantiate(b"tire", kind, guid, resources, byref(callbacks), 0, 0)
    assert tire, messages
    if state == "instantiated":
        return tire
    start(tire)
    assert call(tire, "EnterInitializationMode")[0] == 0
    if state == "initialization":
        return tire
    assert call(tire, "ExitInitializationMode")[0] == 0
    if kind == MODEL_EXCHANGE and state == "continuous":
        info = EventInfo()
        assert call(tire, "NewDiscreteStates", byref(info))[0] == 0
        assert call(tire, "EnterContinuousTimeMode")[0] == 0
    if state == "error":
        reals(tire, "SetReal", INPUT, float("nan"))
        assert call(tire, "DoStep", c_double(0), c_double(0.1), 1)[0] == 3
    if state == "terminated":
        assert call(tire, "Terminate")[0] == 0
    return tire


def with_state(tire, name):
    """A call that needs a saved state."""
    saved = c_void_p()
    size = c_size_t()
    call(tire, "GetFMUstate", byref(saved))
    if name == "SetFMUstate":
        return call(tire, name, saved)
    if name == "FreeFMUstate":
        return call(tire, name, byref(saved))
    answer = call(tire, "SerializedFMUstateSize", saved, byref(size))
    if name == "SerializedFMUstateSize":
        return answer
    row = (c_char * size.value)()
    answer = call(tire, "SerializeFMUstate", saved, row, size)
    if name == "SerializeFMUstate":
        return answer
    return call(tire, name, row, size, byref(c_void_p()))


one = c_size_t(1)
row = (c_double * 4)()
CALLS = {
    "GetTypesPlatform": lambda t: [0 if library.fmi2GetTypesPlatform() else 3, ""],
    "GetVersion": lambda t: [0 if library.fmi2GetVersion() else 3, ""],
    "SetDebugLogging": lambda t: call(t, "SetDebugLogging", 0, c_size_t(0), None),
    "SetupExperiment": lambda t: call(t, "SetupExperiment", 0, c_double(0), c_double(0), 0, c_double(0)),
    "EnterInitializationMode": lambda t: call(t, "EnterInitializationMode"),
    "ExitInitializationMode": lambda t: call(t, "ExitInitializationMode"),
    "Terminate": lambda t: call(t, "Terminate"),
    "Reset": lambda t: call(t, "Reset"),
    "GetReal": lambda t: reals(t, "GetReal", OUTPUT),
    "GetInteger": lambda t: call(t, "GetInteger", None, c_size_t(0), None),
    "GetBoolean": lambda t: call(t, "GetBoolean", (c_uint * 1)(BOOLEAN), one, (c_int * 1)()),
    "GetString": lambda t: call(t, "GetString", None, c_size_t(0), None),
    "SetReal": lambda t: reals(t, "SetReal", INPUT, 0.01),
    "SetInteger": lambda t: call(t, "SetInteger", None, c_size_t(0), None),
    "SetBoolean": lambda t: call(t, "SetBoolean", None, c_size_t(0), None),
    "SetString": lambda t: call(t, "SetString", None, c_size_t(0), None),
    "GetFMUstate": lambda t: call(t, "GetFMUstate", byref(c_void_p())),
    **{
        name: (lambda t, name=name: with_state(t, name))
        for name in (
            "SetFMUstate",
            "FreeFMUstate",
            "SerializedFMUstateSize",
            "SerializeFMUstate",
            "DeSerializeFMUstate",
        )
    },
    "GetDirectionalDerivative": lambda t: call(
        t, "GetDirectionalDerivative", (c_uint * 1)(OUTPUT), one, (c_uint * 1)(INPUT), one, row, row
    ),
}
CO_SIMULATION_CALLS = {
    "SetRealInputDerivatives": lambda t: call(t, "SetRealInputDerivatives", None, c_size_t(0), None, None),
    "GetRealOutputDerivatives": lambda t: call(t, "GetRealOutputDerivatives", None, c_size_t(0), None, None),
    "DoStep": lambda t: call(t, "DoStep", c_double(0), c_double(0.1), 1),
    "CancelStep": lambda t: call(t, "CancelStep"),
    "GetStatus": lambda t: call(t, "GetStatus", 0, (c_int * 1)()),
    "GetRealStatus": lambda t: call(t, "GetRealStatus", 2, row),
    "GetIntegerStatus": lambda t: call(t, "GetIntegerStatus", 0, (c_int * 1)()),
    "GetBooleanStatus": lambda t: call(t, "GetBooleanStatus", 3, (c_int * 1)()),
    "GetStringStatus": lambda t: call(t, "GetStringStatus", 1, (c_char_p * 1)()),
}
nx = len(description.findall("ModelStructure/Derivatives/Unknown"))
nz = int(description.get("numberOfEventIndicators", "0"))
MODEL_EXCHANGE_CALLS = {
    "EnterEventMode": lambda t: call(t, "EnterEventMode"),
    "NewDiscreteStates": lambda t: call(t, "NewDiscreteStates", byref(EventInfo())),
    "EnterContinuousTimeMode": lambda t: call(t, "EnterContinuousTimeMode"),
    "CompletedIntegratorStep": lambda t: call(
        t, "CompletedIntegratorStep", 1, byref(c_int()), byref(c_int())
    ),
    "SetTime": lambda t: call(t, "SetTime", c_double(0.1)),
    "SetContinuousStates": lambda t: call(t, "SetContinuousStates", (c_double * 16)(), c_size_t(nx)),
    "GetEventIndicators": lambda t: call(t, "GetEventIndicators", (c_double * 16)(), c_size_t(nz)),
    "GetContinuousStates": lambda t: call(t, "GetContinuousStates", (c_double * 16)(), c_size_t(nx)),
    "GetDerivatives": lambda t: call(t, "GetDerivatives", (c_double * 16)(), c_size_t(nx)),
    "GetNominalsOfContinuousStates": lambda t: call(
        t, "GetNominalsOfContinuousStates", (c_double * 16)(), c_size_t(nx)
    ),
}

answers = {}
for word, kind, own, other, states in (
    (
        "CoSimulation",
        CO_SIMULATION,
        CO_SIMULATION_CALLS,
        MODEL_EXCHANGE_CALLS,
        ("instantiated", "initialization", "stepComplete", "terminated", "error"),
    ),
    (
        "ModelExchange",
        MODEL_EXCHANGE,
        MODEL_EXCHANGE_CALLS,
        CO_SIMULATION_CALLS,
        ("instantiated", "initialization", "event", "continuous", "terminated"),
    ),
):
    if description.find(word) is None:
        continue
    tables = {word: {**CALLS, **own}}
    if all(description.find(kind_word) is not None for kind_word in ("CoSimulation", "ModelExchange")):
        tables[f"{word}, calls of the other"] = other
    for title, calls in tables.items():
        answers[title] = {}
        for function, act in calls.items():
            answers[title][function] = {}
            for state in states:
                tire = made(kind, state)
                answers[title][function][state] = act(tire)
                library.fmi2FreeInstance(c_void_p(tire))
print(json.dumps(answers))
