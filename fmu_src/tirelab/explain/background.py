"""The noise of recordings, from what a model with every freedom at once leaves over."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from ..noise import Noise, first_guess, noise_of
from .beyond import worth_trying
from .columns import Built, Layout, build, layout_of
from .evidence import explain, products_of
from .families import Family
from .motion import FloatArray, IndexArray
from .outstanding import outstanding
from .place import Point
from .scene import Scene

SPARSE = 6
"""Of families with many alternative columns, every so many are enough to take up what they could."""

MANY = 24
SAMPLES_PER_COLUMN = 20
"""Short recordings leave room for the smooth functions that fit in with this many samples to a column."""

ROUNDS = 2


def background(scene: Scene, families: Sequence[Family], point: Point) -> tuple[Noise, ...]:
    """Return the noise of each recording: size, colour and spikes of what all `families` together leave."""
    _look(scene, [f for f in worth_trying(families, scene) if f.name not in COURSES], point)
    return _noises(scene, worth_trying(families, scene), point, ROUNDS)[0]


COURSES = ("time", "time, added", "jump")
"""Smooth courses of time: they blur the edges of what begins and ends at once."""


def _look(scene: Scene, families: Sequence[Family], point: Point) -> None:
    """Find what stands out of what all other families leave."""
    _, left = _noises(scene, families, point, 1)
    for record, values in zip(scene.records, left, strict=True):
        thin = record.thin
        known = np.where(thin.motion.resolved, values, 0.0)
        found = outstanding(thin.time, known, thin.elastic(thin.motion.deflection))
        record.standing[:] = [found]


def _noises(
    scene: Scene, families: Sequence[Family], point: Point, rounds: int
) -> tuple[tuple[Noise, ...], list[FloatArray]]:
    """Return the noise of each recording and what the families leave of it [N]."""
    built = build(scene, point, families)
    layout = layout_of(built, families)
    columns, groups = _thinned(built, families, layout)
    noises = [first_guess(b.residual) for b in built]
    total = sum(b.residual.size for b in built)
    for _ in range(rounds):
        data = [n.whitened(b.residual) for n, b in zip(noises, built, strict=True)]
        white = [n.whitened(c) for n, c in zip(noises, columns, strict=True)]
        explained = explain(products_of(np.concatenate(white), np.concatenate(data)), groups, 1.0)
        following, rest = [], []
        for b, own, record in zip(built, columns, scene.records, strict=True):
            left = b.residual.copy()
            for group, values in zip(groups, explained.coefficients, strict=True):
                left -= own[:, group] @ values
            freedom = explained.freedom * left.size / total
            through = b.place.stiffness * record.thin.motion.blur
            rest.append(left)
            following.append(noise_of(left, through, freedom, record.thin.motion.resolved))
        noises = following
    return tuple(noises), rest


def _thinned(
    built: Sequence[Built], families: Sequence[Family], layout: Layout
) -> tuple[list[FloatArray], list[IndexArray]]:
    groups, chosen, at = [], [], 0
    most, smooth = sum(b.residual.size for b in built) // SAMPLES_PER_COLUMN, 0
    for f in families:
        own = layout.whole(f.name)
        if len(layout.variants[f.name]) >= MANY or f.name == "jump":
            own = own[::SPARSE]
        if f.agnostic:
            smooth += own.size
            if smooth > most:
                own = own[:0]
        chosen.append(own)
        if own.size:
            groups.append(np.arange(at, at + own.size))
        at += own.size
    index = np.concatenate(chosen)
    whole = [np.concatenate([b.columns[f.name] for f in families], axis=1)[:, index] for b in built]
    return whole, groups
