"""The stages of a diagnosis in their order: recordings and a baseline tire in, a verdict out."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from radialtire import TireModel

from ..computing.threads import one_thread
from ..errors import (
    check_given,
    check_names_given,
    check_recordings_given,
    check_tire_given,
)
from ..estimation.explanation import Explanation, catalogue_names, explain_misfit
from ..estimation.findings import NamedEffect, Remainder, of_the_written_tire
from ..estimation.ranking import MOST_WORK
from ..planning.waveforms import Limits
from ..preprocessing.data_checks import (
    PoorRecording,
    check_recordings,
    check_signal,
    not_compared,
    outliers_told,
)
from ..preprocessing.motion import FloatArray
from ..preprocessing.samples import OF_TIME, RawDataset, Recorded, alone, is_timed, raw_dataset_of
from ..preprocessing.straight import at_one_rate
from ..recordings.zero import refuse_far_zeros
from ..regressors.dataset import arranged
from ..selection.search import LIKE_NOISE
from ..simulation.simulate import simulate
from .acceptance import (
    NO_WORSE,
    HeldOut,
    Validate,
    accept,
    is_worse,
    rmse,
    validation_on,
    without_unlikely,
)
from .alternatives import USUAL_SPEED, Alternative, alternatives_of, no_surer_than_alternatives
from .asked import Asked
from .between_recordings import difference_between
from .confidence import EITHER, confidence_of, grounds_of_effect, grounds_of_verdict, probability_of_effect
from .contradicting_channel import ContradictingChannel, contradicting_channel
from .contradiction import ANEW, EXPLAINED, Contradiction, contradiction_held_out, contradiction_of, driven
from .discriminating_test import DiscriminatingTest, discriminate
from .localization import Span, law_corrected, localize
from .missed import Missed, missed_held_out
from .residual_model import residual_models, unexplained_by
from .summary import before_simulation, not_seen, other_law, slow_noise, summarise
from .verdict import FitErrors, NotNamed, Verdict

MOST_TESTED = 3
"""Alternatives, likeliest first, for which a separating test is searched: each costs a fit."""


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
    baseline, catalogue, limits = asked.baseline, asked.catalogue, asked.limits
    fitted, kept = [alone(r) for r in asked.recordings], asked.held_out
    report = asked.progress or (lambda sentence: None)
    allowed = catalogue_names() if catalogue is None else tuple(catalogue)
    _check_names(allowed)
    refuse_far_zeros(fitted)
    check_recordings(fitted, kept, two_sided=baseline.two_sided)
    data = _Data(fitted, raw_dataset_of(fitted, baseline), [r.force - simulate(baseline, r) for r in fitted])

    def explain_both(several: Sequence[Recorded], judges: Sequence[Recorded]) -> Explanation:
        quiet, work = (lambda sentence: None), ANEW * MOST_WORK
        return explain_misfit(several, baseline, allowed, quiet, held_out=judges, most_work=work)

    candidates = explain_misfit(fitted, baseline, allowed, report, held_out=kept)
    levels = [floor.level for floor in candidates.floors]
    with_simulation = any(getattr(r, "believed_force", None) is not None for r in fitted)
    check_signal(data.samples, [r.name for r in fitted], levels, beside=with_simulation)

    report("validating the correction on held-out data")
    validate = validation_on(fitted, kept, data.samples, data.before)
    accepted = _accepted(candidates, validate)
    explanation, validation = accepted.explanation, accepted.validation
    fit = _errors(data, explanation, validation)
    remainder = _remainder(data, explanation, fit.noise)
    unexplained = _unexplained(data, explanation.left, remainder, explanation.noises)
    models = residual_models(unexplained, data.samples, explanation.residuals, validation)

    grounds = grounds_of_verdict(explanation, validation, remainder, unexplained=bool(unexplained))
    named, doubted = ([e.probability for e in own] for own in (accepted.effects, accepted.doubted))
    motions = [e.motion for e in data.samples.experiments]

    def explain_anew(several: Sequence[Recorded]) -> Explanation:
        return explain_both(several, kept)

    contradiction = contradiction_of(explanation, fitted, motions, data.before, explain_anew)
    contradiction = contradiction or difference_between(explanation, fitted, motions, explain_anew)
    contradiction = contradiction or _contradicted_by(candidates, accepted, fitted, kept)
    contradiction = contradiction or contradicting_channel(explanation, fitted, kept, explain_both)
    confidence = confidence_of(grounds, named, doubted, explanation.share)
    of_law = _left_by_law(fitted, baseline) if remainder.size > LIKE_NOISE else 0.0
    may_be_before = of_law > fit.left
    most = EITHER if isinstance(contradiction, Missed | ContradictingChannel) or may_be_before else 1.0
    confidence = min(confidence, most)
    alternatives = alternatives_of(explanation, data.samples, confidence, limits)
    effects = no_surer_than_alternatives(accepted.effects, alternatives)
    effects = contradiction.no_surer(effects) if isinstance(contradiction, ContradictingChannel) else effects
    if not accepted.effects:
        fit = replace(fit, not_named=_not_named(candidates, validate, fit.before))
    before = asked.before.judged(fit)
    confidence *= before.probability
    effects, alternatives, fit = before.beside(effects, alternatives, fit)
    model = explanation.model
    located = law_corrected(fitted, data.before, model.baseline, model.tire, model.names)
    noise = None if unexplained else explanation.residuals
    where = data.shown(localize(fitted, data.samples, located, explanation.noises, noise))

    report("searching for a test that separates the alternatives")
    test = _recommend(explanation, alternatives, fit.noise, _limits_of(data, limits, part=baseline.is_part))
    missing = not_compared(fitted)
    sentences = _copies_told(fitted, kept)
    sentences += [] if contradiction is None else [contradiction.sentences]
    sentences.append(summarise(effects, alternatives, models, confidence, fit, test))
    sentences += [*before.told(fit), *(before_simulation(of_law, before.tried) if may_be_before else [])]
    sentences += not_seen(remainder.uncompared, models) if unexplained else []
    noises = [e.reading for e in explanation.model.fit.problem.dataset.experiments]
    sentences += slow_noise(fitted, explanation.noise_free, noises)
    sentences += other_law(fit.after, models) if baseline.is_part and baseline.curve is None else []
    return Verdict(
        effects=effects,
        doubted=accepted.doubted,
        confidence=confidence,
        grounds=grounds,
        alternatives=alternatives,
        remainder=before.of_the_whole(remainder, fit.noise),
        unexplained_by=unexplained,
        residual_models=models,
        summary=" ".join([*sentences, *missing, *outliers_told(fitted, explanation.noise_free)]),
        not_compared=missing,
        contradiction=contradiction,
        where=before.where or where,
        fit=fit,
        tire=_renamed(arranged(explanation.model.tire, before.values), baseline, fitted),
        evidence=explanation.evidence,
        test=test if test is not None and test.sufficient else None,
        compared=len(explanation.evidence),
        evaluations=explanation.model.fit.evaluations,
        recordings=before.recordings or tuple(fitted),
        held_out=before.held_out or tuple(kept),
        baseline=baseline,
    )


@dataclass(frozen=True)
class _Data:
    """The fitted recordings, their samples, and the residuals [N] of the baseline in each of them."""

    recordings: Sequence[Recorded]
    samples: RawDataset
    before: Sequence[FloatArray]

    @cached_property
    def timed(self) -> bool:
        """Whether the times of all samples were measured."""
        return is_timed(self.recordings)

    @cached_property
    def unknown(self) -> frozenset[str]:
        """The coordinates that the recordings do not show: those that need times which were not measured, and the
        acceleration of motions at one rate, which is rounding.
        """
        found = frozenset() if self.timed else frozenset(OF_TIME)
        straight = all(at_one_rate(e.time, e.motion) for e in self.samples.experiments)
        return found | {"acceleration"} if straight else found

    def shown(self, places: Sequence[Span]) -> tuple[Span, ...]:
        """Return the places without those over coordinates that the recordings do not show."""
        return tuple(place for place in places if place.by not in self.unknown)


@dataclass(frozen=True)
class _Accepted:
    """The accepted set, its errors on held-out data, its effects, and those of the likeliest set that it lacks."""

    explanation: Explanation
    validation: HeldOut
    effects: tuple[NamedEffect, ...]
    doubted: tuple[NamedEffect, ...]


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


def _contradicted_by(
    candidates: Explanation, accepted: _Accepted, fitted: Sequence[Recorded], kept: Sequence[Recorded]
) -> Contradiction | None:
    """Return the held-out recording that contradicts the set which explains the fitted ones, refused by it or not, or
    that shows what they do not.
    """
    if not kept:
        return None
    names, chosen = candidates.likeliest_fitted, accepted.explanation
    likeliest = candidates.of(names) if candidates.was_fitted(names) else chosen
    clearly = likeliest.error < EXPLAINED * chosen.error
    judged = likeliest if clearly else chosen
    beside = driven(fitted, kept)
    return contradiction_held_out(judged, fitted, beside) or missed_held_out(judged, fitted, beside)


def _calibrated(effect: NamedEffect, explanation: Explanation, validation: HeldOut) -> NamedEffect:
    grounds = grounds_of_effect(effect, explanation, validation)
    return replace(effect, probability=probability_of_effect(effect.name, grounds), grounds=grounds)


def _errors(data: _Data, explanation: Explanation, validation: HeldOut) -> FitErrors:
    """Return the noise floor and the errors [N] before and after the correction, over the compared samples."""
    sizes = np.array([b.size for b in data.before], dtype=float)
    levels = np.array([f.level for f in explanation.floors])
    return FitErrors(
        float(np.sqrt(np.sum(sizes * levels**2) / sizes.sum())),
        rmse(_compared(data.before, explanation)),
        explanation.error,
        validation.before,
        validation.after,
        validation.by,
        validation.noise_free,
        explanation.error_left,
    )


def _compared(residuals: Sequence[FloatArray], explanation: Explanation) -> list[FloatArray]:
    return [r[seen] for r, seen in zip(residuals, explanation.compared, strict=True)]


def _remainder(data: _Data, explanation: Explanation, noise: float) -> Remainder:
    """Return the remainder of the written tire, without a dependence on times that were not measured."""
    before, after = (_compared(residuals, explanation) for residuals in (data.before, explanation.left))
    remainder = of_the_written_tire(explanation.remainder, before, after, noise)
    if data.timed:
        return remainder
    return replace(remainder, depends=tuple(d for d in remainder.depends if d.coordinate not in OF_TIME))


def _unexplained(
    data: _Data, residuals: Sequence[FloatArray], remainder: Remainder, noises: Sequence[FloatArray]
) -> tuple[str, ...]:
    """Return the coordinates on which an unexplained remainder depends; none where nothing is unexplained."""
    places = data.shown(localize(data.recordings, data.samples, residuals, noises, residuals))
    return tuple(by for by in unexplained_by(remainder, places) if by not in data.unknown)


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


def _copies_told(recordings: Sequence[Recorded], held_out: Sequence[Recorded]) -> list[str]:
    """Return a sentence on each held-out recording that is one of the fitted ones."""
    told = []
    for kept in held_out:
        own = kept.time, kept.deflection, kept.force
        same = (r for r in recordings if all(map(np.array_equal, own, (r.time, r.deflection, r.force))))
        if (copied := next(same, None)) is not None:
            told.append(
                f"Held-out {kept.name} has the readings of {copied.name}, which is fitted: it tests nothing; hold out "
                "another recording."
            )
    return told


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


def _limits_of(data: _Data, given: Limits | None, *, part: bool) -> Limits:
    """Return the given limits, or those of a rig that drove these recordings, and can drive twice as fast.

    A tire is pressed from 0; a part moves from the least deflection that was recorded, which may be anywhere.
    """
    motions = [e.motion for e in data.samples.experiments]
    start = min(float(m.deflection.min()) for m in motions) if part else 0.0
    if given is not None:
        return replace(given, start=start)
    stroke = data.samples.max_deflection - start
    if not data.timed:
        return Limits(deepest=stroke, fastest=USUAL_SPEED, start=start)
    fastest = 2.0 * max(float(np.abs(m.rate).max()) for m in motions)
    return Limits(deepest=stroke, fastest=max(USUAL_SPEED, fastest), start=start)


__all__ = ["PoorRecording", "Recorded", "catalogue_names", "diagnose"]
