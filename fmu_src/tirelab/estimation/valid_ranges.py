"""Which effects of a fitted set the recordings ask more of than they can be."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from radialtire import CATALOGUE
from scipy.special import ndtri

from ..preprocessing.noise import FEWEST_EVENTS, NEGLIGIBLE
from ..regressors.signature import LAW
from .problem import EstimationProblem

FloatArray = NDArray[np.float64]


def beyond_range(
    problem: EstimationProblem, held: NDArray[np.bool_], positions: FloatArray
) -> tuple[str, ...]:
    """Return the effects with a strength held (k,) at a limit of its valid range, other than where they vanish, and
    those with a ceiling that readings pass by more than their noise.

    positions (k,): of the free parameters
    """
    found = []
    for i, free in enumerate(problem.parameters):
        if free.owner == LAW:
            continue
        parameter = CATALOGUE[free.owner].parameters[free.index]
        limit = parameter.minimum if positions[i] <= free.low else parameter.maximum
        at_limit = held[i] and parameter.role == "strength" and parameter.neutral != limit
        if at_limit or (parameter.role == "limit" and _is_passed(problem, free.value(float(positions[i])))):
            found.append(free.owner)
    return tuple(dict.fromkeys(found))


def _is_passed(problem: EstimationProblem, ceiling: float) -> bool:
    """Return whether readings pass a ceiling [N] farther than the noise of any of them would, and not by chance."""
    dataset = problem.dataset
    above = (
        dataset.gathered([e.baseline + e.misfit for e in dataset.experiments]) - ceiling
    ) / dataset.gathered([e.noises for e in dataset.experiments])
    farthest = -float(ndtri(NEGLIGIBLE / above.size))
    return bool(np.count_nonzero(above > farthest) >= FEWEST_EVENTS)
