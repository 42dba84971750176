"""A learned remainder is its curve within the range of learning, nothing far outside, and never silently there."""

import json
from dataclasses import replace

import numpy as np
import pytest
from radialtire import CATALOGUE, ParameterError, PowerLaw, TireFileError, TireModel
from radialtire.learned_remainder import FADE, LearnedRemainder
from radialtire.tirefile import from_text, to_text

AT, FORCE = (0.01, 0.02, 0.04), (10.0, -20.0, 30.0)
LAW = PowerLaw(coefficient=1000.0, exponent=1.0)


def stepped(tire: TireModel, deflections: list[float], step: float = 0.01) -> list[float]:
    state, forces = tire.initial_state, []
    for k, x in enumerate(deflections):
        force, state = tire.step(x, np.inf, k * step, state)
        forces.append(force)
    return forces


def test_it_is_its_curve_inside_and_fades_to_nothing_outside() -> None:
    learned = LearnedRemainder("deflection", AT, FORCE)
    width = FADE * 0.03
    inside = np.linspace(0.01, 0.04, 31)
    np.testing.assert_allclose([learned.over(x) for x in inside], np.interp(inside, AT, FORCE), atol=1e-12)
    assert learned.over(0.01 - width / 2) == pytest.approx(5.0)
    assert learned.over(0.04 + width / 4) == pytest.approx(22.5)
    assert [learned.over(x) for x in (-1.0, 0.01 - 1.01 * width, 0.04 + 1.01 * width, 1.0)] == [0.0] * 4


def test_it_is_called_what_it_is_with_the_range_in_which_it_was_learned() -> None:
    learned = LearnedRemainder("deflection", AT, FORCE)
    said = str(learned)
    assert "no physics" in said
    assert f"from {learned.at[0]:.4g} to {learned.at[-1]:.4g}" in said


def test_it_is_added_to_the_force_of_law_and_effects() -> None:
    damping = CATALOGUE["viscous_damping"]
    xs = [0.008, 0.012, 0.02, 0.03, 0.05]
    for effects in ((), ((damping, damping.nominal),)):
        plain = TireModel(law=LAW, effects=effects)
        with_it = replace(plain, remainder=LearnedRemainder("deflection", AT, FORCE))
        added = np.subtract(stepped(with_it, xs), stepped(plain, xs))
        np.testing.assert_allclose(added, [10.0 / 3.0, 4.0 - 0.0 * 10.0, -20.0, 5.0, 0.0], atol=1e-9)


def test_over_the_force_it_is_over_that_of_its_law() -> None:
    learned = LearnedRemainder("force", (500.0, 2500.0), (0.0, 40.0), LAW)
    tire = TireModel(law=PowerLaw(coefficient=900.0, exponent=1.2), remainder=learned)
    plain = replace(tire, remainder=None)
    assert stepped(tire, [0.015])[0] - stepped(plain, [0.015])[0] == pytest.approx(20.0)


def test_over_the_rate_it_is_over_the_tracked_one() -> None:
    """A ramp of 0.1 m/s of exact readings, half way between 0 and 0.2 m/s."""
    tire = TireModel(law=LAW, remainder=LearnedRemainder("rate", (0.0, 0.2), (0.0, 60.0)))
    xs = (0.005 + 0.1 * 0.01 * np.arange(10)).tolist()
    added = np.subtract(stepped(tire, xs), [1e5 * x for x in xs])
    assert added[-1] == pytest.approx(30.0, rel=1e-6)


def test_the_tangent_is_that_of_the_force() -> None:
    tire = TireModel(law=LAW, remainder=LearnedRemainder("deflection", AT, FORCE))
    _, state = tire.step(0.03, np.inf, 0.0, tire.initial_state)
    assert tire.stiffness(0.03, np.inf, state) == pytest.approx(1e5 + 50.0 / 0.02, rel=1e-6)


@pytest.mark.parametrize(
    "learned",
    [LearnedRemainder("deflection", AT, FORCE), LearnedRemainder("force", (1.0, 2.0), (0.5, 0.25), LAW)],
    ids=["deflection", "force"],
)
def test_a_tire_file_keeps_it(learned: LearnedRemainder) -> None:
    tire = TireModel(remainder=learned)
    assert from_text(to_text(tire)) == tire
    assert "learned_remainder" not in json.loads(to_text(TireModel()))


@pytest.mark.parametrize(
    ("given", "match"),
    [
        ({"by": "time"}, "it is one of deflection"),
        ({"at": [0.02, 0.01]}, "rising"),
        ({"at": [0.01]}, "two points"),
        ({"force": [1.0, float("nan")]}, "finite"),
        ({"force": "many"}, "list of numbers"),
        ({"by": "force"}, "needs the law"),
        ({"law": {"name": "power_law"}}, "needs the law"),
    ],
)
def test_a_wrong_one_is_refused(given: dict[str, object], match: str) -> None:
    content = json.loads(to_text(TireModel()))
    content["learned_remainder"] = {"by": "deflection", "at": [0.01, 0.02], "force": [1.0, 2.0], **given}
    with pytest.raises((TireFileError, ParameterError), match=match):
        from_text(json.dumps(content))
