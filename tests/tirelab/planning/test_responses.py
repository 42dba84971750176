"""The products of all responses, against the responses themselves."""

import numpy as np
import pytest
from radialtire import CATALOGUE, TireModel
from small_rig import RIG, few_effects, silent
from tirelab.planning.menu import drive_of, experiment_of
from tirelab.planning.responses import DRAWS, PRIOR_OF_LAW, Responses, responses_of
from tirelab.regressors.law import LAW


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
    assert found.grams[0].shape[0] == found.places[PRIOR_OF_LAW].stop


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
