"""Regressors of each named effect: what its forms can add to the force, in equations of the rig's own.

They are generous on purpose (many breakaway distances, many time constants at once): a set of effects that does not
explain a recording even so is certainly excluded.
"""

from dataclasses import dataclass

import numpy as np

from .bench import Bench
from .effects.effect import Contact
from .effects.friction import jenkins
from .effects.relaxation import overstress
from .motion import FloatArray, Motion

#: Effects that a catalogue of tire physics has a name for.
NAMES = (
    "deflection_offset",
    "force_offset",
    "rate_independent_hysteresis",
    "viscous_damping",
    "viscoelastic_relaxation",
    "series_compliance",
    "gas_compression",
    "bottoming",
    "mullins_softening",
    "pressure_leak",
    "warm_up",
    "inertia",
    "force_lag",
    "saturation",
    "recalibration",
)
#: Effects whose regressors may enter with either sign; all others only add what their physics adds (a shift or
#: a lag has regressors for both directions).
EITHER_SIGN = frozenset({"force_offset", "recalibration"})


@dataclass(frozen=True)
class Range:
    """What all recordings of a trial share: surfaces [m], deepest deflection [m], duration and step [s]."""

    surfaces: tuple[float, ...]
    deepest: float
    strongest: float
    longest: float
    shortest_step: float

    @classmethod
    def of(cls, bench: Bench, motions: tuple[Motion, ...]) -> "Range":
        """The range of some motions on a bench."""
        return cls(
            tuple(sorted({r for m in motions for r in m.surfaces})),
            max(float(np.max(m.deflection)) for m in motions),
            max(float(np.max(Bench(bench.tire).force(m))) for m in motions),
            max(m.duration for m in motions),
            min(m.sample_step for m in motions),
        )


def regressors(bench: Bench, motion: Motion, common: Range, law_shape: bool) -> dict[str, FloatArray]:
    """Regressors [N] of every name on the recorded samples of a motion, shape (n, k); k is the same for all motions.

    law_shape: whether recalibration may change the shape of the law too, not only A and B.
    """
    contact = Bench(bench.tire).contact(motion)
    columns = {
        "deflection_offset": _shifted(bench, contact),
        "force_offset": [np.ones_like(contact.elastic)],
        "rate_independent_hysteresis": _friction(contact, common),
        "viscous_damping": _viscous(contact, common),
        "viscoelastic_relaxation": _relaxation(contact, common),
        "series_compliance": _compliance(bench, contact),
        "gas_compression": _gas(contact, common),
        "bottoming": _rim(contact, common),
        "mullins_softening": _softening(contact, common),
        "pressure_leak": _leak(contact, common),
        "warm_up": _warming(contact, common),
        "inertia": [motion.acceleration],
        "force_lag": _lag(contact, common),
        "saturation": _ceiling(contact, common),
        "recalibration": _recalibration(contact, common, law_shape),
    }
    return {name: np.stack([motion.recorded(c) for c in parts], axis=1) for name, parts in columns.items()}


def _shifted(bench: Bench, contact: Contact) -> list[FloatArray]:
    ones = np.ones_like(contact.elastic)
    return [
        bench.tire.force(contact.deflection + shift, contact.motion.radius, ones) - contact.elastic
        for shift in (-3e-3, -1e-3, -0.2e-3, 0.2e-3, 1e-3, 3e-3)
    ]


def _friction(contact: Contact, common: Range) -> list[FloatArray]:
    breakaway = common.deepest * np.array([0.003, 0.01, 0.03, 0.08, 0.2, 0.4])
    states = jenkins(contact.deflection, breakaway)
    load = contact.elastic / common.strongest
    return [*(contact.touching * states), *(load * states)]


def _viscous(contact: Contact, common: Range) -> list[FloatArray]:
    rate = contact.motion.rate
    load = contact.elastic / common.strongest
    typical = float(np.sqrt(np.mean(rate**2))) + 1e-9
    thinning = np.sign(rate) * np.abs(rate / typical) ** 0.7
    return [rate * contact.touching, rate * load, thinning * contact.touching]


def _relaxation(contact: Contact, common: Range) -> list[FloatArray]:
    constants = np.geomspace(0.5 * common.shortest_step, 2.0 * common.longest, 9)
    return [overstress(contact.elastic, contact.motion.step, float(tau)) for tau in constants]


def _compliance(bench: Bench, contact: Contact) -> list[FloatArray]:
    columns = []
    ones = np.ones_like(contact.elastic)
    for stiffness in (3e5, 8e5, 2e6):
        deflection = contact.deflection
        for _ in range(25):
            force = bench.tire.force(deflection, contact.motion.radius, ones)
            deflection = 0.5 * deflection + 0.5 * (contact.deflection - force / stiffness)
        columns.append(force - contact.elastic)
    return columns


def _gas(contact: Contact, common: Range) -> list[FloatArray]:
    ratio = np.maximum(contact.deflection, 0.0) / common.deepest
    return [contact.elastic * ratio**power for power in (2.0, 2.5, 3.0)]


def _rim(contact: Contact, common: Range) -> list[FloatArray]:
    onsets = common.deepest * np.array([0.5, 0.65, 0.75, 0.82, 0.88, 0.92, 0.95, 0.97])
    return [np.maximum(contact.deflection - onset, 0.0) for onset in onsets]


def _softening(contact: Contact, common: Range) -> list[FloatArray]:
    x = np.maximum(contact.deflection, 0.0)
    largest = np.maximum(np.maximum.accumulate(x), 1e-9)
    below = 1.0 - x / largest
    path = np.cumsum(np.abs(np.diff(x, prepend=x[0])) * (x < largest))
    columns = [-contact.elastic * (1.0 - (x / largest) ** power) for power in (0.5, 1.0, 3.0, 8.0)]
    columns += [-contact.elastic * below * largest / common.deepest]
    columns += [contact.elastic * below * np.expm1(-path / (share * common.deepest)) for share in (0.5, 2.0)]
    return columns


def _leak(contact: Contact, common: Range) -> list[FloatArray]:
    time = contact.motion.time / common.longest
    return [contact.elastic * np.expm1(-rate * time) for rate in (0.02, 1.0, 3.0)]


def _warming(contact: Contact, common: Range) -> list[FloatArray]:
    constants = np.geomspace(0.03, 2.0, 6) * common.longest
    return [-contact.elastic * np.expm1(-contact.motion.time / tau) for tau in constants]


def _lag(contact: Contact, common: Range) -> list[FloatArray]:
    time = contact.motion.time
    delays = np.array([-0.04, -0.01, -0.003, 0.003, 0.01, 0.04])
    return [np.interp(time - delay, time, contact.elastic) - contact.elastic for delay in delays]


def _ceiling(contact: Contact, common: Range) -> list[FloatArray]:
    ceilings = common.strongest * np.array([0.5, 0.6, 0.7, 0.8, 0.87, 0.93, 0.97])
    return [-np.maximum(contact.elastic - ceiling, 0.0) for ceiling in ceilings]


def _recalibration(contact: Contact, common: Range, law_shape: bool) -> list[FloatArray]:
    log = np.log(np.maximum(100.0 * contact.deflection, 1e-3))
    columns = []
    for radius in common.surfaces:
        here = contact.elastic * (contact.motion.radius == radius)
        columns += [here, here * log, *([here * log**2] if law_shape else [])]
    return columns
