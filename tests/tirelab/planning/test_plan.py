"""A plan for a small rig and three effects."""

import json
from dataclasses import replace

import pytest
from radialtire import TireModel
from small_rig import EFFECTS, RIG, few_effects, silent
from tirelab.errors import TirelabError
from tirelab.planning.menu import drive_of
from tirelab.planning.plan import SIZES, RecordingPlan, file_name, offered, plan_recordings
from tirelab.planning.responses import HELD, responses_of
from tirelab.regressors.signature import LAW


@pytest.fixture
def plan(monkeypatch: pytest.MonkeyPatch) -> RecordingPlan:
    few_effects(monkeypatch)
    return plan_recordings(TireModel(), RIG, 0.05)


def test_it_keeps_the_time_and_tells_what_the_rig_can_tell(plan: RecordingPlan) -> None:
    told, possible, asked = plan.told
    assert 0.0 < plan.seconds <= RIG.time
    assert told <= possible <= asked == 3 * 3 + 1 + 3
    assert told > 0.5 * asked


def test_each_effect_is_asked_for_beside_each_other_one(plan: RecordingPlan) -> None:
    told, possible, asked = plan.told_beside
    assert told <= possible <= asked == 3 * 2
    assert not any(a.question.beside for a in plan.answers)
    assert len(plan.to_dict()["beside"]) == asked


def test_friction_and_damping_need_more_than_one_rate(plan: RecordingPlan) -> None:
    one_rate = {"slow triangles", "fast triangles", "fast sine"}
    assert {d.name for d in plan.drives} - one_rate


def test_larger_effects_are_named_more_often(plan: RecordingPlan) -> None:
    assert {row.effect for row in plan.rows} == {*EFFECTS, LAW}
    for row in plan.rows:
        assert len(row.named) == len(SIZES)
        assert row.named[0] <= row.named[1] + 0.02 <= row.named[2] + 0.04
        assert set(row.hopeless) <= set(row.confused)


def test_less_noise_needs_less_time(plan: RecordingPlan) -> None:
    quiet = plan_recordings(TireModel(), replace(RIG, noise=1.0), 0.05)
    assert quiet.told[0] >= plan.told[0]
    assert quiet.seconds <= plan.seconds + 1e-9


def test_slow_triangles_at_each_other_pressure(plan: RecordingPlan) -> None:
    at_two = plan_recordings(TireModel(), replace(RIG, pressures=(2e5, 3e5)), 0.05)
    others = [d for d in at_two.drives if d.pressure != 2e5]
    assert {d.pressure for d in at_two.drives} == {2e5, 3e5}
    assert {d.name for d in others} == {"slow triangles"}
    assert at_two.seconds <= RIG.time
    assert file_name(7, others[0]) == "07_slow_triangles_flat_3bar.csv"
    assert HELD.name not in {row.effect for row in plan.rows}
    row = next(row for row in at_two.rows if row.effect == HELD.name)
    assert row.named[-1] > 0.9
    assert row.named[0] <= row.named[-1] + 1e-9
    assert not any(HELD.name in a.question.alternative for a in at_two.answers)


def test_its_content_is_json(plan: RecordingPlan) -> None:
    content = json.loads(json.dumps(plan.to_dict(), allow_nan=False))
    assert content["rig"]["surfaces"] == ["inf"]
    assert content["recordings"][0]["file"].startswith("01_")
    assert len(content["pairs"]) == plan.told[2]


def test_limits_without_any_motion_are_refused() -> None:
    with pytest.raises(TirelabError, match="no motion fits into these limits"):
        plan_recordings(TireModel(), replace(RIG, time=0.2))


def test_what_was_recorded_is_added_up(monkeypatch: pytest.MonkeyPatch) -> None:
    few_effects(monkeypatch, ("force_offset", "force_drift"))
    names = ("slow triangles", "triangles at three rates", "sweep")
    drives = [drive_of(name, 0.25, RIG.surfaces[0], RIG) for name in names]
    found = responses_of(drives, TireModel(), RIG, silent)
    options = offered(found, (), 1)
    assert options.seconds == (drives[0].duration,)
    assert options.recorded == pytest.approx(found.grams[1] + found.grams[2])
    assert (options.mixed, options.recorded_mixed) == ((False,), True)
