"""An instance of the native FMU of FMI 3.0, in fmpy."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import fmpy
from fmpy.fmi3 import FMU3Slave
from loader_bench import unpacked_archive
from radialtire import CATALOGUE, TireModel
from tirelab.fmu.native.pack import build_native_fmu

DAMPED = TireModel(
    effects=tuple(
        (CATALOGUE[n], CATALOGUE[n].nominal)
        for n in ("viscous_damping", "viscoelastic_relaxation", "force_lag")
    )
)
FORCE, STIFFNESS, RANGE = 2, 3, 4
FLAT = 1e5


@contextmanager
def opened(
    tire: TireModel, folder: Path, kind: type = FMU3Slave, token: str | None = None, *, logging: bool = False
) -> Iterator[Any]:
    """An instance of FMI 3.0, and the messages that it told; its FMU is built where the folder has none."""
    unpacked = folder / "fmu"
    if not unpacked.is_dir():
        unpacked_archive(build_native_fmu(tire, folder, fmi=3).path, unpacked)
    description = fmpy.read_model_description(str(unpacked))
    unit = kind(
        guid=token or description.instantiationToken,
        unzipDirectory=str(unpacked),
        modelIdentifier="BicycleTire",
        instanceName="tire",
    )
    messages: list[str] = []

    def told(_environment: Any, _status: int, _category: bytes, message: bytes) -> None:
        messages.append(message.decode())

    unit.messages, unit.description = messages, description
    unit.instantiate(logMessage=told, loggingOn=logging)
    yield unit
    unit.freeInstance()


def begun(unit: Any, deflection: float, radius: float, time: float = 0.0) -> None:
    unit.enterInitializationMode(startTime=time)
    unit.setFloat64([0, 1], [deflection, radius])
    unit.exitInitializationMode()
