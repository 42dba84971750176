"""The recordings that the rig of Hull, Wang & Moore (1996) would have made of a tire.

A wheel hangs in a stiff fork above a hydraulic actuator, which presses semicircular wooden surfaces against the tire:
a triangle wave of 30 s sampled at 5 Hz, on ten convex surfaces, a flat one and three concave ones, to a deflection
between 1.27 and 3.175 cm that keeps the force below 2240 N. All of this is the article's. Three things it leaves open
are chosen here: the eight convex radii between 1.27 and 58.4 cm except 25.4 cm, which its text names (inch sizes,
closer together where the tire feels them); the steps of the deflection (1/8 in); the number of cycles (one).

Reference: M. L. Hull, E. L. Wang, D. F. Moore, "An empirical model for determining the radial force-deflection
behavior of off-road bicycle tires", Cycling Science, Spring 1996, section Methods.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray
from radialtire import TireModel
from radialtire.hull1996 import DEFLECTION_MAX, FORCE_MAX

from ..errors import TirelabError
from ..recordings.recording import Recording

PERIOD = 30.0
"""Period of the triangle wave [s]."""

SAMPLING_RATE = 5.0
"""Samples per second [Hz]."""

DEFLECTION_LEAST = 0.0127
"""Least of the largest deflections [m]: 0.5 in."""

DEFLECTION_STEP = 0.003175
"""Step in which the largest deflection was set [m]: 1/8 in, our choice."""

CONVEX_RADII = (0.0127, 0.01905, 0.03175, 0.0508, 0.0762, 0.1143, 0.1651, 0.254, 0.381, 0.584)
"""Convex radii [m]: 0.5, 0.75, 1.25, 2, 3, 4.5, 6.5, 10, 15 and 23 in; the article gives the first, 10 in, the last."""

CONCAVE_RADII = (-0.381, -0.508, -0.584)
"""Concave radii [m]: 15, 20 and 23 in, all from the article."""

SURFACES = (*CONVEX_RADII, math.inf, *CONCAVE_RADII)
"""The fourteen surfaces [m]: convex > 0, flat infinite, concave < 0."""

WARM_UP = 12.0
"""Correlation times that the noise runs before a recording starts, so that its start is like the rest."""


@dataclass(frozen=True)
class ForceNoise:
    """Gaussian noise of the force.

    standard_deviation: [N]; correlation_time: [s] over which its autocorrelation falls to 1/e, 0 for white noise
    seed: the same seed gives the same noise
    """

    standard_deviation: float = 0.0
    correlation_time: float = 0.0
    seed: tuple[int, ...] = (0,)

    @property
    def description(self) -> str:
        """The noise in words."""
        return f"noise of {self.standard_deviation:g} N correlated over {self.correlation_time:g} s"


NO_NOISE = ForceNoise()


def largest_deflection(tire: TireModel, surface_radius: float) -> float:
    """Return the deflection [m] to which the rig presses `tire` on a surface of radius `surface_radius` [m].

    The largest of 1.27, 1.5875, ... 3.175 cm at which the force stays below 2240 N; TirelabError if there is none.
    """
    count = round((DEFLECTION_MAX - DEFLECTION_LEAST) / DEFLECTION_STEP)
    peak = math.inf
    for i in range(count, -1, -1):
        deflection = DEFLECTION_LEAST + i * DEFLECTION_STEP
        _, _, force = _cycles(tire, surface_radius, deflection, 1, SAMPLING_RATE)
        peak = float(force.max())
        if peak < FORCE_MAX:
            return deflection
    raise TirelabError(
        f"{tire.name or 'the tire'} pushes back with {peak:.0f} N at {100 * DEFLECTION_LEAST:g} cm on "
        f"{surface_name(surface_radius)} ground, more than the rig's {FORCE_MAX:g} N; name a softer tire"
    )


def record(
    tire: TireModel,
    surface_radius: float,
    *,
    cycles: int = 1,
    noise: ForceNoise = NO_NOISE,
    sampling_rate: float = SAMPLING_RATE,
) -> Recording:
    """Return what the rig records of `tire` on one surface.

    surface_radius: [m] convex > 0, concave < 0, flat infinite
    cycles: triangles of 30 s, at least 1; noise: added to the force; sampling_rate: [Hz]

    Raises TirelabError where an argument makes no sense or the tire is too stiff for the rig.
    """
    if cycles < 1:
        raise TirelabError(f"{cycles} cycles make no recording; ask for one or more")
    if not (0.0 <= noise.standard_deviation < math.inf and 0.0 <= noise.correlation_time < math.inf):
        raise TirelabError(f"{noise.description}: neither may be below 0")
    if not 2.0 <= sampling_rate * PERIOD < math.inf:
        raise TirelabError(
            f"a sampling rate of {sampling_rate:g} Hz does not see a cycle of {PERIOD:g} s; raise it"
        )
    deflection_max = largest_deflection(tire, surface_radius)
    time, deflection, force = _cycles(tire, surface_radius, deflection_max, cycles, sampling_rate)
    if noise.standard_deviation > 0.0:
        force = force + noise.standard_deviation * _noise(
            time.size, noise.correlation_time * sampling_rate, noise.seed
        )
    return Recording(
        name=surface_name(surface_radius),
        time=time,
        deflection=deflection,
        surface_radius=np.full(time.size, surface_radius),
        force=force,
        notes=(
            f"computed from {tire.name or 'a tire'} as the rig of Hull, Wang & Moore 1996 would record it",
            *([f"{noise.description}, added"] if noise.standard_deviation > 0.0 else []),
        ),
    )


def record_all(
    tire: TireModel | None = None,
    *,
    cycles: int = 1,
    noise: ForceNoise = NO_NOISE,
    sampling_rate: float = SAMPLING_RATE,
) -> tuple[Recording, ...]:
    """Return the rig's fourteen recordings of `tire` (the article's where None); arguments as in `record`.

    Each recording has noise of its own, drawn from the seed and the number of its surface.
    """
    return tuple(
        record(
            tire or TireModel(),
            radius,
            cycles=cycles,
            noise=replace(noise, seed=(*noise.seed, i)),
            sampling_rate=sampling_rate,
        )
        for i, radius in enumerate(SURFACES)
    )


def surface_name(surface_radius: float) -> str:
    """Return "flat", or "convex_" or "concave_" with the radius in cm."""
    if math.isinf(surface_radius):
        return "flat"
    return f"{'convex' if surface_radius > 0.0 else 'concave'}_{100.0 * abs(surface_radius):g}cm"


def _cycles(
    tire: TireModel, surface_radius: float, deflection_max: float, cycles: int, sampling_rate: float
) -> tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.float64]]:
    """Return time [s], deflection [m] and force [N], the force step by step as the FMU computes it."""
    count = round(cycles * PERIOD * sampling_rate)
    time = np.arange(count + 1) / sampling_rate
    phase = time / PERIOD % 1.0
    deflection = deflection_max * (1.0 - np.abs(2.0 * phase - 1.0))
    force = np.empty(time.size)
    state = tire.initial_state
    for i, (t, x) in enumerate(zip(time.tolist(), deflection.tolist(), strict=True)):
        force[i], state = tire.step(x, surface_radius, t, state)
    return time, deflection, force


def _noise(count: int, correlation: float, seed: Sequence[int]) -> NDArray[np.float64]:
    """Return `count` samples of unit variance whose correlation falls to 1/e over `correlation` samples."""
    generator = np.random.default_rng(seed)
    if correlation == 0.0:
        return generator.standard_normal(count)
    from scipy.signal import lfilter

    ahead = math.ceil(WARM_UP * correlation)
    memory = math.exp(-1.0 / correlation)
    white = generator.standard_normal(ahead + count)
    coloured: NDArray[np.float64] = lfilter([math.sqrt(1.0 - memory**2)], [1.0, -memory], white)
    return coloured[ahead:]
