"""The one way through a diagnosis: recordings and a baseline tire in, a verdict out."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace

import numpy as np
from radialtire import TireModel

from ..computing.threads import one_thread
from ..estimation.explanation import Explanation, catalogue_names, explain_misfit
from ..estimation.findings import NamedEffect, Remainder, of_the_written_tire
from ..planning.waveforms import Limits
from ..preprocessing.data_checks import PoorRecording, check_recordings, check_signal, not_compared
from ..preprocessing.motion import FloatArray
from ..preprocessing.samples import OF_TIME, RawDataset, Recorded, alone, is_timed, raw_dataset_of
from ..recordings.zero import refuse_far_zeros
from ..simulation.simulate import simulate
from .acceptance import HeldOut, accept, noise_free_residual, rmse, validation_on, without_unlikely
from .confidence import (
    REACHED,
    Alternative,
    alternatives_of,
    confidence_of,
    grounds_of_effect,
    grounds_of_verdict,
    probability,
)
from .discriminating_test import DiscriminatingTest, discriminate
from .localization import Span, law_corrected, localize
from .residual_model import contradiction_of, residual_models, unexplained_by
from .summary import summarise
from .verdict import Fit, Verdict

QUICK = (
    "Most of it lies in sharp turns of the motion or in changes quicker than what is compared: drive round corners, "
    "sample faster, or look for what disturbs the force."
)
"""Said of a remainder that is not where one set is compared with another."""

MOST_TESTED = 3
"""Alternatives, likeliest first, for which a separating test is searched: each costs a fit."""


@one_thread()
def diagnose(
    recordings: Recorded | Sequence[Recorded],
    baseline: TireModel = TireModel(),  # noqa: B008
    *,
    held_out: Recorded | Sequence[Recorded] = (),
    catalogue: Sequence[str] | None = None,
    limits: Limits | None = None,
    progress: Callable[[str], None] | None = None,
) -> Verdict:
    """Return what the `baseline` tire leaves out of one recording or several.

    held_out: recordings that only check the correction, a part of a file after what was recorded before it; without
    any, the fit is repeated without a part of `recordings` (see `acceptance.split`)
    catalogue: names of the effects that may be found, None for all (what an effect outside it does is something
    unknown); limits: of the rig that would drive the next test; progress: called with a sentence for each stage

    Raises PoorRecording where the recordings are too short or too poor, RecordingError where the zero of a gauge is so
    far off that no effect holds it, ValueError for an unknown name in `catalogue`.
    """
    fitted, kept = [alone(r) for r in _several(recordings)], _several(held_out)
    report = progress or (lambda sentence: None)
    allowed = catalogue_names() if catalogue is None else tuple(catalogue)
    _check_names(allowed)
    refuse_far_zeros(fitted)
    check_recordings(fitted, two_sided=baseline.two_sided)
    dataset = raw_dataset_of(fitted, baseline)
    timed = is_timed(fitted)
    explanation = explain_misfit(fitted, baseline, allowed, report, timed=timed)
    levels = [floor.level for floor in explanation.floors]
    beside = any(getattr(r, "believed_force", None) is not None for r in fitted)
    check_signal(dataset, [r.name for r in fitted], levels, beside=beside)
    report("validating the correction on held-out data")
    before = [r.force - simulate(baseline, r) for r in fitted]
    validate = validation_on(fitted, kept, dataset, before)
    explanation, validation = accept(explanation, validate)
    considered = [_calibrated(e, explanation, validation) for e in explanation.effects]
    likely = {e.name: e.probability for e in considered}
    explanation, validation = without_unlikely(explanation, validation, likely, validate)
    effects, doubted = _named_and_doubted(explanation, considered)
    residuals = _not_of_the_reading(explanation, dataset, fitted)
    fit = _figures(before, residuals, explanation, validation)
    written = of_the_written_tire(
        explanation.remainder,
        [values[seen] for values, seen in zip(before, explanation.compared, strict=True)],
        [values[seen] for values, seen in zip(residuals, explanation.compared, strict=True)],
        fit.noise,
    )
    left = _remainder_told(written, timed)
    shown = _places_told(localize(fitted, dataset, residuals, levels, residuals), timed)
    unexplained = tuple(by for by in unexplained_by(left, shown) if timed or by not in OF_TIME)
    grounds = grounds_of_verdict(explanation, validation, left, unexplained=bool(unexplained))
    confidence = confidence_of(grounds, [e.probability for e in effects], [e.probability for e in doubted])
    alternatives = alternatives_of(explanation, dataset, confidence, limits)
    if not effects:
        alternatives = tuple(_with_error(a, explanation) for a in alternatives)
    remainder = residual_models(unexplained, dataset, explanation.residuals, validation)
    places = localize(
        fitted,
        dataset,
        law_corrected(fitted, before, explanation.model.baseline, explanation.model.tire),
        levels,
        None if unexplained else explanation.residuals,
    )
    contradiction = contradiction_of(explanation, fitted)
    missing = not_compared(fitted)
    report("searching for a test that separates the alternatives")
    test = _recommend(explanation, alternatives, fit.noise, limits or _limits_of(dataset, timed))
    return Verdict(
        effects=effects,
        doubted=doubted,
        confidence=confidence,
        grounds=grounds,
        alternatives=alternatives,
        remainder=left,
        unexplained_by=unexplained,
        residual_models=remainder,
        summary=_said(
            summarise(effects, alternatives, remainder, confidence, fit, test),
            QUICK if unexplained and left.uncompared > 0.5 else "",
            "" if contradiction is None else contradiction.sentence,
            *missing,
        ),
        not_compared=missing,
        where=_places_told(places, timed),
        fit=fit,
        tire=_named(explanation.model.tire, baseline, fitted),
        evidence=explanation.evidence,
        test=test if test is not None and test.sufficient else None,
        compared=len(explanation.evidence),
        evaluations=explanation.evaluations,
        recordings=tuple(fitted),
        held_out=tuple(kept),
        baseline=baseline,
    )


def _said(*sentences: str) -> str:
    return " ".join(sentence for sentence in sentences if sentence)


def _not_of_the_reading(
    explanation: Explanation, dataset: RawDataset, fitted: Sequence[Recorded]
) -> list[FloatArray]:
    """Return what the written tire leaves of each recording [N], as read or with the noise-free deflection.

    Whichever is less: what goes with the noise of the reading is no physics.
    """
    tire, found = explanation.model.tire, []
    for recording, e, read in zip(fitted, dataset.experiments, explanation.residuals, strict=True):
        noise_free = noise_free_residual(tire, recording, e.motion)
        found.append(min(read, noise_free, key=lambda left: float(left @ left)))
    return found


def _with_error(alternative: Alternative, explanation: Explanation) -> Alternative:
    """Return an alternative with what its tire leaves [N], where it was fitted."""
    if not explanation.was_fitted(alternative.names):
        return alternative
    return replace(alternative, left=explanation.of(alternative.names).error)


def _calibrated(effect: NamedEffect, explanation: Explanation, validation: HeldOut) -> NamedEffect:
    grounds = grounds_of_effect(effect, explanation, validation)
    return replace(effect, probability=probability("effect", grounds), grounds=grounds)


def _named_and_doubted(
    explanation: Explanation, considered: Sequence[NamedEffect]
) -> tuple[tuple[NamedEffect, ...], tuple[NamedEffect, ...]]:
    """Return the effects of the set with their calibrated probabilities, and those considered that it is without."""
    judged = {e.name: e for e in considered}
    effects = tuple(
        replace(e, probability=judged[e.name].probability, grounds=judged[e.name].grounds)
        for e in explanation.effects
    )
    return effects, tuple(e for e in considered if e.name not in explanation.model.names)


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
    unknown = set(catalogue) - set(catalogue_names())
    if unknown:
        raise ValueError(
            f"no effect is named {', '.join(sorted(unknown))}; known are {', '.join(catalogue_names())}"
        )


def _figures(
    before: Sequence[FloatArray],
    noise_free: Sequence[FloatArray],
    explanation: Explanation,
    validation: HeldOut,
) -> Fit:
    def error(residuals: Sequence[FloatArray]) -> float:
        return rmse([r[seen] for r, seen in zip(residuals, explanation.compared, strict=True)])

    sizes = np.array([b.size for b in before], dtype=float)
    levels = np.array([f.level for f in explanation.floors])
    return Fit(
        float(np.sqrt(np.sum(sizes * levels**2) / sizes.sum())),
        error(before),
        explanation.error,
        validation.before,
        validation.after,
        validation.by,
        validation.noise_free,
        error(noise_free),
    )


def _recommend(
    explanation: Explanation, alternatives: Sequence[Alternative], noise: float, limits: Limits
) -> DiscriminatingTest | None:
    """Return the test that separates the likeliest alternative that a test can; else the one that comes nearest."""
    nearest: DiscriminatingTest | None = None
    for alternative in alternatives[:MOST_TESTED]:
        model = explanation.alternative_model(alternative.names)
        if model is None:
            continue
        test = discriminate(explanation.model, model, noise, limits)
        if nearest is None or test.gain > nearest.gain:
            nearest = test
        if test.sufficient:
            break
    return nearest


def _limits_of(dataset: RawDataset, timed: bool) -> Limits:
    """Return the limits of a rig that did what was recorded, and may drive twice as fast."""
    if not timed:
        return Limits(deepest=dataset.max_deflection, fastest=REACHED)
    fastest = 2.0 * max(float(np.abs(e.motion.rate).max()) for e in dataset.experiments)
    return Limits(deepest=dataset.max_deflection, fastest=max(REACHED, fastest))


__all__ = ["PoorRecording", "Recorded", "catalogue_names", "diagnose"]


def _places_told(places: Sequence[Span], timed: bool) -> tuple[Span, ...]:
    """Return the places that can be told."""
    return tuple(place for place in places if timed or place.by not in OF_TIME)


def _remainder_told(remainder: Remainder, timed: bool) -> Remainder:
    """Return a remainder without what it depends on in time."""
    if timed:
        return remainder
    return replace(remainder, depends=tuple(d for d in remainder.depends if d.coordinate not in OF_TIME))
