"""The one way through a diagnosis: recordings and a baseline tire in, a verdict out."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace

import numpy as np
from radialtire import TireModel

from ..engine.explanation import CATALOGUE_NAMES, Explanation, explain_misfit
from ..names import UNKNOWN
from ..preprocessing.data_checks import PoorRecording, check_recordings
from ..preprocessing.dataset import Dataset, Recorded, dataset_of
from ..preprocessing.kinematics import FloatArray
from ..simulation.simulate import simulate
from ..simulation.threads import one_thread
from .discriminating_test import DiscriminatingTest, Limits, discriminate
from .held_out import HeldOut, given, rmse, split
from .localization import law_corrected, localize
from .residual_model import residual_models
from .summary import summarise
from .verdict import Fit, Verdict

MOST_TESTED = 3
"""Alternatives, likeliest first, for which a separating test is searched: each costs a fit."""

FASTEST = 0.1
"""Rate [m/s] that every rig is taken to reach where its limits are not given; else twice the fastest recorded one."""


@one_thread()
def diagnose(
    recordings: Recorded | Sequence[Recorded],
    baseline: TireModel = TireModel(),  # noqa: B008
    *,
    held_out: Recorded | Sequence[Recorded] = (),
    catalogue: Sequence[str] = CATALOGUE_NAMES,
    limits: Limits | None = None,
    progress: Callable[[str], None] | None = None,
) -> Verdict:
    """Return what the `baseline` tire leaves out of one recording or several.

    held_out: recordings that only check the correction (without any, the fit is repeated without a part of
    `recordings`, see `held_out.split`); catalogue: names of the effects that may be found (what an effect outside it
    does is something unknown); limits: of the rig that would drive the next test; progress: called with a sentence for
    each stage

    Raises PoorRecording where the recordings are too short or too poor, ValueError for an unknown name in `catalogue`.
    """
    fitted, kept = _several(recordings), _several(held_out)
    report = progress or (lambda sentence: None)
    _check_names(catalogue)
    check_recordings(fitted)
    dataset = dataset_of(fitted, baseline)
    explanation = explain_misfit(fitted, dataset, baseline, catalogue, report)
    report("validating the correction on held-out data")
    before = [r.force - simulate(baseline, r) for r in fitted]
    validation = _validate(fitted, kept, dataset, before, baseline, explanation)
    remainder = residual_models(explanation.unexplained_by, dataset, explanation.residuals, validation)
    places = localize(
        fitted,
        dataset,
        law_corrected(fitted, before, explanation.model.baseline, explanation.model.tire),
        explanation.noises,
        None if explanation.unexplained_by else explanation.residuals,
    )
    fit = _figures(before, explanation, validation)
    test = _recommend(dataset, explanation, fit.noise, limits, report)
    return Verdict(
        effects=explanation.effects,
        confidence=explanation.confidence,
        alternatives=explanation.alternatives,
        unexplained_by=explanation.unexplained_by,
        residual_models=remainder,
        summary=summarise(
            explanation.effects, explanation.alternatives, remainder, explanation.confidence, fit, test
        ),
        where=places,
        fit=fit,
        tire=_named(explanation.model.tire, baseline, fitted),
        evidence=explanation.evidence,
        test=test if test is not None and test.sufficient else None,
        compared=explanation.compared,
        evaluations=explanation.evaluations,
        recordings=tuple(fitted),
        held_out=tuple(kept),
        baseline=baseline,
    )


def _named(corrected: TireModel, baseline: TireModel, fitted: Sequence[Recorded]) -> TireModel:
    """Return the corrected tire under a name of its own, unless it is the baseline."""
    if corrected.law == baseline.law and corrected.effects == baseline.effects:
        return corrected
    return replace(
        corrected,
        name=f"{baseline.name}, corrected",
        source=f"{baseline.source}; corrected by tirelab diagnose with {', '.join(r.name for r in fitted)}",
    )


def _several(given: Recorded | Sequence[Recorded]) -> Sequence[Recorded]:
    return given if isinstance(given, Sequence) else (given,)


def _check_names(catalogue: Sequence[str]) -> None:
    unknown = set(catalogue) - set(CATALOGUE_NAMES)
    if unknown:
        raise ValueError(
            f"no effect is named {', '.join(sorted(unknown))}; known are {', '.join(CATALOGUE_NAMES)}"
        )


def _validate(
    recordings: Sequence[Recorded],
    held_out: Sequence[Recorded],
    dataset: Dataset,
    before: Sequence[FloatArray],
    baseline: TireModel,
    explanation: Explanation,
) -> HeldOut:
    """Return the errors on held-out data: the held-out recordings, else a part of the fitted ones."""
    if held_out:
        return given(held_out, recordings, dataset, before, baseline, explanation)
    return split(recordings, dataset, before, explanation)


def _figures(before: Sequence[FloatArray], explanation: Explanation, validation: HeldOut) -> Fit:
    sizes = np.array([b.size for b in before], dtype=float)
    levels = np.array([n.level for n in explanation.noises])
    return Fit(
        float(np.sqrt(np.sum(sizes * levels**2) / sizes.sum())),
        rmse(before),
        rmse(explanation.residuals),
        validation.before,
        validation.after,
        validation.by,
        validation.noise_free,
    )


def _recommend(
    dataset: Dataset,
    explanation: Explanation,
    noise: float,
    limits: Limits | None,
    progress: Callable[[str], None],
) -> DiscriminatingTest | None:
    """Return the test that separates the likeliest alternative that a test can; else the one that comes nearest."""
    if not explanation.alternatives:
        return None
    progress("searching for a test that separates the alternatives")
    fastest = 2.0 * max(float(np.abs(e.motion.rate).max()) for e in dataset.experiments)
    rig = limits or Limits(deepest=dataset.max_deflection, fastest=max(FASTEST, fastest))
    nearest: DiscriminatingTest | None = None
    for alternative in explanation.alternatives[:MOST_TESTED]:
        model = None if UNKNOWN in alternative.names else explanation.alternative_model(alternative.names)
        if model is None:
            continue
        test = discriminate(explanation.model, model, noise, rig)
        if nearest is None or test.separation > nearest.separation:
            nearest = test
        if test.sufficient:
            break
    return nearest


__all__ = ["CATALOGUE_NAMES", "PoorRecording", "Recorded", "diagnose"]
