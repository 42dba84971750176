"""The tire FMU as a function that is asked once per step, driven with fmpy."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from coupled import SteppedTire
from fmpy.fmi1 import FMICallException
from tirelab.errors import TirelabError
from tirelab.fmu.replay import NO_REASON, OpenFmu, opened

FLAT = 1e5
"""Surface radius [m] that the FMU takes for flat, as it does infinity."""


@contextmanager
def fmu_tire(fmu: Path, **held: float) -> Iterator[SteppedTire]:
    """Open the tire FMU at `fmu` and yield it as a function of time [s], deflection [m] and surface radius [m].

    held: inputs that keep one value, such as inflation_pressure [Pa] of a tire that has one

    Every question is a communication step that ends at its time, the inputs set first. An FMU is native code: open
    only those that you trust.
    """
    with opened(fmu) as unit:
        for name in held:
            if name not in unit.references:
                raise TirelabError(f"{fmu} has no input {name!r}; build it from a tire that reads it")
        yield _asked(unit, held)


def _asked(unit: OpenFmu, held: dict[str, float]) -> SteppedTire:
    instance = unit.instance
    inputs = [unit.references[name] for name in ("deflection", "surface_radius")]
    output = [unit.references["radial_force"]]
    last: list[float] = []

    def tire(time: float, deflection: float, surface_radius: float) -> float:
        if not last:
            instance.setupExperiment(startTime=time)
            instance.enterInitializationMode()
            instance.setReal([unit.references[name] for name in held], list(held.values()))
        instance.setReal(inputs, [deflection, min(max(surface_radius, -FLAT), FLAT)])
        try:
            if last:
                instance.doStep(last[0], time - last[0])
            else:
                instance.exitInitializationMode()
        except FMICallException:
            reason = unit.messages()[-1] if unit.messages() else NO_REASON
            raise TirelabError(f"the tire FMU refused t = {time:g} s: {reason}") from None
        last[:] = [time]
        return float(instance.getReal(output)[0])

    return tire
