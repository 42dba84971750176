"""Fitted sets against each other, on a ride of 500 N s/m of damping under 5 N of noise."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from drives import flat_force
from radialtire import CATALOGUE, TireModel
from tirelab.estimation.fit import Fit, fitted
from tirelab.estimation.held_out import held_out_of
from tirelab.estimation.ranking import (
    EVALUATION,
    TEMPERATURE,
    FittedSets,
    Ranking,
    begun,
    corrected,
    ranked,
    with_parts,
)
from tirelab.recordings.recording import Recording
from tirelab.regressors.dataset import Dataset, arranged, dataset_of, samples_of
from tirelab.regressors.signature import LAW, Signature, law_signature, signatures_of
from tirelab.selection.search import LOST, Discrepancy, discrepancy_of
from tirelab.simulation.simulate import simulate


@pytest.fixture(scope="module")
def ranking(dataset: Dataset, signatures: tuple[Signature, ...], noise: Discrepancy) -> Ranking:
    return ranked(begun(dataset, signatures, noise, []), lambda name: ())


def test_a_refitted_law_is_fitted_whatever_was_predicted_of_it(monkeypatch: pytest.MonkeyPatch) -> None:
    """A prediction has one size for all its columns, a fit one for each group of them."""
    monkeypatch.setattr(
        "tirelab.estimation.ranking.predicted_gains",
        lambda signatures, base, discrepancy: [0.0] * len(signatures),
    )
    deflection = 0.02 * np.abs(np.sin(np.linspace(0.0, 3.0 * np.pi, 900)))
    force = flat_force(deflection) * (1.0 + 0.05 * np.sin(300.0 * deflection))
    noise = 2.0 * np.random.default_rng(3).normal(size=900)
    press = Recording("press", np.linspace(0.0, 9.0, 900), deflection, np.full(900, np.inf), force + noise)
    dataset = dataset_of([press], TireModel())
    law = law_signature(dataset)
    found = ranked(begun(dataset, (law,), discrepancy_of(dataset.misfit, 0.05), []), lambda name: ())
    assert found.best.names == (LAW,)


def test_candidates_are_tried_alone_however_far_nothing_is_behind(monkeypatch: pytest.MonkeyPatch) -> None:
    """A law of another shape on one ramp, of which a stop imitates the end: what begins far ahead may lead astray."""
    deflection = np.linspace(0.0005, 0.02, 300)
    missed = 40.0 * (np.exp(200.0 * (deflection - 0.02)) - 0.5 * np.sin(250.0 * deflection))
    noise = 0.2 * np.random.default_rng(3).normal(size=300)
    force = flat_force(deflection) + missed + noise
    ramp = Recording("ramp", np.linspace(0.0, 9.0, 300), deflection, np.full(300, np.inf), force)
    dataset = dataset_of([ramp], TireModel())
    signatures = (*signatures_of(("bottoming",), dataset), law_signature(dataset))
    begin = (1.0, {"bottoming": dataset.misfit})
    sets = begun(dataset, signatures, discrepancy_of(dataset.misfit, 0.05), [begin])
    assert sets.posterior(sets.best()) > sets.posterior(frozenset()) + LOST
    followed: list[frozenset[str]] = []
    monkeypatch.setattr("tirelab.estimation.ranking._fit_neighbours", lambda _, names: followed.append(names))
    ranked(sets, lambda name: ())
    assert followed == [frozenset(), {"bottoming"}]


def test_what_a_set_explains_is_no_slow_noise_though_nothing_is_likeliest_beside_it() -> None:
    """One ramp on a law of another shape: where nothing is fitted, its whole misfit is slow."""
    deflection = np.linspace(0.0005, 0.02, 300)
    force = flat_force(deflection) + 30.0 * np.sin(500.0 * deflection)
    noise = 0.5 * np.random.default_rng(3).normal(size=300)
    ramp = Recording("ramp", np.linspace(0.0, 9.0, 300), deflection, np.full(300, np.inf), force + noise)
    dataset = dataset_of([ramp], TireModel())
    law = law_signature(dataset)
    found = ranked(begun(dataset, (law,), discrepancy_of(dataset.misfit, 0.05), []), lambda name: ())
    nothing = found.of(frozenset())
    assert nothing is not None
    assert found.best.names == (LAW,)
    assert found.best.power < 0.25 * nothing.power


def by_hand(*sets: tuple[str, float]) -> Ranking:
    fits: Any = [SimpleNamespace(names=tuple(n.split()), log_posterior=p) for n, p in sets]
    return Ranking(tuple(fits), Discrepancy(100, 30.0, 1.0, 2.0))


def test_odds_are_those_of_the_posteriors_tempered() -> None:
    ranking = by_hand(("a b", 7.0), ("a", 5.0), ("", 1.0))
    first, second, third = ranking.weights()
    assert first + second + third == pytest.approx(1.0)
    assert first / second == pytest.approx(np.exp(2.0 / TEMPERATURE))
    assert ranking.inclusion() == {"a": pytest.approx(1.0 - third), "b": pytest.approx(first)}
    assert [ranking.behind(fit) for fit in ranking.fits] == [0.0, 2.0, 6.0]


def by_response(*sets: tuple[str, float, tuple[float, ...]]) -> Ranking:
    """Sets with their probability, the largest first, and what they leave of a misfit of some samples."""
    fits: Any = [
        SimpleNamespace(
            names=tuple(n.split()),
            hypotheses=frozenset(n.split()),
            log_posterior=TEMPERATURE * np.log(p),
            residual=np.array(left),
        )
        for n, p, left in sets
    ]
    return Ranking(tuple(fits), Discrepancy(100, 30.0, 1.0, 2.0))


ANYWHERE = 10.0
"""Log posterior odds within which all sets of these tests lie."""


def test_of_effects_unlike_each_other_those_above_one_half_stand_for_all() -> None:
    """The median set: a is in all, b and c in fewer than half. What each does is at right angles to the others."""
    ranking = by_response(
        ("a b", 0.4, (0.0, 0.0, 1.0)), ("a", 0.35, (0.0, 1.0, 1.0)), ("a c", 0.25, (0.0, 1.0, 0.0))
    )
    assert ranking.central(ANYWHERE).names == ("a",)


def test_of_effects_alike_one_stands_for_all_though_neither_is_above_one_half() -> None:
    """Nothing is likelier than either of two that do the same, and less likely than both together."""
    ranking = by_response(("", 0.4, (1.0, 1.0)), ("a", 0.35, (0.0, 1.0)), ("b", 0.25, (0.0, 1.1)))
    assert ranking.central(ANYWHERE).names == ("a",)
    unlike = by_response(("", 0.4, (1.0, 1.0)), ("a", 0.35, (0.0, 1.0)), ("b", 0.25, (1.0, 0.0)))
    assert unlike.central(ANYWHERE).names == ()


def test_an_effect_that_goes_a_little_towards_the_mean_is_not_added() -> None:
    """Half of the sets have something else, which differs; a tenth of one of these is nearer to the mean than none."""
    ranking = by_response(
        ("a", 0.4, (1.0, 1.0, 0.0)),
        ("a b", 0.3, (0.0, 1.0, 0.0)),
        ("a c", 0.2, (1.0, 0.0, 0.0)),
        ("a d", 0.1, (0.9, 1.0, 0.0)),
    )
    assert ranking.central(ANYWHERE).names == ("a",)


def test_a_set_far_behind_the_best_does_not_stand_for_all() -> None:
    ranking = by_response(("", 0.4, (1.0, 1.0)), ("a", 0.35, (0.0, 1.0)), ("b", 0.25, (0.0, 1.1)))
    behind = ranking.behind(ranking.fits[1])
    assert ranking.central(0.9 * behind).names == ()
    assert ranking.central(1.1 * behind).names == ("a",)


def test_only_what_is_nested_takes_the_place_of_the_likeliest() -> None:
    """The mean of a and b lies nearest to c, which is neither: what is named should be likely too."""
    ranking = by_response(("a", 0.45, (0.0, 1.0)), ("b", 0.4, (1.0, 0.0)), ("c", 0.15, (0.5, 0.5)))
    assert ranking.central(ANYWHERE).names == ("a",)


def test_a_set_is_found_by_its_names_in_any_order() -> None:
    ranking = by_hand(("a b", 2.0), ("", 1.0))
    assert ranking.of(frozenset(("b", "a"))) is ranking.best
    assert ranking.of(frozenset(("b",))) is None


def test_nothing_is_fitted_twice_from_one_start(
    dataset: Dataset, signatures: tuple[Signature, ...], noise: Discrepancy
) -> None:
    """But the the starts of another discrepancy the same ones: what is slow in the rest may have been told since."""
    sets = begun(dataset, signatures, noise, [])
    nothing, count = sets.best_fit, sets.count
    for _ in range(2):
        sets.add(nothing, "viscous_damping")
    assert sets.count == count + 1
    sets.discrepancy = sets.discrepancy.above(3.0)
    sets.add(nothing, "viscous_damping")
    assert sets.count == count + 2


def test_what_is_there_wins_although_nothing_was_begun_with(ranking: Ranking) -> None:
    assert ranking.best.names == ("viscous_damping",)
    (damping,) = ranking.best.values["viscous_damping"][:1]
    assert damping == pytest.approx(500.0, rel=0.05)
    assert list(ranking.posteriors) == sorted(ranking.posteriors, reverse=True)


def test_a_ranking_ends_where_its_budget_of_simulations_does(
    dataset: Dataset,
    signatures: tuple[Signature, ...],
    noise: Discrepancy,
    ranking: Ranking,
) -> None:
    """Every fit is counted with all its starts; that which uses the budget up is the last of the search."""
    each = EVALUATION + dataset.misfit.size
    sets = begun(dataset, signatures, noise, [], most_work=150 * each)
    short = ranked(sets, lambda name: ())
    assert len(short.fits) < len(ranking.fits)
    assert sets.work >= 150 * each
    assert sets.work >= each * sum(f.evaluations for f in short.fits)
    assert short.best.names == ("viscous_damping",)


def test_no_set_within_reach_leaves_more_than_a_subset_of_it(ranking: Ranking) -> None:
    """A larger set can do what a smaller one does; a thousandth is what a fit that stops may miss."""
    powers = {frozenset(fit.names): fit.power for fit in ranking.fits if ranking.behind(fit) < 15.0}
    assert len(powers) > 2
    for names, power in powers.items():
        for less, left in powers.items():
            assert not less < names or power <= 1.002 * left


def test_a_set_that_stopped_early_is_fitted_again_from_the_smaller_one_that_leaves_less(
    dataset: Dataset, signatures: tuple[Signature, ...], noise: Discrepancy, ranking: Ranking
) -> None:
    """A larger set can do what a smaller one does: what stands in its way is where its fit began."""
    less = ranking.of(frozenset({"viscous_damping"}))
    more = next(f for f in ranking.fits if set(f.names) > {"viscous_damping"})
    assert less is not None

    def tried(factor: float) -> FittedSets:
        """Return the sets where the larger one left `factor` times as much, after a search without a budget."""
        early = replace(more, residual=factor * less.residual, log_likelihood=more.log_likelihood - 5.0)
        fits = {frozenset(f.names): f for f in (less, early)}
        known = {s.name: s for s in signatures}
        sets = FittedSets(dataset, known, noise, ranking.discrepancy, None, fits, most_work=0)
        ranked(sets, lambda name: ())
        return sets

    sets = tried(2.0)
    assert sets.count == 1
    assert sets.fits[frozenset(more.names)].power == pytest.approx(more.power, rel=0.01)
    assert tried(1.001).count == 0


LATE = (0.005, 0.01, 0.0)
"""Low-pass of 5 ms and delay of 10 ms."""


def late_cycles() -> Recording:
    """Return cycles of 1.5 Hz every 2 ms whose force is read late."""
    time = 0.002 * np.arange(16_000)
    x = 0.010 - 0.008 * np.cos(2.0 * np.pi * 1.5 * time)
    silent = Recording("cycles", time, x, np.full(16_000, np.inf), np.zeros(16_000))
    return replace(silent, force=simulate(arranged(TireModel(), [("force_lag", LATE)]), silent))


def test_a_delay_among_long_blocks_is_that_of_the_samples(monkeypatch: pytest.MonkeyPatch) -> None:
    """Cycles of 1.5 Hz every 2 ms, in blocks of several samples, read 10 ms late behind a low-pass of 5 ms. The
    optional parameters were tried in blocks: a correction does not ask for them.
    """
    wanted: list[float] = []

    def seen(*given: Any) -> Fit:
        wanted.append(given[-1])
        return fitted(*given)

    late = late_cycles()
    read = replace(late, force=late.force + np.random.default_rng(3).normal(size=16_000))
    dataset = dataset_of([read], TireModel())
    assert dataset.experiments[0].size >= 2
    noise = discrepancy_of(dataset.misfit, 0.0)
    in_blocks = ranked(begun(dataset, signatures_of(("force_lag",), dataset), noise, []), lambda name: ())
    monkeypatch.setattr("tirelab.estimation.ranking.fitted", seen)
    of_samples = corrected(in_blocks, samples_of([read], TireModel()))
    assert set(wanted) == {np.inf}
    assert of_samples.best.names == ("force_lag",)
    total = sum(of_samples.best.values["force_lag"][:2])
    assert total == pytest.approx(0.015, abs=2e-5)
    left = [r.best.residual.size**-0.5 * r.best.power**0.5 for r in (in_blocks, of_samples)]
    assert left[1] < left[0]
    assert of_samples.of(frozenset()) is in_blocks.of(frozenset())


def test_a_part_of_what_can_win_is_corrected_however_far_behind_it_is() -> None:
    """What the blocks leave out of a delay passed for a mass beside it; a rival that is no part of it stays."""
    read = late_cycles()
    dataset = dataset_of([read], TireModel())
    noise = discrepancy_of(dataset.misfit, 0.0)
    sets = (
        {"force_lag": LATE, "inertia": (1.0,)},
        {"force_lag": LATE},
        {"inertia": (1.0,)},
        {"force_drift": (0.0, 0.0)},
    )
    made = [fitted(dataset, [values], noise, 1.0, -np.inf) for values in sets]
    far = (0.0, -90.0, -90.0, -90.0)
    fits = tuple(
        replace(fit, log_predictive=to - fit.log_posterior) for fit, to in zip(made, far, strict=True)
    )
    found = corrected(Ranking(fits, noise), samples_of([read], TireModel()))
    names = [frozenset(values) for values in sets]
    changed = [found.of(n) is not fit for n, fit in zip(names, fits, strict=True)]
    assert changed[:2] == [True, True]
    assert not changed[3]


def sine(name: str, frequency: float, seed: int) -> Recording:
    """Return five cycles to 20 mm under 400 N s/m of damping and 5 N of noise."""
    time = np.linspace(0.0, 5.0 / frequency, 1500)
    angle = 2.0 * np.pi * frequency * time
    x, rate = 0.011 - 0.009 * np.cos(angle), 0.018 * np.pi * frequency * np.sin(angle)
    force = flat_force(x) + 400.0 * rate + 5.0 * np.random.default_rng(seed).normal(size=time.size)
    return Recording(name, time, x, np.full(time.size, np.inf), force)


def test_held_out_recordings_judge_what_is_fitted() -> None:
    """Friction that stands for damping at one speed is a fifth of it at five times that speed.

    Its residual there is then the damping's 400 N s/m less what a loop has at a fifth of the rate, far over the noise;
    the damping leaves the noise.
    """
    slow, fast = sine("slow", 0.5, 1), sine("fast", 2.5, 2)
    dataset = dataset_of([slow], TireModel())
    noise = discrepancy_of(dataset.misfit, 0.0)
    fits = {
        name: fitted(dataset, [{name: values}], noise, 1.0, -np.inf)
        for name, values in {
            "viscous_damping": (300.0, 1.0, 0.0, 0.0, 1.0, 0.0, 0.0),
            "rate_independent_hysteresis": (10.0, 0.0, 0.003, 0.0, 0.6, 0.0, 1.0, 1.0),
        }.items()
    }
    held_out = held_out_of([fast], TireModel(), samples_of([slow], TireModel()))
    assert held_out is not None
    damping, friction = (held_out.predicted(fits[name]) for name in fits)
    assert damping.held_out_residual.size == friction.held_out_residual.size == held_out.dataset.misfit.size
    missed = 400.0 * np.sqrt(np.mean(np.gradient(fast.deflection, fast.time) ** 2))
    level = held_out.dataset.experiments[0].noise
    assert np.std(damping.held_out_residual) == pytest.approx(5.0 / level, rel=0.15)
    assert np.std(friction.held_out_residual) == pytest.approx(0.8 * missed / level, rel=0.15)
    apart = (damping.log_posterior - friction.log_posterior) - (
        fits["viscous_damping"].log_posterior - fits["rate_independent_hysteresis"].log_posterior
    )
    # A set is priced by e ln(what it leaves), e = 30 effective samples, as far as forms usually miss: 6 % or less.
    assert apart > 30.0 * np.log(0.8 / 0.06)
    assert held_out_of([], TireModel(), samples_of([slow], TireModel())) is None


def test_every_set_without_one_of_the_effects_is_fitted(ranking: Ranking, dataset: Dataset) -> None:
    start = {"viscous_damping": (500.0, 1.0, 0.0, 0.0, 1.0, 0.0, 0.0), "inertia": (1.0,)}
    whole = fitted(dataset, [start], ranking.discrepancy, 1.0, -np.inf)
    alone = Ranking((whole,), ranking.discrepancy)
    found = with_parts(alone, whole)
    assert {frozenset(f.names) for f in found.fits} == {
        frozenset(names) for names in (("viscous_damping", "inertia"), ("viscous_damping",), ("inertia",))
    }
    without = found.of(frozenset(("viscous_damping",)))
    expected = ranking.of(frozenset(("viscous_damping",)))
    assert without is not None
    assert expected is not None
    assert without.power == pytest.approx(expected.power, rel=1e-3)
    assert with_parts(found, whole) is found


def test_a_candidate_is_drawn_beside_the_ceiling_that_hides_a_part_of_it(dataset: Dataset) -> None:
    """Beside a ceiling a dashpot's force shows below it only; beside a dashpot it is what it was."""
    own = signatures_of(("viscous_damping", "viscoelastic_relaxation"), dataset)
    sets = begun(
        dataset,
        signatures_of(("saturation", *(s.name for s in own)), dataset),
        discrepancy_of(dataset.misfit, 0.1),
        [],
    )
    peak = max(float(e.baseline.max()) for e in dataset.experiments)
    damped = (500.0, *[p.start for p in CATALOGUE["viscous_damping"].parameters[1:]])

    def beside(name: str, values: tuple[float, ...]) -> Mapping[str, Signature]:
        tire = arranged(dataset.tire, [(name, values)])
        left: Any = SimpleNamespace(
            names=(name,), tire=tire, residual=dataset.misfit - dataset.response(tire)
        )
        return sets.beside(left)

    above = dataset.gathered([e.baseline for e in dataset.experiments]) > 0.8 * peak
    hidden = beside("saturation", (0.5 * peak, 0.0))["viscous_damping"]
    assert np.abs(hidden.curves[:, above]).max() < 1e-6 < np.abs(own[0].curves[:, above]).max()
    still = beside("viscous_damping", damped)["viscoelastic_relaxation"]
    assert still is sets.signatures["viscoelastic_relaxation"]
