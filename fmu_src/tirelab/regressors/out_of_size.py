"""Effects whose bounds, in SI, are those of a tire, on recordings of something far smaller or larger.

The priors are multiples of the recording's own force and travel; the bounds of the parameters are not. Where hardly any
of a prior lies within them, the effect could only be fitted with a value that is out of proportion, and is not tried.
"""

from __future__ import annotations

import math
from collections.abc import Sequence

from radialtire import CATALOGUE, Parameter
from scipy.special import ndtr

from .draws import centre_and_spread
from .law import SHAPE
from .scales import Scales

SIZES = frozenset({"force", "travel"})
"""The scales by which a recording is small or large; how long or fast it is says nothing of its size."""

WITHIN = 0.05
"""Part of a prior that must lie within the parameter's bounds."""


def out_of_size(names: Sequence[str], scales: Scales) -> dict[str, str]:
    """Return which of the effects `names` cannot be fitted to recordings of these scales, and why."""
    return {name: why for name in names if (why := _why(name, scales))}


def _why(name: str, scales: Scales) -> str:
    for p in CATALOGUE[name].parameters:
        needed = not p.optional or name == SHAPE
        if needed and p.prior is not None and p.prior.shape == "log" and _within(p, scales) < WITHIN:
            size = math.exp(centre_and_spread(p, scales)[0])
            bound = (
                f"at least {p.minimum:g} {p.unit}" if size < p.minimum else f"at most {p.maximum:g} {p.unit}"
            )
            return (
                f"its {p.name.replace('_', ' ')} is {bound}, a tire's, and these recordings, of {scales.travel:.2g} m "
                f"and {scales.force:.2g} N, would need about {size:.1g} {p.unit}"
            )
    return ""


def _within(p: Parameter, scales: Scales) -> float:
    """Return the part of a prior of the logarithm that lies within the bounds; 1 of one that has no size."""
    assert p.prior is not None
    if not set(p.prior.scale.split("/")) <= SIZES:
        return 1.0
    centre, spread, _ = centre_and_spread(p, scales)
    low = -math.inf if p.minimum <= 0.0 else (math.log(p.minimum) - centre) / spread
    return float(ndtr((math.log(p.maximum) - centre) / spread) - ndtr(low))
