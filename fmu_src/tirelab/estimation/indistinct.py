"""What the recordings cannot tell from a fitted set: by their motion, by a law of another shape, or by the noise."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

import numpy as np
from numpy.typing import NDArray

from ..regressors.excitation import Excitation
from ..regressors.signature import AS_GOOD, LAW, Signature, size_of
from ..selection.search import LOST, PRIOR_ODDS
from .additions import outside
from .fit import BARE_MENTION, Fit
from .ranking import Ranking

FloatArray = NDArray[np.float64]


def followed_by_law(signatures: Sequence[Signature], misfit: FloatArray, variance: float) -> tuple[str, ...]:
    """Return the effects that a refitted law follows: even as large as the whole misfit, none would be found.

    With the sum of squares s^2 outside the law's columns, such an effect gains s^2 / 2V in log likelihood, less than
    PRIOR_ODDS.
    """
    law = next((s for s in signatures if s.name == LAW), None)
    if law is None:
        return ()
    found, beside_law = [], outside(law.columns)
    for other in (s for s in signatures if s.name != LAW and not s.silent):
        curve = other.mean * size_of(misfit) / max(size_of(other.mean), 1e-300)
        beyond = beside_law(curve)
        if 0.5 * float(beyond @ beyond) / variance < PRIOR_ODDS:
            found.append(other.name)
    return tuple(found)


def alike_in(excitation: Excitation, name: str) -> tuple[str, ...]:
    """Return the effects that a motion cannot distinguish from one; a refitted law is no loop."""
    return excitation.alike(name) if name != LAW else ()


def confounded(chosen: Fit, ranking: Ranking, excitation: Excitation) -> tuple[tuple[str, ...], ...]:
    """Return the sets that the motion cannot distinguish from the chosen one: with another effect in place of one of
    its own, or with the refitted law in place of all effects that a law of another shape can imitate.

    Only sets count that can still win or leave no more than the chosen one: that it has fewer parameters is no proof.
    """
    found = []
    for name in chosen.names:
        less = ranking.of(frozenset(chosen.names) - {name})
        for other in alike_in(excitation, name):
            fit = ranking.of(frozenset(chosen.names) - {name} | {other})
            if fit is None or less is None or other in chosen.names:
                continue
            if less.power - fit.power > AS_GOOD * (less.power - chosen.power):
                found.append(fit)
    shape = frozenset(n for n in chosen.names if n == LAW or not excitation.within_law(n))
    if LAW in shape and len(shape) < len(chosen.names) and (law_alone := ranking.of(shape)) is not None:
        found.append(law_alone)
    lost = ranking.behind(chosen) + LOST
    return tuple(f.names for f in found if f.power <= chosen.power or ranking.behind(f) < lost)


def leaving_the_same(chosen: Fit, fits: Iterable[Fit]) -> tuple[tuple[str, ...], ...]:
    """Return the sets with no more effects whose forces differ from those of the chosen one by what noise does.

    Two fits to one truth differ by the noise that each of them follows, one square for each parameter, in units of the
    noise. What they differ by beyond that is what the recordings can tell, beside the V of the chosen fit; up to
    BARE_MENTION that is nothing, as of a damper and a lag beside a linear spring: the priors alone decide between them.
    A part of the chosen set, or a set that holds it, is told apart by what it has to spare.
    """
    own = frozenset(chosen.names)

    def evidence(other: Fit) -> float:
        noise = chosen.positions.size + other.positions.size
        return 0.5 * (_apart(chosen, other) - noise) / chosen.variance

    return tuple(
        other.names
        for other in fits
        if len(other.names) <= len(own)
        and not other.out_of_range
        and not own >= frozenset(other.names)
        and evidence(other) < BARE_MENTION
    )


def _apart(one: Fit, other: Fit) -> float:
    """Return the sum of squares of the difference of two fits, in units of the noise."""
    fitted, held_out = one.residual - other.residual, one.held_out_residual - other.held_out_residual
    return float(fitted @ fitted) + float(held_out @ held_out)
