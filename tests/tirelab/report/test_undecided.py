"""What the first lines say where the recordings do not decide."""

from __future__ import annotations

from first_screens import diagnosis
from tirelab.report import first_screen


def test_where_the_recordings_cannot_decide_that_is_the_headline() -> None:
    doubtful = {"alternatives": [["viscous_damping"]]}
    assert first_screen.headline(diagnosis({"inertia": 9.0}, 0.49, **doubtful)).startswith("Undecided: ")
    assert first_screen.headline(diagnosis({"inertia": 9.0}, 0.51, **doubtful)).startswith("Inertia, ")
    assert "cannot decide" in first_screen.lead(diagnosis({"inertia": 9.0}, 0.49, **doubtful))


def test_what_is_sure_by_itself_leads_where_the_rest_is_undecided() -> None:
    told = diagnosis(
        {"viscoelastic_relaxation": 20.0, "recalibration": 5.0},
        0.1,
        alternatives=[
            ["viscoelastic_relaxation"],
            ["viscoelastic_relaxation", "inertia"],
            ["mullins_softening"],
        ],
    )
    first = told["verdict"]["effects"][0]
    first["probability"] = 0.97
    assert first_screen.headline(told) == "Relaxation; undecided: refitted law or inertia"
    told["verdict"]["effects"][1]["probability"] = 0.82
    assert first_screen.headline(told) == "Relaxation; more likely than not: refitted law"
    told["verdict"]["effects"][1]["probability"] = 0.1
    assert first_screen.lead(told).startswith("The force relaxes")
    assert "cannot decide what else acts" in first_screen.lead(told)
    assert "the likeliest one is shown" in first_screen.lead(told)
    told["verdict"]["alternative_details"] = [{"probability": None}, {"probability": 0.5}]
    assert "an alternative is likelier" in first_screen.lead(told)
    told["verdict"]["alternative_details"] = [{"probability": 0.3}]
    assert "no set of effects is likely" in first_screen.lead(told)
    first["probability"] = 0.6
    assert first_screen.headline(told).startswith("Undecided: relaxation + refitted law, ")


def test_an_effect_that_is_likely_leads_where_the_sets_are_too_long_for_a_line() -> None:
    """Sets of three or more effects each, of which a line of 70 characters holds one: it told a number of sets."""
    physics = ("inertia", "viscous_damping", "bottoming", "viscoelastic_relaxation")
    others = [["rate_independent_hysteresis", "series_compliance", name] for name in physics]
    told = diagnosis(
        {"force_lag": 20.0, "viscous_damping": 9.0, "recalibration": 2.0}, 0.2, alternatives=others
    )
    lag, damping, _ = told["verdict"]["effects"]
    lag["probability"], damping["probability"] = 0.57, 0.47
    assert first_screen.headline(told) == "Undecided; more likely than not: force lag"
    damping["probability"] = 0.52
    assert (
        first_screen.headline(told) == "Undecided; each more likely than not: force lag and viscous damping"
    )
    lag["probability"] = damping["probability"] = 0.4
    assert "likely" not in first_screen.headline(told)


def test_what_leaves_the_same_is_told_in_the_headline_where_it_is_half_as_likely() -> None:
    told = diagnosis({"deflection_lag": 20.0}, 0.58, alternatives=[["viscous_damping"], ["inertia"]])
    details = [{"probability": p, "same": same} for p, same in ((0.3, True), (0.05, False))]
    told["verdict"]["alternative_details"] = details
    assert first_screen.headline(told) == "Undecided: deflection lag or viscous damping"
    assert first_screen.lead(told) == (
        "These recordings cannot decide between the explanations; the likeliest one is shown."
    )
    details[0]["probability"] = 0.28
    assert first_screen.headline(told) == "Deflection lag, 4 % of the load"
