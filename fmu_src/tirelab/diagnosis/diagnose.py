"""The stages of a diagnosis in their order: recordings and a baseline tire in, a verdict out."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace

from radialtire import TireModel

from ..computing.threads import one_thread
from ..errors import (
    check_given,
    check_names_given,
    check_recordings_given,
    check_tire_given,
)
from ..estimation.explanation import Explanation, catalogue_names, explain_misfit
from ..estimation.findings import NamedEffect
from ..estimation.ranking import MOST_WORK
from ..planning.waveforms import Limits
from ..preprocessing.data_checks import (
    PoorRecording,
    check_recordings,
    check_signal,
    copies_told,
    not_compared,
    outliers_told,
)
from ..preprocessing.samples import Recorded, alone, raw_dataset_of
from ..recordings.zero import refuse_far_zeros
from ..regressors.dataset import arranged
from ..selection.search import LIKE_NOISE
from ..simulation.simulate import simulate
from .acceptance import NO_WORSE, accept, is_worse, without_unlikely
from .alternatives import Alternative, alternatives_of, no_surer_than_alternatives
from .asked import Asked, Before
from .between_recordings import difference_between
from .confidence import EITHER, confidence_of, grounds_of_effect, grounds_of_verdict, probability_of_effect
from .contradicting_channel import contradicting_channel
from .contradiction import ANEW, EXPLAINED, Contradiction, contradiction_held_out, contradiction_of, driven
from .discriminating_test import DiscriminatingTest, limits_of_rig, recommended
from .errors_left import FittedData, Left, left_by
from .held_out import HeldOut, Validate, rmse, validation_on
from .localization import Span, law_corrected, localize
from .missed import missed_held_out
from .sudden_change import sudden_change
from .summary import (
    before_simulation,
    in_few_samples,
    law_of_first_loading,
    less_than_noise,
    not_seen,
    other_law,
    pressed_only,
    slow_noise,
    summarise,
    together,
)
from .verdict import FitErrors, NotNamed, Verdict

ExplainAnew = Callable[[Sequence[Recorded], Sequence[Recorded]], Explanation]
"""Explains some of the recordings anew, judged by others that are held out."""


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

    Raises PoorRecording where recordings, also held-out ones, are too short or too poor, RecordingError where the zero
    of a gauge is so far off that no effect holds it, ValueError for an unknown name in `catalogue`, TypeError for
    what is no recording or no tire, such as the path of one.
    """
    check_tire_given(baseline)
    check_recordings_given((*_several(recordings), *_several(held_out)))
    if catalogue is not None:
        check_names_given("catalogue", catalogue)
    if limits is not None:
        check_given(limits, Limits, "limits", "the limits of a rig", "Limits(deepest=0.02, fastest=0.1)")
    several = _several(recordings), baseline, _several(held_out)
    return diagnosed(Asked(*several, catalogue, limits, progress))


