"""What a reader is told in ten seconds."""

from __future__ import annotations

from itertools import combinations
from typing import Any

import pytest
from first_screens import diagnosis
from radialtire import CATALOGUE
from tirelab.diagnosis.contradiction import Contradiction
from tirelab.report import first_screen


@pytest.mark.parametrize(
    ("sizes", "more", "told"),
    [
        ({}, {}, "Nothing is missing"),
        ({"rate_independent_hysteresis": 20.0}, {}, "Friction loop, 4 % of the load"),
        ({"rate_independent_hysteresis": None}, {}, "Friction loop"),
        ({"recalibration": 90.0}, {}, "No other physics shows: the law is refitted"),
        ({"recalibration": 90.0}, {"after": 9.1}, "The law is refitted, and more than the noise is left"),
        (
            {"recalibration": 90.0, "rate_independent_hysteresis": 20.0},
            {},
            "Friction loop, 4 % of the load; law refitted",
        ),
        (
            {"viscous_damping": 10.0, "rate_independent_hysteresis": 20.0},
            {},
            "Friction loop 4 % and viscous damping 2 % of the load",
        ),
        ({}, {"unexplained": True}, "Something unknown, 4 % of the load"),
        ({"inertia": 1.0}, {}, "Inertia, < 1 % of the load"),
        (
            {"inertia": 1.0},
            {"confidence": 0.4, "alternatives": [["force_lag"], []]},
            "Undecided: inertia, force lag or nothing missing",
        ),
        (
            {"inertia": 1.0},
            {"confidence": 0.4, "alternatives": [["inertia", "force_lag"]]},
            "Undecided: inertia or + force lag",
        ),
    ],
)
def test_headlines(sizes: dict[str, float | None], more: dict[str, Any], told: str) -> None:
    assert first_screen.headline(diagnosis(sizes, **more)) == told


@pytest.mark.parametrize("count", [1, 2, 3, 5])
@pytest.mark.parametrize("confidence", [0.95, 0.4])
def test_no_headline_is_longer_than_its_line(count: int, confidence: float) -> None:
    names = ["recalibration", *CATALOGUE]
    for chosen in combinations(names, count):
        others = [list(chosen[:i]) for i in range(4)]
        told = diagnosis(dict.fromkeys(chosen, 61.0), confidence, alternatives=others, unexplained=count == 2)
        line = first_screen.headline(told)
        assert 0 < len(line) <= 70, line
        assert "_" not in line


def test_alarm_is_where_something_is_wrong() -> None:
    def alarms(**errors: float | None) -> dict[str, str]:
        shown = first_screen.figures(diagnosis({"inertia": 9.0}, **errors))
        return {figure.title: figure.alarm for figure in shown if figure.alarm}

    assert alarms() == {}
    assert alarms(after=12.0) == {"Error after": "2.0 × the noise"}
    assert alarms(held_out_after=70.0) == {"Held-out": "worse than before"}
    assert alarms(held_out_before=None, held_out_after=None) == {}
    (error, *_) = first_screen.figures(diagnosis({}, unexplained=True))
    assert (error.title, error.alarm) == ("Error", "10 × the noise")


def test_the_errors_are_told_with_what_they_were() -> None:
    shown = {f.title: (f.value, f.note) for f in first_screen.figures(diagnosis({"inertia": 9.0}))}
    assert shown == {
        "Error before": (60.0, ""),
        "Error after": (6.1, ""),
        "Held-out": (6.2, "from 61.0 N"),
        "Noise floor": (6.0, ""),
    }


TEST = {
    "waveform": "sweep",
    "amplitude": 0.022,
    "rate_max": 0.25,
    "duration": 60.0,
    "surfaces": ["inf"],
    "between": [["inertia"], ["rate_independent_hysteresis"]],
}


