"""What is said, how sure, and what else it could be."""

from drives import flat_force, read, ride, triangle
from radialtire import TireModel
from tirelab.explain.scene import scene_of
from tirelab.rivals import one_constant_rate, one_rate_rivals, poverty, reason_of


def scene(time, deflection):
    drive = read("drive", time, deflection, flat_force(deflection), 1)
    return scene_of([(drive.time, drive.deflection, drive.surface_radius, drive.force)], TireModel())


def test_a_triangle_has_one_rate_and_a_ride_has_many():
    assert one_constant_rate(scene(*triangle()))
    assert not one_constant_rate(scene(*ride(1)[:2]))


def test_at_one_rate_every_loop_is_a_rival():
    rivals = one_rate_rivals(("viscous_damping",), scene(*triangle()))
    assert {r[0] for r in rivals} == {"rate_independent_hysteresis", "viscoelastic_relaxation", "force_lag"}
    assert one_rate_rivals(("pressure_leak",), scene(*triangle())) == []


def test_what_a_triangle_lacks():
    lacks = poverty(scene(*triangle()))
    assert "there is one constant rate only" in lacks
    assert "there is one surface only" in lacks
    assert "nothing is held still for a second" in lacks


def test_the_reason_for_rivals_of_the_deflection_alone():
    reason = reason_of(("series_compliance",), ("recalibration",), scene(*ride(1)[:2]))
    assert "deflection and surface alone" in reason