@one_thread()
def diagnosed(asked: Asked) -> Verdict:
    """Return the verdict that is asked for; see `diagnose`."""
    fitted, kept, baseline = [alone(r) for r in asked.recordings], asked.held_out, asked.baseline
    allowed = catalogue_names() if asked.catalogue is None else tuple(asked.catalogue)
    report = asked.progress or (lambda sentence: None)
    _check_names(allowed)
    refuse_far_zeros(fitted)
    check_recordings(fitted, kept, two_sided=baseline.two_sided)
    residuals = [r.force - simulate(baseline, r) for r in fitted]
    data = FittedData(baseline, fitted, kept, raw_dataset_of(fitted, baseline), residuals)

    candidates = explain_misfit(fitted, baseline, allowed, report, held_out=kept)
    levels = [floor.level for floor in candidates.floors]
    with_simulation = any(getattr(r, "believed_force", None) is not None for r in fitted)
    check_signal(data.samples, [r.name for r in fitted], levels, beside=with_simulation)

    report("validating the correction on held-out data")
    validate = validation_on(fitted, kept, data.samples, residuals)
    accepted = _accepted(candidates, validate)
    left = left_by(accepted.explanation, accepted.validation, data)
    if not accepted.effects:
        not_named = _not_named(candidates, validate, left.fit.before)
        left = replace(left, fit=replace(left.fit, not_named=not_named))

    def explain_anew(several: Sequence[Recorded], judges: Sequence[Recorded]) -> Explanation:
        quiet, work = (lambda sentence: None), ANEW * MOST_WORK
        return explain_misfit(several, baseline, allowed, quiet, held_out=judges, most_work=work)

    contradiction = _contradiction(data, candidates, accepted, explain_anew)
    judged = _judged(asked, data, accepted, left, contradiction)

    report("searching for a test that separates the alternatives")
    limits = limits_of_rig(data.samples, asked.limits, timed=data.timed, part=baseline.is_part)
    test = recommended(accepted.explanation, judged.alternatives, judged.fit.noise, limits)
    return _verdict(data, accepted, left, judged, test)


@dataclass(frozen=True)
class _Accepted:
    """The accepted set, its errors on held-out data, its effects, and those of the likeliest set that it lacks."""

    explanation: Explanation
    validation: HeldOut
    effects: tuple[NamedEffect, ...]
    doubted: tuple[NamedEffect, ...]


@dataclass(frozen=True)
class _Judged:
    """How sure the verdict is, and of what: its effects, those before a simulation among them, and its alternatives.

    fit: its errors, in the recordings as they are; contradiction: what speaks against it
    of_law [N]: what its law leaves of a simulation where an effect may be before that, else 0; before: see `asked`
    """

    confidence: float
    grounds: Mapping[str, float]
    effects: tuple[NamedEffect, ...]
    alternatives: tuple[Alternative, ...]
    fit: FitErrors
    contradiction: Contradiction | None
    of_law: float
    before: Before


def _accepted(candidates: Explanation, validate: Validate) -> _Accepted:
    """Return the set to deliver; every effect has its calibrated probability in the set that was accepted first."""
    explanation, validation = accept(candidates, validate)
    considered = {e.name: _calibrated(e, explanation, validation) for e in explanation.effects}
    probabilities = {name: e.probability for name, e in considered.items()}
    explanation, validation = without_unlikely(explanation, validation, probabilities, validate)
    effects = tuple(
        replace(e, probability=considered[e.name].probability, grounds=considered[e.name].grounds)
        for e in explanation.effects
    )
    doubted = tuple(e for name, e in considered.items() if name not in explanation.model.names)
    return _Accepted(explanation, validation, effects, doubted)


def _not_named(candidates: Explanation, validate: Validate, before: float) -> NotNamed | None:
    """Return the set that is likeliest by the fitted recordings of those that reduce their error, None without any.

    before [N]: that error; the written tire of a set may leave more of the readings than its fit leaves of the motion
    """
    names = candidates.likeliest_reducing(NO_WORSE)
    if not names or (chosen := candidates.of(names)).error > NO_WORSE * before:
        return None
    validation = validate(chosen)
    return NotNamed(names, chosen.error, validation.after, validation.before, is_worse(validation))


def _contradiction(
    data: FittedData, candidates: Explanation, accepted: _Accepted, explain: ExplainAnew
) -> Contradiction | None:
    """Return what speaks against the verdict: a fitted recording that contradicts the others, a difference between two
    of them, a held-out recording, a change at once, or a channel; the first that is found.
    """
    explanation, fitted = accepted.explanation, data.fitted

    def explain_fitted(several: Sequence[Recorded]) -> Explanation:
        return explain(several, data.kept)

    clearest = _clearest(candidates, explanation)
    return (
        contradiction_of(explanation, fitted, data.motions, data.residuals, explain_fitted)
        or difference_between(clearest, fitted, data.motions, explain_fitted)
        or _contradicted_by_held_out(data, clearest)
        or sudden_change(explanation, fitted, data.motions)
        or contradicting_channel(explanation, fitted, data.kept, explain)
    )


