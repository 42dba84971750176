"""Every explanation as columns: what each effect, in every form its physics allows, would add to the force.

A family is linear in its coefficients around a point (the elastic law and the shifts found so far), so that thousands
of sets can be compared on one matrix of products. Which form an effect takes (Dahl or Iwan elements, one relaxation
time or a spectrum, sharp knee or soft) is left to the coefficients of its own family.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numba import njit
from radialtire.effects.gas_compression import LEAST_CURVATURE
from radialtire.hull1996 import WHEEL_RADIUS
from scipy.signal import lfilter

from ..preprocessing.kinematics import FloatArray
from .lag import lagged
from .place import Place
from .scene import Scene

Builder = Callable[[Place], FloatArray]


@dataclass(frozen=True)
class Family:
    """One explanation: its columns, how they group into variants, and the sign that its physics demands.

    variants: lists of column numbers, one of which is used; None means all columns together
    sign: +1 or -1 where the projection on the first variant's leading column must be so, 0 where both are allowed
    agnostic: True for a smooth function of coordinates that is no physics of the catalogue
    remembers: True where the columns need every sample before
    slow: True where it looks like slow noise; standing: True where it is tried for what stands out of a recording alone
    after_lag: True where the columns are added behind the lag of the force's reading
    """

    name: str
    build: Builder
    variants: Callable[[int], list[list[int]]] = lambda count: [list(range(count))]
    sign: float = 0.0
    agnostic: bool = False
    after_lag: bool = False
    remembers: bool = False
    slow: bool = False
    standing: bool = False

    @property
    def like_noise(self) -> bool:
        """Whether the amplifier's noise looks like it: a drift of its zero, or hum at a multiple of the sampling."""
        return self.slow or self.name == "force_drift"


def scale_of(p: Place, what: str) -> float:
    return max(float(np.sqrt(np.mean(getattr(r.motion, what) ** 2))) for r in p.scene.records) + 1e-12


def one_each(count: int) -> list[list[int]]:
    """Return variants of one column each."""
    return [[i] for i in range(count)]


def law_columns(powers: tuple[int, ...]) -> Builder:
    """Return what builds the elastic force times these powers of the deflection's logarithm, on each surface."""

    def build(p: Place) -> FloatArray:
        return np.stack([w * p.elastic * p.logarithm**k for w in p.record.surface.T for k in powers], axis=1)

    return build


@njit(cache=True)
def jenkins(deflection: FloatArray, reach: float, forgets: bool, seated: bool = True) -> FloatArray:
    """Return the pull of a spring with a slider, -1 to 1, that slides after `reach` [m] of travel (Iwan 1966).

    forgets: True where a tire that has left the ground starts anew, False where it comes back as it left
    seated: True where the tire was pressed to its first deflection from 0, False where nothing pulls there
    """
    state = np.empty_like(deflection)
    z = max(deflection[0], 0.0) / reach if seated else 0.0
    for i in range(deflection.size):
        z += (deflection[i] - deflection[max(i - 1, 0)]) / reach
        z = min(max(z, -1.0), 1.0)
        if forgets and deflection[i] <= 0.0:
            z = 0.0
        state[i] = z
    return state


@njit(cache=True)
def linear_recursion(decay: FloatArray, drive: FloatArray) -> FloatArray:
    """Return z with z[i] = decay[i] z[i-1] + drive[i], z[-1] = 0."""
    state = np.empty_like(drive)
    z = 0.0
    for i in range(drive.size):
        z = decay[i] * z + drive[i]
        state[i] = z
    return state


REACHES = (1e-4, 2.5e-4, 5e-4, 1e-3, 1.7e-3, 3e-3, 6e-3, 1.2e-2)
"""Travels [m] after which the sliders of an Iwan model slide: sums of them follow Dahl, Bouc-Wen and Iwan loops."""


BEGINNINGS = ((False, True), (True, True), (False, False))
"""Whether a slider forgets in the air, and whether it is seated at the first moment."""


