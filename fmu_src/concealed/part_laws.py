"""Elastic laws of parts that are no power of the deflection, in closed form."""

from collections.abc import Callable

import numpy as np

from .motion import FloatArray

PartLaw = Callable[[FloatArray], FloatArray]
"""Force, in units of its stiffness at small deflections times the stroke, of deflections over the stroke."""


def drawn_part_law(rng: np.random.Generator) -> PartLaw:
    """An exponential, a cubic, a softening, a two-stage or a one-sided law."""
    return (_exponential, _cubic, _softening, _two_stage, _one_sided)[rng.integers(5)](rng)


def _exponential(rng: np.random.Generator) -> PartLaw:
    way = _even_in_log(rng, 0.3, 3.0) * rng.choice((-1.0, 1.0))
    return lambda x: np.asarray(way * np.expm1(x / way))


def _cubic(rng: np.random.Generator) -> PartLaw:
    hardening = rng.uniform(-0.25, 2.0)
    return lambda x: np.asarray(x + hardening * x**3)


def _softening(rng: np.random.Generator) -> PartLaw:
    way = _even_in_log(rng, 0.3, 2.0)
    return lambda x: np.asarray(way * np.tanh(x / way))


def _two_stage(rng: np.random.Generator) -> PartLaw:
    """Another stiffness from a deflection on, with a rounded corner."""
    second, corner, width = _even_in_log(rng, 0.2, 5.0), rng.uniform(-0.6, 0.6), _even_in_log(rng, 0.03, 0.3)
    return lambda x: np.asarray(x + (second - 1.0) * width * np.logaddexp(0.0, (x - corner) / width))


def _one_sided(rng: np.random.Generator) -> PartLaw:
    bend = rng.uniform(-0.4, 0.4)
    return lambda x: np.asarray(x + bend * x**2)


def _even_in_log(rng: np.random.Generator, least: float, most: float) -> float:
    return float(np.exp(rng.uniform(np.log(least), np.log(most))))
