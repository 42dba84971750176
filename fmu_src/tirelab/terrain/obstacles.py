"""Obstacles to ride over, alone on flat ground or added to a profile.

Round and straight pieces meet tangentially, so that the ground has a direction everywhere; where they meet, its radius
of curvature jumps, which the article says its tire cannot predict and which the ride is flagged for.

Sizes. The International Mountain Bicycling Association's trail difficulty rating grades trails by their unavoidable
obstacles: up to 5 cm tall (easy), 20 cm (more difficult), 38 cm (very difficult): `root` and `log` are the first two.
`stick` is a little thicker than the smallest bump of the article (1.27 cm radius). Rollers on slow pump tracks are
about 0.3 m high and 2 to 2.5 m apart (track builders' advice): `whoops`. The upstand of `kerb` is common for the
British half-battered kerb HB2 (BS EN 1340 NA, 125 mm wide and 255 mm high, most of it in the ground); its nose, batter
and foot, and the depth and width of `rut`, are ours.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from scipy.interpolate import CubicSpline

from ..errors import TirelabError
from .curvature import smoothed_heights
from .profile import Floats, Profile

FLANK = math.acos(1.0 / 3.0)
"""Steepest slope [rad] of a round obstacle, 70.5 degrees: a wheel of more than twice its radius touches no steeper."""

TURN_PER_POINT = 0.08
"""Turn of the ground [rad] from one point of an arc to the next."""


@dataclass(frozen=True, eq=False)
class Obstacle:
    """Heights `z` [m] over distances `u` [m] from the obstacle's middle; ground beyond keeps the height of its end."""

    name: str
    u: Floats
    z: Floats


def stick(radius: float = 0.015) -> Obstacle:
    """Return a round stick of `radius` [m] that lies on the ground."""
    return _round("stick", radius, radius)


def log(radius: float = 0.10, sunk: float = 0.0) -> Obstacle:
    """Return a log of `radius` [m] that has sunk into the ground by `sunk` [m], at most to its middle."""
    return _round("log", radius, radius - sunk)


def root(radius: float = 0.05) -> Obstacle:
    """Return a tree root of `radius` [m], the lower half of it in the ground."""
    return _round("root", radius, 0.0)


def rut(depth: float = 0.08, width: float = 0.4) -> Obstacle:
    """Return a rain rut across the track, z = -depth (1 - (2 u / width)^2)^3, with a smooth edge [m]."""
    _positive("rut", depth=depth, width=width)
    u = np.linspace(-0.5 * width, 0.5 * width, 161)
    return Obstacle("rut", u, -depth * (1.0 - (2.0 * u / width) ** 2) ** 3)


def whoops(count: int = 4, height: float = 0.3, wavelength: float = 2.5) -> Obstacle:
    """Return `count` whoop-de-doos, z = height/2 (1 - cos(2 pi u / wavelength)), their two ends blended in [m]."""
    _positive("whoops", count=count, height=height, wavelength=wavelength)
    u = np.linspace(0.0, count * wavelength, 160 * count + 1)
    end = np.clip(np.minimum(u, u[-1] - u) / (0.5 * wavelength), 0.0, 1.0)
    blend = end**3 * (10.0 - 15.0 * end + 6.0 * end**2)
    z = 0.5 * height * (1.0 - np.cos(2.0 * np.pi * u / wavelength)) * blend
    return Obstacle("whoops", u - 0.5 * u[-1], z)


def kerb(
    height: float = 0.1, nose_radius: float = 0.02, face_angle: float = math.radians(75.0), foot: float = 0.03
) -> Obstacle:
    """Return a kerb to climb: a rounded `foot` [m], a face at `face_angle` [rad], a nose; the ground stays up.

    height [m]: at least what foot and nose take, (foot + nose_radius)(1 - cos face_angle)
    """
    _positive("kerb", height=height, nose_radius=nose_radius, foot=foot)
    steepest = math.radians(80.0)
    if not 0.1 <= face_angle <= steepest:
        raise TirelabError(
            f"kerb: face at {math.degrees(face_angle):g} degrees; give 6 to 80 degrees (an upright face has no z(s))"
        )
    face = (height - (foot + nose_radius) * (1.0 - math.cos(face_angle))) / math.sin(face_angle)
    if face < 0.0:
        raise TirelabError(
            f"kerb: {height:g} m is too low for a nose of {nose_radius:g} m and a foot of {foot:g} m; make them less"
        )
    return _path(
        "kerb",
        (foot * face_angle, 1.0 / foot),
        (face, 0.0),
        (nose_radius * face_angle, -1.0 / nose_radius),
    )


