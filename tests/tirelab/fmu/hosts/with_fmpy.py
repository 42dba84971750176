"""Run FMUs with fmpy's low-level calls in a process that cannot import the project.

Standard input: {"fmus": [paths], "calls": [[instance, "set", {name: value}] | [instance, "step", t, h] |
[instance, "get", [names]] | [instance, "save" | "restore" | "reset" | "free"]]}; prints the answers: values, or the
status and the messages of what was not fmi2OK.
"""

import json
import os
import sys
from pathlib import Path

for name in ("radialtire", "tirelab", "bicycle_tire_fmu", "fmu_description", "concealed"):
    sys.modules[name] = None  # importing them from here on is an ImportError

import fmpy
from fmpy.fmi1 import FMICallException
from fmpy.fmi2 import FMU2Slave, fmi2CallbackFunctions, fmi2CallbackLoggerTYPE

job = json.load(sys.stdin)
messages = []


def logger(_environment, _instance, status, _category, message):
    messages.append([status, message.decode()])


units, references, kinds, saved, keep = [], [], [], {}, []
crashes_at_exit = False
for number, path in enumerate(job["fmus"]):
    description = fmpy.read_model_description(path)
    folder = Path(fmpy.extract(path))
    # pythonfmu 0.7.0's own library reads freed memory in its finalizer, which may abort the process (its issue 228).
    for library in folder.glob("binaries/linux64/*"):
        crashes_at_exit |= b"finalizePythonInterpreter" in library.read_bytes()
    unit = FMU2Slave(
        guid=description.guid,
        unzipDirectory=folder,
        modelIdentifier=description.coSimulation.modelIdentifier,
        instanceName=f"tire{number}",
    )
    callbacks = fmi2CallbackFunctions(logger=fmi2CallbackLoggerTYPE(logger))
    keep.append(callbacks)
    unit.instantiate(callbacks=callbacks, loggingOn=bool(job.get("logging", True)))
    unit.setupExperiment(startTime=0.0)
    unit.enterInitializationMode()
    unit.exitInitializationMode()
    units.append(unit)
    references.append({v.name: v.valueReference for v in description.modelVariables})
    kinds.append({v.name: v.type for v in description.modelVariables})

answers = []
for number, verb, *rest in job["calls"]:
    unit, reference = units[number], references[number]
    messages.clear()
    answer = None
    try:
        if verb == "set":
            unit.setReal([reference[name] for name in rest[0]], list(rest[0].values()))
        elif verb == "step":
            unit.doStep(*rest)
        elif verb == "get":
            answer = [
                unit.getReal([reference[name]])[0]
                if kinds[number][name] == "Real"
                else unit.getBoolean([reference[name]])[0]
                for name in rest[0]
            ]
        elif verb == "save":
            state = unit.getFMUstate()
            saved[number] = unit.serializeFMUstate(state)
            unit.freeFMUstate(state)
        elif verb == "restore":
            state = unit.deSerializeFMUstate(saved[number])
            unit.setFMUstate(state)
            unit.freeFMUstate(state)
        elif verb == "reset":
            unit.reset()
            unit.setupExperiment(startTime=0.0)
            unit.enterInitializationMode()
            unit.exitInitializationMode()
        else:
            sys.exit(f"unknown verb {verb}")
    except FMICallException as error:
        answer = {"status": error.status, "messages": list(messages)}
    answers.append(answer)
for unit in units:
    unit.terminate()
    unit.freeInstance()
print(json.dumps(answers), flush=True)
if crashes_at_exit:
    os._exit(0)
