"""The signature of an effect: what its own response may look like on the recorded motion.

Parameters are drawn from their priors, the response of the baseline tire with the effect is simulated along the motion,
and the baseline is taken off. Mean and covariance of these curves, of one size, are a Gaussian law of forms: the mean
and the leading vectors of a singular value decomposition, each scaled by its standard deviation.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from radialtire import CATALOGUE, Effect

from .dataset import Dataset, arranged
from .draws import drawn

FloatArray = NDArray[np.float64]

DRAWS = 32
COLUMNS = 8
ENERGY = 0.999
"""Draws of an effect, most columns of its signature, and the part of the deviations' energy that they hold."""

FEWEST = 6
"""Fewer draws with a response make no signature: the effect cannot show itself here."""

SMALLEST, LARGEST = 0.1, 1.0
"""Sizes between which curves are drawn, as parts of the misfit: where the response is not linear, the form depends on
the size."""

SILENT = 1e-7
"""Response over the baseline force below which there is none."""


@dataclass(frozen=True)
class Signature:
    """The law of forms of one candidate, in units of the noise.

    mean (m,) and basis (m, r): of the curves, divided by their size; signed: whether the size may be negative
    curves (k, m) of size 1, values of their parameters and sizes (k,): the draws; none for the law
    """

    name: str
    mean: FloatArray
    basis: FloatArray
    signed: bool
    curves: FloatArray
    values: tuple[tuple[float, ...], ...]
    sizes: FloatArray

    @property
    def columns(self) -> FloatArray:
        """Mean and basis beside each other (m, 1 + r)."""
        return np.column_stack([self.mean, self.basis])


def size_of(curve: FloatArray) -> float:
    """Return the root mean square."""
    return float(np.sqrt(np.mean(curve**2)))


def signature_of(name: str, dataset: Dataset) -> Signature | None:
    """Return the signature of an effect, or None where it has no response on these recordings."""
    effect = CATALOGUE[name]
    sets, shares = drawn(effect, dataset.scales, DRAWS)
    force = dataset.load
    misfit = size_of(dataset.misfit)
    curves: list[FloatArray] = []
    values: list[tuple[float, ...]] = []
    sizes: list[float] = []
    for chosen, share in zip(sets, shares, strict=True):
        wanted = min(misfit * SMALLEST * (LARGEST / SMALLEST) ** share, 0.3 * force)
        curve, scaled = _sized(effect, chosen, dataset, wanted)
        size = size_of(curve) if curve.size else 0.0
        if not SILENT * force < size < 30.0 * max(misfit, wanted):
            continue
        sign = -1.0 if effect.signed and _strength(effect, scaled) < 0.0 else 1.0
        curves.append(sign * curve / size)
        values.append(tuple(scaled))
        sizes.append(sign * size)
    if len(curves) < FEWEST:
        return None
    whole = np.array(curves)
    mean = whole.mean(axis=0)
    return Signature(name, mean, _basis(whole - mean), effect.signed, whole, tuple(values), np.array(sizes))


def signatures_of(names: Sequence[str], dataset: Dataset) -> tuple[Signature, ...]:
    """Return the signatures of the effects that have a response on these recordings."""
    found = (signature_of(name, dataset) for name in names)
    return tuple(s for s in found if s is not None)


def _strength(effect: Effect, values: Sequence[float]) -> float:
    return next((v for p, v in zip(effect.parameters, values, strict=True) if p.role == "strength"), 1.0)


def _sized(
    effect: Effect, values: list[float], dataset: Dataset, wanted: float
) -> tuple[FloatArray, list[float]]:
    """Return a response near the wanted size and its parameters; an empty one where it is not finite."""
    adjustable = any(p.role == "strength" for p in effect.parameters)
    curve = np.zeros(0)
    for _ in range(3):
        curve = dataset.response(arranged(dataset.tire, [(effect.name, tuple(values))]))
        size = size_of(curve)
        if not np.isfinite(size):
            return np.zeros(0), values
        if not adjustable or size <= 0.0 or 0.4 < size / wanted < 2.5:
            break
        values = strengthened(effect, values, wanted / size)
    return curve, values


def strengthened(effect: Effect, values: Sequence[float], factor: float) -> list[float]:
    """Return the values with every strength, and what adds to it in its unit, times a factor, within bounds."""
    units = {p.unit for p in effect.parameters if p.role == "strength"}
    found = []
    for p, value in zip(effect.parameters, values, strict=True):
        strong = p.role == "strength" or (p.neutral is not None and p.unit in units and p.role != "limit")
        found.append(float(min(max(value * factor, p.minimum), p.maximum)) if strong else value)
    return found


def _basis(deviations: FloatArray) -> FloatArray:
    gram = deviations @ deviations.T
    powers, vectors = np.linalg.eigh(gram)
    order = np.argsort(powers)[::-1]
    powers, vectors = np.maximum(powers[order], 0.0), vectors[:, order]
    if powers.sum() <= 1e-6 * deviations.size:
        return np.zeros((deviations.shape[1], 0))
    needed = int(np.searchsorted(np.cumsum(powers) / powers.sum(), ENERGY) + 1)
    kept = min(COLUMNS, needed, deviations.shape[0] - 2)
    return np.asarray(deviations.T @ vectors[:, :kept] / np.sqrt(deviations.shape[0]))


def in_other_noise(signature: Signature, before: Dataset, after: Dataset) -> Signature:
    """Return a signature of a dataset in the noise levels of another one of the same recordings."""
    pairs = zip(before.experiments, after.experiments, strict=True)
    factor = np.concatenate([np.full(int(b.counts.sum()), b.noise / a.noise) for b, a in pairs])
    curves = signature.curves * factor
    sizes = np.sqrt(np.mean(curves**2, axis=1)) if len(curves) else np.ones(0)
    unit = float(sizes.mean()) if sizes.size else float(np.sqrt(np.mean(factor**2)))
    return Signature(
        signature.name,
        signature.mean * factor / unit,
        signature.basis * factor[:, None] / unit,
        signature.signed,
        curves / sizes[:, None] if sizes.size else curves,
        signature.values,
        signature.sizes * sizes,
    )
