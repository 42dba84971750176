"""The signature of the elastic law itself: how a refitted law, or one of another shape, would differ.

    dF / F = a + b l + c l^2 + d l^3 + hats(l),   l = ln(x / x_ref)

common to all surfaces, and on each surface beside it. The hats are a static discrepancy: what no log-polynomial
follows.
Its scale is not declared: it is found by the marginal likelihood (type II), like that of the effects.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from radialtire import CATALOGUE

from ..names import REFITTED_LAW
from .dataset import Dataset
from .signature import Signature, size_of

FloatArray = NDArray[np.float64]

LAW = REFITTED_LAW
"""The name under which a refitted law stands in a verdict."""

SHAPE = next(name for name, effect in CATALOGUE.items() if "law" in effect.traits)
"""The effect in which a refitted law keeps bend and twist."""


FACTOR, EXPONENT, BEND, TWIST, HAT = 0.1, 0.07, 0.03, 0.01, 0.05
"""Standard deviations of a, b, c, d and of a hat at the scale 1: their proportions are what counts."""

HATS = 7

HEIGHT = 0.05
"""Standard deviation of each height of a refitted law's shape at the scale 1."""

HEIGHTS = 5
"""Heights in the shape of a refitted law."""


def candidates() -> tuple[str, ...]:
    """Return the names of the effects that may be missing; the law comes beside them."""
    return tuple(name for name in CATALOGUE if name != SHAPE)


def form_error(name: str) -> float:
    """Return the declared form error of an effect or of the law."""
    return CATALOGUE[SHAPE if name == LAW else name].form_error


def law_signature(dataset: Dataset) -> Signature:
    """Return the law's signature; its size 1 is that of a change of A by FACTOR."""
    gather = dataset.gathered
    x = gather(
        [np.abs(e.deflection) if dataset.tire.two_sided else e.deflection for e in dataset.experiments]
    )
    radius = gather([e.surface_radius for e in dataset.experiments])
    # A refitted law leaves a part's preload as it is.
    force = dataset.stacked([e.baseline - dataset.tire.preload for e in dataset.experiments])
    positive = x[x > 0.0]
    middle = float(np.median(positive)) if positive.size else 1.0
    way = np.log(np.maximum(x / middle, 0.01))
    loaded = way[x > 0.02 * float(x.max())] if x.max() > 0.0 else way
    knots = np.linspace(float(loaded.min()), float(loaded.max()), HATS)
    hats = [HAT * np.interp(way, knots, row) for row in np.eye(HATS)]
    parts = [FACTOR + 0.0 * way, EXPONENT * way, BEND * way**2, TWIST * way**3, *hats]
    shapes = [force * part for part in parts]
    columns = list(shapes)
    if len(dataset.radii) > 1:
        columns = [np.sqrt(0.5) * s for s in shapes]
        columns += [np.sqrt(0.5) * s * (radius == r) for r in dataset.radii for s in shapes]
    basis = np.column_stack(columns) / max(size_of(FACTOR * force), 1e-300)
    none = np.zeros((0, force.size))
    return Signature(LAW, np.zeros(force.size), basis, False, none, (), np.zeros(0))
