"""What the form of a fitted effect may miss: its own response, modulated smoothly by what the recording shows.

    discrepancy = sum_e c_e f_e scale sum_j z_j phi_j,   z_j ~ N(0, 1)

c_e: response of effect e as fitted; f_e: its form error, declared from measurements; phi_j: smooth functions of
deflection, direction, speed, time and surface, together of mean square 1. An effect beside another one that only mends
the other one's form explains nothing that these do not. The law's discrepancy is the law times functions of the
deflection, on each surface. `scale` is found by the evidence under a half-Cauchy prior (A. Gelman, Bayesian Analysis 1
(2006) 515), since real forms may be further from the catalogue's than the measured ones.

M. Kennedy, A. O'Hagan, J. R. Stat. Soc. B 63, 425 (2001); J. Brynjarsdottir, A. O'Hagan, Inverse Problems 30 (2014).
"""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray

from ..regressors.dataset import Dataset
from ..regressors.law import LAW, form_error
from ..regressors.signature import size_of

FloatArray = NDArray[np.float64]

DEPTHS, WAYS = 6, 3
"""Hats over the deflection, and over the deflection with the sign of the direction."""


def smooth_functions(dataset: Dataset) -> FloatArray:
    """Return the functions phi (m, k) at the counted blocks, of mean square 1 together."""
    many = dataset.experiments
    x = dataset.gathered([e.deflection for e in many])
    rate = dataset.gathered([e.rate for e in many])
    time = dataset.gathered([(e.time - e.time[0]) / max(e.time[-1] - e.time[0], 1e-300) for e in many])
    radius = dataset.gathered([e.surface_radius for e in many])
    depth = (x - x.min()) / max(float(np.ptp(x)), 1e-300)
    speed = np.log(np.maximum(np.abs(rate) / dataset.scales.rate, 1e-2))
    groups = [_hats(depth, DEPTHS), np.sign(rate)[:, None] * _hats(depth, WAYS)]
    groups += [_polynomial(time), _polynomial(speed)]
    if 1 < len(dataset.radii) <= DEPTHS:
        groups.append(np.column_stack([(radius == r).astype(float) for r in dataset.radii]))
    parts = [g / np.sqrt(max(float(np.mean(np.sum(g**2, axis=1))), 1e-300)) for g in groups]
    return np.asarray(np.concatenate(parts, axis=1) / np.sqrt(len(parts)))


def form_errors(curves: Mapping[str, FloatArray], dataset: Dataset, functions: FloatArray) -> FloatArray:
    """Return the columns (m, k) of the discrepancy at scale 1, in units of the noise.

    curves (m,): what each effect adds to the others
    """
    columns = []
    for name, curve in curves.items():
        if name == LAW:
            columns.append(form_error(name) * size_of(curve) * _of_law(dataset))
        else:
            columns.append(form_error(name) * curve[:, None] * functions)
    return np.concatenate(columns, axis=1) if columns else np.zeros((dataset.misfit.size, 0))


def _of_law(dataset: Dataset) -> FloatArray:
    """Return the law times hats over the deflection, common to all surfaces and on each, of mean square 1 together."""
    many = dataset.experiments
    x = dataset.gathered([e.deflection for e in many])
    radius = dataset.gathered([e.surface_radius for e in many])
    force = dataset.stacked([e.baseline for e in many])
    hats = force[:, None] * _hats((x - x.min()) / max(float(np.ptp(x)), 1e-300), DEPTHS)
    columns = [hats]
    if 1 < len(dataset.radii) <= DEPTHS:
        columns += [hats * (radius == r)[:, None] for r in dataset.radii]
    whole = np.concatenate(columns, axis=1)
    return np.asarray(whole / np.sqrt(max(float(np.mean(np.sum(whole**2, axis=1))), 1e-300)))


def _hats(place: FloatArray, count: int) -> FloatArray:
    knots = np.linspace(0.0, 1.0, count)
    return np.column_stack([np.interp(place, knots, row) for row in np.eye(count)])


def _polynomial(values: FloatArray) -> FloatArray:
    """Return first and second power, each of mean zero and mean square 1; zero where the values are all one."""
    spread = float(np.std(values))
    if spread < 1e-9:
        return np.zeros((values.size, 1))
    first = (values - values.mean()) / spread
    second = first**2 - 1.0
    return np.column_stack([first, second / max(float(np.std(second)), 1e-300)])
