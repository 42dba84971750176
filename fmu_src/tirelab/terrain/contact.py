"""Where a wheel touches the ground: deflection, section in contact, and the average radius of curvature there.

The unloaded wheel is a circle of radius R_w about the hub at (s, h). With d the distance from the hub to a point of the
ground,

    deflection = R_w - min d

over the points beneath: the article's compression along the line from the hub to the ground, where it is largest.
It is negative by the gap when the wheel is in the air. The section in contact is the ground inside the circle, from
one crossing to the other around the deepest point. Over it the article prescribes "an average radius of curvature";
we average the curvature,

    1 / R = (direction at its start - direction at its end) / length of the section,

and not the radius, since a radius has no average over a section that goes from bump to dip: it passes through
infinity, and +1 m with -1 m would average to a sharp 0 instead of to flat. The mean curvature is the turn of the ground
per length: it depends on the section's two ends alone, adds up over parts, and stays finite across a corner.

The smallest distance is found between samples by a parabola through d^2 at three of them, exact on flat ground.

Reference: M. L. Hull, E. L. Wang, D. F. Moore, "An empirical model for determining the radial force-deflection behavior
of off-road bicycle tires", Cycling Science, Spring 1996 (quoted); the wheel of 66 cm diameter is theirs.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, fields

import numpy as np
from numpy.typing import NDArray
from radialtire.hull1996 import WHEEL_RADIUS

from ..errors import TirelabError
from .curvature import Ground, radius_of
from .profile import Floats

BLOCK = 1 << 18
"""Pairs of hub and ground point that are compared at once: what fits a processor's cache."""


@dataclass(frozen=True, eq=False)
class Contact:
    """A wheel on the ground, for every position of its hub; all arrays of shape (n,).

    position, hub_height: the hub [m]; deflection [m], negative by the gap in the air
    contact_position: s of the deepest point [m]; inclination: angle of the force on the wheel from the vertical [rad],
    positive when it pushes forwards; section_length: length of the section in contact along the ground [m]
    curvature: mean over the section, at the nearest point in the air [1/m]; curvature_min, curvature_max: its extremes
    there; curvature_jump: the largest jump of the ground's curvature there [1/m]
    resolution: shortest length over which the ground's data can show a change, at the deepest point [m]
    turn: largest turn of the ground within its resolution in the section [rad]
    zones: stretches of ground inside the wheel's circle, 0 in the air
    """

    position: Floats
    hub_height: Floats
    deflection: Floats
    contact_position: Floats
    inclination: Floats
    section_length: Floats
    curvature: Floats
    curvature_min: Floats
    curvature_max: Floats
    curvature_jump: Floats
    resolution: Floats
    turn: Floats
    zones: NDArray[np.int64]

    @property
    def surface_radius(self) -> Floats:
        """Average radius of curvature in contact [m]: convex > 0, concave < 0, flat = inf."""
        return radius_of(self.curvature)


def reach(ground: Ground, wheel_radius: float = WHEEL_RADIUS) -> tuple[float, float]:
    """Return the first and last hub position [m] at which the whole wheel has `ground` beneath it.

    Raises TirelabError where there is none.
    """
    if not (np.isfinite(wheel_radius) and wheel_radius > 0.0):
        raise TirelabError(f"wheel radius {wheel_radius:g} m; give a radius above 0 m")
    margin = _half_window(ground, wheel_radius)
    if ground.s.size < 2 * margin + 3:
        raise TirelabError(
            f"{ground.name} is {ground.s[-1] - ground.s[0]:g} m long; a wheel of {wheel_radius:g} m radius needs more "
            "than its own diameter"
        )
    return float(ground.s[margin]), float(ground.s[-margin - 2])


def hub_positions(ground: Ground, wheel_radius: float = WHEEL_RADIUS) -> Floats:
    """Return the samples of `ground` within `reach` [m]."""
    first, last = reach(ground, wheel_radius)
    inside: Floats = ground.s[(ground.s >= first) & (ground.s <= last)]
    return inside


