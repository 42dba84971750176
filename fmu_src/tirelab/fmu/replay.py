"""An FMU on a recording: the force it returns for the recorded deflection and surface radius."""

from __future__ import annotations

import ctypes
import shutil
import tempfile
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import fmpy
import numpy as np
from fmpy.fmi1 import FMICallException
from fmpy.fmi2 import FMU2Slave, fmi2CallbackFunctions, fmi2CallbackLoggerTYPE
from fmpy.model_description import ModelDescription
from numpy.typing import NDArray
from radialtire import CHANNELS

from ..errors import TirelabError, check_recordings_given
from ..simulation.channels import Sampled, begun, measured_of
from .unpacking import description_in, unpack

INPUTS = ("deflection", "surface_radius")
OUTPUT = "radial_force"

FMI_TRUE, WARNING = 1, 1
"""fmi2True; the highest status that is no failure (FMI 2.0.4, 2.1.3)."""

NO_REASON = "it logged no reason"


@dataclass(frozen=True)
class OpenFmu:
    """An instance of an FMU, its variables' references, and a function that returns the messages it has logged."""

    instance: FMU2Slave
    references: Mapping[str, int]
    messages: Callable[[], tuple[str, ...]]


def description_of(fmu: Path) -> ModelDescription:
    """Return what an FMU says of itself; nothing of it is run.

    Raises TirelabError where it cannot be read, or is not FMI 2.0 Co-Simulation.
    """
    description = description_in(fmu, validate=True, again="build it again")
    if description.fmiVersion != "2.0" or description.coSimulation is None:
        raise TirelabError(f"{fmu} is not an FMI 2.0 Co-Simulation unit; export it as one")
    return description


@contextmanager
def opened(fmu: Path) -> Iterator[OpenFmu]:
    """Unpack, load and instantiate `fmu`, and leave nothing behind.

    An FMU is native code and runs with the rights of this process: open only FMUs that you trust.
    Raises TirelabError where it cannot be read, is not FMI 2.0 Co-Simulation, or does not load here.
    """
    description = description_of(fmu)
    kind = description.coSimulation
    folder = tempfile.mkdtemp(prefix="tirelab_")
    messages: list[str] = []
    try:
        unpack(fmu, Path(folder))
        library = Path(folder, "binaries", fmpy.platform, kind.modelIdentifier + fmpy.sharedLibraryExtension)
        if not library.is_file():
            raise TirelabError(f"{fmu} has no binary for this machine ({fmpy.platform}); export it for that")
        instance = FMU2Slave(
            guid=description.guid,
            unzipDirectory=folder,
            modelIdentifier=kind.modelIdentifier,
            instanceName=Path(fmu).stem,
        )

        def logger(_: Any, __: bytes, ___: int, ____: bytes, message: bytes) -> None:
            messages.append((message or b"").decode(errors="replace").replace("%%", "%"))

        callbacks = fmi2CallbackFunctions(logger=fmi2CallbackLoggerTYPE(logger))
        try:
            instance.instantiate(callbacks=callbacks, loggingOn=True)
        except Exception:
            instance.freeLibrary()
            reason = messages[-1] if messages else NO_REASON
            raise TirelabError(f"{fmu} cannot be instantiated: {reason}") from None
        try:
            references = {v.name: v.valueReference for v in description.modelVariables}
            yield OpenFmu(instance, references, lambda: tuple(messages))
        finally:
            instance.freeInstance()
    except OSError as error:
        raise TirelabError(
            f"{fmu} does not load on this machine ({error}); see its documentation folder"
        ) from None
    finally:
        shutil.rmtree(folder, ignore_errors=True)


def _check(function: str, status: int) -> None:
    if status > WARNING:
        raise FMICallException(function=function, status=status)