def _clearest(candidates: Explanation, chosen: Explanation) -> Explanation:
    """Return the set that explains the fitted recordings, whether the held-out ones refused it or not."""
    names = candidates.likeliest_fitted
    if set(names) == set(chosen.model.names) or not candidates.was_fitted(names):
        return chosen
    likeliest = candidates.of(names)
    return likeliest if likeliest.error < EXPLAINED * chosen.error else chosen


def _contradicted_by_held_out(data: FittedData, judged: Explanation) -> Contradiction | None:
    """Return the held-out recording that contradicts the set which explains the fitted ones, or that shows what they do
    not.
    """
    if not data.kept:
        return None
    beside = driven(data.fitted, data.kept)
    return contradiction_held_out(judged, data.fitted, beside) or missed_held_out(judged, data.fitted, beside)


def _judged(
    asked: Asked, data: FittedData, accepted: _Accepted, left: Left, contradiction: Contradiction | None
) -> _Judged:
    """Return how sure the verdict is."""
    explanation, remainder, fit = accepted.explanation, left.remainder, left.fit
    grounds = grounds_of_verdict(
        explanation, accepted.validation, remainder, unexplained=bool(left.unexplained)
    )
    named, doubted = ([e.probability for e in own] for own in (accepted.effects, accepted.doubted))
    confidence = confidence_of(grounds, named, doubted, explanation.share)
    replaced = {name for name, _ in explanation.read_instead}
    confidence *= EITHER if replaced else 1.0
    of_law = _left_by_law(data.fitted, data.baseline) if remainder.size > LIKE_NOISE else 0.0
    may_be_before = of_law > fit.left
    confidence = min(confidence, EITHER) if may_be_before else confidence
    confidence = confidence if contradiction is None else min(confidence, contradiction.most_sure)
    alternatives = alternatives_of(explanation, data.samples, confidence, asked.limits)
    halved = (
        replace(e, probability=EITHER * e.probability) if e.name in replaced else e for e in accepted.effects
    )
    effects = no_surer_than_alternatives(tuple(halved), alternatives)
    if contradiction is not None:
        effects = contradiction.no_surer(effects)
        contradiction = replace(contradiction, named=bool(effects))
    before = asked.before.judged(fit)
    confidence *= before.probability
    of_all = before.beside(effects, alternatives, fit)
    return _Judged(confidence, grounds, *of_all, contradiction, of_law if may_be_before else 0.0, before)


def _verdict(
    data: FittedData, accepted: _Accepted, left: Left, judged: _Judged, test: DiscriminatingTest | None
) -> Verdict:
    """Return the verdict, with its sentences and the places of the misfit."""
    explanation, before = accepted.explanation, judged.before
    model, fitted, missing = explanation.model, data.fitted, not_compared(data.fitted)
    told = _sentences(data, explanation, left, judged, test)
    outliers = outliers_told(fitted, explanation.noise_free)
    return Verdict(
        effects=judged.effects,
        doubted=accepted.doubted,
        confidence=judged.confidence,
        grounds=judged.grounds,
        alternatives=judged.alternatives,
        remainder=before.of_the_whole(left.remainder, judged.fit.noise),
        unexplained_by=left.unexplained,
        residual_models=left.models,
        summary=" ".join([*told, *missing, *outliers]),
        not_compared=missing,
        contradiction=judged.contradiction,
        where=before.where or _where(data, explanation, left),
        fit=judged.fit,
        tire=_renamed(arranged(model.tire, before.values), data.baseline, fitted),
        evidence=explanation.evidence,
        test=test if test is not None and test.sufficient else None,
        compared=len(explanation.evidence),
        evaluations=model.fit.evaluations,
        recordings=before.recordings or tuple(fitted),
        held_out=before.held_out or tuple(data.kept),
        baseline=data.baseline,
    )


