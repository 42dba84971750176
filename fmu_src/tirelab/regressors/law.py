"""The signature of the elastic law itself: how a refitted law, or one of another shape, would differ.

    dF / F = a + b l + c l^2 + d l^3 + h(x),   l = ln(x / x_ref)

a and b on each surface beside those common to all, h: straight lines between the heights of `elastic_shape`. These are
the derivatives of what is fitted and delivered as a refitted law, so a law that can be fitted is seen before it is.
Their scale is not declared: it is found by the marginal likelihood (type II), like that of the effects.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from radialtire import CATALOGUE

from ..names import REFITTED_LAW
from .dataset import Dataset
from .draws import at_reading
from .signature import Signature, size_of

FloatArray = NDArray[np.float64]

LAW = REFITTED_LAW
"""The name under which a refitted law stands in a verdict."""

SHAPE = next(name for name, effect in CATALOGUE.items() if "law" in effect.traits)
"""The effect in which a refitted law keeps bend and twist."""


FACTOR, EXPONENT, BEND, TWIST = 0.1, 0.07, 0.03, 0.01
"""Standard deviations of a, b, c and d at the scale 1: their proportions are what counts."""

HEIGHT = 0.05
"""Standard deviation of each height of a refitted law's shape at the scale 1."""

HEIGHTS = 5
"""Heights in the shape of a refitted law."""

REFERENCE, SMALLEST = 2, 0.01
"""Index of the shape's reference, and the least x / x_ref, as in `elastic_shape`."""

MOST_SURFACES = 8
"""Beyond them (terrain) the law is refitted for all alike."""


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
    reference = at_reading(CATALOGUE[SHAPE].parameters[REFERENCE], dataset.scales)
    way = np.log(np.maximum(x / reference, SMALLEST))
    places = 2.0 * reference * np.arange(1, HEIGHTS + 1) / HEIGHTS
    heights = [HEIGHT * np.interp(x, places, row) for row in np.eye(HEIGHTS)]
    changes = [FACTOR + 0.0 * way, EXPONENT * way]
    bends = [BEND * way**2, TWIST * way**3, *heights]
    columns = [force * part for part in (*changes, *bends)]
    if len(dataset.radii) > 1:
        shapes = [np.sqrt(0.5) * force * part for part in changes]
        columns[: len(shapes)] = shapes
        if len(dataset.radii) <= MOST_SURFACES:
            columns += [s * (radius == r) for r in dataset.radii for s in shapes]
    basis = np.column_stack(columns) / max(size_of(FACTOR * force), 1e-300)
    none = np.zeros((0, force.size))
    return Signature(LAW, np.zeros(force.size), basis, False, none, (), np.zeros(0))