@pytest.mark.parametrize(
    ("given", "reasons", "action"),
    [
        (diagnosis({"inertia": 9.0}), [], "Nothing: use this tire."),
        (diagnosis({}, before=6.0, after=6.0), [], "Nothing: use the baseline tire."),
        (
            diagnosis({"inertia": 9.0}, 0.6, alternatives=[[]], separating_test=TEST),
            [],
            "Record sweep to 22.0 mm on flat ground, at up to 250 mm/s, for 60 s.",
        ),
        (  # the least deflection of a smooth beginning is none
            diagnosis(
                {"inertia": 9.0}, 0.6, alternatives=[[]], separating_test={**TEST, "begins_at": 1.6e-9}
            ),
            [],
            "Record sweep to 22.0 mm on flat ground, at up to 250 mm/s, for 60 s.",
        ),
        (
            diagnosis(
                {"inertia": 9.0}, 0.6, alternatives=[[]], separating_test={**TEST, "begins_at": -0.005}
            ),
            [],
            "Record sweep from −5.0 to 22.0 mm on flat ground, at up to 250 mm/s, for 60 s.",
        ),
        (
            diagnosis({"inertia": 9.0}, 0.6, alternatives=[[]]),
            ["no hold: hold 10 s at 15 mm; one speed only: repeat at 30 mm/s"],
            "Hold 10 s at 15 mm.",
        ),
        (diagnosis({}, 0.95, unexplained=True), [], "Repeat one recording with another tire."),
        (diagnosis({"inertia": 9.0}, 0.95, after=30.0), [], "Repeat one recording with another tire."),
        (
            diagnosis({"inertia": 9.0}, 0.95, held_out_after=30.0),
            [],
            "Repeat one recording with another tire.",
        ),
        (diagnosis({"inertia": 9.0}, 0.95, held_out_after=None), [], "Nothing: use this tire."),
        (
            diagnosis({"inertia": 9.0}, 0.6, alternatives=[[]]),
            ["the difference is smaller than these recordings can show"],
            "Nothing: use this tire.",
        ),
    ],
)
def test_one_thing_to_do_next(given: dict[str, Any], reasons: list[str], action: str) -> None:
    step = first_screen.next_step(given, reasons)
    assert step.action == action
    assert step.drive == action.startswith("Record ")


def test_an_undecided_verdict_that_may_be_used_says_what_is_left() -> None:
    given = diagnosis({"inertia": 9.0}, 0.4, alternatives=[["force_lag"]], before=60.0, after=6.0)
    given["verdict"]["remainder"] = {"size": 0.9, "depends_on": [{"by": "deflection"}]}
    said = first_screen.next_step(given).why
    assert said.startswith(
        "The remainder, 0.9 times the noise, depends on the deflection. No motion of this rig"
    )


@pytest.mark.parametrize(
    ("sizes", "others", "headline", "action", "why"),
    [
        (
            {"inertia": 9.0},
            [["force_lag"]],
            "Undecided: inertia or force lag",
            "Nothing: use this tire.",
            "the corrected force is equally good with either.",
        ),
        (
            {"inertia": 9.0},
            [["force_lag"], ["viscous_damping"]],
            "Undecided: inertia, force lag or viscous damping",
            "Nothing: use this tire.",
            "the corrected force is equally good with any of them.",
        ),
        (
            {},
            [["force_offset"]],
            "Undecided: nothing missing or force offset",
            "Nothing: use the baseline tire.",
            "the baseline's force is equally good with either.",
        ),
    ],
)
def test_an_undecided_verdict_says_why_there_is_nothing_to_do(
    sizes: dict[str, float | None], others: list[list[str]], headline: str, action: str, why: str
) -> None:
    given = diagnosis(sizes, 0.4, alternatives=others, before=60.0 if sizes else 6.0, after=6.0)
    assert first_screen.headline(given) == headline
    step = first_screen.next_step(given)
    assert (step.action, step.why) == (
        action,
        f"No motion of this rig decides between the alternatives; {why}",
    )


def test_an_action_is_not_said_to_be_no_motion() -> None:
    step = first_screen.next_step(
        diagnosis({"inertia": 9.0}, 0.4, alternatives=[["force_lag"]]),
        ["they change slowly: repeat the first cycle after a rest"],
    )
    assert (step.action, step.why) == (
        "Repeat the first cycle after a rest.",
        "No other motion of this rig on these surfaces decides between the alternatives.",
    )


