"""What a fit may miss besides noise: forms that are not quite right, and a zero of the force that drifts.

The discrepancy that the form of a fitted effect may cause is its own response, modulated smoothly:

    discrepancy = sum_e c_e f_e scale_e sum_j z_j phi_j,   z_j ~ N(0, 1)

c_e: response of effect e as fitted; f_e: its form error, declared from measurements; phi_j: smooth functions of
deflection, direction, path since the last reversal, speed, time and surface, of mean square 1 together. A second effect
that would only correct the form of the first explains nothing that these functions do not. The discrepancy of the law
is the law times functions of the deflection, on each surface. Each `scale` maximises the evidence under a half-Cauchy
prior (A. Gelman, Bayesian Analysis 1 (2006) 515), since real forms may differ more from the catalogue's than those that
were measured; the form error is at most the whole effect.

Beside every set the zero of the force may drift: a function of the time alone in each recording, at most as large as
the misfit, that only what is as slow can follow (see `drifts`).

M. Kennedy, A. O'Hagan, J. R. Stat. Soc. B 63, 425 (2001); J. Brynjarsdottir, A. O'Hagan, Inverse Problems 30 (2014).
"""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray

from ..preprocessing.noise import STILL
from ..preprocessing.turns import branches
from ..regressors.dataset import Dataset
from ..regressors.signature import HEIGHTS, LAW, form_error, size_of

FloatArray = NDArray[np.float64]


DEFLECTION_HATS, SIGNED_HATS = HEIGHTS // 2 + 1, HEIGHTS // 4 + 1
"""Numbers of hat functions of the deflection (a hat at every second height of a law's shape), and of those of the
deflection times the sign of the direction and of the path since the last reversal."""


def smooth_functions(dataset: Dataset) -> FloatArray:
    """Return the functions phi (m, k) of the module's docstring at the counted blocks, of mean square 1 together."""
    many, x = dataset.experiments, dataset.deflection
    rate = dataset.gathered([e.rate for e in many])
    time = dataset.gathered([(e.time - e.time[0]) / max(e.time[-1] - e.time[0], 1e-300) for e in many])
    radius = dataset.gathered([e.surface_radius for e in many])
    depth = (x - x.min()) / max(float(np.ptp(x)), 1e-300)
    speed = np.log(np.maximum(np.abs(rate) / dataset.scales.rate, STILL))
    since_turn = dataset.gathered([_since_turn(e.deflection, e.gauge) for e in many]) / max(
        float(np.ptp(x)), 1e-300
    )
    groups = [_hats(depth, DEFLECTION_HATS), np.sign(rate)[:, None] * _hats(depth, SIGNED_HATS)]
    groups += [
        _hats(np.sqrt(np.minimum(since_turn, 1.0)), SIGNED_HATS),
        _polynomial(time),
        _polynomial(speed),
    ]
    if 1 < len(dataset.radii) <= DEFLECTION_HATS:
        groups.append(np.column_stack([(radius == r).astype(float) for r in dataset.radii]))
    parts = [g / np.sqrt(max(float(np.mean(np.sum(g**2, axis=1))), 1e-300)) for g in groups]
    return np.asarray(np.concatenate(parts, axis=1) / np.sqrt(len(parts)))


def form_errors(
    curves: Mapping[str, FloatArray], dataset: Dataset, functions: FloatArray
) -> dict[str, FloatArray]:
    """Return for each effect the columns (m, k) of its discrepancy at scale 1, in units of the noise.

    curves (m,): response that each effect adds to the others
    """
    return {
        name: form_error(name, dataset.tire) * size_of(curve) * _of_law(dataset)
        if name == LAW
        else form_error(name) * curve[:, None] * functions
        for name, curve in curves.items()
    }


def drifts(dataset: Dataset) -> FloatArray:
    """Return a drift of the force (m, k) in each recording, as large as the misfit together: hats over the time,
    evenly over its strokes.

    There are as many as strokes, since within one of them, or in a hold, no time can be told from what the deflection
    does, and at most as many as a refitted law has over the deflection. In one cycle there are none: no deflection is
    passed again in its direction.
    """
    many, columns = dataset.experiments, [np.zeros((dataset.misfit.size, 0))]
    span = float(np.ptp(dataset.deflection))
    for own in many:
        direction, _ = branches(own.deflection, own.gauge, span)
        turns = own.time[1:][np.diff(direction) != 0]
        strokes = 1 + turns.size
        if strokes > 2:
            count = min(strokes, HEIGHTS)
            ends = np.concatenate([own.time[:1], turns, own.time[-1:]])
            hats = _hats(np.interp(own.time, ends, np.linspace(0.0, 1.0, ends.size)), count)
            columns.append(
                dataset.stacked([hats if e is own else np.zeros((e.time.size, count)) for e in many])
            )
    whole = np.concatenate(columns, axis=1)
    size = float(np.sqrt(np.mean(np.sum(whole**2, axis=1))))
    return np.asarray(whole * (size_of(dataset.misfit) / max(size, 1e-300)))


def _of_law(dataset: Dataset) -> FloatArray:
    """Return the law times hats over the deflection, common to all surfaces and on each, of mean square 1 together."""
    many, x = dataset.experiments, dataset.deflection
    radius = dataset.gathered([e.surface_radius for e in many])
    force = dataset.stacked([e.baseline for e in many])
    hats = force[:, None] * _hats((x - x.min()) / max(float(np.ptp(x)), 1e-300), DEFLECTION_HATS)
    columns = [hats]
    if 1 < len(dataset.radii) <= DEFLECTION_HATS:
        columns += [hats * (radius == r)[:, None] for r in dataset.radii]
    whole = np.concatenate(columns, axis=1)
    return np.asarray(whole / np.sqrt(max(float(np.mean(np.sum(whole**2, axis=1))), 1e-300)))


def _since_turn(deflection: FloatArray, noise: float) -> FloatArray:
    """Return the distance (n,) [m] from the last reversal; noise [m]: of the deflection."""
    direction, _ = branches(deflection, noise)
    begin = np.append(0, np.flatnonzero(np.diff(direction)) + 1)
    turn = begin[np.searchsorted(begin, np.arange(deflection.size), side="right") - 1]
    return np.asarray(np.abs(deflection - deflection[turn]))


def _hats(place: FloatArray, count: int) -> FloatArray:
    knots = np.linspace(0.0, 1.0, count)
    return np.column_stack([np.interp(place, knots, row) for row in np.eye(count)])


def _polynomial(values: FloatArray) -> FloatArray:
    """Return first and second power, each of mean 0 and mean square 1; one column of zeros where all values are
    equal.
    """
    spread = float(np.std(values))
    if spread < 1e-9:
        return np.zeros((values.size, 1))
    first = (values - values.mean()) / spread
    second = first**2 - 1.0
    return np.column_stack([first, second / max(float(np.std(second)), 1e-300)])