OBSTACLES: dict[str, Callable[[], Obstacle]] = {
    "stick": stick,
    "log": log,
    "root": root,
    "rut": rut,
    "whoops": whoops,
    "kerb": kerb,
}
"""Every obstacle in its ordinary size, by name."""


def place(profile: Profile, obstacle: Obstacle, position: float) -> Profile:
    """Return `profile` with `obstacle` added to its heights, its middle at the distance `position` [m].

    The profile's own heights are smoothed first where they carry noise, so that the obstacle keeps its shape.
    """
    start, end = position + float(obstacle.u[0]), position + float(obstacle.u[-1])
    if not (profile.s[0] < start and end < profile.s[-1]):
        raise TirelabError(
            f"{obstacle.name} from s = {start:g} m to {end:g} m does not fit on {profile.name}, which goes from "
            f"{profile.s[0]:g} m to {profile.s[-1]:g} m"
        )
    base = CubicSpline(profile.s, smoothed_heights(profile.s, profile.z, profile.smoothing_length))
    margin = 0.5 * float(np.min(np.diff(obstacle.u)))
    before, after = profile.s[profile.s < start - margin], profile.s[profile.s > end + margin]
    s = np.concatenate([before, position + obstacle.u, after])
    added = np.concatenate([np.zeros(before.size), obstacle.z, np.full(after.size, obstacle.z[-1])])
    notes = profile.notes
    if profile.smoothing_length > 0.0:
        notes += (f"smoothed over {profile.smoothing_length:g} m before {obstacle.name} was added",)
    return Profile(s, base(s) + added, f"{profile.name} with {obstacle.name}", notes=notes)


def _round(name: str, radius: float, middle: float) -> Obstacle:
    """Return a cylinder whose axis is `middle` [m] above the ground, earth filling the corners beside it."""
    _positive(name, radius=radius)
    if not 0.0 <= middle <= radius:
        raise TirelabError(
            f"{name}: of {radius:g} m radius, its axis {middle:g} m above the ground; sink it by 0 m to its radius"
        )
    corner = (radius + middle) / (1.0 - math.cos(FLANK)) - radius
    return _path(
        name,
        (corner * FLANK, 1.0 / corner),
        (radius * 2.0 * FLANK, -1.0 / radius),
        (corner * FLANK, 1.0 / corner),
    )


def _path(name: str, *pieces: tuple[float, float]) -> Obstacle:
    """Return the obstacle whose surface is `pieces` one after the other: length [m] and upward curvature [1/m]."""
    u, z, angle = [np.zeros(1)], [np.zeros(1)], 0.0
    longest = min(TURN_PER_POINT / abs(curvature) for _, curvature in pieces if curvature)
    for length, curvature in pieces:
        if length == 0.0:
            continue
        along = np.linspace(0.0, length, 2 * math.ceil(0.5 * length / longest) + 1)[1:]
        if curvature:
            heading = angle + curvature * along
            across = (np.sin(heading) - math.sin(angle)) / curvature
            up = (math.cos(angle) - np.cos(heading)) / curvature
            angle = float(heading[-1])
        else:
            across, up = along * math.cos(angle), along * math.sin(angle)
        u.append(u[-1][-1] + across)
        z.append(z[-1][-1] + up)
    distance = np.concatenate(u)
    return Obstacle(name, distance - 0.5 * distance[-1], np.concatenate(z))


def _positive(name: str, **sizes: float) -> None:
    for what, size in sizes.items():
        if not (math.isfinite(size) and size > 0.0):
            raise TirelabError(f"{name}: {what} is {size:g}; give a number above 0")
