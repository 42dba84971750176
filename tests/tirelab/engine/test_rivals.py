"""What is said, how sure, and what else it could be."""

from dataclasses import replace

import numpy as np
import pytest
from drives import flat_force, read, ride, triangle
from radialtire import TireModel
from settled_sets import settled
from tirelab.diagnosis.diagnose import diagnose
from tirelab.engine.findings import Alternative
from tirelab.engine.rivals import (
    DECIDABLE,
    HIDING,
    SUREST,
    UNSEEN,
    confidence_of,
    one_constant_rate,
    one_rate_rivals,
    poverty,
    reason_of,
    rivals_of,
    static_rivals,
)
from tirelab.engine.scene import scene_of
from tirelab.preprocessing.dataset import dataset_of


def scene(time, deflection):
    drive = read("drive", time, deflection, flat_force(deflection), 1)
    return scene_of(dataset_of([drive], TireModel()))


def test_a_triangle_has_one_rate_and_a_ride_has_many():
    assert one_constant_rate(scene(*triangle()))
    assert not one_constant_rate(scene(*ride(1)[:2]))


def test_at_one_rate_every_loop_is_a_rival():
    rivals = one_rate_rivals(("viscous_damping",), scene(*triangle()))
    assert {r[0] for r in rivals} == {"rate_independent_hysteresis", "viscoelastic_relaxation", "force_lag"}
    assert one_rate_rivals(("pressure_leak",), scene(*triangle())) == []


def test_what_a_triangle_lacks():
    lacks = poverty(scene(*triangle()))
    assert "one constant rate only: drive a second rate" in lacks
    assert "one surface only: press on a second surface" in lacks
    assert "no hold: hold 10 s at 15 mm" in lacks


def test_the_reason_for_rivals_of_the_deflection_alone():
    reason = reason_of(("series_compliance",), ("recalibration",), scene(*ride(1)[:2]))
    assert "deflection and surface only" in reason


def test_two_sets_that_are_as_likely_share_the_confidence():
    assert confidence_of(()) == SUREST
    assert confidence_of((Alternative(("inertia",), 0.0, ""),)) == pytest.approx(SUREST / 2.0)
    assert confidence_of((Alternative(("inertia",), DECIDABLE, ""),)) > 0.98 * SUREST


def test_what_is_too_small_to_be_believed_is_a_rival():
    # Damping of a tenth of the noise changes the RMSE by sqrt(1 + 0.1^2), half a percent; over 6000 samples its log
    # likelihood is 0.1^2 6000 / 2 = 30, so that it may be said to be there, and not that it matters.
    time, deflection, rate = ride(4)
    force = flat_force(deflection) + 0.1 * 5.0 / np.sqrt(np.mean(rate**2)) * rate
    verdict = diagnose([read("ride", time, deflection, force, 4)])
    assert verdict.names == ()
    assert verdict.alternatives[0].names == ("viscous_damping",)
    assert verdict.confidence < 0.75


def of(evidence, *names):
    return settled(evidence, dict.fromkeys(names, 1.0))


def leaving(chi_square, one):
    return replace(
        one,
        candidate=replace(one.candidate, explained=replace(one.candidate.explained, chi_square=chi_square)),
    )


def stated(*sets):
    return {frozenset(names): gap for names, gap in static_rivals(sets)}


def test_beside_a_free_law_what_it_can_stand_for_may_always_be_there():
    found = stated(of(0.0, "inertia", "recalibration"))
    assert found == {frozenset({"inertia", "recalibration", h}): UNSEEN for h in HIDING}


def test_what_is_hardly_seen_beside_a_free_law_may_be_another_such():
    seen = of(0.0, "bottoming", "recalibration")
    others = [h for h in HIDING if h != "bottoming"]
    beside = {frozenset({"bottoming", "recalibration", h}): UNSEEN for h in others}
    instead = {frozenset({"recalibration", h}): UNSEEN for h in others}
    hardly = stated(seen, leaving(1.02, of(-12.0, "recalibration")))
    assert hardly == {frozenset({"recalibration"}): 12.0} | instead | beside
    assert stated(seen, leaving(1.5, of(-200.0, "recalibration"))) == beside


def test_another_function_of_the_deflection_is_a_rival_where_the_error_of_its_form_is_all_it_leaves():
    law = of(0.0, "recalibration")
    for size, stands in ((30.0, True), (10.0, False)):
        far = leaving(1.7, settled(-500.0, {"gas_compression": size}))
        # 3 % of 30 noises are 0.9, of power 0.8; of 10 noises they are 0.3, of power 0.09.
        assert (frozenset({"gas_compression"}) in stated(law, far)) is stands


def small(likely, *names):
    """A set of which a part is too small to be believed."""
    one = of(likely, *names)
    return replace(one, candidate=replace(one.candidate, log_evidence=-np.inf))


def rivals_beside(*sets):
    return [set(r.names) for r in rivals_of(sets, scene(*ride(1)[:2]))]


def test_a_likelier_set_of_which_a_part_is_too_small_to_be_believed_is_a_rival():
    best, alone = of(0.0, "inertia", "warm_up"), of(-70.0, "warm_up")
    assert rivals_beside(best, alone, small(20.0, "warm_up", "force_drift")) == [{"warm_up", "force_drift"}]
    # Nothing speaks for the drift where the set without it is likelier by the price of one effect.
    assert rivals_beside(best, of(-7.0, "warm_up"), small(-12.0, "warm_up", "force_drift")) == [{"warm_up"}]


def test_beside_something_unknown_what_is_known_and_comes_near_is_a_rival():
    best = of(0.0, "rate", "warm_up")
    known, far = of(-22.0, "force_lag", "warm_up"), of(-60.0, "warm_up")
    assert rivals_beside(best, known, far) == [{"force_lag", "warm_up"}]


@pytest.mark.parametrize("gap", [3.0, 9.0])
def test_a_set_that_comes_near_is_a_rival(gap):
    sets = [of(0.0, "warm_up"), of(-gap, "force_drift"), of(-40.0, "inertia")]
    assert [r.names for r in rivals_of(sets, scene(*ride(1)[:2]))] == [("force_drift",)]
