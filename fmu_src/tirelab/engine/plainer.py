"""Whether less would do: an effect that slow noise can stand for is not believed.

The noise is first measured on what a model with every freedom leaves, and such a model follows slow noise too. So each
family of the best set is taken out once more, the noise measured on what is then left, and both sets compared with that
noise: where the smaller one is now as likely, the difference was noise.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from ..preprocessing.kinematics import FloatArray
from ..preprocessing.noise_model import Noise, noise_of
from .columns import build, pointed
from .families import Family
from .judge import MATERIAL_SLOW, law_whole
from .scene import Scene
from .search import Settled, settle

UNASKED = ("inertia", "force_lag", "saturation", "force_offset")
"""What slow noise cannot stand for, but its measure can swallow: what is quick, or there for a moment, and a constant
(see `noise_model.MEAN_DRIFT`). What is beyond the catalogue has to be louder than slow noise anyway
(`judge.MATERIAL_SLOW`)."""


MOST = 1.0 + MATERIAL_SLOW**2
"""Power of a noise measured anew over that before: what it adds beyond this is no slow noise."""


def noise_of_less(
    best: Settled, scene: Scene, noises: Sequence[Noise], families: Sequence[Family], zeta: float
) -> tuple[Noise, ...] | None:
    """Return the noise with which a smaller set does as well as the best one, None where none does.

    Nor is it asked where a line or a span stands out: noise that is measured across it is none.
    """
    if any(r.outstanding.lines or r.outstanding.segments for r in scene.records):
        return None
    by_name = {f.name: f for f in families}
    asked = [n for n in best.names if n != "shape" and n not in UNASKED and not by_name[n].agnostic]
    # Two can follow slow noise together where neither does alone.
    for gone in [*((n,) for n in asked), *([tuple(asked)] if len(asked) > 1 else [])]:
        names = law_whole(n for n in best.names if n not in gone)
        less = settle(scene, noises, by_name, names, zeta, best.point)
        if not np.isfinite(less.log_evidence):
            continue
        wider = tuple(_wider(less, scene, noises))
        if _power(wider) > MOST * _power(noises):
            continue
        more = settle(scene, wider, by_name, best.names, zeta, best.point)
        less = settle(scene, wider, by_name, names, zeta, less.point)
        if less.log_evidence >= more.log_evidence:
            return wider
    return None


def _power(noises: Sequence[Noise]) -> float:
    return float(np.sum([n.level**2 * n.weight.size for n in noises]))


def _wider(less: Settled, scene: Scene, noises: Sequence[Noise]) -> list[Noise]:
    """Return the noise of each recording on what a settled set leaves."""
    built = build(scene, less.point, [less.layout.families[n] for n in less.names])
    found = []
    for b, record, noise in zip(built, scene.records, noises, strict=True):
        left = _left(less, b.residual, b.columns)
        through = b.place.stiffness * record.thin.motion.smoothed_noise
        share = less.candidate.explained.freedom * left.size / less.products.samples
        own = noise_of(left, through, share, record.thin.motion.resolved, load=b.place.elastic)
        found.append(own if own.level > noise.level else noise)
    return found


def left_by(settled: Settled, scene: Scene) -> list[FloatArray]:
    """Return what a settled set leaves of each recording [N], at its thin samples."""
    built = build(scene, settled.point, [settled.layout.families[n] for n in settled.names])
    return [_left(settled, b.residual, b.columns) for b in built]


def _left(less: Settled, residual: FloatArray, columns: dict[str, FloatArray]) -> FloatArray:
    left = np.array(residual)
    for name, group, values in zip(
        less.names, less.candidate.groups, less.candidate.explained.coefficients, strict=True
    ):
        own = group - less.layout.start[name]
        # What the point already holds has left the residual: only the last step is still in the columns.
        left = left - columns[name][:, own] @ (
            values - pointed(less.point, name, columns[name].shape[1])[own]
        )
    return np.asarray(left)
