"""Sets of effects as a fit would leave them, with values of our own: nothing is fitted."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from drives import flat_force, read, ride
from radialtire import CATALOGUE, TireModel
from tirelab.estimation.evidence import Linearised
from tirelab.estimation.findings import FittedModel
from tirelab.estimation.fit import Fit
from tirelab.estimation.problem import law_start, problem_of
from tirelab.regressors.dataset import Dataset, dataset_of
from tirelab.regressors.signature import LAW


def values_of(name: str, **given: float) -> tuple[float, ...]:
    """Return the values of an effect, those that are not given as the catalogue begins."""
    return tuple(given.get(p.name, p.start) for p in CATALOGUE[name].parameters)


def law_of(dataset: Dataset, **given: float) -> tuple[float, ...]:
    """Return the values of a refitted law, those that are not given as of the baseline's."""
    free = problem_of(dataset, {LAW: law_start(dataset)}, plain=False).parameters
    return tuple(given.get(p.label, 0.0) for p in free)


HULL = TireModel()


def fit_of(
    effects: Mapping[str, Mapping[str, float]],
    radii: tuple[float, ...] = (np.inf,),
    tire: TireModel = HULL,
) -> Fit:
    """Return a fit of these effects, each by some of its parameters, to a ride on each of these surfaces."""
    time, deflection, _ = ride(3, samples=1200)
    drive = read("ride", time, deflection, flat_force(deflection), 3)
    drives = [type(drive)(f"{r}", time, drive.deflection, np.full(time.size, r), drive.force) for r in radii]
    dataset = dataset_of(drives, tire)
    values = {
        n: law_of(dataset, **given) if n == LAW else values_of(n, **given) for n, given in effects.items()
    }
    problem = problem_of(dataset, values, plain=True)
    positions = problem.positions(values)
    slopes = np.ones((dataset.misfit.size, positions.size))
    residual = problem.residual(positions)
    none, forms = np.zeros((residual.size, 0)), len(values)
    near = Linearised(
        *(residual, slopes, positions, (none,) * forms, (1.0,) * forms),
        *(none, problem.groups, problem.widths(positions)),
    )
    left = float(residual @ residual)
    return Fit(
        problem, positions, 0.0, 1.0, residual, slopes, near, np.ones(forms), 0.0, left, left, 1.0, {}, 1
    )


def model_of(
    effects: Mapping[str, Mapping[str, float]], radius: float = np.inf, tire: TireModel = HULL
) -> FittedModel:
    """Return a fitted model of these effects on one surface."""
    return FittedModel(fit_of(effects, (radius,), tire))