def _sentences(
    data: FittedData,
    explanation: Explanation,
    left: Left,
    judged: _Judged,
    test: DiscriminatingTest | None,
) -> list[str]:
    """Return the verdict in sentences, before those on samples that were left out."""
    told = copies_told(data.fitted, data.kept)
    told += [] if judged.contradiction is None else [judged.contradiction.sentences]
    fit, baseline, of_found = judged.fit, data.baseline, (judged.effects, judged.alternatives, left.models)
    noises = [e.reading for e in explanation.model.fit.problem.dataset.experiments]
    slow = slow_noise(data.fitted, explanation.noise_free, noises)
    if judged.contradiction is not None and judged.contradiction.is_all:
        return [*told, together(judged.contradiction.question, judged.confidence, fit), *slow]
    told.append(summarise(*of_found, judged.confidence, fit, test))
    told += judged.before.told(fit)
    told += before_simulation(judged.of_law, judged.before.tried) if judged.of_law else []
    if left.unexplained:
        told += not_seen(left.remainder.uncompared, left.models)
        told += in_few_samples(data.fitted, explanation.in_noise)
    told += slow
    if not (explanation.effects or left.unexplained or any(noise.memory > 1 for noise in noises)):
        told += less_than_noise(explanation.in_noise, fit.noise)
    told += other_law(fit.after, left.models) if baseline.is_part and baseline.curve is None else []
    told += pressed_only(data.fitted) if baseline.two_sided else []
    if baseline.is_part and left.unexplained:
        told += law_of_first_loading(data.fitted, data.residuals, explanation.residuals)
    return told


def _where(data: FittedData, explanation: Explanation, left: Left) -> tuple[Span, ...]:
    """Return the places in which the recordings and the baseline differ."""
    model = explanation.model
    located = law_corrected(data.fitted, data.residuals, model.baseline, model.tire, model.names)
    noise = None if left.unexplained else explanation.residuals
    return data.shown(localize(data.fitted, data.samples, located, explanation.noises, noise))


def _calibrated(effect: NamedEffect, explanation: Explanation, validation: HeldOut) -> NamedEffect:
    grounds = grounds_of_effect(effect, explanation, validation)
    return replace(effect, probability=probability_of_effect(effect.name, grounds), grounds=grounds)


def _renamed(corrected: TireModel, baseline: TireModel, fitted: Sequence[Recorded]) -> TireModel:
    """Return the corrected tire under a name of its own, unless it is the baseline."""
    if corrected.law == baseline.law and corrected.effects == baseline.effects:
        return corrected
    return replace(
        corrected,
        name=f"{baseline.name}, corrected",
        source=f"{baseline.source}; corrected by tirelab diagnose with {', '.join(r.name for r in fitted)}",
    )


def _several(given: Recorded | Sequence[Recorded]) -> Sequence[Recorded]:
    return given if isinstance(given, Sequence) and not isinstance(given, str) else (given,)


def _check_names(catalogue: Sequence[str]) -> None:
    unknown = set(catalogue) - set(catalogue_names())
    if unknown:
        raise ValueError(
            f"no effect is named {', '.join(sorted(unknown))}; known are {', '.join(catalogue_names())}"
        )


def _left_by_law(fitted: Sequence[Recorded], baseline: TireModel) -> float:
    """Return the root mean square [N] of what the baseline, its law, leaves of a simulation in the recordings; 0 where
    there is none.
    """
    forces = [(r, getattr(r, "believed_force", None)) for r in fitted]
    left = [believed - simulate(baseline, r) for r, believed in forces if believed is not None]
    return rmse(left) if left else 0.0


__all__ = ["PoorRecording", "Recorded", "catalogue_names", "diagnose"]
