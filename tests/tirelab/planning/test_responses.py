"""The products of all responses, against the responses themselves."""

import math
from dataclasses import replace

import numpy as np
import pytest
from radialtire import CATALOGUE, TireModel
from small_rig import RIG, few_effects, silent
from tirelab.errors import TirelabError
from tirelab.planning.menu import drive_of, experiment_of
from tirelab.planning.responses import (
    DRAWS,
    HELD,
    PRIOR_OF_GAIN,
    PRIOR_OF_LAW,
    SLOW_NOISE,
    Responses,
    responses_of,
    within_force,
)
from tirelab.planning.separation import Question, probabilities
from tirelab.regressors.signature import LAW


@pytest.fixture
def found(monkeypatch: pytest.MonkeyPatch) -> Responses:
    few_effects(monkeypatch, ("viscous_damping", "force_offset", "bottoming"))
    drives = [
        drive_of(name, 0.25, RIG.surfaces[0], RIG)
        for name in ("slow triangles", "fast triangles", "ramp and hold")
    ]
    return responses_of(drives, TireModel(), RIG, silent)


def test_every_effect_and_the_law_have_their_draws(found: Responses) -> None:
    assert found.names == ("viscous_damping", "force_offset", "bottoming", LAW)
    assert all(found.places[n].stop - found.places[n].start <= DRAWS for n in found.names)
    assert found.places[PRIOR_OF_LAW].stop == found.places[SLOW_NOISE].start
    assert found.grams[0].shape[0] == found.places[SLOW_NOISE].stop


def test_slow_noise_is_a_tenth_of_the_power_and_like_no_response(found: Responses) -> None:
    """10 s at 100 Hz, 1 / f below 1 Hz: 2 x 0.01 s x 1 Hz x ln(10 / 0.02) = 0.124 of the variance of each sample."""
    for gram, drive in zip(found.grams, found.drives, strict=True):
        e = experiment_of(drive, TireModel(), RIG.noise)
        # rows that follow the motion may leave a few samples of the 10 s over
        assert gram[-1, -1] == pytest.approx(0.124 * e.counts.sum() * e.size, rel=0.01)
        assert not gram[-1, :-1].any()


def test_a_ceiling_is_sized_where_the_force_is_largest(monkeypatch: pytest.MonkeyPatch) -> None:
    """A convex surface is softer than the flat one: a ceiling just below the largest force shows on the flat one,
    whichever of them the rig states first, and no soft beginning of it on the other one is blown up to its size.
    """
    few_effects(monkeypatch, ("saturation",))
    flat, convex = math.inf, 0.05
    found = []
    for surfaces in ((flat, convex), (convex, flat)):
        rig = replace(RIG, surfaces=surfaces)
        drives = [drive_of("slow triangles", 0.25, radius, rig) for radius in (flat, convex)]
        responses = responses_of(drives, TireModel(), rig, silent)
        place = responses.places["saturation"]
        found.append([float(np.diag(gram)[place].mean()) for gram in responses.grams])
    assert found[0] == pytest.approx(found[1], rel=1e-6)
    assert found[0][0] > 100.0 * found[0][1]


def test_a_constant_force_of_size_one_is_the_peak_force(found: Responses) -> None:
    """An offset is one constant: its power is (peak / noise)^2 times the samples compared."""
    place = found.places["force_offset"]
    for gram, drive in zip(found.grams, found.drives, strict=True):
        e = experiment_of(drive, TireModel(), RIG.noise)
        expected = (found.peak / RIG.noise) ** 2 * e.counts.sum() * e.size
        assert np.diag(gram)[place] == pytest.approx(expected, rel=1e-6)


def test_no_response_is_larger_than_the_peak_force_at_size_one(found: Responses) -> None:
    for gram, drive in zip(found.grams, found.drives, strict=True):
        e = experiment_of(drive, TireModel(), RIG.noise)
        most = (found.peak / e.noise) ** 2 * e.counts.sum()
        assert np.all(np.diag(gram)[: found.places[LAW].stop] <= most * (1.0 + 1e-9))


def test_damping_shows_in_fast_motions(found: Responses) -> None:
    """Forty times the rate; by its prior the force grows with a power of it that may be far below one."""
    slow, fast, _ = (np.diag(g)[found.places["viscous_damping"]].max() for g in found.grams)
    assert fast > 10.0 * slow


def test_an_effect_without_response_is_said_to_have_none(monkeypatch: pytest.MonkeyPatch) -> None:
    few_effects(monkeypatch, ("force_offset", "inertia"))
    still = drive_of("slow triangles", 0.25, RIG.surfaces[0], RIG)
    found = responses_of([still], TireModel(), RIG, silent)
    assert found.silent == ("inertia",)
    assert set(found.silent) < set(CATALOGUE)