def rolling_path(
    ground: Ground, position: Floats | None = None, wheel_radius: float = WHEEL_RADIUS
) -> Floats:
    """Return the hub's height [m] at each `position` [m] of a wheel that rolls without deflection.

        h(s) = max over u of z(s + u) + sqrt(R_w^2 - u^2)

    The envelope of the ground by the wheel's circle. position: None takes the ground's samples within `reach`.
    """
    place = (
        hub_positions(ground, wheel_radius) if position is None else _checked(ground, position, wheel_radius)
    )
    height = np.empty_like(place)
    for block, points in _blocks(ground, place, wheel_radius):
        offset = ground.s[points] - place[block, None]
        beneath = np.sqrt(np.maximum(wheel_radius**2 - offset**2, 0.0))
        lift = np.where(np.abs(offset) <= wheel_radius, ground.z[points] + beneath, -np.inf)
        row = np.arange(place[block].size)
        top = np.argmax(lift, axis=1)
        left, middle, right = lift[row, top - 1], lift[row, top], lift[row, top + 1]
        height[block] = middle - _vertex(-left, -middle, -right)[1]
    return height


def contact(
    ground: Ground, position: Floats, hub_height: Floats, wheel_radius: float = WHEEL_RADIUS
) -> Contact:
    """Return how a wheel of `wheel_radius` [m] with its hub at (`position`, `hub_height`) [m] meets `ground`.

    Raises TirelabError for hubs beneath the ground or where a part of the wheel has no ground beneath it.
    """
    place = _checked(ground, position, wheel_radius)
    height = np.asarray(hub_height, dtype=np.float64)
    if height.shape != place.shape or not np.all(np.isfinite(height)):
        raise TirelabError("the hub's heights must be finite numbers, one for each position")
    buried = np.flatnonzero(height <= np.interp(place, ground.s, ground.z))
    if buried.size:
        i = int(buried[0])
        raise TirelabError(
            f"the hub is beneath the ground at s = {place[i]:g} m (height {height[i]:g} m); give a path above it"
        )
    parts = [
        _meet(ground, place[block], height[block], points, wheel_radius)
        for block, points in _blocks(ground, place, wheel_radius)
    ]
    return Contact(*(np.concatenate([getattr(part, f.name) for part in parts]) for f in fields(Contact)))


def _meet(
    ground: Ground,
    place: Floats,
    height: Floats,
    points: NDArray[np.int64],
    wheel_radius: float,
) -> Contact:
    row, column = np.arange(place.size), np.arange(points.shape[1])
    squared = (ground.s[points] - place[:, None]) ** 2 + (height[:, None] - ground.z[points]) ** 2
    deepest = np.minimum(np.maximum(squared.argmin(axis=1), 1), column.size - 2)
    shift, change = _vertex(squared[row, deepest - 1], squared[row, deepest], squared[row, deepest + 1])
    deflection = wheel_radius - np.sqrt(np.maximum(squared[row, deepest] + change, 0.0))
    nearest = points[row, deepest] + shift

    inside = squared < wheel_radius**2
    zones = np.count_nonzero(inside[:, 1:] & ~inside[:, :-1], axis=1)
    before = np.where(~inside & (column < deepest[:, None]), column, 0).max(axis=1)
    after = np.where(~inside & (column > deepest[:, None]), column, column.size - 1).min(axis=1)
    touching = inside[row, deepest]
    first = np.where(touching, points[row, before] + _crossing(squared, row, before, wheel_radius), nearest)
    last = np.where(touching, points[row, after] - _crossing(squared, row, after, wheel_radius, -1), nearest)
    start, end, foot = (_between(sample, ground.s.size) for sample in (first, last, nearest))

    section = inside & (column > before[:, None]) & (column < after[:, None])
    section[row, deepest] = True
    length = _at(ground.arc, end) - _at(ground.arc, start)
    curvature = _at(ground.curvature, foot)
    turning = _at(ground.direction, start) - _at(ground.direction, end)
    np.divide(turning, length, out=curvature, where=length > 1e-9)

    foot_position, bend = _at(ground.s, foot), ground.curvature[points]
    return Contact(
        place,
        height,
        deflection,
        foot_position,
        np.arctan2(place - foot_position, height - _at(ground.z, foot)),
        length,
        curvature,
        np.minimum(np.where(section, bend, np.inf).min(axis=1), curvature),
        np.maximum(np.where(section, bend, -np.inf).max(axis=1), curvature),
        np.where(section, ground.jump[points], 0.0).max(axis=1),
        _at(ground.resolution, foot),
        np.where(section, ground.turn[points], 0.0).max(axis=1),
        np.where(touching, np.maximum(zones, 1), (deflection > 0.0).astype(np.int64)),
    )


