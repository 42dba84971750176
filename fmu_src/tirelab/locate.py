"""Where simulation and recording part: the residual against everything that a recording knows.

Time, direction, deflection, rate, acceleration, radius, force, cycle, largest deflection so far, and recording are cut
into spans. Each span has its mean residual, its share of the squared error beyond the noise, and how significant its
mean is: the residual is cut into blocks longer than the noise's correlation, and blocks are counted, not samples.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy.stats import norm

from .explain.motion import FloatArray, IndexArray
from .explain.scene import Scene
from .noise import Noise

SPANS = 10
"""Spans into which a continuous coordinate is cut, of equal numbers of samples."""

BLOCKS = 400
"""Blocks of time at most, over all recordings; fewer where the noise is correlated for longer."""

SIGNIFICANT = 1e-3
"""Chance, over all spans of all coordinates together, of calling a span significant where there is noise alone."""


@dataclass(frozen=True)
class Span:
    """One place of the misfit.

    by: coordinate; start, stop: its span in `unit`; label: what it is called where it has no numbers
    share: part of the squared error beyond the noise, 0 to 1; mean_residual [N]: recording less simulation
    z: mean over its standard error from blocks; significant: after correction for all spans looked at
    """

    by: str
    start: float
    stop: float
    unit: str
    label: str
    share: float
    mean_residual: float
    z: float
    significant: bool

    def to_contract(self) -> dict[str, object]:
        """Return the span as the entry of `where` in diagnosis.json."""
        return {
            "by": self.by,
            "from": _finite(self.start),
            "to": _finite(self.stop),
            "unit": self.unit,
            "share": self.share,
            "mean_residual": self.mean_residual,
        }


def _finite(value: float) -> float | str:
    if np.isfinite(value):
        return float(value)
    return "inf" if value > 0.0 else "-inf"


def locate(scene: Scene, residuals: Sequence[FloatArray], noises: Sequence[Noise]) -> tuple[Span, ...]:
    """Return the spans of the residuals [N] of each recording, those with the largest share first."""
    residual = np.concatenate(residuals)
    floor = np.concatenate([np.full(r.size, n.level**2) for r, n in zip(residuals, noises, strict=True)])
    beyond = residual**2 - floor
    whole = max(float(np.sum(beyond)), 1e-12)
    strides = [max(r.time.size // r.rows.size, 1) for r in scene.records]
    blocks = _blocks(residuals, noises, strides)
    found = []
    for by, unit, values, edges, labels in _coordinates(scene):
        for i in range(len(edges) - 1):
            last = i == len(edges) - 2
            inside = (values >= edges[i]) & ((values <= edges[i + 1]) if last else (values < edges[i + 1]))
            if int(inside.sum()) < 5:
                continue
            mean = float(np.mean(residual[inside]))
            z = _block_z(residual, inside, blocks)
            share = float(np.clip(np.sum(beyond[inside]) / whole, 0.0, 1.0))
            label = labels[i] if labels else ""
            found.append(Span(by, float(edges[i]), float(edges[i + 1]), unit, label, share, mean, z, False))
    limit = float(norm.isf(SIGNIFICANT / 2.0 / max(len(found), 1)))
    judged = [Span(**{**s.__dict__, "significant": abs(s.z) > limit}) for s in found]
    return tuple(sorted(judged, key=lambda s: (-int(s.significant), -s.share)))


def _blocks(residuals: Sequence[FloatArray], noises: Sequence[Noise], strides: Sequence[int]) -> IndexArray:
    """Return the number of the block of each sample: at least four correlation lengths of the noise long."""
    total = sum(r.size for r in residuals)
    numbers, at = [], 0
    for r, n, stride in zip(residuals, noises, strides, strict=True):
        length = max(int(np.ceil(4.0 * stride * n.correlation_samples)), -(-total // BLOCKS), 2)
        numbers.append(at + np.arange(r.size) // length)
        at = int(numbers[-1][-1]) + 1
    return np.concatenate(numbers)


def _block_z(residual: FloatArray, inside: np.ndarray, blocks: IndexArray) -> float:
    """Return the mean inside over its standard error, with the blocks as the independent draws."""
    count = int(blocks[-1]) + 1
    sums = np.bincount(blocks[inside], residual[inside], minlength=count)
    sizes = np.bincount(blocks[inside], minlength=count).astype(float)
    used = sizes > 0
    if int(used.sum()) < 3:
        return 0.0
    mean = float(sums.sum() / sizes.sum())
    spread = float(np.sqrt(np.sum((sums[used] - mean * sizes[used]) ** 2) * used.sum() / (used.sum() - 1)))
    return mean * float(sizes.sum()) / max(spread, 1e-12)


_Coordinate = tuple[str, str, FloatArray, FloatArray, list[str]]


def _coordinates(scene: Scene) -> list[_Coordinate]:
    records = scene.records

    def joined(values: Sequence[FloatArray]) -> FloatArray:
        return np.concatenate(values)

    found: list[_Coordinate] = []

    def spread(by: str, unit: str, values: FloatArray) -> None:
        edges = np.unique(np.quantile(values, np.linspace(0.0, 1.0, SPANS + 1)))
        if edges.size >= 3:
            found.append((by, unit, values, edges, []))

    spread("deflection", "m", joined([r.motion.deflection for r in records]))
    spread("rate", "m/s", joined([r.motion.rate for r in records]))
    spread("acceleration", "m/s^2", joined([r.motion.acceleration for r in records]))
    spread("time", "s", joined([r.time for r in records]))
    spread("force", "N", joined([r.elastic(r.motion.deflection) for r in records]))
    spread("history", "m", joined([r.motion.deepest for r in records]))
    direction = joined([r.motion.direction for r in records])
    found.append(("direction", "1", direction, np.array([-1.5, 0.0, 1.5]), ["unloading", "loading"]))
    cycle = joined([r.motion.cycle for r in records])
    if cycle.max() >= 1.0:
        found.append(
            ("cycle", "1", cycle, np.array([-0.5, 0.5, cycle.max() + 0.5]), ["first cycle", "later cycles"])
        )
    if len(scene.radii) > 1:
        nearest = joined([np.argmax(r.surface, axis=1).astype(float) for r in records])
        edges = np.arange(len(scene.radii) + 1, dtype=np.float64) - 0.5
        found.append(("radius", "m", nearest, edges, [_radius(r) for r in scene.radii]))
    if len(records) > 1:
        number = joined([np.full(r.time.size, float(i)) for i, r in enumerate(records)])
        edges = np.arange(len(records) + 1, dtype=np.float64) - 0.5
        found.append(("recording", "1", number, edges, [f"recording {i + 1}" for i in range(len(records))]))
    return found


def _radius(radius: float) -> str:
    return "flat" if not np.isfinite(radius) else f"{radius:.4g} m"
