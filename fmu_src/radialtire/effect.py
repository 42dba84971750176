"""The interface of one effect: physics that an elastic law alone leaves out.

An effect is a pure response at one stage of the signal path from the measured deflection to the measured force:

    place "deflection"  measured deflection  -> deflection of wheel and tire
    place "series"      deflection           -> deflection of the tire (springs in series)
    place "law"         force of A x^B       -> force of another law
    place "scale"       factor               -> factor on the elastic force (pressure, softening)
    place "parallel"    force                -> force with what is added beside the elastic law
    place "mass"        force                -> force with what accelerates
    place "reading"     force                -> measured force (lag, zero, ceiling)

Effects of one place act in the order of the catalogue. At "scale" a response multiplies its signal, at "parallel" it
adds to it, whatever the signal is. After "parallel" a force below zero becomes zero, since the ground cannot pull; that
of a part that is held at both ends (a damper, a bushing) stays.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import NamedTuple

from .parameter import Parameter

TRAITS = ("static", "rate", "loop", "rest", "localized", "slow", "reading", "law", "air")
"""What an effect depends on or is: deflection alone; rate or acceleration; loading and unloading differ; moves the
force for a while in a hold; acts in a part of the range only; changes with the time since the start; is of the
instrument and not of the tire; is the elastic law's own shape; needs air that carries the load."""

PLACES = ("deflection", "series", "law", "scale", "parallel", "mass", "reading")

State = tuple[float, ...]


@dataclass(frozen=True)
class Channel:
    """A quantity beside the motion that a recording may hold, that an effect may read, and that is then an input.

    name: as in recordings and in `Instant`; variable: as the FMU's input; unit, in SI; usual: a value of usual size;
    minimum, maximum: the closed interval of values that can be; meaning: one line for the FMU; resolution: least change
    that shows anything, as a part of the value; unknown: the input's value that stands for a quantity that is not
    known, or NOT_MEASURED where there is none
    """

    name: str
    variable: str
    unit: str
    usual: float
    minimum: float
    maximum: float
    meaning: str
    resolution: float
    unknown: float = math.nan


NOT_MEASURED = math.nan
"""What `Instant` holds of a channel that was not recorded and is no input."""

CHANNELS = (
    Channel(
        "pressure",
        "inflation_pressure",
        "Pa",
        344.7e3,
        -101325.0,
        1e7,
        "Gauge pressure of the air in the tire",
        resolution=1e-2,
    ),
    Channel(
        "temperature",
        "tire_temperature",
        "K",
        293.15,
        0.0,
        1e4,
        "Temperature of the tire; 0: not known, it warms with time",
        resolution=1e-3,
        unknown=0.0,
    ),
)
"""Every channel that an effect may read, in the order of the fields of `Instant` and of `measured` values."""

NONE_MEASURED = (NOT_MEASURED,) * len(CHANNELS)
"""The measured values where no channel was recorded."""


def is_measured(value: float) -> bool:
    """Return whether a channel was recorded: NOT_MEASURED is not equal to itself."""
    return value == value


class Instant(NamedTuple):
    """The quantities that an effect may use at one time, all in SI except A.

    time: [s] since the first sample; interval: [s] since the previous sample; first: whether this is the first sample
    deflection: [m] at the places "deflection" and "series" the input of the place, after them that of the tire
    rate: [m/s] of that deflection; acceleration: [m/s^2] of the measured deflection
    coefficient, exponent: A [N/cm^B] and B [1] of the surface
    elastic_force: [N] after "scale" A x^B with its factor, and with the preload of a part that air carries; before it 0
    curvature: [1/m] of the surface, convex > 0
    pressure: [Pa], gauge, and temperature [K] of the tire, as measured or as inputs; else NOT_MEASURED
    two_sided: whether the part is held at both ends, so that a deflection below 0 is no lost contact
    preload: [N] after "scale" that preload without the factor; 0 of a part without air
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
    pressure: float = NOT_MEASURED
    temperature: float = NOT_MEASURED
    two_sided: bool = False
    preload: float = 0.0


Response = Callable[[float, Instant, State, State], "tuple[float, State]"]
"""respond(signal, instant, state, values) -> (signal, state).