class _Stepper:
    """An instance led from sample to sample by its three functions, without the lists and copies that fmpy makes for
    each call: the FMU reads the inputs from where they lie and writes its output to where it belongs.

    inputs (samples, number of inputs); sample: the one that was reached
    """

    def __init__(self, instance: FMU2Slave, inputs: NDArray[np.float64], references: Sequence[int]) -> None:
        status, pointer, size, real = ctypes.c_int, ctypes.c_void_p, ctypes.c_size_t, ctypes.c_double
        access = ctypes.CFUNCTYPE(status, pointer, pointer, size, pointer)
        self._set = access(("fmi2SetReal", instance.dll))
        self._get = access(("fmi2GetReal", instance.dll))
        self._step = ctypes.CFUNCTYPE(status, pointer, real, real, ctypes.c_int)(("fmi2DoStep", instance.dll))
        self._component = instance.component
        self._references = (ctypes.c_uint * len(references))(*references)
        self._inputs = np.ascontiguousarray(inputs)
        self.force = np.empty(len(inputs))
        self.sample = 0

    def access(self, sample: int, before_output: Callable[[], None]) -> None:
        """Set the inputs of a sample, call a function, and get the output."""
        references = ctypes.addressof(self._references)
        width = self._inputs.shape[1]
        row = self._inputs.ctypes.data + sample * self._inputs.strides[0]
        _check("fmi2SetReal", self._set(self._component, references, width, row))
        before_output()
        at = self.force.ctypes.data + 8 * sample
        output = references + ctypes.sizeof(ctypes.c_uint) * width
        _check("fmi2GetReal", self._get(self._component, output, 1, at))

    def run(self, times: list[float], steps: list[float]) -> None:
        """Step from each of the times by each of the steps [s], from the first sample to the last."""
        set_real, do_step, get_real, component = self._set, self._step, self._get, self._component
        width, stride = self._inputs.shape[1], self._inputs.strides[0]
        references = ctypes.addressof(self._references)
        output = references + ctypes.sizeof(ctypes.c_uint) * width
        row, at = self._inputs.ctypes.data, self.force.ctypes.data
        for self.sample, (time, step) in enumerate(zip(times, steps, strict=True), 1):
            row += stride
            at += 8
            if status := set_real(component, references, width, row):
                _check("fmi2SetReal", status)
            if status := do_step(component, time, step, FMI_TRUE):
                _check("fmi2DoStep", status)
            if status := get_real(component, output, 1, at):
                _check("fmi2GetReal", status)


def replay(fmu: Path, motion: Sampled, *, most: int | None = None) -> NDArray[np.float64]:
    """Return the FMU's radial force [N] at every sample of `motion`, without a sample of delay.

    A channel that the motion holds and the FMU has an input for, such as the pressure, is set at every sample. A part
    of a file starts with what was recorded before it. most: number of samples after which the replay ends
    Raises TirelabError where the FMU lacks a variable or refuses a sample, TypeError for what is no motion.
    """
    check_recordings_given([motion])
    motion, before = begun(motion)
    measured = measured_of(motion)
    inputs = dict(zip(INPUTS, (motion.deflection, motion.surface_radius), strict=True))
    inputs |= {c.variable: measured[c.name] for c in CHANNELS if c.name in measured}
    until = None if most is None else before + most
    inputs = {name: values[:until] for name, values in inputs.items()}
    force = driven(fmu, motion.time[:until], inputs, OUTPUT, optional=[c.variable for c in CHANNELS])
    if not np.isfinite(force[0]):
        raise TirelabError(f"{fmu} gives no force for the first sample; check its deflection and radius")
    return force[before:]


def driven(
    fmu: Path,
    time: NDArray[np.float64],
    inputs: Mapping[str, NDArray[np.float64]],
    output: str,
    optional: Sequence[str] = (),
) -> NDArray[np.float64]:
    """Return one output of the FMU at every time [s] for inputs that are given there, without a sample of delay.

    optional: inputs that are left out where the FMU has none of the name.

    Each step sets the inputs of its end, steps, and reads the output (fmpy.simulate_fmu samples the output of a model
    with direct feed-through one communication step late).
    Raises TirelabError where the FMU lacks a variable or refuses a sample.
    """
    with opened(fmu) as unit:
        inputs = {n: v for n, v in inputs.items() if n not in optional or n in unit.references}
        for name in (*inputs, output):
            if name not in unit.references:
                raise TirelabError(
                    f"{fmu} has no variable {name!r}; a tire has {', '.join((*inputs, output))}"
                )
        instance = unit.instance
        times = time.tolist()
        columns = np.column_stack(list(inputs.values()))
        stepper = _Stepper(instance, columns, [unit.references[name] for name in (*inputs, output)])
        try:
            instance.setupExperiment(startTime=times[0])
            instance.enterInitializationMode()
            stepper.access(0, instance.exitInitializationMode)
            stepper.run(times[:-1], np.diff(time).tolist())
            instance.terminate()
        except FMICallException as error:
            reason = unit.messages()[-1] if unit.messages() else str(error)
            sample = stepper.sample
            raise TirelabError(
                f"{fmu} refused sample {sample} (after t = {times[max(sample - 1, 0)]:g} s): {reason}"
            ) from None
    return stepper.force
