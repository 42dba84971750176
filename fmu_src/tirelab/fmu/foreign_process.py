"""The process in which anybody's FMU is replayed: `python -m tirelab.fmu.foreign_process FOLDER`.

FOLDER holds job.json, inputs.npy (time [s] and an input per column) and the unpacked FMU; force.npy is written there.
What it has to say goes to its standard output, one JSON object a line: {"sample": k}, {"message": "..."},
{"failed": "..."}. What the FMU prints goes to standard error.
"""

from __future__ import annotations

import json
import os
import sys
import time
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import numpy as np
from fmpy import read_model_description
from fmpy.simulation import Input, instantiate_fmu
from fmpy.sundials import CVodeSolver
from numpy.typing import NDArray

EVERY = 0.2
"""Time [s] between two words on how far it is."""

TOLERANCE = 1e-6
"""Relative tolerance of the solver in Model Exchange."""

Say = Callable[[dict[str, Any]], None]


def main() -> None:
    """Replay the FMU of the folder that the command line names."""
    folder = Path(sys.argv[1])
    say = _own_output()
    try:
        np.save(folder / "force.npy", replayed(folder, say))
    except Exception as error:  # whatever an FMU or fmpy raises is told to the user
        say({"failed": str(error) or type(error).__name__})
        os._exit(1)
    # an FMU's library may abort as the process ends: all is written
    os._exit(0)


def _own_output() -> Say:
    """Return a function that writes to the standard output, which nobody else has from now on."""
    own = os.fdopen(os.dup(1), "w", encoding="utf-8")
    os.dup2(2, 1)

    def say(what: dict[str, Any]) -> None:
        own.write(json.dumps(what) + "\n")
        own.flush()

    return say


def replayed(folder: Path, say: Say) -> NDArray[np.float64]:
    """Return the output at every time of inputs.npy."""
    job = json.loads((folder / "job.json").read_text(encoding="utf-8"))
    table = np.load(folder / "inputs.npy", allow_pickle=False)
    unpacked = folder / "fmu"
    description = read_model_description(str(unpacked), validate=False)

    def logger(*arguments: Any) -> None:
        text = arguments[-1]
        said = text.decode(errors="replace") if isinstance(text, bytes) else str(text)
        say({"message": said.strip().replace("%%", "%")})

    fmu = instantiate_fmu(str(unpacked), description, job["kind"], False, True, logger)
    step = _co_simulated if job["kind"] == "CoSimulation" else _integrated
    get = fmu.getFloat64 if job["version"] == "3.0" else fmu.getReal
    force = np.empty(len(table))
    said = 0.0
    for sample in step(fmu, description, job, table):
        force[sample] = get([job["output"]])[0]
        if time.monotonic() > said + EVERY:
            said = time.monotonic()
            say({"sample": sample})
    return force


def _initialized(
    fmu: Any, job: dict[str, Any], table: NDArray[np.float64], apply: Callable[[], None]
) -> None:
    start, stop = float(table[0, 0]), float(table[-1, 0])
    if job["version"] == "3.0":
        fmu.enterInitializationMode(startTime=start, stopTime=stop)
    else:
        fmu.setupExperiment(startTime=start, stopTime=stop)
        fmu.enterInitializationMode()
    apply()
    fmu.exitInitializationMode()


def _co_simulated(
    fmu: Any, description: Any, job: dict[str, Any], table: NDArray[np.float64]
) -> Iterator[int]:
    """Step from sample to sample with the inputs of each step's end; yield each sample that is reached."""
    put = fmu.setFloat64 if job["version"] == "3.0" else fmu.setReal
    references = list(job["inputs"].values())
    rows, times = table[:, 1:].tolist(), table[:, 0].tolist()
    _initialized(fmu, job, table, lambda: put(references, rows[0]))
    yield 0
    for sample in range(1, len(times)):
        put(references, rows[sample])
        done = fmu.doStep(times[sample - 1], times[sample] - times[sample - 1])
        if done is not None and (done[1] or done[2]):  # FMI 3.0: terminated, or returned early
            raise RuntimeError(f"it ended the simulation at {done[3]:g} s of {times[-1]:g} s")
        yield sample


class _Solver(CVodeSolver):  # type: ignore[misc]
    """fmpy's solver with the inputs of the time at which it asks for the derivatives; fmpy holds those of the step."""

    def f(self, t: float, y: Any, ydot: Any, user_data: Any) -> int:
        """Give the derivatives."""
        self.input.apply(t, discrete=False)
        answer: int = super().f(t, y, ydot, user_data)
        return answer


def _integrated(fmu: Any, description: Any, job: dict[str, Any], table: NDArray[np.float64]) -> Iterator[int]:
    """Integrate from sample to sample with CVode, inputs on straight lines between; yield each sample reached."""
    names = list(job["inputs"])
    signals = np.zeros(len(table), dtype=[("time", float), *((name, float) for name in names)])
    for column, name in enumerate(("time", *names)):
        signals[name] = table[:, column]
    inputs = Input(fmu, description, signals)
    times = table[:, 0].tolist()
    _initialized(fmu, job, table, lambda: inputs.apply(times[0]))
    event_time = _settled(fmu)
    fmu.enterContinuousTimeMode()
    solver = _Solver(
        nx=description.numberOfContinuousStates,
        nz=description.numberOfEventIndicators,
        get_x=fmu.getContinuousStates,
        set_x=fmu.setContinuousStates,
        get_dx=fmu.getContinuousStateDerivatives if job["version"] == "3.0" else fmu.getDerivatives,
        get_z=fmu.getEventIndicators,
        get_nominals=fmu.getNominalsOfContinuousStates,
        set_time=fmu.setTime,
        input=inputs,
        startTime=times[0],
        maxStep=float(np.median(np.diff(table[:, 0]))),
        relativeTolerance=TOLERANCE,
    )
    accepts = description.modelExchange.needsCompletedIntegratorStep
    yield 0
    at = times[0]
    for sample in range(1, len(times)):
        while at < times[sample]:
            event, _, at = solver.step(at, min(times[sample], event_time))
            fmu.setTime(at)
            inputs.apply(at, discrete=False)
            if accepts:
                wanted, ended = fmu.completedIntegratorStep()
                event = event or wanted
                if ended:
                    raise RuntimeError(f"it ended the simulation at {at:g} s of {times[-1]:g} s")
            if event or at >= event_time:
                fmu.enterEventMode()
                inputs.apply(at, after_event=True)
                event_time = _settled(fmu)
                fmu.enterContinuousTimeMode()
                solver.reset(at)
        yield sample


def _settled(fmu: Any) -> float:
    """Iterate the events of this time until none is left, and return the time [s] of the next one."""
    update = fmu.updateDiscreteStates if hasattr(fmu, "updateDiscreteStates") else fmu.newDiscreteStates
    again = True
    following = np.inf
    while again:
        again, ended, _, _, defined, when = update()
        if ended:
            raise RuntimeError("it ended the simulation at an event")
        following = float(when) if defined else np.inf
    return following


if __name__ == "__main__":
    main()
