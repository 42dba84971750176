"""The contract of one piece of physics that a bare elastic law leaves out.

An effect is a pure response at one place of the signal's way from the deflection's reading to the force's reading:

    place "deflection"  deflection read      -> deflection of wheel and tire
    place "series"      deflection           -> deflection of the tire (springs in series)
    place "scale"       factor               -> factor on the elastic force (pressure, softening)
    place "parallel"    force                -> force with what acts beside the elastic law
    place "inertia"     force                -> force with what accelerates
    place "reading"     force                -> force read (lag, zero, ceiling)

Effects of one place act in the order of the catalogue. After "parallel" a force below zero becomes zero, since the
ground cannot pull.
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

    time: [s] since the first moment; interval: [s] since the last moment; first: whether this is the first moment
    deflection: [m] at the places "deflection" and "series" the signal that the place began with, after them that of
    the tire; rate: [m/s] of that deflection; acceleration: [m/s^2] of the deflection read
    coefficient, exponent: A [N/cm^B] and B [1] of the surface
    elastic_force: [N] at the place "scale" A x^B, after it A x^B with its factor, before it 0
    curvature: [1/m] of the surface, convex > 0
    """

    time: float
    interval: float
    first: bool
    deflection: float
    rate: float
    acceleration: float
    coefficient: float
    exponent: float
    elastic_force: float
    curvature: float = 0.0


Response = Callable[[float, Instant, State, State], "tuple[float, State]"]
"""respond(signal, instant, state, values) -> (signal, state).

Plain floats, math and tuples of fixed length only: the tool compiles it. At an interval of zero that is not the first
moment the last moment is looked at again, perhaps with another deflection.
"""


@dataclass(frozen=True)
class Effect:
    """One piece of physics.

    name: as in the catalogue, tire files and verdicts; place: one of PLACES
    parameters: in the order in which `respond` takes their values; the effect is off, exactly, when every parameter
    that has an `off` value has it
    rest: its state where nothing has happened yet
    respond: the pure response (see Response)
    statement: one sentence for the verdict; tell_tale: how it shows itself; imitators: what looks like it
    source: where equation and magnitudes come from
    differentiates: whether it looks at rate or acceleration
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
    differentiates: bool = False

    @property
    def off(self) -> State:
        """The values at which the effect vanishes: `off` where a parameter has it, else its start."""
        return tuple(p.start if p.off is None else p.off for p in self.parameters)

    @property
    def typical(self) -> State:
        """Everyday values, from which a search may begin; what the plain form does without stays at its start."""
        return tuple(p.start if p.extra else p.everyday for p in self.parameters)

    def checked(self, values: State) -> State:
        """Return the values as floats, or raise ParameterError."""
        return tuple(p.checked(v) for p, v in zip(self.parameters, values, strict=True))
