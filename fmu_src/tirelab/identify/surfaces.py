"""Recordings sorted by the surface they were made on, ready for a power law to be fitted.

Only the samples with a compressed tire (deflection > 0) are kept: elsewhere the law is 0 whatever its constants.
Loading and unloading count alike, as in the article: the samples of each branch get the weight that makes the
branches' sums equal, and the samples at rest get none.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray
from radialtire import FLAT_RADIUS

from ..errors import TirelabError
from ..recording import Recording
from .branches import LOADING, RESTING, branches

CM_PER_M = 100.0

SAMPLES_LEAST = 20
"""Fewest samples with a compressed tire from which A and B are taken."""

STRETCHES_MOST = 100
"""Most stretches of constant radius in one recording: with more it was made on terrain, not on surfaces."""


@dataclass(frozen=True)
class Piece:
    """One recording's samples with a compressed tire on one surface, in the order of time.

    log_deflection: ln of the deflection in cm (n,); force: [N] (n,); branch: LOADING, RESTING or UNLOADING (n,)
    interval: median time between samples [s]
    """

    name: str
    log_deflection: NDArray[np.float64]
    force: NDArray[np.float64]
    branch: NDArray[np.int8]
    interval: float


@dataclass(frozen=True)
class Surface:
    """One surface and what was recorded on it; radius [m]: convex > 0, concave < 0, flat infinite."""

    radius: float
    pieces: tuple[Piece, ...]

    @property
    def curvature(self) -> float:
        """1/R [1/m]."""
        return 1.0 / self.radius

    @cached_property
    def samples(self) -> tuple[int, int, int]:
        """Numbers of samples that load, rest and unload."""
        loading = sum(int(np.count_nonzero(p.branch == LOADING)) for p in self.pieces)
        resting = sum(int(np.count_nonzero(p.branch == RESTING)) for p in self.pieces)
        total = sum(p.branch.size for p in self.pieces)
        return loading, resting, total - loading - resting

    @cached_property
    def weights(self) -> NDArray[np.float64]:
        """Weights of a sample that loads, rests, unloads (3,), to be indexed by 1 - branch."""
        loading, _, unloading = self.samples
        if loading == 0 or unloading == 0:
            return np.array([1.0, 0.0, 1.0])
        half = (loading + unloading) / 2.0
        return np.array([half / loading, 0.0, half / unloading])

    @cached_property
    def weight_sum(self) -> float:
        """Sum of the weights: the number of samples that load or unload."""
        return float(self.samples[0] + self.samples[2])

    @cached_property
    def deflection_max(self) -> float:
        """Largest deflection [m]."""
        return max(math.exp(float(p.log_deflection.max())) for p in self.pieces) / CM_PER_M

    @cached_property
    def force_max(self) -> float:
        """Largest force [N]."""
        return max(float(p.force.max()) for p in self.pieces)


def surfaces_of(recordings: Iterable[Recording]) -> tuple[Surface, ...]:
    """Return the surfaces of `recordings`, from the sharpest bump over flat ground to the tightest dip.

    Raises TirelabError, with the recording's name, where one cannot tell a power law.
    """
    found: dict[float, list[Piece]] = {}
    for recording in recordings:
        for radius, stretch in _stretches(recording):
            piece = _piece(recording, stretch)
            if piece is not None:
                found.setdefault(radius, []).append(piece)
    if not found:
        raise TirelabError(
            "no recording has a compressed tire (deflection > 0); name recordings of a tire under load"
        )
    surfaces = tuple(Surface(radius, tuple(pieces)) for radius, pieces in found.items())
    for surface in surfaces:
        _check(surface)
    return tuple(sorted(surfaces, key=lambda surface: -surface.curvature))


def describe(radius: float) -> str:
    """Return "flat", or the radius in cm with "convex" or "concave"."""
    if math.isinf(radius):
        return "flat"
    return f"{'convex' if radius > 0.0 else 'concave'} {CM_PER_M * abs(radius):.4g} cm"


def names(surfaces: Sequence[Surface]) -> str:
    """Return the surfaces' descriptions, separated by commas."""
    return ", ".join(describe(surface.radius) for surface in surfaces)


def _stretches(recording: Recording) -> list[tuple[float, slice]]:
    """Return the stretches of constant radius, each with that radius rounded to nine digits (inf where flat)."""
    radius = recording.surface_radius
    ends = np.flatnonzero(radius[1:] != radius[:-1]) + 1
    if ends.size >= STRETCHES_MOST:
        raise TirelabError(
            f"{recording.name}: the surface's radius changes {ends.size} times; a law is identified from recordings "
            "on one surface at a time, so record each surface by itself"
        )
    edges = [0, *ends.tolist(), radius.size]
    found = []
    for first, last in pairwise(edges):
        value = float(radius[first])
        if math.isnan(value) or value == 0.0:
            raise TirelabError(
                f"{recording.name}: sample {first + 1} has the surface radius {value:g}; give convex radii as "
                "positive, concave ones as negative, flat ground as inf"
            )
        found.append((math.inf if abs(value) >= FLAT_RADIUS else float(f"{value:.9g}"), slice(first, last)))
    return found


def _piece(recording: Recording, stretch: slice) -> Piece | None:
    """Return the samples of `stretch` with a compressed tire, or None where there is none."""
    time, deflection, force = (a[stretch] for a in (recording.time, recording.deflection, recording.force))
    if not (np.isfinite(deflection).all() and np.isfinite(force).all() and np.isfinite(time).all()):
        raise TirelabError(
            f"{recording.name}: a time, deflection or force is not a finite number; remove that sample"
        )
    loaded = deflection > 0.0
    if not loaded.any():
        return None
    branch = branches(time, deflection)
    log_deflection = deflection[loaded]
    log_deflection *= CM_PER_M
    np.log(log_deflection, out=log_deflection)
    interval = float(np.median(np.diff(time))) if time.size > 1 else 1.0
    return Piece(recording.name, log_deflection, force[loaded], branch[loaded], interval)


def _check(surface: Surface) -> None:
    loading, _, unloading = surface.samples
    where = f"{', '.join(p.name for p in surface.pieces)} ({describe(surface.radius)})"
    if loading + unloading < SAMPLES_LEAST:
        raise TirelabError(
            f"{where}: only {loading + unloading} samples with a tire being compressed or released; A and B need at "
            f"least {SAMPLES_LEAST}"
        )
    if (
        max(p.log_deflection.max() for p in surface.pieces)
        - min(p.log_deflection.min() for p in surface.pieces)
        < 0.05
    ):
        raise TirelabError(
            f"{where}: the deflection stays at {1e3 * surface.deflection_max:.4g} mm; A and B need it to vary"
        )
    force = sum(float(p.force.sum()) for p in surface.pieces)
    if force <= 0.0:
        raise TirelabError(
            f"{where}: the force on the compressed tire is negative on average; compression must be positive, so turn "
            "the sign of the force"
        )
