"""From heights to a smooth curve: the ground's direction and signed curvature at every point.

    kappa = -(x' z'' - z' x'') / (x'^2 + z'^2)^(3/2)         convex (a bump) > 0, concave (a dip) < 0, flat = 0

The curve is the cubic spline (x(t), z(t)) through the points over their chord length t. Why so: the article asks for
"the second derivative of a parameterized description of the surface", whose inverse is the radius only if the
parameter is the length along it; a curve over length treats the flank of a log like its top, where z(s) would bend
without bound; and a cubic spline is the smoothest of all twice differentiable curves through the points, its curvature
continuous and changed by one point in its neighbourhood only (a factor 0.27 from point to point).

Heights that carry noise are smoothed first: two derivatives turn 0.3 mm of noise at a point per cm into curvatures of
7 /m, a radius of 14 cm that is not there. The smoothing spline keeps half of waves as long as the smoothing length,
94 % of those twice as long, 99.6 % of those four times as long:

    gain(wavelength) = 1 / (1 + (smoothing_length / wavelength)^4)

References: C. H. Reinsch, "Smoothing by spline functions", Numerische Mathematik 10 (1967) 177-183,
doi:10.1007/BF02162161; B. W. Silverman, "Spline smoothing: the equivalent variable kernel method", Annals of
Statistics 12 (1984) 898-916, doi:10.1214/aos/1176346710 (the gain).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.interpolate import CubicSpline
from scipy.linalg import solveh_banded

from ..errors import TirelabError
from .profile import Floats, Profile

FINEST_SPACING = 1e-3
COARSEST_SPACING = 1e-2
"""Bounds [m] of the spacing that is chosen when none is given: the tire's tread, and a tenth of its contact."""

FLAT_CURVATURE = 1e-6
"""Curvatures [1/m] of up to this are flat: over a contact of 30 cm the ground then sags by 0.01 micrometres."""

MOST_POINTS = 20_000_000
"""More points of ground than this are taken for a mistake."""


@dataclass(frozen=True, eq=False)
class Ground:
    """A smooth curve under the wheel, sampled at even horizontal distances.

    s: horizontal distance [m]; z: height [m]; direction: angle of the tangent above the horizontal [rad];
    arc: length along the curve [m]; curvature [1/m], convex > 0; resolution: shortest length [m] along the curve over
    which the data can show a change, two points or half the smoothing length (a corner's whole turn and 85 % of it lie
    within); jump of the curvature [1/m] and turn of the direction [rad] within that length: what is more than a steady
    change, and all of it; all of shape (n,). spacing: distance of samples in s [m].
    """

    s: Floats
    z: Floats
    direction: Floats
    arc: Floats
    curvature: Floats
    resolution: Floats
    jump: Floats
    turn: Floats
    spacing: float
    name: str = "ground"
    notes: tuple[str, ...] = ()

    @property
    def radius(self) -> Floats:
        """Signed radius of curvature [m]: convex > 0, concave < 0, flat = inf."""
        return radius_of(self.curvature)


def radius_of(curvature: Floats) -> Floats:
    """Return the radius 1 / curvature [m], +inf where the curvature [1/m] is below FLAT_CURVATURE."""
    radius = np.full(np.shape(curvature), np.inf)
    np.divide(1.0, curvature, out=radius, where=np.abs(curvature) > FLAT_CURVATURE)
    return radius


def smoothed_heights(s: Floats, z: Floats, smoothing_length: float) -> Floats:
    """Return z [m] at s [m] on the cubic smoothing spline that keeps half of waves of `smoothing_length` [m].

    It minimises sum w_i (z_i - f(s_i))^2 + (smoothing_length / 2 pi)^4 integral f''(s)^2 ds, w_i the stretch of ground
    that point i stands for, so that the gain is the same whatever the points' spacing; solved as Reinsch has it.
    """
    if smoothing_length == 0.0:
        return z
    stiffness = (smoothing_length / (2.0 * np.pi)) ** 4
    run = np.diff(s)
    weight = np.empty_like(s)
    weight[0], weight[-1], weight[1:-1] = 0.5 * run[0], 0.5 * run[-1], 0.5 * (run[:-1] + run[1:])
    left, right = 1.0 / run[:-1], 1.0 / run[1:]
    middle = -(left + right)
    banded = np.zeros((3, s.size - 2))
    banded[2] = (run[:-1] + run[1:]) / 3.0 + stiffness * (
        left**2 / weight[:-2] + middle**2 / weight[1:-1] + right**2 / weight[2:]
    )
    banded[1, 1:] = run[1:-1] / 6.0 + stiffness * (
        middle[:-1] * left[1:] / weight[1:-2] + right[:-1] * middle[1:] / weight[2:-1]
    )
    banded[0, 2:] = stiffness * right[:-2] * left[2:] / weight[2:-2]
    bend = solveh_banded(banded, left * z[:-2] + middle * z[1:-1] + right * z[2:])
    pull = np.zeros_like(z)
    pull[:-2] += left * bend
    pull[1:-1] += middle * bend
    pull[2:] += right * bend
    smooth: Floats = z - stiffness * pull / weight
    return smooth


