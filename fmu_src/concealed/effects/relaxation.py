"""Viscoelastic relaxation: several Maxwell branches, or a springpot (fractional element)."""

import math
from dataclasses import dataclass
from typing import ClassVar

import numpy as np
from scipy.signal import fftconvolve, lfilter

from ..motion import FloatArray
from .effect import Conditions, Contact, Effect


def overstress(elastic: FloatArray, step: float, time_constant: float) -> FloatArray:
    """Force of a Maxwell branch of unit share: q' = F_e' - q/tau, at rest at the start.

    Exact for an F_e that is linear between samples. F_e [N] every `step` [s], tau [s].
    """
    keep = math.exp(-step / time_constant)
    gain = -math.expm1(-step / time_constant) * time_constant / step
    changes = np.diff(elastic, prepend=elastic[0])
    return np.asarray(lfilter([gain], [1.0, -keep], changes), dtype=np.float64)


def fractional_derivative(values: FloatArray, step: float, order: float) -> FloatArray:
    """Grunwald-Letnikov derivative D^a f = h^-a sum_j (-1)^j binom(a, j) f(t - j h), at rest before the
    start.

    values shape (n,), every `step` h [s]; order a in (0, 1). Returns [unit of values / s^a].
    Source: Podlubny, Fractional Differential Equations (1999), section 2.2.
    """
    ratios = 1.0 - (order + 1.0) / np.arange(1, values.size)
    weights = np.concatenate([[1.0], np.cumprod(ratios)])
    return np.asarray(fftconvolve(values, weights)[: values.size] * step**-order, dtype=np.float64)


@dataclass(frozen=True)
class PronySeries(Effect):
    """Overstress above the relaxed law in three to six branches: F = sum g_i q_i, q_i' = F_e' - q_i/tau_i.

    `strength` is sum g_i [1]; weights sum to one; time constants tau_i [s] over two or three decades.
    """

    weights: tuple[float, ...]
    time_constants: tuple[float, ...]

    name: ClassVar[str] = "viscoelastic_relaxation"
    unit: ClassVar[str] = "1"
    limit: ClassVar[float] = 0.35

    @classmethod
    def drawn(cls, rng: np.random.Generator, conditions: Conditions) -> "PronySeries":
        """Time constants around those that the recordings can show."""
        count = int(rng.integers(3, 7))
        middle = float(np.exp(rng.uniform(np.log(0.15), np.log(max(0.1 * conditions.longest, 0.5)))))
        decades = rng.uniform(1.5, 3.0)
        constants = middle * 10.0 ** (decades * np.linspace(-0.5, 0.5, count))
        weights = rng.dirichlet(np.full(count, 3.0))
        return cls(0.05, tuple(weights.tolist()), tuple(constants.tolist()))

    def parallel(self, contact: Contact) -> FloatArray:
        """Overstress [N]."""
        total = np.zeros_like(contact.elastic)
        for weight, constant in zip(self.weights, self.time_constants, strict=True):
            total += weight * overstress(contact.elastic, contact.motion.step, constant)
        return self.strength * total


@dataclass(frozen=True)
class Springpot(Effect):
    """F = g tau^a D^a F_e in parallel to the relaxed law: creep and relaxation by a power of time.

    share g [1] at the time tau [s], order a [1]; overstress after a step falls as (t/tau)^-a / Gamma(1 - a).
    """

    time_constant: float
    order: float

    name: ClassVar[str] = "viscoelastic_relaxation"
    unit: ClassVar[str] = "1"
    limit: ClassVar[float] = 0.25

    @classmethod
    def drawn(cls, rng: np.random.Generator, conditions: Conditions) -> "Springpot":
        """Order as of rubber between its plateau and its transition."""
        return cls(0.03, float(np.exp(rng.uniform(np.log(0.1), np.log(2.0)))), rng.uniform(0.25, 0.5))

    def parallel(self, contact: Contact) -> FloatArray:
        """Overstress [N]."""
        changed = contact.elastic - contact.elastic[0]
        slope = fractional_derivative(changed, contact.motion.step, self.order)
        return float(self.strength * self.time_constant**self.order) * slope