def _friction(p: Place) -> FloatArray:
    load = p.elastic / p.scene.strongest
    contact = _contact(p)
    states = p.record.kept(
        "friction",
        lambda motion: (
            jenkins(motion.deflection, reach, *start) for start in BEGINNINGS for reach in REACHES
        ),
    )
    return np.stack([z * share for z in states for share in (contact, load, 1.0)], axis=1)


CLOSING = 3e-4
"""Deflection [m] over which the contact closes, before which dry and viscous forces cannot act in full."""


def _contact(p: Place) -> FloatArray:
    return np.asarray(-np.expm1(-np.maximum(p.deflection, 0.0) / CLOSING))


def _memories(count: int) -> list[list[int]]:
    """Return one variant for each beginning, with the dry force growing as the contact closes or at once."""
    own = count // len(BEGINNINGS)
    return [
        [first + 3 * i + k for i in range(own // 3) for k in (constant, 1)]
        for first in range(0, count, own)
        for constant in (0, 2)
    ]


RATE_EXPONENTS = (1.0, 0.75, 0.5, 1.35, 1.8)


def _viscous(p: Place) -> FloatArray:
    contact = _contact(p)
    depth = np.maximum(p.deflection, 0.0) / p.scene.deepest
    typical = scale_of(p, "rate")
    powers = p.record.kept(
        "rate powers",
        lambda motion: (np.sign(motion.rate) * np.abs(motion.rate / typical) ** n for n in RATE_EXPONENTS),
    )
    columns = [power * share for power in powers for share in (contact, contact * depth)]
    return np.stack([*columns, powers[0] * depth**2], axis=1)


def relaxation_times(scene: Scene) -> FloatArray:
    """Return the relaxation times [s] that the recordings can show, a factor of about 2.5 apart."""
    low, high = 2.0 * scene.finest, 1.5 * scene.longest
    return np.geomspace(low, high, max(2, int(np.ceil(np.log(high / low) / np.log(2.5))) + 1))


def high_pass(time: FloatArray, signal: FloatArray, time_constant: float) -> FloatArray:
    """Return the Maxwell force of a signal, dq/dt = ds/dt - q/tau, exact for a signal linear between samples."""
    interval = np.diff(time, prepend=time[0])
    rise = np.diff(signal, prepend=signal[0])
    ratio = interval / time_constant
    gain = np.where(ratio > 1e-9, -np.expm1(-ratio) / np.maximum(ratio, 1e-9), 1.0)
    if np.ptp(interval[1:]) <= 1e-3 * interval[-1]:
        return np.asarray(lfilter([gain[-1]], [1.0, -np.exp(-ratio[-1])], rise))
    return linear_recursion(np.exp(-ratio), gain * rise)


def _relaxation(p: Place) -> FloatArray:
    times = relaxation_times(p.scene)
    return np.stack([p.taken(high_pass(p.record.time, p.elastic, tau)) for tau in times], axis=1)


MEASURES = ((0.3, 0.0), (0.3, 0.15), (0.3, 0.6))
"""Energies over which a tire softens, as parts of the largest so far and of the largest of all."""


def _mullins(p: Place) -> FloatArray:
    """Softer below the largest deflection so far: at once, and as the way travelled below it goes on.

    How far below is measured in deflection or in energy, in proportion to the largest so far or not.
    """
    deepest = np.maximum(np.maximum.accumulate(p.deflection), 1e-9)
    part = np.clip(p.deflection / deepest, 0.0, 1.0)
    energy = np.maximum(p.elastic * p.deflection, 0.0)
    largest = np.maximum(np.maximum.accumulate(energy), 1e-9)
    below, lost = 1.0 - part, 1.0 - energy / largest
    fixed = p.scene.strongest * p.scene.deepest / largest
    shapes = [-np.expm1(-below / 0.04), -np.expm1(-below / 0.15), np.sqrt(below), below]
    shapes += [-np.expm1(-lost / (share + own * fixed)) for share, own in MEASURES]
    way = np.cumsum(np.abs(np.diff(p.deflection, prepend=p.deflection[0])) * (below > 0.0))
    gathered = [1.0, *(-np.expm1(-way / (share * p.scene.deepest)) for share in (0.4, 1.5))]
    return np.stack([p.taken(p.elastic * shape * part) for part in gathered for shape in shapes], axis=1)


PATCHES = (0.0, 0.3)
"""Exponents of 1 + r_w / R by which a patch may be shorter (see `radialtire.effects.gas_compression`): a sum of both
follows those between and a little beyond."""


def _compliance(p: Place) -> FloatArray:
    """What gives way by so much for each newton, and less so under a larger force."""
    return np.stack([p.stiffness * p.elastic * (p.elastic / p.scene.strongest) ** k for k in (0, 1)], axis=1)


GAS_POWERS = (1.5, 1.75, 2.0, 2.25, 2.5, 2.75, 3.0, 3.25)


def _gas(p: Place) -> FloatArray:
    """The air's volume falls with a power of the deflection; the pressure rises with that, and with its square.

    The volume lost at one deflection is the same on every surface, or as the patch is shorter on a convex one.
    """
    depth = np.maximum(p.deflection, 0.0) / p.scene.deepest
    bends = [0.0 if np.isinf(r) else 1.0 / r for r in p.scene.radii]
    bent = np.maximum(1.0 + WHEEL_RADIUS * (p.record.surface @ np.array(bends)), LEAST_CURVATURE)
    lost = [bent**-s * depth**power for power in GAS_POWERS for s in PATCHES]
    return np.stack([p.elastic * part**k for part in lost for k in (1, 2)], axis=1)


def _of_one_power(count: int) -> list[list[int]]:
    """Return one variant for each power of the deflection, with every patch."""
    width = 2 * len(PATCHES)
    return [list(range(first, first + width)) for first in range(0, count, width)]


def pairs(count: int) -> list[list[int]]:
    return [[i, i + 1] for i in range(0, count, 2)]


KNEES = np.linspace(0.40, 0.985, 40)
SOFTNESSES = (0.0, 0.006, 0.018, 0.05)
"""Knees of a rim strike, and how softly they bend, as parts of the largest deflection."""


def _bottoming(p: Place) -> FloatArray:
    depth = p.deflection / p.scene.deepest
    beyond = []
    for softness in SOFTNESSES:
        for knee in KNEES:
            if softness == 0.0:
                beyond.append(np.maximum(depth - knee, 0.0))
            else:
                beyond.append(softness * np.logaddexp(0.0, (depth - knee) / softness))
    return np.stack([*beyond, *(b**2 for b in beyond[: KNEES.size])], axis=1)


def _soft_knees(count: int) -> list[list[int]]:
    """Return one variant for each knee and softness: with those beside it, and stiffening beyond."""
    squares = KNEES.size * len(SOFTNESSES)
    variants = []
    for first in range(0, squares, KNEES.size):
        for i in range(KNEES.size):
            near = [first + i, first + i + 1] if i + 1 < KNEES.size else [first + i]
            softer = [first + KNEES.size + i] if first + KNEES.size < squares else []
            variants.append([*near, *softer, squares + i])
    return variants


CEILINGS = np.linspace(0.30, 1.26, 56)
CEILING_SOFTNESSES = (0.0, 0.015, 0.03, 0.06)
"""Ceilings of the force's reading, and how softly they are met, as parts of the largest reading: none lies above it by
more than the zero of the reading is off."""


def _saturation(p: Place) -> FloatArray:
    force = p.before_reading / p.scene.highest
    beyond = []
    for softness in CEILING_SOFTNESSES:
        for ceiling in CEILINGS:
            if softness == 0.0:
                beyond.append(np.maximum(force - ceiling, 0.0))
            else:
                beyond.append(softness * np.logaddexp(0.0, (force - ceiling) / softness))
    return np.stack([*beyond, *(force**power for power in (3, 5, 8, 12))], axis=1)


def _soft_ceilings(count: int) -> list[list[int]]:
    """Return one variant for each ceiling and softness, with those beside it; and the smooth powers."""
    soft = CEILINGS.size * len(CEILING_SOFTNESSES)
    variants = []
    for first in range(0, soft, CEILINGS.size):
        for i in range(CEILINGS.size):
            near = [first + i, first + i + 1] if i + 1 < CEILINGS.size else [first + i]
            softer = [first + CEILINGS.size + i] if first + CEILINGS.size < soft else []
            variants.append([*near, *softer])
    return [*variants, *([i, i + 1] for i in range(soft, count - 1))]


LAGS = tuple((lag, stages) for stages in (0, 1, 2) for lag in (1e-3, 2e-3, 4e-3, 8e-3, 16e-3, 32e-3, 64e-3))
"""Lags [s] and their stages that a screening from no lag tries."""


def _lag(p: Place) -> FloatArray:
    """The slope in time, and what each of LAGS would take away: the coefficient of the right one is -1."""
    slope = np.gradient(p.elastic, p.record.time)
    steps = [p.taken(p.elastic - lagged(p.record.time, p.elastic[:, None], *lag)[:, 0]) for lag in LAGS]
    return np.stack([p.taken(slope), *steps, p.taken(np.zeros_like(slope))], axis=1)


def _lag_variants(count: int) -> list[list[int]]:
    """Return the slope with its bend (nothing from no lag), and each finite lag."""
    return [[0, count - 1], *([i] for i in range(1, count - 1))]


def _warm(p: Place) -> FloatArray:
    """Stiffer by what the air or the rubber has warmed; less where the casing carries more of the force."""
    part = p.record.time / p.scene.longest
    depth = np.maximum(p.deflection, 0.0) / p.scene.deepest
    courses = [-np.expm1(-part / share) for share in (0.03, 0.1, 0.3, 1.0)]
    return np.stack([*(p.elastic * c for c in courses), p.elastic * depth * courses[1]], axis=1)


def _drift(p: Place) -> FloatArray:
    return (p.record.time / p.scene.longest)[:, None]


def _leak(p: Place) -> FloatArray:
    """Softer as the air goes; less where the casing carries more of the force."""
    part = p.record.time / p.scene.longest
    depth = np.maximum(p.deflection, 0.0) / p.scene.deepest
    return np.stack(
        [*(p.elastic * part**k for k in (1, 2, 3)), *(p.elastic * depth * part**k for k in (1, 2))], axis=1
    )


CATALOGUE_FAMILIES: tuple[Family, ...] = (
    Family("deflection_offset", lambda p: p.stiffness[:, None]),
    Family("force_offset", lambda p: np.ones((p.elastic.size, 1)), after_lag=True),
    Family("rate_independent_hysteresis", _friction, _memories, sign=1.0),
    Family("viscous_damping", _viscous, sign=1.0),
    Family("viscoelastic_relaxation", _relaxation, sign=1.0, remembers=True),
    Family("series_compliance", _compliance, sign=-1.0),
    Family("gas_compression", _gas, _of_one_power, sign=1.0),
    Family("bottoming", _bottoming, _soft_knees, sign=1.0),
    Family("mullins_softening", _mullins, sign=-1.0, remembers=True),
    Family("pressure_leak", _leak, sign=-1.0),
    Family("warm_up", _warm, sign=1.0),
    Family("force_drift", _drift, after_lag=True),
    Family("inertia", lambda p: p.record.motion.acceleration[:, None], sign=1.0),
    Family("force_lag", _lag, _lag_variants, sign=-1.0, remembers=True),
    Family("saturation", _saturation, _soft_ceilings, sign=-1.0),
)

STATIC = ("deflection_offset", "series_compliance", "gas_compression")
"""Effects that depend on deflection and radius alone and everywhere: they compete with the law's own shape."""

LAW_FAMILIES: tuple[Family, ...] = (
    Family("recalibration", law_columns((0, 1))),
    Family("shape", law_columns((2, 3))),
)