@pytest.mark.parametrize(
    ("between", "why"),
    [
        (
            [["inertia"], ["rate_independent_hysteresis"]],
            "It decides between inertia and friction loop.",
        ),
        ([["inertia"], ["inertia", "force_lag"]], "It decides whether the force lag acts too."),
        (
            [["inertia", "force_lag", "force_drift"], ["inertia"]],
            "It decides whether the force lag and the force drift act.",
        ),
        (
            [["inertia", "force_lag"], ["inertia", "saturation"]],
            "It decides between force lag and saturation.",
        ),
        ([[], ["saturation"]], "It decides whether the saturation acts."),
    ],
)
def test_what_a_recording_decides_is_told_by_what_differs(between: list[list[str]], why: str) -> None:
    test = {**TEST, "between": between}
    given = diagnosis({"inertia": 9.0}, 0.6, alternatives=[[]], separating_test=test)
    assert first_screen.next_step(given).why == why


def test_a_tire_that_can_be_used_tells_what_it_leaves_in_order() -> None:
    given = diagnosis({"inertia": 9.0}, 0.95)
    remainder = {"size": 0.8, "depends_on": [{"by": "rate"}, {"by": "time"}]}
    given["verdict"]["remainder"] = remainder
    step = first_screen.next_step(given)
    assert step.action == "Nothing: use this tire."
    assert step.why == "The remainder, 0.8 times the noise, depends on the rate of deflection and time."
    given["verdict"]["remainder"] = {**remainder, "depends_on": []}
    assert first_screen.next_step(given).why == ""


def test_a_recording_that_would_make_a_sure_verdict_surer_is_named() -> None:
    """Its file is written in any case."""
    given = diagnosis(
        {"inertia": 9.0}, 0.97, alternatives=[[]], separating_test={**TEST, "file": "drive.csv"}
    )
    step = first_screen.next_step(given)
    assert (step.action, step.why) == ("Nothing: use this tire.", "To be surer still, drive drive.csv.")


def test_an_effect_that_the_simulation_has_is_said_to_have_other_values() -> None:
    given = diagnosis({"inertia": 9.0}, 0.97)
    given["verdict"]["effects"][0]["in_baseline"] = True
    assert first_screen.headline(given) == "Inertia (other values), 2 % of the load"
    assert first_screen.lead(given).endswith(" The simulation has it, with other values.")


@pytest.mark.parametrize("name", ["b", "x" * 80])
def test_a_contradiction_comes_before_everything_else(name: str) -> None:
    given = diagnosis({"inertia": 9.0}, 0.97)
    one = Contradiction((name,), (), 2.0, 118.7)
    given["verdict"]["contradiction"] = one.to_dict()
    expected = "Recording b contradicts the others" if name == "b" else "The recordings contradict each other"
    assert first_screen.headline(given) == expected
    assert first_screen.lead(given) == one.finding
    assert first_screen.next_step(given).action == one.action


def test_samples_that_were_not_compared_are_told() -> None:
    given = diagnosis({}, 0.95)
    given["verdict"]["not_compared"] = [
        "In a the gauge is at the end of its travel; record with more travel."
    ]
    assert first_screen.lead(given).startswith("Where the gauges follow, the difference")
    assert first_screen.next_step(given).why == given["verdict"]["not_compared"][0]


def test_single_samples_that_stand_out_are_told() -> None:
    given = diagnosis({}, 0.95)
    given["fit"]["after"] = 1.6 * given["fit"]["noise"]
    assert first_screen.lead(given).startswith("Apart from single outliers, the difference")


def test_the_noise_of_the_reading_is_no_error_of_the_tire() -> None:
    """A mass of 15 kg multiplies the noise of a gauge; given the noise-free deflection the tire leaves the force's."""
    given = diagnosis({"inertia": 9.0}, 0.95)
    given["fit"] |= {
        "after": 24.0,
        "after_noise_free": 6.5,
        "held_out_after": 11.0,
        "held_out_noise_free": 9.8,
    }
    after, held_out = first_screen.figures(given)[1:3]
    assert (after.alarm, after.note) == ("", "6.50 N without the noise of the reading")
    assert held_out.alarm == "1.6 × the noise"
    given["fit"]["held_out_noise_free"] = 6.4
    assert first_screen.next_step(given).action == "Nothing: use this tire."
    given["fit"]["after_noise_free"] = None
    assert not first_screen.next_step(given).action.startswith("Nothing")


