"""The noise of recordings, from what a model with every freedom at once leaves over."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from scipy.fft import dct

from ..preprocessing.coloured_noise import WHITE
from ..preprocessing.kinematics import BoolArray, FloatArray, IndexArray, Motion
from ..preprocessing.lines_and_segments import LinesAndSegments, detect_lines_and_segments
from ..preprocessing.noise_model import Noise, first_guess, noise_of
from .beyond import worth_trying
from .columns import Built, Layout, build, layout_of
from .evidence import Products, explain, products_of
from .families import Family
from .place import Point
from .scene import Record, Scene

SPARSE = 6
"""Of families with many alternative columns, every so many are enough to take up what they could."""

MANY = 24
SAMPLES_PER_COLUMN = 10
"""Short recordings leave room for the smooth functions that fit in with this many samples to a column."""

ROUNDS = 2

BESIDE_CORNER = 3
"""Samples on each side of a corner of the motion whose mean residuals are compared."""


def background(scene: Scene, families: Sequence[Family], point: Point) -> tuple[Noise, ...]:
    """Return the noise of each recording: size, colour and spikes of what all `families` together leave."""
    # Smooth courses of time blur the edges of what begins and ends at once, and a mode rings with any line near it.
    blind = [f for f in worth_trying(families, scene) if (f.standing or not f.slow) and f.name != "resonance"]
    _look(scene, blind, point)
    return noises_beside(scene, families, point)


def noises_beside(scene: Scene, families: Sequence[Family], point: Point) -> tuple[Noise, ...]:
    """Return the noise of each recording beside the lines and spans that are known to stand out."""
    return _noises(scene, worth_trying(families, scene), point, ROUNDS)[0]


def _look(scene: Scene, families: Sequence[Family], point: Point) -> None:
    """Find what stands out of what all other families leave."""
    _, left = _noises(scene, families, point, 1)
    for record, values in zip(scene.records, left, strict=True):
        record.standing[:] = [standing_out(record, values)]


def standing_out(record: Record, left: FloatArray) -> LinesAndSegments:
    """Return what stands out of what is left of a recording [N] at its thin samples, corners of the motion aside."""
    thin = record.thin
    return detect_lines_and_segments(
        thin.time, np.where(thin.motion.resolved, left, 0.0), thin.elastic(thin.motion.deflection)
    )


def _noises(
    scene: Scene, families: Sequence[Family], point: Point, rounds: int
) -> tuple[tuple[Noise, ...], list[FloatArray]]:
    """Return the noise of each recording and what the families leave of it [N]."""
    built = build(scene, point, families)
    layout = layout_of(built, families)
    columns, groups = _thinned(built, families, layout)
    noises = [first_guess(b.residual) for b in built]
    told = [
        _told(b.residual, r.thin.motion, n.level)
        for b, r, n in zip(built, scene.records, noises, strict=True)
    ]
    total = sum(b.residual.size for b in built)
    for _ in range(rounds):
        # Slow noise is not foretold here: what a course of time or motion can follow is first given to that.
        noises = [replace(n, slow=WHITE) for n in noises]
        data = [n.whitened(b.residual) for n, b in zip(noises, built, strict=True)]
        white = [n.whitened(c) for n, c in zip(noises, columns, strict=True)]
        p = products_of(np.concatenate(white), np.concatenate(data))
        explained = explain(p, groups, 1.0)
        following, rest = [], []
        for b, own, seen, record in zip(built, columns, white, scene.records, strict=True):
            left = b.residual.copy()
            for group, values in zip(groups, explained.coefficients, strict=True):
                left -= own[:, group] @ values
            freedom = explained.freedom * left.size / total
            through = b.place.stiffness * record.thin.motion.smoothed_noise
            rest.append(left)
            taken = _taken(seen, p, groups, explained.covariance)
            following.append(noise_of(left, through, freedom, told[record.number], taken, b.place.elastic))
        noises = following
    return tuple(noises), rest


def _told(residual: FloatArray, motion: Motion, level: float) -> BoolArray:
    """Return which samples say something: all but the corners of the motion across which the force jumps.

    What depends on rate or direction jumps where the motion turns, and within a sample nobody knows when. Tops, and
    bottoms, are kept where they do not show a jump of more than half the noise's level [N].
    """
    edges = np.flatnonzero(np.diff(np.concatenate([[False], ~motion.resolved, [False]]).astype(int)))
    corners: dict[float, list[tuple[int, int]]] = {}
    for first, after in zip(edges[::2].tolist(), edges[1::2].tolist(), strict=True):
        if first >= BESIDE_CORNER and after + BESIDE_CORNER <= residual.size:
            corners.setdefault(float(motion.direction[first - 1]), []).append((first, after))
    told: BoolArray = motion.resolved.copy()
    for spans in corners.values():
        jumps = [
            residual[after : after + BESIDE_CORNER].mean() - residual[first - BESIDE_CORNER : first].mean()
            for first, after in spans
        ]
        deviation = level * np.sqrt(2.0 / BESIDE_CORNER / len(jumps))
        if abs(np.mean(jumps)) < 0.5 * level + 2.0 * deviation:
            for first, after in spans:
                told[first:after] = True
    return told


def _taken(
    white: FloatArray, p: Products, groups: Sequence[IndexArray], covariance: FloatArray
) -> FloatArray:
    """Return the part of the noise's power in each cosine coefficient that the fitted columns have taken."""
    index = np.concatenate(groups)
    waves = dct(white[:, index] / p.scale[index], axis=0, norm="ortho")
    return np.asarray(np.einsum("ij,ij->i", waves @ covariance, waves))


def _thinned(
    built: Sequence[Built], families: Sequence[Family], layout: Layout
) -> tuple[list[FloatArray], list[IndexArray]]:
    columns = {
        f.name: layout.whole(f.name)[
            :: SPARSE if len(layout.variants[f.name]) >= MANY or f.name == "jump" else 1
        ]
        for f in families
    }
    left = sum(b.residual.size for b in built) // SAMPLES_PER_COLUMN
    # Courses of time first: without them a short recording's drift would be taken for its noise.
    for f in sorted(families, key=lambda f: not f.slow):
        if f.agnostic and columns[f.name].size > left:
            columns[f.name] = columns[f.name][:0]
        elif f.agnostic:
            left -= columns[f.name].size
    groups, chosen, at = [], [], 0
    for f in families:
        own = columns[f.name]
        chosen.append(own)
        if own.size:
            groups.append(np.arange(at, at + own.size))
        at += own.size
    index = np.concatenate(chosen)
    whole = [np.concatenate([b.columns[f.name] for f in families], axis=1)[:, index] for b in built]
    return whole, groups