def ground_from(
    profile: Profile, spacing: float | None = None, smoothing_length: float | None = None
) -> Ground:
    """Return the smooth ground of `profile`, sampled every `spacing` [m].

    spacing: None takes the profile's own smallest one, within 1 mm and 1 cm
    smoothing_length: wavelength [m] of which half is kept; None takes the profile's, 0 goes through every point

    Raises TirelabError where the curve through the points folds back, with the position.
    """
    smoothing = profile.smoothing_length if smoothing_length is None else smoothing_length
    if not (np.isfinite(smoothing) and smoothing >= 0.0):
        raise TirelabError(f"smoothing length {smoothing:g} m; give a length of 0 m or more")
    heights = smoothed_heights(profile.s, profile.z, smoothing)
    chord = np.hypot(np.diff(profile.s), np.diff(heights))
    spacing = _spacing_of(profile) if spacing is None else spacing
    count = _points(profile, spacing)
    along = np.concatenate([[0.0], np.cumsum(chord)])
    curve = CubicSpline(along, np.column_stack([profile.s, heights]))
    _check_forward(curve, along)

    s = profile.s[0] + spacing * np.arange(count)
    s[-1] = min(s[-1], profile.s[-1])
    t = _parameter_at(curve, s, along, profile.s)
    velocity, acceleration = curve(t, 1), curve(t, 2)
    dx, dz = velocity[:, 0], velocity[:, 1]
    speed = np.hypot(dx, dz)
    z = curve(t)[:, 1]
    direction = np.arctan2(dz, dx)
    own = chord[np.clip(np.searchsorted(profile.s, s, side="right") - 1, 0, chord.size - 1)]
    arc = _arc_length(s, z, direction)
    curvature = (dz * acceleration[:, 0] - dx * acceleration[:, 1]) / speed**3
    resolution = np.maximum(2.0 * np.maximum(own, spacing / np.cos(direction)), 0.5 * smoothing)
    steady = 0.5 * _change(arc, curvature, 2.0 * resolution)
    return Ground(
        s,
        z,
        direction,
        arc,
        curvature,
        resolution,
        np.maximum(2.0 * (_change(arc, curvature, resolution) - steady), 0.0),
        _change(arc, direction, resolution),
        float(spacing),
        profile.name,
        profile.notes + ((f"smoothed over {smoothing:g} m",) if smoothing > 0.0 else ()),
    )


def _spacing_of(profile: Profile) -> float:
    """Return the smallest spacing [m] of the profile's own points in whole millimetres, within 1 mm and 1 cm."""
    own_spacing = float(np.clip(np.min(np.diff(profile.s)), FINEST_SPACING, COARSEST_SPACING))
    return float(FINEST_SPACING * np.floor(own_spacing / FINEST_SPACING + 1e-6))


def _points(profile: Profile, spacing: float) -> int:
    """Return the number of points every `spacing` [m]. Errors: TirelabError where that cannot be, or is too many."""
    if not (np.isfinite(spacing) and spacing > 0.0 and 4.0 * spacing <= profile.length):
        raise TirelabError(
            f"spacing {spacing:g} m on {profile.length:g} m of ground; give more than 0 m and at most a quarter of it"
        )
    count = int(profile.length / spacing + 1e-9) + 1
    if count > MOST_POINTS:
        raise TirelabError(
            f"{profile.length:g} m of ground every {spacing:g} m is {count} points; space them wider or cut it"
        )
    return count


def _arc_length(s: Floats, z: Floats, direction: Floats) -> Floats:
    """Return the length along the curve [m]: each chord, longer by (turn^2 / 24) as that of a circle's arc."""
    turn = np.diff(direction)
    return np.concatenate([[0.0], np.cumsum(np.hypot(np.diff(s), np.diff(z)) * (1.0 + turn**2 / 24.0))])


def _change(arc: Floats, values: Floats, length: Floats) -> Floats:
    """Return by how much `values` change over a stretch of `length` [m] around every sample."""
    difference: Floats = np.abs(
        np.interp(arc + 0.5 * length, arc, values) - np.interp(arc - 0.5 * length, arc, values)
    )
    return difference


def _check_forward(curve: CubicSpline, along: Floats) -> None:
    """Raise TirelabError where the curve runs backwards at or midway between its points."""
    places = np.sort(np.concatenate([along, 0.5 * (along[1:] + along[:-1])]))
    backwards = np.flatnonzero(curve(places, 1)[:, 0] <= 0.0)
    if backwards.size:
        where = float(curve(places[backwards[0]])[0])
        raise TirelabError(
            f"the smooth curve through the profile folds back near s = {where:.4g} m; give more points on the steep "
            "face there, or a smoothing length"
        )


def _parameter_at(curve: CubicSpline, s: Floats, along: Floats, knots: Floats) -> Floats:
    """Return the chord length t at which the curve's x(t) is `s`: linear between the points, then Newton."""
    t = np.interp(s, knots, along)
    for _ in range(20):
        step = (curve(t)[:, 0] - s) / curve(t, 1)[:, 0]
        t = np.clip(t - step, along[0], along[-1])
        if np.max(np.abs(step)) < 1e-12 * max(1.0, along[-1]):
            break
    return t