@pytest.mark.parametrize("force", [200.0, 800.0])
def test_the_stroke_ends_where_the_tire_reaches_the_largest_force(force: float) -> None:
    """F = A x^B with x in cm, so x = (F / A)^(1 / B) on the stiffer of two surfaces, to a thousandth of the stroke."""
    tire = TireModel()
    found = within_force(replace(RIG, surfaces=(math.inf, 0.254), force=force), tire)
    laws = [tire.law.coefficients(radius) for radius in (math.inf, 0.254)]
    least = min(1e-2 * (force / a) ** (1.0 / b) for a, b in laws)
    assert found.stroke == pytest.approx(least, abs=1e-3 * RIG.stroke)
    assert replace(found, stroke=RIG.stroke, surfaces=RIG.surfaces, force=math.inf) == RIG


def test_a_held_pressure_counts_in_the_largest_force() -> None:
    held = replace(RIG, pressures=(2e5, 4e5), force=500.0)
    assert (
        within_force(held, TireModel()).stroke < within_force(replace(held, pressures=()), TireModel()).stroke
    )


def test_a_force_that_the_tire_exceeds_before_it_is_pressed_is_refused() -> None:
    tire = TireModel(effects=((CATALOGUE["force_offset"], (60.0,)),))
    with pytest.raises(TirelabError, match="is beyond 50 N before it is pressed; give a larger --force"):
        within_force(replace(RIG, force=50.0), tire)


def test_triangles_pass_each_deflection_at_one_speed(found: Responses) -> None:
    assert found.mixed[:2] == (False, False)
    rates = drive_of("triangles at three rates", 0.25, RIG.surfaces[0], RIG)
    assert responses_of([rates], TireModel(), RIG, silent).mixed == (True,)


def test_the_whole_catalogue_answers_but_what_needs_a_channel_to_be_set_anew() -> None:
    found = responses_of([drive_of("fast triangles", 0.25, RIG.surfaces[0], RIG)], TireModel(), RIG, silent)
    told = {*found.names, *found.silent} - {LAW}
    read = {n for n, e in CATALOGUE.items() if e.reads is not None and e.reads.reference is not None}
    assert read
    assert told == {n for n, e in CATALOGUE.items() if "law" not in e.traits} - read


@pytest.fixture
def at_two(monkeypatch: pytest.MonkeyPatch) -> Responses:
    """Slow triangles at the reference of 2 bar and at 3 bar."""
    few_effects(monkeypatch, ("bottoming",))
    rig = replace(RIG, pressures=(2e5, 3e5))
    drives = [drive_of("slow triangles", 0.25, RIG.surfaces[0], rig, p) for p in rig.pressures]
    return responses_of(drives, TireModel(), rig, silent)


def test_at_another_pressure_the_law_grows_with_the_force_and_a_rim_does_not(at_two: Responses) -> None:
    """The air carries 0.8 of the force: at 3 bar for 2 it is 1 + 0.8 x 0.5 = 1.4 of it."""
    first, second = (np.diag(g) for g in at_two.grams)
    law, rim = at_two.places[PRIOR_OF_LAW], at_two.places["bottoming"]
    assert second[law] == pytest.approx(1.4**2 * first[law], rel=1e-6)
    assert second[rim] == pytest.approx(first[rim], rel=1e-6)


def test_the_gain_with_the_pressure_is_a_column_of_its_own(at_two: Responses) -> None:
    """0.25 of half the force at the reference: nothing at 2 bar."""
    (gain,) = range(*at_two.places[PRIOR_OF_GAIN].indices(99))
    e = experiment_of(at_two.drives[0], TireModel(), RIG.noise)
    force = e.baseline[e.counts] / e.noise
    assert at_two.grams[0][gain, gain] == pytest.approx(0.0, abs=1e-12)
    assert at_two.grams[1][gain, gain] == pytest.approx(float(np.sum((0.125 * force) ** 2)), rel=1e-6)


def test_a_second_pressure_tells_a_rim_from_a_law_better_than_the_first_one_again(at_two: Responses) -> None:
    question = Question("bottoming", frozenset({LAW}), 0.01, nested=True)
    first, second = at_two.grams
    again, other = (
        float(np.mean(probabilities(first + more, at_two.places, [question])[0])) for more in (first, second)
    )
    assert other > again


def test_the_gain_with_the_pressure_shows_at_another_pressure_as_a_factor_alone(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """At the first pressure a gain about it changes nothing; at both together nothing but it follows the difference."""
    few_effects(monkeypatch, ("force_offset", "viscous_damping"))
    rig = replace(RIG, pressures=(2e5, 3e5))
    drives = [drive_of("slow triangles", 0.25, rig.surfaces[0], rig, p) for p in rig.pressures]
    found = responses_of(drives, TireModel(), rig, silent)
    assert HELD.name in found.names
    question = Question(HELD.name, frozenset({LAW}), 0.05, nested=True)
    one, both = (
        probabilities(gram, found.places, [question])[0].mean()
        for gram in (found.grams[0], found.grams[0] + found.grams[1])
    )
    assert one < 0.5
    assert both > 0.95
