"""The entry of the engine: which effects explain the misfit of a baseline tire in recordings.

The signatures of all effects are compared with the misfit (`selection`). Every set that can still win is fitted with
the effects' own equations, and the sets are ranked by those fits.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property, partial
from typing import Any

import numpy as np
from numpy.typing import NDArray
from radialtire import CATALOGUE, TireModel

from ..preprocessing.data_checks import compared
from ..preprocessing.levels import STAYS
from ..preprocessing.noise import Noise, noise_left
from ..preprocessing.noise_floor import NoiseFloor
from ..preprocessing.samples import Recorded, is_timed
from ..regressors.dataset import Samples, dataset_of, samples_of
from ..regressors.excitation import Excitation, excitation_of, misread
from ..regressors.experiment import driven_by
from ..regressors.signature import LAW, candidates, single_valued
from ..selection.search import discrepancy_of
from ..simulation.simulate import simulate
from .findings import (
    Estimate,
    Evidence,
    FittedModel,
    NamedEffect,
    Refitted,
    Remainder,
    estimates_of,
    remainder_of,
    significances_of,
)
from .first_sets import FirstSets, in_quiet_units, with_signatures
from .fit import Fit, fitted
from .held_out import held_out_of
from .hidden import LIKE_READING, Unshown, like_law_of_part, read_instead
from .indistinct import alike_in, confounded, followed_by_law, leaving_the_same
from .ranking import MOST_WORK, Ranking, corrected, ranked, with_parts

FloatArray = NDArray[np.float64]
BoolArray = NDArray[np.bool_]
Progress = Callable[[str], None]

FIRST_PART = 0.5
"""Budget: part of that of an explanation in which the set is found whose distortion by the blocks is subtracted."""

NEAR = 4.0
"""Log posterior odds of a set over the one that stands best for all, or over a part of it, up to which that is
preferred."""


@dataclass(frozen=True)
class Explanation:
    """What explains the misfit: all fitted sets of effects, and one of them that is chosen, by default the likeliest.

    effects: of the set, the largest share first; probability: of the set
    evidence: all sets within the effects' valid ranges, this one first, then the likeliest
    confounded: sets that can still win and differ from this one by an effect that this motion cannot distinguish from
    the one it replaces, or by the refitted law in place of the effects that a law of another shape can imitate, and
    that do not leave the same
    same: sets with no more effects that leave the same of the recordings (see `indistinct.leaving_the_same`)
    unshown: effects that the recordings cannot show; remainder: what is left beyond the noise
    within_law: names of effects that the refitted law of the set follows entirely
    model: the set, fitted; floors: noise floor of each recording
    compared: which samples of each recording are compared (see `data_checks.compared`)
    """

    effects: tuple[NamedEffect, ...]
    probability: float
    evidence: tuple[Evidence, ...]
    confounded: tuple[tuple[str, ...], ...]
    same: tuple[tuple[str, ...], ...]
    within_law: tuple[str, ...]
    remainder: Remainder
    model: FittedModel
    floors: tuple[NoiseFloor, ...]
    compared: tuple[BoolArray, ...]
    excitation: Excitation
    _ranking: Ranking = field(repr=False)
    _samples: Samples = field(repr=False)
    unshown: Unshown = field(repr=False)

    @cached_property
    def error(self) -> float:
        """RMS residual [N] of the set over all compared samples."""
        # Long arrays, which are kept of the chosen set alone.
        return self._rms(_residuals(self.model.tire, self._samples.recordings))

    @cached_property
    def residuals(self) -> tuple[FloatArray, ...]:
        """Residuals [N] of the set in each recording."""
        return _residuals(self.model.tire, self._samples.recordings)

    @cached_property
    def noise_free(self) -> tuple[FloatArray, ...]:
        """Residuals [N] of the set in each recording where it is given the noise-free deflection."""
        return self._samples.residuals(self.model.tire)

    @property
    def noises(self) -> tuple[FloatArray, ...]:
        """Noise floor [N] of every sample, one array for each recording."""
        return self._samples.noises(self.model.fit.problem.dataset)

    @property
    def in_noise(self) -> tuple[FloatArray, ...]:
        """Residuals of the set given the noise-free deflection, in units of the noise; 0 where not compared."""
        own = zip(self.noise_free, self.noises, self.compared, strict=True)
        return tuple(np.where(seen, residual / noise, 0.0) for residual, noise, seen in own)

    @cached_property
    def left(self) -> tuple[FloatArray, ...]:
        """Residuals [N] of the set given the deflection as read or the noise-free one, whichever leaves less of a
        recording: a residual that follows the noise of the reading is not physics.
        """
        pairs = zip(self.residuals, self.noise_free, strict=True)
        return tuple(min(pair, key=lambda residual: float(residual @ residual)) for pair in pairs)

    @cached_property
    def error_left(self) -> float:
        """RMS [N] of `left` over all compared samples."""
        return self._rms(self.left)

    def _rms(self, residuals: Sequence[FloatArray]) -> float:
        own = [r[c] for r, c in zip(residuals, self.compared, strict=True)]
        return float(np.sqrt(np.mean(np.concatenate(own) ** 2)))

    @property
    def share(self) -> float:
        """Probability of the set over that of itself and of all that leave the same, which no recording changes."""
        others = sum(e.probability for e in self.evidence if e.names in self.same)
        return self.probability / (self.probability + others) if self.probability and others else 1.0

    def was_fitted(self, names: Sequence[str]) -> bool:
        """Whether a set was fitted, its effects within their valid ranges."""
        return self._fit(names) is not None

    def _fit(self, names: Sequence[str]) -> Fit | None:
        fit = self._ranking.of(frozenset(names))
        return None if fit is None or fit.out_of_range else fit

    @property
    def likeliest_fitted(self) -> tuple[str, ...]:
        """The set that is likeliest by the fitted recordings alone, whatever it makes of the held-out ones."""
        return max(self._ranking.fits, key=lambda fit: fit.log_posterior - fit.log_predictive).names

    def likeliest_reducing(self, part: float) -> tuple[str, ...]:
        """The same of the sets that leave less than this part of what is left without any; () where none does."""
        nothing = self._ranking.of(frozenset())
        most = 0.0 if nothing is None else part**2 * nothing.power
        reducing = [fit for fit in self._ranking.fits if fit.power < most and not fit.out_of_range]
        return max(reducing, key=lambda f: f.log_posterior - f.log_predictive).names if reducing else ()

    def is_near(self, names: Sequence[str], other: Sequence[str]) -> bool:
        """Whether a set was fitted and is nearly as likely as another one, or likelier."""
        fits = [self._fit(n) for n in (names, other)]
        if fits[0] is None or fits[1] is None:
            return False
        return self._ranking.behind(fits[0]) - self._ranking.behind(fits[1]) < NEAR

    def of(self, names: Sequence[str]) -> Explanation:
        """Return the explanation by another set that was fitted; raises ValueError where it was not (`was_fitted`)."""
        fit = self._fit(names)
        if fit is None:
            raise ValueError(f"no fit of {', '.join(names) or 'no effect'} was made within valid ranges")
        return self._by(fit, self._ranking)

    def with_parts(self) -> Explanation:
        """Return the explanation where every set that lacks one of its effects was fitted; itself where they were."""
        ranking = with_parts(self._ranking, self.model.fit)
        return self if ranking is self._ranking else self._by(self.model.fit, ranking)

    def _by(self, fit: Fit, ranking: Ranking) -> Explanation:
        return _explanation(self._samples, ranking, fit, self.excitation, self.unshown)

    @cached_property
    def read_instead(self) -> tuple[tuple[str, str], ...]:
        """Pairs of a named effect and one that would do as well in its place, see `hidden.read_instead`."""
        return read_instead(self._ranking, self.model.fit, self.unshown.unread)

    def in_order(self, most: int) -> tuple[tuple[str, ...], ...]:
        """Return the likeliest sets; before them the one that stands best for all, if it is nearly as likely."""
        central = self._ranking.central(NEAR).names
        likely = (fit.names for fit in self._ranking.fits[:most] if not fit.out_of_range)
        return (central, *(names for names in likely if names != central))

    def refitted(self, kept: Sequence[BoolArray]) -> Refitted:
        """Return the set fitted to the samples `kept` of each recording only; the motion of the others stays known."""
        fit = self.model.fit
        chosen = [i for i, k in enumerate(kept) if k.any()]
        samples = self._samples.only(chosen)
        readings = {e.name: e.reading for e in fit.problem.dataset.experiments}
        own = [readings[r.name] for r in samples.recordings]
        dataset = dataset_of(samples.recordings, self.model.baseline, own)
        dataset = dataset.corrected(samples.left_out(dataset, fit.tire)).only([kept[i] for i in chosen])
        dataset = in_quiet_units(dataset)
        again = fitted(dataset, [fit.values], discrepancy_of(dataset.misfit, 0.0), fit.variance, -np.inf)
        return Refitted(again.tire, _residuals(again.tire, self._samples.recordings))

    def alternative_model(self, names: Sequence[str]) -> FittedModel | None:
        """Return the fit of another set; None where it was not fitted."""
        fit = self._fit(names)
        return None if fit is None else FittedModel(fit)


def catalogue_names() -> tuple[str, ...]:
    """Return the names of every effect that a verdict may name."""
    return (LAW, *candidates())


@dataclass(frozen=True)
class _Asked:
    """What is asked of `explain_misfit`; readings: noise of the force of each recording, None where it is not known."""

    recordings: Sequence[Recorded]
    baseline: TireModel
    catalogue: Sequence[str]
    progress: Progress
    held_out: Sequence[Recorded]
    most_work: float
    readings: Sequence[Noise | None] | None = None

    def again(self, done: float, **changed: Any) -> _Asked:
        """Return the same with changes, and with what is left of the budget."""
        return replace(self, most_work=max(self.most_work - done, FIRST_PART * self.most_work), **changed)


def explain_misfit(
    recordings: Sequence[Recorded],
    baseline: TireModel,
    catalogue: Sequence[str],
    progress: Progress,
    *,
    held_out: Sequence[Recorded] = (),
    most_work: float = MOST_WORK,
) -> Explanation:
    """Return what explains the misfit of the `baseline` tire on `recordings`.

    catalogue: names of the effects that may be found, of `catalogue_names`; progress: called with a sentence for each
    stage; held_out: recordings to which nothing is fitted, which judge what is; most_work: budget in place of MOST_WORK
    """
    return _explained(_Asked(recordings, baseline, catalogue, progress, held_out, most_work))


def _explained(asked: _Asked) -> Explanation:
    recordings, baseline, catalogue = asked.recordings, asked.baseline, asked.catalogue
    progress, most_work = asked.progress, asked.most_work
    dataset = dataset_of(recordings, baseline, asked.readings)
    excitation = excitation_of(dataset, timed=is_timed(recordings))
    impossible = excitation.channels.impossible
    if not baseline.inflated:
        impossible |= {name for name, effect in CATALOGUE.items() if "air" in effect.traits}
    allowed = [name for name in candidates() if name in catalogue and name not in impossible]
    hidden = excitation.reasons(allowed)
    shown = [name for name in allowed if name not in hidden]
    progress("comparing the effects' signatures")
    dataset, raw, quiet = with_signatures(dataset, recordings, shown, catalogue)
    hidden |= dict.fromkeys(misread(raw, dataset.read_anew(recordings)), LIKE_READING)
    excitation = replace(excitation, single_valued=excitation.single_valued | single_valued(raw, dataset))
    hidden |= like_law_of_part(raw, dataset) if LAW in catalogue else {}
    unread = tuple(s for s in raw if hidden.get(s.name) == LIKE_READING)
    raw = tuple(s for s in raw if s.name not in hidden)
    progress("fitting the sets that can win")
    samples = samples_of(recordings, baseline)
    others = held_out_of(asked.held_out, baseline, samples)
    blocks = FirstSets(dataset, raw, samples, others, FIRST_PART * most_work)
    alike = partial(alike_in, excitation)
    sets = blocks.begun(quiet)
    sets = blocks.less_distorted(sets, sets.best_fit)
    ranking = ranked(sets, alike)
    again = blocks.less_distorted(sets, ranking.best)
    if again is not sets or sets.work >= sets.most_work:
        sets = replace(again, most_work=most_work - sets.work if again is not sets else most_work)
        ranking = ranked(sets, alike)
    if beyond := _beyond_range(ranking):
        # What would have to be more than it can be is another effect's, which a search beside it does not find.
        others_of = [name for name in catalogue if name not in beyond]
        return _explained(asked.again(sets.work, catalogue=others_of))
    if asked.readings is None and (readings := _filtered_noises(ranking.best, samples)):
        return _explained(asked.again(sets.work, readings=readings))
    signatures, misfit = tuple(sets.signatures.values()), sets.dataset.misfit
    del raw, quiet, blocks, again, sets  # they are large, and needed no more
    ranking = _read_best(corrected(ranking, samples), samples.recordings)
    like_law = followed_by_law(signatures, misfit, ranking.best.variance)
    unshown = Unshown(tuple(hidden.items()), unread, like_law)
    return _explanation(samples, ranking, ranking.best, excitation, unshown)


def _filtered_noises(fit: Fit, samples: Samples) -> list[Noise | None]:
    """Return the noise of each recording, None where it is as it was read; nothing where it is so of all.

    Beside the misfit of the baseline a noise with a memory passes for what the tire does, if the motion is as quick.
    What the likeliest set leaves shows it.
    """
    found: list[Noise | None] = []
    left = samples.residuals(fit.tire)
    for e, motion, own in zip(fit.problem.dataset.experiments, samples.motions, left, strict=True):
        noise = None
        if float(np.sqrt(np.mean(own**2))) > STAYS * e.floor.level:
            noise = noise_left(own, driven_by(motion, e.interval / e.size))
        found.append(noise if noise is not None and noise.level > STAYS * e.reading.level else None)
    return found if any(found) else []


def _beyond_range(ranking: Ranking) -> tuple[str, ...]:
    """Return the effects of the set that would be the likeliest that are out of their range there, and in every set."""
    beyond = max(ranking.fits, key=lambda fit: fit.in_any_range).beyond
    return tuple(
        name for name in beyond if all(name in fit.beyond for fit in ranking.fits if name in fit.names)
    )


def _read_best(ranking: Ranking, recordings: Sequence[Recorded]) -> Ranking:
    """Return the ranking with tires that take the deflection as exact, where that leaves less of the recordings.

    Of a fast motion that is sampled sparsely a part looks like noise of the reading: what follows less of it than a
    rate does follows less of the force.
    """
    if not ranking.best.tire.differentiates:
        return ranking  # no rate is tracked, and the guard does nothing
    exact = [fit.reading_exactly() for fit in ranking.fits]
    left = (_residuals(fit.tire, recordings) for fit in (ranking.best, exact[0]))
    guarded, followed = (sum(float(own @ own) for own in residuals) for residuals in left)
    return replace(ranking, fits=tuple(exact)) if followed < guarded else ranking


def _explanation(
    samples: Samples,
    ranking: Ranking,
    chosen: Fit,
    excitation: Excitation,
    unshown: Unshown,
) -> Explanation:
    order = sorted(range(len(ranking.fits)), key=lambda i: ranking.fits[i] is not chosen)
    same = leaving_the_same(chosen, ranking.fits)
    weights = ranking.weights().tolist()
    pairs = [(ranking.fits[i], weights[i]) for i in order]
    own = ranking.posteriors[order[0]]
    included = ranking.inclusion()
    held = {effect.name for effect, _ in chosen.problem.dataset.tire.effects}
    estimates, together = estimates_of(chosen), significances_of(chosen)
    effects = [
        NamedEffect(
            name,
            {
                e.name: Estimate(e.value, e.deviation, e.unit, e.determined)
                for e in estimates
                if e.owner == name
            },
            _share(ranking, chosen, name),
            min(included[name], 1.0),
            in_baseline=name in held,
            together=together[name],
        )
        for name in chosen.names
    ]
    return Explanation(
        tuple(sorted(effects, key=lambda e: -e.share)),
        pairs[0][1],
        tuple(
            Evidence(
                fit.names,
                ranking.posteriors[i] - own,
                fit.power / fit.residual.size,
                tuple(fit.sizes.get(n, 0.0) for n in fit.names),
                weight,
            )
            for (fit, weight), i in zip(pairs, order, strict=True)
            if fit is chosen or not fit.out_of_range
        ),
        tuple(n for n in confounded(chosen, ranking, excitation) if n not in same),
        same,
        tuple(n for n in unshown.like_law if LAW in chosen.names and n not in chosen.names),
        remainder_of(chosen),
        FittedModel(chosen),
        tuple(e.floor for e in chosen.problem.dataset.experiments),
        compared(samples.recordings),
        excitation,
        ranking,
        samples,
        unshown,
    )


def _share(ranking: Ranking, chosen: Fit, name: str) -> float:
    without = ranking.of(frozenset(chosen.names) - {name})
    misfit = chosen.problem.dataset.misfit
    missed = float(misfit @ misfit) - chosen.residual.size
    gained = 0.0 if without is None else without.power - chosen.power
    return float(np.clip(gained / max(missed, 1e-12), 0.0, 1.0))


def _residuals(tire: TireModel, recordings: Sequence[Recorded]) -> tuple[FloatArray, ...]:
    return tuple(r.force - simulate(tire, r) for r in recordings)
