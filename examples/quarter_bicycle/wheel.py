"""Where one wheel touches sampled ground, in plain numbers.

The same contact as `tirelab.terrain.contact`, which explains it, for one position of the hub at a time: a test holds
the two to 1e-12. Standard library only: QuarterBicycle.fmu carries this file.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

FLAT_CURVATURE = 1e-6
"""Curvatures [1/m] of up to this are flat."""


class OffTheGroundError(ValueError):
    """A hub that is not above the ground, or where a part of the wheel has no ground beneath it."""


@dataclass(frozen=True)
class Track:
    """Ground sampled every `spacing` [m]: distance s [m], height z [m], direction [rad], arc [m], curvature [1/m]."""

    spacing: float
    s: tuple[float, ...]
    z: tuple[float, ...]
    direction: tuple[float, ...]
    arc: tuple[float, ...]
    curvature: tuple[float, ...]


@dataclass(frozen=True)
class Meeting:
    """What the tire is asked: deflection [m] (negative in the air) and surface radius [m]; with the force's angle."""

    deflection: float
    surface_radius: float
    inclination: float


def meet(track: Track, position: float, hub_height: float, wheel_radius: float) -> Meeting:
    """Return how a wheel with its hub at (`position`, `hub_height`) [m] meets the ground.

    Raises OffTheGroundError where there is no ground beneath the whole wheel, and for a hub within the ground.
    """
    s, z = track.s, track.z
    half = math.ceil(wheel_radius / track.spacing) + 1
    if not s[half] - 1e-9 <= position <= s[-half - 2] + 1e-9:
        raise OffTheGroundError(
            f"the hub at s = {position:g} m has not the whole wheel over the ground; keep it between {s[half]:g} m and "
            f"{s[-half - 2]:g} m"
        )
    base = min(max(math.floor((position - s[0]) / track.spacing), half), len(s) - half - 2)
    if not hub_height > z[base]:
        raise OffTheGroundError(f"the hub is in the ground at s = {position:g} m; take a shorter step")
    first, last = base - half, base + half + 2
    squared = [
        (a - position) * (a - position) + (hub_height - b) * (hub_height - b)
        for a, b in zip(s[first:last], z[first:last], strict=True)
    ]
    deepest = min(max(squared.index(min(squared)), 1), len(squared) - 2)
    shift, change = _vertex(*squared[deepest - 1 : deepest + 2])
    deflection = wheel_radius - math.sqrt(max(squared[deepest] + change, 0.0))
    foot = first + deepest + shift

    circle = wheel_radius * wheel_radius
    if squared[deepest] < circle:
        start = first + _edge(squared, deepest, -1, circle)
        end = first + _edge(squared, deepest, 1, circle)
        length = _at(track.arc, end) - _at(track.arc, start)
    else:
        start = end = foot
        length = 0.0
    if length > 1e-9:
        curvature = (_at(track.direction, start) - _at(track.direction, end)) / length
    else:
        curvature = _at(track.curvature, foot)
    return Meeting(
        deflection,
        1.0 / curvature if abs(curvature) > FLAT_CURVATURE else math.inf,
        math.atan2(position - _at(s, foot), hub_height - _at(z, foot)),
    )


def _vertex(left: float, middle: float, right: float) -> tuple[float, float]:
    """Return where, in samples, and how far below `middle` the parabola through three neighbours is lowest."""
    bend = left - 2.0 * middle + right
    if not bend > 0.0:
        return 0.0, 0.0
    shift = min(max(0.5 * (left - right) / bend, -0.5), 0.5)
    return shift, shift * (0.5 * (right - left) + 0.5 * shift * bend)


def _edge(squared: list[float], deepest: int, way: int, circle: float) -> float:
    """Return the sample, with its fraction, at which the ground leaves the wheel's circle on the `way`, -1 or 1."""
    outer = deepest + way
    while 0 < outer < len(squared) - 1 and squared[outer] < circle:
        outer += way
    out, inn = squared[outer], squared[outer - way]
    share = (out - circle) / (out - inn) if out > inn else 0.0
    return outer - way * min(max(share, 0.0), 1.0)


def _at(values: tuple[float, ...], sample: float) -> float:
    """Return `values` between samples, linear."""
    low = min(max(int(sample), 0), len(values) - 2)
    return values[low] + (sample - low) * (values[low + 1] - values[low])