def _half_window(ground: Ground, wheel_radius: float) -> int:
    return int(np.ceil(wheel_radius / ground.spacing)) + 1


def _blocks(ground: Ground, place: Floats, wheel_radius: float) -> Iterator[tuple[slice, NDArray[np.int64]]]:
    """Yield slices of the positions with the samples of ground under each; the outermost lie beyond the wheel."""
    half = _half_window(ground, wheel_radius)
    window = np.arange(-half, half + 2)
    base = np.floor((place - ground.s[0]) / ground.spacing).astype(np.int64)
    base = np.minimum(np.maximum(base, half), ground.s.size - half - 2)
    rows = max(1, BLOCK // window.size)
    for first in range(0, place.size, rows):
        block = slice(first, first + rows)
        yield block, base[block, None] + window


def _checked(ground: Ground, position: Floats, wheel_radius: float) -> Floats:
    first, last = reach(ground, wheel_radius)
    place = np.asarray(position, dtype=np.float64)
    if place.ndim != 1 or place.size == 0 or not np.all(np.isfinite(place)):
        raise TirelabError("the hub's positions must be a column of finite numbers; give at least one")
    outside = np.flatnonzero((place < first - 1e-9) | (place > last + 1e-9))
    if outside.size:
        raise TirelabError(
            f"the hub at s = {place[outside[0]]:g} m has not the whole wheel over {ground.name}; keep it between "
            f"{first:g} m and {last:g} m"
        )
    return place


def _vertex(left: Floats, middle: Floats, right: Floats) -> tuple[Floats, Floats]:
    """Return where, in samples, and how far below `middle` the parabola through three neighbours is lowest."""
    bend = left - 2.0 * middle + right
    curved = np.isfinite(bend) & (bend > 0.0)
    shift = np.zeros_like(middle)
    np.divide(0.5 * (left - right), bend, out=shift, where=curved)
    shift = np.minimum(np.maximum(shift, -0.5), 0.5)
    change = np.zeros_like(middle)
    np.multiply(shift, 0.5 * (right - left) + 0.5 * shift * bend, out=change, where=curved)
    return shift, change


def _crossing(
    squared: Floats, row: NDArray[np.int64], outer: NDArray[np.int64], wheel_radius: float, step: int = 1
) -> Floats:
    """Return how far, in samples from `outer`, the ground crosses the wheel's circle towards its neighbour."""
    out, inn = squared[row, outer], squared[row, outer + step]
    share = np.zeros_like(out)
    np.divide(out - wheel_radius**2, out - inn, out=share, where=out > inn)
    return np.minimum(np.maximum(share, 0.0), 1.0)


def _between(sample: Floats, size: int) -> tuple[NDArray[np.int64], Floats]:
    """Return the samples below fractional ones, and by how much these are above."""
    low = np.minimum(np.maximum(sample.astype(np.int64), 0), size - 2)
    return low, sample - low


def _at(values: Floats, where: tuple[NDArray[np.int64], Floats]) -> Floats:
    """Return `values` between samples, linear."""
    low, share = where
    below = values[low]
    between: Floats = below + share * (values[low + 1] - below)
    return between
