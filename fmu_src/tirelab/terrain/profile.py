"""A terrain profile: heights z over the horizontal distance s, checked once and then never changed."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import TypeAlias

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..errors import TirelabError

Floats: TypeAlias = NDArray[np.float64]

FEWEST_POINTS = 5
"""A cubic curve needs four points, and one more to say anything about its noise."""

STEEPEST_SLOPE = 10.0
"""Rise over run between neighbouring points above which z(s) is a step: 84 degrees from the horizontal."""

FARTHEST = 4.1e7
"""Distance [m] around the Earth; what is farther is a mistake."""


@dataclass(frozen=True, eq=False)
class Profile:
    """Ground heights z(s) in the plane of the wheel.

    s: horizontal distance [m], shape (n,), growing; z: height [m], shape (n,); n >= 5
    smoothing_length: wavelength [m] of which smoothing should keep half, for heights that carry noise; 0 for exact ones
    notes: how the heights were processed, a sentence each

    Raises TirelabError, with the point, for heights that are not numbers, profiles that fold back, repeated points,
    and steps (slopes above STEEPEST_SLOPE).
    """

    s: Floats
    z: Floats
    name: str = "profile"
    smoothing_length: float = 0.0
    notes: tuple[str, ...] = ()

    def __post_init__(self) -> None:
        s, z = (np.array(values, dtype=np.float64) for values in (self.s, self.z))
        check_points(s, z, lambda i: f"{self.name}, point {i + 1}")
        if not (np.isfinite(self.smoothing_length) and self.smoothing_length >= 0.0):
            raise TirelabError(
                f"{self.name}: smoothing length {self.smoothing_length} m; give a length of 0 m or more"
            )
        s.flags.writeable = z.flags.writeable = False
        object.__setattr__(self, "s", s)
        object.__setattr__(self, "z", z)

    @property
    def length(self) -> float:
        """Horizontal length [m]."""
        return float(self.s[-1] - self.s[0])


def check_points(s: Floats, z: Floats, place: Callable[[int], str]) -> None:
    """Raise TirelabError at the first point of s [m], z [m] that no ground can have; `place` names a point."""
    if s.ndim != 1 or s.shape != z.shape:
        raise TirelabError(f"s has the shape {s.shape} and z {z.shape}; give two columns of one length")
    if s.size < FEWEST_POINTS:
        points = "1 point" if s.size == 1 else f"{s.size} points"
        raise TirelabError(f"{place(0)}: the profile has {points} in all; give at least {FEWEST_POINTS}")
    for values, symbol in ((s, "s"), (z, "z")):
        bad = np.flatnonzero(~np.isfinite(values))
        if bad.size:
            i = int(bad[0])
            raise TirelabError(
                f"{place(i)}: {symbol} is {values[i]}, not a finite number; give a number for every point"
            )
        bad = np.flatnonzero(np.abs(values) > FARTHEST)
        if bad.size:
            i = int(bad[0])
            raise TirelabError(
                f"{place(i)}: {symbol} is {values[i]:g} m, farther than around the Earth; check the column's unit"
            )
    run, rise = np.diff(s), np.diff(z)
    bad = np.flatnonzero((run <= 0.0) | (np.abs(rise) > STEEPEST_SLOPE * run))
    if not bad.size:
        return
    i = int(bad[0]) + 1
    before, here = float(s[i - 1]), float(s[i])
    if here < before:
        raise TirelabError(
            f"{place(i)}: the profile folds back, s falls from {before:g} m to {here:g} m; give s as a distance that "
            "only grows"
        )
    if here == before and z[i] == z[i - 1]:
        raise TirelabError(f"{place(i)}: the point at s = {here:g} m is there twice; remove one")
    raise TirelabError(
        f"{place(i)}: the profile steps from z = {z[i - 1]:g} m to {z[i]:g} m at s = {here:g} m; give the face of the "
        f"step a slope of less than {STEEPEST_SLOPE:g}, or use the obstacle kerb"
    )


def grid(length: float, spacing: float) -> Floats:
    """Return distances [m] from 0 to `length` [m], at most `spacing` [m] apart and all the same distance apart."""
    if not (np.isfinite(length) and np.isfinite(spacing) and spacing > 0.0 and length >= 4.0 * spacing):
        raise TirelabError(
            f"length {length:g} m with a point every {spacing:g} m; give a length of at least four spacings, both "
            "above 0 m"
        )
    return np.linspace(0.0, length, round(np.ceil(length / spacing - 1e-9)) + 1)


def from_function(
    height: Callable[[Floats], ArrayLike], length: float, spacing: float = 0.01, name: str = "function"
) -> Profile:
    """Return the profile z = height(s) for s from 0 to `length` [m], a point every `spacing` [m]."""
    s = grid(length, spacing)
    z = np.broadcast_to(np.asarray(height(s), dtype=np.float64), s.shape)
    return Profile(s, z, name)


def flat(length: float, spacing: float = 0.01) -> Profile:
    """Return level ground of `length` [m]."""
    return from_function(lambda s: 0.0, length, spacing, "flat ground")


def sine(length: float, *waves: tuple[float, float], spacing: float = 0.01) -> Profile:
    """Return the sum of sines z = sum a sin(2 pi s / l) over `waves`, pairs of amplitude a [m] and wavelength l [m]."""
    for amplitude, wavelength in waves:
        if not (np.isfinite(amplitude) and np.isfinite(wavelength) and wavelength > 2.0 * spacing):
            raise TirelabError(
                f"a sine of amplitude {amplitude:g} m and wavelength {wavelength:g} m; give a finite amplitude, and a "
                f"wavelength above two spacings ({2.0 * spacing:g} m)"
            )
    name = "sine " + " + ".join(f"{a:g} m / {length_:g} m" for a, length_ in waves)

    def height(s: Floats) -> Floats:
        z = np.zeros_like(s)
        for amplitude, wavelength in waves:
            z += amplitude * np.sin(2.0 * np.pi * s / wavelength)
        return z

    return from_function(height, length, spacing, name)