def test_what_is_unknown_is_not_called_nothing() -> None:
    test = {**TEST, "between": [[], ["saturation"]], "surfaces": [-0.6]}
    step = first_screen.next_step(
        diagnosis({}, 0.6, unexplained=True, alternatives=[[]], separating_test=test)
    )
    assert step.why == "It decides between something unknown and saturation."
    assert "on a concave surface of radius 60 cm, at" in step.action


@pytest.mark.parametrize(
    ("sure", "action"), [(0.4, "Hold 10 s at 15 mm."), (0.9, "Repeat one recording with ")]
)
def test_beside_alternatives_that_a_recording_tells_apart_the_unknown_asks_for_it(
    sure: float, action: str
) -> None:
    given = diagnosis({}, sure, unexplained=True, alternatives=[["viscoelastic_relaxation"]])
    step = first_screen.next_step(given, ["no hold: hold 10 s at 15 mm"])
    assert step.action.startswith(action)


def test_two_effects_are_told_in_two_sentences() -> None:
    said = first_screen.lead(diagnosis({"deflection_offset": 9.0, "viscous_damping": 8.0}))
    assert said == "The deflection's zero is shifted. The force grows with the speed of compression."
    long = first_screen.lead(diagnosis({"force_lag": 8.0, "rate_independent_hysteresis": 9.0}))
    assert long == f"{CATALOGUE['rate_independent_hysteresis'].statement.capitalize()}."


def test_actions_are_told_once() -> None:
    told = ["no hold: hold 10 s at 15 mm; one speed only: repeat at 30 mm/s", "no hold: hold 10 s at 15 mm"]
    assert first_screen.actions(told) == ["hold 10 s at 15 mm", "repeat at 30 mm/s"]
    assert first_screen.actions(["the recording has no time"]) == []


def test_confidence_is_told_in_words_and_as_a_number() -> None:
    assert first_screen.sureness({"confidence": 0.82}) == "Fairly sure: 82 %"
    assert first_screen.sureness({"confidence": 0.3}) == "One of several possibilities: 30 %"


@pytest.mark.parametrize(
    ("system", "simulation", "sizes", "action"),
    [
        ("C.ssp", "model.fmu", {"inertia": 9.0}, "Nothing: use C.ssp, which couples model.fmu with C.fmu."),
        (
            None,
            None,
            {"inertia": 9.0},
            "Nothing: add the output additional_force of C.fmu to the force of your simulation.",
        ),
        ("C.ssp", "model.fmu", {}, "Nothing: use model.fmu as it is."),
    ],
)
def test_beside_a_simulation_it_is_told_what_to_do_with_that(
    system: str | None, simulation: str | None, sizes: dict[str, float | None], action: str
) -> None:
    given = diagnosis(sizes) | {"correction": {"fmu": "C.fmu", "system": system, "simulation": simulation}}
    assert first_screen.next_step(given).action == action
    unknown = diagnosis({}, unexplained=True) | {"correction": given["correction"]}
    assert first_screen.next_step(unknown).action == "Repeat one recording with another part."
    assert "simulation" in first_screen.lead(
        diagnosis({"recalibration": 9.0}) | {"delivered": given["correction"]}
    )


@pytest.mark.parametrize("baseline", [{"two_sided": True}, {"inflated": False}])
def test_a_part_is_no_tire_whether_it_is_held_at_both_ends_or_loose(baseline: dict[str, bool]) -> None:
    unknown = diagnosis({}, 0.95, unexplained=True) | {"baseline_tire": baseline}
    assert first_screen.next_step(unknown).action == "Repeat one recording with another part."
    found = diagnosis({"inertia": 9.0}) | {"baseline_tire": baseline}
    assert first_screen.next_step(found).action == "Nothing: use this part."
