"""An FMU on a recording: the force it returns for the recorded deflection and surface radius."""

from __future__ import annotations

import shutil
import tempfile
import zipfile
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from types import SimpleNamespace
from typing import Any, Protocol

import fmpy
import numpy as np
from fmpy.fmi1 import FMICallException
from fmpy.fmi2 import FMU2Slave, fmi2CallbackFunctions, fmi2CallbackLoggerTYPE
from numpy.typing import NDArray

from ..errors import TirelabError

INPUTS = ("deflection", "surface_radius")
OUTPUT = "radial_force"

NO_REASON = "it logged no reason"


class Motion(Protocol):
    """The channels of a recording that a replay needs, in SI."""

    @property
    def time(self) -> NDArray[np.float64]: ...
    @property
    def deflection(self) -> NDArray[np.float64]: ...
    @property
    def surface_radius(self) -> NDArray[np.float64]: ...


@dataclass(frozen=True)
class OpenFmu:
    """An instance of an FMU, its variables' references, and a function that returns the messages it has logged."""

    instance: FMU2Slave
    references: Mapping[str, int]
    messages: Callable[[], tuple[str, ...]]


@contextmanager
def opened(fmu: Path) -> Iterator[OpenFmu]:
    """Unpack, load and instantiate `fmu`, and leave nothing behind.

    An FMU is native code and runs with the rights of this process: open only FMUs that you trust.
    Raises TirelabError where it cannot be read, is not FMI 2.0 Co-Simulation, or does not load here.
    """
    try:
        with open(
            fmu, "rb"
        ) as file:  # opened here, since fmpy leaves it open where it refuses the description
            description = fmpy.read_model_description(file)
        kind = description.coSimulation
        if description.fmiVersion != "2.0" or kind is None:
            raise TirelabError(f"{fmu} is not an FMI 2.0 Co-Simulation unit; export it as one")
    except TirelabError:
        raise
    except FileNotFoundError:
        raise TirelabError(f"{fmu} does not exist; build it with build_fmu.py or name another") from None
    except (OSError, zipfile.BadZipFile, KeyError) as error:
        raise TirelabError(f"{fmu} cannot be read as an FMU ({error}); build it again") from None
    except Exception as error:  # fmpy raises plain Exception for a description that breaks the standard
        first = " ".join(str(error).splitlines()[:2])
        raise TirelabError(f"{fmu} breaks the FMI standard ({first}); build it again") from None

    folder = tempfile.mkdtemp(prefix="tirelab_")
    messages: list[str] = []
    try:
        fmpy.extract(str(fmu), folder)
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


def replay(fmu: Path, motion: Motion) -> NDArray[np.float64]:
    """Return the FMU's radial force [N] at every sample of `motion`, without a sample of delay.

    Each step sets the inputs of its end, steps, and reads the output (fmpy.simulate_fmu samples the output of a model
    with direct feed-through one communication step late).
    Raises TirelabError where the FMU lacks a variable or refuses a sample.
    """
    with opened(fmu) as unit:
        for name in (*INPUTS, OUTPUT):
            if name not in unit.references:
                raise TirelabError(
                    f"{fmu} has no variable {name!r}; a tire has {', '.join((*INPUTS, OUTPUT))}"
                )
        inputs = [unit.references[name] for name in INPUTS]
        output = [unit.references[OUTPUT]]
        instance = unit.instance
        force = np.empty(len(motion.time))
        samples = zip(
            motion.time.tolist(), motion.deflection.tolist(), motion.surface_radius.tolist(), strict=True
        )
        at = SimpleNamespace(sample=0, time=float(motion.time[0]))
        try:
            instance.setupExperiment(startTime=at.time)
            instance.enterInitializationMode()
            for at.sample, (time, deflection, surface_radius) in enumerate(samples):
                instance.setReal(inputs, [deflection, surface_radius])
                if at.sample == 0:
                    instance.exitInitializationMode()
                else:
                    instance.doStep(at.time, time - at.time)
                force[at.sample] = instance.getReal(output)[0]
                at.time = time
            instance.terminate()
        except FMICallException as error:
            reason = unit.messages()[-1] if unit.messages() else str(error)
            raise TirelabError(
                f"{fmu} refused sample {at.sample} (after t = {at.time:g} s): {reason}"
            ) from None
    if not np.isfinite(force[0]):
        raise TirelabError(f"{fmu} gives no force for the first sample; check its deflection and radius")
    return force