Plain floats, math and tuples of fixed length only: the tool compiles it. An interval of zero after the first sample
evaluates the last sample again, perhaps with another deflection.
"""


@dataclass(frozen=True)
class Flow:
    """An effect as differential equations, for a solver: Model Exchange.

    respond: as that of the effect, but the numbers `states` of the state are the solver's, and in the state after it
    stand their rates [per s], or their values at the first sample; the others are memory, kept at accepted steps
    states: their indices in the effect's state; names: their names; units: their units
    whole: index of the number from which those of steps are subtracted to have the solver's; None: they are the same
    """

    respond: Response
    states: tuple[int, ...]
    names: tuple[str, ...]
    units: tuple[str, ...]
    whole: int | None = None


@dataclass(frozen=True)
class Reading:
    """An effect that reads a channel.

    channel: of CHANNELS, by its name; reference: the parameter that is the channel's value at which the effect
    vanishes, and then it does nothing where the channel was not measured; None: it has a response without it too
    """

    channel: str
    reference: str | None = None


@dataclass(frozen=True)
class LookAlike:
    """Something outside the catalogue that leaves the same in a recording, so that no fit tells it from an effect.

    what: it; check: what tells the two apart, as an action
    """

    what: str
    check: str


@dataclass(frozen=True)
class Effect:
    """One piece of physics.

    name: as in the catalogue, tire files and verdicts; place: one of PLACES
    parameters: in the order in which `respond` takes their values; the effect vanishes exactly where every parameter
    that has a neutral value has it
    initial_state: its state before the first sample
    respond: the pure response (see Response)
    statement: one sentence for the verdict; tell_tale: how it shows in a recording; imitators: what looks like it
    source: where equation and magnitudes come from; look_alike: outside the catalogue, None for the law's own shape
    differentiates: whether it uses rate or acceleration; traits: of TRAITS
    form_error: part of its response by which other formulations of the same physics differ from it once fitted, as
    measured by `tirelab.validation.form_errors` (at least 0.001; a lag of the deflection and a drift of the force were
    never alone)
    flow: the effect as differential equations, or None: then its state is memory, kept at accepted steps
    reads: the channel that it reads, or None; changes: names of the channels that move in proportion to what it does to
    the force, so that a recording of them shows it or refutes it
    """

    name: str
    place: str
    parameters: tuple[Parameter, ...]
    initial_state: State
    respond: Response
    statement: str
    tell_tale: str
    imitators: tuple[str, ...]
    source: str
    look_alike: LookAlike | None = None
    differentiates: bool = False
    traits: tuple[str, ...] = ()
    form_error: float = 0.02
    flow: Flow | None = None
    reads: Reading | None = None
    changes: tuple[str, ...] = ()

    @property
    def holds_gap(self) -> bool:
        """Whether its first parameter shifts the deflection by one number, as the gap of a part does."""
        return self.place == "deflection" and {"static", "reading"} <= set(self.traits)

    @property
    def signed(self) -> bool:
        """Whether its first strength may be of either sign."""
        return next((p.minimum < 0.0 for p in self.parameters if p.role == "strength"), False)

    @property
    def neutral(self) -> State:
        """The values at which the effect vanishes: the neutral value of a parameter that has one, else its start."""
        return tuple(p.start if p.neutral is None else p.neutral for p in self.parameters)

    @property
    def nominal(self) -> State:
        """Values of usual size, from which a search may begin; optional parameters stay at their start."""
        return tuple(p.start if p.optional else p.nominal_value for p in self.parameters)

    def checked(self, values: State) -> State:
        """Return the values as floats, or raise ParameterError."""
        return tuple(p.checked(v) for p, v in zip(self.parameters, values, strict=True))
