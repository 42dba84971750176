"""The contract of one piece of physics that a bare elastic law leaves out.

An effect is a pure response at one place of the signal's way from the deflection's reading to the force's reading:

    place "deflection"  deflection read      -> deflection of wheel and tire
    place "series"      deflection           -> deflection of the tire (springs in series)
    place "scale"       1                    -> factor on the elastic force (pressure, softening)
    place "parallel"    force                -> force with what acts beside the elastic law
    place "inertia"     force                -> force with what accelerates
    place "reading"     force                -> force read (lag, zero, ceiling)

Effects of one place act in the order of the catalogue.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import NamedTuple

from .parameter import Parameter

PLACES = ("deflection", "series", "scale", "parallel", "inertia", "reading")

State = tuple[float, ...]


class Instant(NamedTuple):
    """What an effect may know of one moment, all in SI except A.

    time: [s] since the start; interval: [s] since the last moment, 0 for the first one
    deflection: [m] of the tire, after offsets and springs in series; rate: [m/s]; acceleration: [m/s^2]
    coefficient, exponent: A [N/cm^B] and B [1] of the surface; elastic_force: [N] A x^B with its factor
    """

    time: float
    interval: float
    deflection: float
    rate: float
    acceleration: float
    coefficient: float
    exponent: float
    elastic_force: float


Response = Callable[[float, Instant, State, State], "tuple[float, State]"]
"""respond(signal, instant, state, values) -> (signal, state): plain floats, math and fixed-length tuples only."""


@dataclass(frozen=True)
class Effect:
    """One piece of physics.

    name: as in the catalogue, tire files and verdicts; place: one of PLACES
    parameters: in the order in which `respond` takes their values
    rest: its state where nothing has happened yet
    respond: the pure response (see Response)
    statement: one sentence for the verdict; tell_tale: how it shows itself; imitators: what looks like it
    source: where equation and magnitudes come from
    """

    name: str
    place: str
    parameters: tuple[Parameter, ...]
    rest: State
    respond: Response
    statement: str
    tell_tale: str
    imitators: tuple[str, ...]
    source: str

    def checked(self, values: State) -> State:
        """Return the values as floats, or raise ParameterError."""
        return tuple(p.checked(v) for p, v in zip(self.parameters, values, strict=True))
