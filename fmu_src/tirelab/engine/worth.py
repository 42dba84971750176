"""What one effect of a fit is worth: the fit without it, what it gains, and the fit begun anew beside the others."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from radialtire import CATALOGUE, TireModel

from ..simulation.simulate import simulate
from .refit import Case, Knob, Refit, fit_knobs, owners_of, price_of
from .starts import matched


def without(
    name: str, fitted: Refit, believed: TireModel, cases: Sequence[Case], radii: Sequence[float]
) -> Refit:
    """Return the fit without one effect: all other knobs fitted anew, from where they stand."""
    owners = owners_of(name)
    left = [(k, v) for k, v in zip(fitted.knobs, fitted.values, strict=True) if k.owner not in owners]
    return fit_knobs(believed, tuple(k for k, _ in left), np.array([v for _, v in left]), cases, radii)


def gain(fitted: Refit, less: Refit, power: float) -> float:
    """Return what a fit gains over one of fewer knobs in log likelihood, less the price of its own (`price_of`)."""
    return power * (less.cost - fitted.cost) - (len(fitted.knobs) - len(less.knobs)) * price_of(fitted, power)


def begun_anew(
    name: str,
    fitted: Refit,
    less: Refit,
    believed: TireModel,
    cases: Sequence[Case],
    radii: Sequence[float],
    deepest: float,
    highest: float,
) -> Refit:
    """Return a fit with one effect begun once more at what nearest follows what the fit without it leaves.

    Where all effects begin at once, one of them can go where no sample knows of it (a rim beyond the largest
    deflection) while the others are still on their way. less: the fit without it; deepest [m], highest [N]: largest
    deflection and reading. The better one of the two fits is returned.
    """
    if name not in CATALOGUE:
        return fitted
    left = [(c.force - simulate(less.tire, c.smooth, c.smooth))[c.rows] - c.beyond for c in cases]
    start = matched(CATALOGUE[name], left, cases, less.tire, deepest, highest)
    others = {(k.owner, k.index): float(v) for k, v in zip(less.knobs, less.values, strict=True)}

    def begin(knob: Knob) -> float:
        return start[knob.index] if knob.owner == name else others[knob.owner, knob.index]

    anew = fit_knobs(believed, fitted.knobs, np.array([begin(k) for k in fitted.knobs]), cases, radii)
    return anew if anew.cost < fitted.cost else fitted
