"""The noise of the averaged misfit, from what a model with every freedom at once leaves."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from ..regressors.dataset import Dataset
from ..regressors.noise_floor import noise_of
from ..regressors.signature import Signature
from ..selection.marginal_likelihood import NormalEquations, normal_equations


def with_saturated_noise(dataset: Dataset, signatures: Sequence[Signature]) -> Dataset:
    """Return the dataset with the noise that all signatures together leave, block by block."""
    equations = normal_equations(signatures, dataset.misfit)
    left = dataset.apart(dataset.misfit - _saturated(equations))
    found = []
    for e, own in zip(dataset.experiments, left, strict=True):
        noise = noise_of(own, e.interval, *(v[e.counts] for v in (e.deflection, e.rate, e.acceleration)))
        found.append(replace(noise, level=e.noise * max(noise.level, 1e-3)))
    return dataset.with_noise(found)


def _saturated(equations: NormalEquations) -> np.ndarray:
    """Return the misfit as all columns follow it, each with a weak prior of the misfit's own size."""
    size = equations.power / equations.columns.shape[0]
    gram = equations.gram + np.eye(equations.gram.shape[0]) / max(size, 1.0)
    return np.asarray(equations.columns @ np.linalg.solve(gram, equations.moment))
