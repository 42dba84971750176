"""The test that tells alternatives apart."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
from drives import read
from fits import model_of
from radialtire import PowerLaw, TireModel
from scipy.stats import norm
from tirelab.diagnosis.alternatives import USUAL_SPEED
from tirelab.diagnosis.discriminating_test import (
    DECISIVE,
    MOST_TESTED,
    discriminate,
    expected_gain,
    limits_of_rig,
    recommended,
)
from tirelab.planning.waveforms import Limits
from tirelab.preprocessing.samples import raw_dataset_of
from tirelab.selection.search import EFFECTIVE
from tirelab.simulation.simulate import simulate

SLIPPING = {"rate_independent_hysteresis": {"slip_force": 30.0, "reach": 1e-3}}


def friction(radius=np.inf):
    return model_of(SLIPPING, radius)


def viscous():
    return model_of({"viscous_damping": {"damping": 2500.0}})


def fitted(noise):
    return discriminate(viscous(), friction(), noise, Limits())


def test_friction_and_viscosity_are_told_apart_by_more_than_one_rate():
    found = fitted(6.0)
    rate = np.abs(np.gradient(found.test.deflection, found.test.time))
    assert rate.max() > 5.0 * np.median(rate[rate > 1e-6]) or np.ptp(np.unique(rate.round(3))) > 0.05
    assert found.separation > 100.0


def test_the_difference_is_in_units_of_the_noise_of_one_sample_and_of_all():
    found = fitted(6.0)
    assert found.separation == pytest.approx(found.typical * np.sqrt(found.test.time.size), rel=1e-9)


@pytest.mark.parametrize("ratio", [0.5, 1.0, 3.0, 10.0])
def test_beside_forms_that_miss_more_than_the_noise_their_ratio_counts(ratio):
    """The discrepancy's variance follows what is left: the gain is e / 2 times the logarithm of the squares' ratio."""
    told = expected_gain(12_000, 100.0 * ratio, 100.0)
    assert told == pytest.approx(0.5 * EFFECTIVE * np.log(1.0 + ratio**2), rel=0.01)
    assert expected_gain(12_000, 400.0 * ratio, 400.0) == pytest.approx(told, rel=0.01)


def test_where_forms_miss_nothing_a_faint_difference_counts_in_every_sample():
    """Beside white noise the gain is half of the sum of squares, as long as no discrepancy is as likely: V = 1."""
    assert expected_gain(12_000, 0.01, 0.0) == pytest.approx(0.5 * 12_000 * 0.01**2, rel=0.2)


def test_a_test_on_which_the_forms_miss_as_much_as_the_difference_does_not_decide():
    found = fitted(6.0)
    assert found.sufficient
    poor = replace(found, gain=expected_gain(found.test.time.size, found.missed, found.missed))
    assert not poor.sufficient
    assert poor.separation > 100.0


def test_the_contract_of_a_test():
    entry = fitted(6.0).to_dict()
    assert entry["surfaces"] == ["inf"]
    assert "sentence" in entry


def test_the_sentence_says_what_to_drive_and_on_which_surface():
    """Limits and noise are round numbers, so that the sentence can be worked out by hand."""
    found = discriminate(viscous(), friction(-0.381), 6.0, Limits(deepest=0.02, fastest=0.1, longest=60.0))
    assert found.sentence.startswith(f"Drive {found.test.name} to ")
    assert "on a concave surface of radius 38.1 cm, at up to " in found.sentence
    assert "It decides between viscous damping and friction loop: the forces differ by " in found.sentence
    assert discriminate(viscous(), friction(), 6.0, Limits()).sentence.count("on flat ground") == 1


def test_a_part_is_driven_where_it_was_recorded():
    """A joint between -1165 and -659 mm: from one end to the other, no faster than the rig, and it says so."""
    part = TireModel(law=PowerLaw(1.0, 1.0), two_sided=True)
    pair = [model_of(effects, tire=part) for effects in ({"viscous_damping": {"damping": 2500.0}}, SLIPPING)]
    limits = Limits(deepest=0.506, fastest=0.164, start=-1.165)
    found = discriminate(*pair, 0.5, limits)
    path = found.test.deflection
    assert (path.min(), path.max()) == pytest.approx((-1.165, -0.659), abs=0.001)
    assert np.abs(np.diff(path)).max() / limits.step < 0.164 * 1.02
    assert found.sentence.startswith(
        f"Drive {found.test.name} from {1e3 * path.min():.1f} to -659.0 mm, at up to "
    )
    assert found.to_dict()["begins_at"] == pytest.approx(path.min())


@pytest.mark.parametrize(("scale", "said"), [(1.0, "20.0 mm"), (1e-3, "0.020 mm"), (1e-5, "0.00020 mm")])
def test_the_stroke_of_a_tiny_part_is_told_with_as_many_decimals_as_show_it(scale: float, said: str):
    found = discriminate(viscous(), friction(), 6.0, Limits(deepest=0.02, fastest=0.1, longest=60.0))
    test = replace(found.test, deflection=scale * found.test.deflection / found.test.deflection.max() * 0.02)
    sentence = replace(found, test=test).sentence
    assert f" to {said} on flat ground, at up to " in sentence
    assert "up to 0 mm/s" not in sentence


def test_against_the_baseline_it_is_decided_whether_the_effect_acts():
    told = discriminate(friction(), model_of({}), 6.0, Limits()).sentence
    assert "It decides whether the friction loop acts: the forces differ by " in told


def test_a_separation_is_decisive_where_nineteen_of_twenty_tests_give_odds_of_a_thousand():
    ratio = norm(DECISIVE**2 / 2.0, DECISIVE)
    assert ratio.sf(np.log(1000.0)) == pytest.approx(0.95, abs=0.005)


def test_the_same_force_under_other_names_cannot_be_told_apart():
    """Friction against friction and no offset: whatever is driven, the refit takes up all of the difference."""
    found = discriminate(friction(), model_of({**SLIPPING, "force_offset": {}}), 6.0, Limits())
    assert not found.sufficient
    none = (
        "No motion within the rig's limits decides whether the force offset acts: the forces would differ by "
    )
    assert found.sentence == f"{none}less than a hundredth of the noise."
    assert replace(found, typical=0.02, missed=0.1).sentence.startswith(
        f"{none}at most 0.02 times the noise in a typical sample, 0.2 times what the forms of the effects may miss ("
    )
    assert fitted(6.0).sufficient


def test_one_effect_more_is_decided_by_what_the_smaller_set_cannot_follow() -> None:
    """20 N at every deflection: friction cannot follow it, whichever of the two sets was accepted."""
    more = model_of({**SLIPPING, "force_offset": {"offset": 20.0}})
    added, left_out = (
        discriminate(*pair, 6.0, Limits()) for pair in ((friction(), more), (more, friction()))
    )
    assert added.sufficient
    assert added.typical == pytest.approx(left_out.typical)
    assert added.between == (friction().names, more.names)
    assert "It decides whether the force offset acts: " in added.sentence


def test_it_is_driven_on_a_recorded_surface_that_can_be_mounted():
    limits = Limits(deepest=0.02, fastest=0.1, longest=60.0, surfaces=(-0.381, 0.254))
    assert set(discriminate(viscous(), friction(-0.381), 6.0, limits).test.surface_radius) == {-0.381}


def test_the_next_test_of_a_part_stays_where_it_was_recorded() -> None:
    """A spring read between 10 and 12 mm on a gauge of its own; of a tire the next test begins at 0."""
    time = np.arange(0.0, 20.0, 0.01)
    spring = TireModel(law=PowerLaw(100.0, 1.0), two_sided=True)
    x = 0.011 + 0.001 * np.sin(time)
    recordings = [read("spring", time, x, 1e4 * x, 1)]
    samples = raw_dataset_of(recordings, spring)
    limits = limits_of_rig(samples, None, timed=True, part=True)
    assert (limits.start, limits.deepest) == pytest.approx((0.010, 0.002), abs=1e-5)
    assert limits_of_rig(samples, Limits(deepest=0.03), timed=True, part=True).start == limits.start
    assert limits_of_rig(samples, None, timed=True, part=False).start == 0.0
    assert limits_of_rig(samples, None, timed=True, part=False).deepest == pytest.approx(0.012, rel=1e-3)


def test_a_rig_that_drove_a_motion_can_drive_it_twice_as_fast() -> None:
    """0.5 m/s at most; samples without measured times say nothing of it."""
    time = np.arange(0.0, 20.0, 0.01)
    x = 0.010 * (1.0 - np.cos(50.0 * time))
    recordings = [read("press", time, x, 1e4 * x, 1)]
    samples = raw_dataset_of(recordings, TireModel())
    assert limits_of_rig(samples, None, timed=True, part=False).fastest == pytest.approx(1.0, rel=0.02)
    assert limits_of_rig(samples, None, timed=False, part=False).fastest == USUAL_SPEED


def test_the_recommended_test_presses_no_model_beyond_the_largest_force_of_the_rig():
    one, other = viscous(), friction()
    explanation = SimpleNamespace(model=one, alternative_model=lambda names: other)
    asked = [SimpleNamespace(names=other.names)]
    limits = Limits(deepest=0.02, fastest=0.1)
    free = recommended(explanation, asked, 6.0, limits)
    within = recommended(explanation, asked, 6.0, replace(limits, force=500.0))
    peaks = [max(simulate(m.tire, found.test).max() for m in (one, other)) for found in (free, within)]
    assert peaks[0] > 1000.0
    assert peaks[1] <= 500.0
    assert recommended(explanation, asked, 6.0, replace(limits, force=1e-6)) is None


def test_alternatives_that_were_not_fitted_take_no_place_of_those_that_a_test_is_searched_for():
    one, other = viscous(), friction()
    explanation = SimpleNamespace(
        model=one, alternative_model=lambda names: None if names == "not" else other
    )
    asked = [*(SimpleNamespace(names="not") for _ in range(MOST_TESTED)), SimpleNamespace(names=other.names)]
    found = recommended(explanation, asked, 6.0, Limits(deepest=0.02, fastest=0.1))
    assert found is not None
    assert found.between == (one.names, other.names)
