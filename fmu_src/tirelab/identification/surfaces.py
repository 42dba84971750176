"""Recordings sorted by the surface they were made on, ready for a power law to be fitted.

Only the samples with a compressed tire (deflection > 0) are kept: elsewhere the law is 0 whatever its constants.
Loading and unloading count alike, as in the article: the samples of each branch get the weight that makes the
branches' sums equal. Samples at rest between the branches are left out and counted.
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
from ..names import plain
from ..recordings.recording import Recording
from .branches import LOADING, RESTING, branches

CM_PER_M = 100.0

SAMPLES_LEAST = 20
"""Fewest samples with a compressed tire from which A and B are taken."""

SPAN_LEAST = 0.05
"""Least span of the deflection's logarithm: where it stays within 5 % there is no exponent to see."""

STRETCHES_MOST = 100
"""Most stretches of constant radius in one recording: with more it was made on terrain, not on surfaces."""


@dataclass(frozen=True)
class Piece:
    """One recording's samples of a tire being compressed or released on one surface, in the order of time.

    log_deflection: ln of the deflection in cm (n,); force: [N] (n,); branch: LOADING or UNLOADING (n,)
    interval: median time between samples [s]; resting: samples left out because the tire was held
    deflection_max: [m] and force_max: [N], those at rest included
    """

    name: str
    log_deflection: NDArray[np.float64]
    force: NDArray[np.float64]
    branch: NDArray[np.int8]
    interval: float
    resting: int
    deflection_max: float
    force_max: float


@dataclass(frozen=True)
class Surface:
    """One surface and what was recorded on it.

    radius: [m] convex > 0, concave < 0, flat infinite; pieces: none of them empty
    resting: number of samples left out because the tire was held
    """

    radius: float
    pieces: tuple[Piece, ...]
    resting: int

    @property
    def curvature(self) -> float:
        """1/R [1/m]."""
        return 1.0 / self.radius

    @property
    def where(self) -> str:
        """The recordings' names and the surface, for sentences."""
        return _where(self.radius, self.pieces)

    @cached_property
    def samples(self) -> tuple[int, int]:
        """Numbers of samples that load and unload."""
        loading = sum(int(np.count_nonzero(p.branch == LOADING)) for p in self.pieces)
        return loading, sum(p.branch.size for p in self.pieces) - loading

    @cached_property
    def weights(self) -> NDArray[np.float64]:
        """Weights (3,) of a sample that unloads and one that loads, to be indexed by branch: -1 and 1."""
        loading, unloading = self.samples
        if loading == 0 or unloading == 0:
            return np.array([0.0, 1.0, 1.0])
        half = (loading + unloading) / 2.0
        return np.array([0.0, half / loading, half / unloading])

    @cached_property
    def weight_sum(self) -> float:
        """Sum of the weights: the number of samples."""
        return float(sum(self.samples))

    @cached_property
    def deflection_max(self) -> float:
        """Largest deflection [m]."""
        return max(p.deflection_max for p in self.pieces)

    @cached_property
    def force_max(self) -> float:
        """Largest force [N]."""
        return max(p.force_max for p in self.pieces)


def surfaces_of(recordings: Iterable[Recording]) -> tuple[Surface, ...]:
    """Return the surfaces of `recordings`, from the sharpest bump over flat ground to the tightest dip.

    Raises TirelabError, with the recording's name, where it does not determine a power law.
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
    surfaces = [_surface(radius, pieces) for radius, pieces in found.items()]
    return tuple(sorted(surfaces, key=lambda surface: -surface.curvature))


def describe(radius: float) -> str:
    """Return "flat", or the radius in cm with "convex" or "concave"."""
    if math.isinf(radius):
        return "flat"
    return f"{'convex' if radius > 0.0 else 'concave'} {plain(CM_PER_M * abs(radius), 4)} cm"


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
    moving = loaded & (branch != RESTING)
    log_deflection = deflection[moving]
    log_deflection *= CM_PER_M
    np.log(log_deflection, out=log_deflection)
    interval = float(np.median(np.diff(time))) if time.size > 1 else 1.0
    return Piece(
        name=recording.name,
        log_deflection=log_deflection,
        force=force[moving],
        branch=branch[moving],
        interval=interval,
        resting=int(np.count_nonzero(loaded)) - log_deflection.size,
        deflection_max=float(deflection.max()),
        force_max=float(force[loaded].max()),
    )


def _surface(radius: float, pieces: list[Piece]) -> Surface:
    """Return the surface that `pieces` were recorded on, or raise TirelabError where they do not determine A and B."""
    where = _where(radius, pieces)
    count = sum(p.force.size for p in pieces)
    if count < SAMPLES_LEAST:
        raise TirelabError(
            f"{where}: only {count} samples with a tire being compressed or released; A and B need at least "
            f"{SAMPLES_LEAST}"
        )
    surface = Surface(radius, tuple(p for p in pieces if p.force.size), sum(p.resting for p in pieces))
    logs = [p.log_deflection for p in surface.pieces]
    if max(x.max() for x in logs) - min(x.min() for x in logs) < SPAN_LEAST:
        raise TirelabError(
            f"{where}: the deflection stays at {plain(1e3 * surface.deflection_max, 4)} mm; A and B need it to vary"
        )
    if sum(float(p.force.sum()) for p in pieces) <= 0.0:
        raise TirelabError(
            f"{where}: the force on the compressed tire is negative on average; compression must be positive, so turn "
            "the sign of the force"
        )
    return surface


def _where(radius: float, pieces: Sequence[Piece]) -> str:
    return f"{', '.join(dict.fromkeys(p.name for p in pieces))} ({describe(radius)})"
