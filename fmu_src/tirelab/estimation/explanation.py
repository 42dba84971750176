"""The engine's one entry: which effects explain the misfit of a baseline tire on recordings.

The signatures of all effects are compared with the misfit (`selection`); every set that can still win is fitted in the
catalogue's own forms (`estimation`), and the sets are ranked by those fits.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray
from radialtire import TireModel

from ..preprocessing.dataset import Recorded
from ..regressors.dataset import Dataset, dataset_of
from ..regressors.excitation import Excitation, excitation_of
from ..regressors.law import CANDIDATES, LAW, law_signature
from ..regressors.noise_floor import NoiseFloor
from ..regressors.signature import in_other_noise, signatures_of
from ..selection.discrepancy import FLOOR_OF_SIGNATURES, discrepancy_of
from ..selection.marginal_likelihood import normal_equations, parts_of
from ..selection.search import search
from ..simulation.simulate import simulate
from .findings import Estimate, Evidence, FittedModel, NamedEffect, Refitted
from .fit import Fit, fitted
from .noise import with_saturated_noise
from .ranking import BEGUN, Ranking, ranked
from .remainder import Remainder, remainder_of

FloatArray = NDArray[np.float64]
BoolArray = NDArray[np.bool_]
Progress = Callable[[str], None]

CATALOGUE_NAMES: tuple[str, ...] = (LAW, *CANDIDATES)
"""Every effect that a verdict may name."""

TEMPERATURE = 2.0
"""Tempering of the posterior odds between sets: fits that stop early and forms that are not quite right."""


@dataclass(frozen=True)
class Explanation:
    """What explains the misfit.

    effects: of the likeliest set, the largest share first; probability: of that set; evidence: all sets that were
    fitted, the likeliest first; hidden: names of effects that the excitation cannot show, and why
    remainder: what the effects leave beyond the noise; model: the likeliest set, fitted; residuals [N]: what it leaves
    of each recording; floors: noise floor of each recording; evaluations: simulations of the final fit
    """

    effects: tuple[NamedEffect, ...]
    probability: float
    evidence: tuple[Evidence, ...]
    hidden: tuple[tuple[str, str], ...]
    remainder: Remainder
    model: FittedModel
    residuals: tuple[FloatArray, ...]
    floors: tuple[NoiseFloor, ...]
    evaluations: int
    excitation: Excitation
    _ranking: Ranking = field(repr=False)
    _recordings: tuple[Recorded, ...] = field(repr=False)

    def refitted(self, kept: Sequence[BoolArray]) -> Refitted:
        """Return the likeliest set fitted to the samples `kept` of each recording alone: a beginning, all or none."""
        best = self._ranking.best
        baseline = best.problem.dataset.tire
        parts = [_part(r, k) for r, k in zip(self._recordings, kept, strict=True) if k.any()]
        dataset = _quiet(dataset_of(parts, baseline))
        fit = fitted(dataset, [best.values], discrepancy_of(dataset.misfit, 0.0), best.variance, -np.inf)
        return Refitted(fit.tire, _residuals(fit.tire, self._recordings))

    def alternative_model(self, names: tuple[str, ...]) -> FittedModel | None:
        """Return the fit of another set; None where it was not fitted."""
        wanted = frozenset(names)
        return next((FittedModel(f) for f in self._ranking.fits if frozenset(f.names) == wanted), None)


def explain_misfit(
    recordings: Sequence[Recorded],
    baseline: TireModel,
    catalogue: Sequence[str],
    progress: Progress,
    *,
    timed: bool = True,
) -> Explanation:
    """Return what explains the misfit of the `baseline` tire on `recordings`.

    catalogue: names of the effects that may be found, of CATALOGUE_NAMES; progress: called with a sentence for each
    stage; timed: whether the times of the samples were measured
    """
    dataset = dataset_of(recordings, baseline)
    excitation = excitation_of(dataset, timed=timed)
    allowed = [name for name in CANDIDATES if name in catalogue]
    hidden = tuple((name, why) for name in allowed if (why := excitation.hidden(name)))
    shown = [name for name in allowed if name not in dict(hidden)]
    progress("comparing the effects' signatures")
    raw = (*((law_signature(dataset),) if LAW in catalogue else ()), *signatures_of(shown, dataset))
    quiet = with_saturated_noise(dataset, raw)
    signatures = tuple(in_other_noise(s, dataset, quiet) for s in raw)
    rough = discrepancy_of(quiet.misfit, FLOOR_OF_SIGNATURES)
    equations = normal_equations(signatures, quiet.misfit)
    starts = [(e.variance, parts_of(e, equations, rough)) for e in search(equations, rough).starts(BEGUN)]
    progress("fitting the sets that can win")
    ranking = ranked(quiet, signatures, discrepancy_of(quiet.misfit, 0.0), starts)
    return _explanation(tuple(recordings), quiet, ranking, hidden, excitation)


def _explanation(
    recordings: tuple[Recorded, ...],
    dataset: Dataset,
    ranking: Ranking,
    hidden: tuple[tuple[str, str], ...],
    excitation: Excitation,
) -> Explanation:
    weights = np.exp((np.array(ranking.posteriors) - ranking.posteriors[0]) / TEMPERATURE)
    weights /= weights.sum()
    best = ranking.best
    pairs = list(zip(ranking.fits, weights.tolist(), strict=True))
    effects = [
        NamedEffect(
            name,
            _estimates(best, name),
            _share(ranking, name),
            float(sum(weight for fit, weight in pairs if name in fit.names)),
        )
        for name in best.names
    ]
    return Explanation(
        tuple(sorted(effects, key=lambda e: -e.share)),
        float(weights[0]),
        tuple(
            Evidence(
                fit.names,
                posterior - ranking.posteriors[0],
                fit.power / fit.residual.size,
                tuple(fit.sizes.get(n, 0.0) for n in fit.names),
                weight,
            )
            for (fit, weight), posterior in zip(pairs, ranking.posteriors, strict=True)
        ),
        hidden,
        remainder_of(best),
        FittedModel(best),
        _residuals(best.tire, recordings),
        tuple(e.floor for e in dataset.experiments),
        best.evaluations,
        excitation,
        ranking,
        recordings,
    )


def _quiet(dataset: Dataset) -> Dataset:
    """Return a dataset in units of the noise that all signatures together leave."""
    raw = (law_signature(dataset), *signatures_of(CANDIDATES, dataset))
    return with_saturated_noise(dataset, raw)


def _share(ranking: Ranking, name: str) -> float:
    best = ranking.best
    less = frozenset(best.names) - {name}
    without = next((f.power for f in ranking.fits if frozenset(f.names) == less), best.power)
    misfit = best.problem.dataset.misfit
    missed = float(misfit @ misfit) - best.residual.size
    return float(np.clip((without - best.power) / max(missed, 1e-12), 0.0, 1.0))


def _estimates(fit: Fit, name: str) -> dict[str, Estimate]:
    """Return what was fitted of an effect, with standard deviations that count the discrepancy and the priors."""
    parameters = fit.problem.parameters
    information = fit.jacobian.T @ fit.jacobian / max(fit.variance, 1.0) + np.eye(len(parameters))
    deviations = np.sqrt(np.diag(np.linalg.inv(information)))
    values = fit.values
    found = {}
    for parameter, position, deviation in zip(parameters, fit.positions, deviations, strict=True):
        if parameter.owner == name:
            value = values[name][parameter.index]
            slope = parameter.spread * (value if parameter.logarithm else 1.0)
            found[parameter.label] = Estimate(float(value), float(abs(slope) * deviation), parameter.unit)
    return found


def _residuals(tire: TireModel, recordings: Sequence[Recorded]) -> tuple[FloatArray, ...]:
    return tuple(r.force - simulate(tire, r) for r in recordings)


@dataclass(frozen=True)
class _Part:
    """Some samples of a recording."""

    name: str
    time: FloatArray
    deflection: FloatArray
    surface_radius: FloatArray
    force: FloatArray


def _part(recording: Recorded, kept: BoolArray) -> _Part:
    r = recording
    return _Part(r.name, r.time[kept], r.deflection[kept], r.surface_radius[kept], r.force[kept])
