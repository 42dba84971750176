"""The FMU as its host sees it: numbers, states and refusals, in a process that cannot import the project."""

from __future__ import annotations

import math
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from radialtire import PowerLaw, TireModel, read_tire
from radialtire.effects import CATALOGUE
from tirelab.fmu.build import build_fmu
from tirelab.fmu.native.pack import build_native_fmu

Run = Callable[..., Any]
FLAT = 1e5


def article_force(x_cm: float, radius_cm: float) -> float:
    """Equations 2, 5 and 6 typed a second time, from the print, with x and Rb in cm."""
    if x_cm <= 0:
        return 0.0
    if math.isinf(radius_cm) or abs(radius_cm) >= 1e7:
        a, b = 550.9, 1.422
    elif radius_cm > 0:
        a = 550.9 - 337.8 * math.e ** (-0.2519 * radius_cm)
        b = 1.422 - 0.2469 * math.e ** (-0.1651 * radius_cm)
    else:
        a = 550.9 + 7822.0 * math.e ** (0.1398 * radius_cm)
        b = 1.422 + 0.2128 * math.e ** (0.0289 * radius_cm)
    return a * math.exp(b * math.log(x_cm))


# 16 digits through exp and pow, each good to 1 ulp: 1e-12 leaves three decades for either formulation.
TOLERANCE = 1e-12


def test_force_on_a_grid_of_ten_thousand_points(run_fmpy: Run, article_fmu: Path) -> None:
    rng = np.random.default_rng(1996)
    deflections = rng.uniform(-0.005, 0.032, 10_000)
    magnitude = 10 ** rng.uniform(-2, 1, 10_000)
    radii = np.where(rng.random(10_000) < 0.5, magnitude, -np.maximum(magnitude, 0.34))
    radii[::50] = np.inf
    calls: list[list[object]] = []
    for i, (x, R) in enumerate(zip(deflections, radii, strict=True)):
        calls += [[0, "set", {"deflection": x, "surface_radius": R}], [0, "step", 0.1 * i, 0.1]]
        calls += [[0, "get", ["radial_force"]]]
    forces = [answer[0] for answer in run_fmpy([article_fmu], calls)[2::3]]
    expected = [article_force(100 * x, 100 * R) for x, R in zip(deflections, radii, strict=True)]
    np.testing.assert_allclose(forces, expected, rtol=TOLERANCE, atol=0)


CONVEX_CM = (1.27, 2.54, 3.81, 5.08, 7.62, 12.7, 19.05, 25.4, 38.1, 58.4)
CONCAVE_CM = (-38.1, -50.8, -58.4)


@pytest.mark.parametrize("radius_cm", [*CONVEX_CM, math.inf, *CONCAVE_CM])
def test_triangle_test_of_the_article(run_fmpy: Run, article_fmu: Path, radius_cm: float) -> None:
    top = 3.175
    while article_force(top, radius_cm) > 2240:
        top -= 0.001
    time = np.arange(0, 30, 0.2)
    deflection_cm = top * (1 - np.abs(time / 15 - 1))
    calls: list[list[object]] = []
    for t, x in zip(time, deflection_cm, strict=True):
        calls += [[0, "set", {"deflection": x / 100, "surface_radius": radius_cm / 100}]]
        calls += [[0, "step", t, 0.2], [0, "get", ["radial_force", "in_tested_range"]]]
    answers = run_fmpy([article_fmu], calls)[2::3]
    expected = [article_force(100 * (x / 100), 100 * (radius_cm / 100)) for x in deflection_cm]
    np.testing.assert_allclose([force for force, _ in answers], expected, rtol=TOLERANCE, atol=0)
    assert max(expected) <= 2240
    assert all(inside for _, inside in answers)


def test_a_get_after_a_set_without_a_step_gives_the_new_value(run_fmpy: Run, either_fmu: Path) -> None:
    calls: list[list[object]] = [[0, "set", {"deflection": 0.01}], [0, "step", 0.0, 0.1]]
    calls += [[0, "set", {"deflection": 0.02}]]
    answers = run_fmpy([either_fmu], [*calls, [0, "get", ["radial_force", "radial_stiffness"]]])
    assert answers[-1][0] == pytest.approx(article_force(2.0, math.inf), rel=TOLERANCE)
    assert answers[-1][1] == pytest.approx(100 * 550.9 * 1.422 * 2.0**0.422, rel=TOLERANCE)


def test_a_parameter_can_be_set(run_fmpy: Run, either_fmu: Path) -> None:
    """With the second reading of E0 the secant on the 1.27 cm bump is the article's 2.3e4 N/m (2.36e4)."""
    name = "law.convex_coefficient_decay"
    calls = [
        [0, "set", {name: 0.02519, "deflection": 0.0127, "surface_radius": 0.0127}],
        [0, "step", 0.0, 0.1],
    ]
    answers = run_fmpy([either_fmu], [*calls, [0, "get", ["radial_force", name]]])
    assert answers[-1][0] / 0.0127 == pytest.approx(2.36e4, abs=50)
    assert answers[-1][1] == 0.02519


@pytest.mark.parametrize(
    ("inputs", "words"),
    [
        ({"deflection": math.nan}, ["deflection", "nan", "0.33"]),
        ({"deflection": math.inf}, ["deflection", "inf", "0.33"]),
        ({"deflection": 22.0}, ["deflection", "22", "0.33"]),
        ({"surface_radius": 0.0}, ["surface_radius", "0", "infinite"]),
        ({"surface_radius": math.nan}, ["surface_radius", "nan", "infinite"]),
        ({"law.flat_exponent": -1.0}, ["law.flat_exponent", "-1", "between 0.1 and 10"]),
        ({"law.flat_coefficient": math.nan}, ["law.flat_coefficient", "nan", "between"]),
        ({"law.convex_coefficient_drop": 600.0}, ["law.convex_coefficient_drop", "600", "less than"]),
    ],
)
def test_bad_input_is_an_error_with_one_message_and_the_unit_goes_on(
    run_fmpy: Run, either_fmu: Path, inputs: dict[str, float], words: list[str]
) -> None:
    good = {
        "deflection": 0.02,
        "surface_radius": FLAT,
        "law.flat_exponent": 1.422,
        "law.flat_coefficient": 550.9,
    }
    good["law.convex_coefficient_drop"] = 337.8
    step_and_get = [[0, "step", 0.0, 0.1], [0, "get", ["radial_force"]]]
    calls = [[0, "set", inputs], *step_and_get, [0, "set", good], *step_and_get]
    _, refused, _, _, accepted, force = run_fmpy([either_fmu], calls)
    assert refused["status"] == 3  # fmi2Error: after fmi2Discard masters try the same step again for ever
    assert len(refused["messages"]) == 1
    for word in words:
        assert word in refused["messages"][0][1]
    assert accepted is None
    assert force[0] == pytest.approx(article_force(2.0, math.inf), rel=TOLERANCE)


@pytest.mark.parametrize(
    ("time", "width", "words"),
    [
        (1.0, -0.5, ["communicationStepSize", "-0.5"]),
        (1.0, math.nan, ["communicationStepSize", "nan"]),
        (1.0, math.inf, ["communicationStepSize", "inf"]),
        (2.0, 0.5, ["currentCommunicationPoint = 2 s", "it must be 1 s"]),
        (0.0, 0.5, ["currentCommunicationPoint = 0 s", "it must be 1 s"]),
        (math.nan, 0.5, ["currentCommunicationPoint = nan s"]),
    ],
)
def test_a_step_of_no_length_or_from_elsewhere_is_refused(
    run_fmpy: Run, either_fmu: Path, time: float, width: float, words: list[str]
) -> None:
    _, _, refused, accepted = run_fmpy(
        [either_fmu],
        [
            [0, "set", {"deflection": 0.01}],
            [0, "step", 0.0, 1.0],
            [0, "step", time, width],
            [0, "step", 1.0, 0.5],
        ],
    )
    assert refused["status"] == 3
    for word in words:
        assert word in refused["messages"][0][1]
    assert accepted is None


def test_a_time_that_was_added_up_is_not_taken_for_a_jump(run_fmpy: Run, either_fmu: Path) -> None:
    """Ten times 0.1 is not 1; of a thousand steps the host's own sum is 1e-13 off."""
    calls: list[list[object]] = [[0, "step", 0.1 * i, 0.1] for i in range(1000)]
    assert run_fmpy([either_fmu], calls) == [None] * 1000


@pytest.mark.parametrize("name", ["radial_force", "radial_stiffness"])
def test_an_output_cannot_be_set(run_fmpy: Run, either_fmu: Path, name: str) -> None:
    refused, stepped = run_fmpy([either_fmu], [[0, "set", {name: 1.0}], [0, "step", 0.0, 0.1]])
    assert refused["status"] == 3
    assert refused["messages"] == [[3, f"{name} = 1 cannot be set; set inputs and parameters only"]]
    assert stepped is None


def test_two_tires_in_one_process_give_two_forces(run_fmpy: Run, article_fmu: Path, tmp_path: Path) -> None:
    other = build_fmu(TireModel(law=PowerLaw(718.5, 1.4), name="Wang & Hull"), tmp_path).path
    calls: list[list[object]] = []
    for number in (0, 1):
        calls += [[number, "set", {"deflection": 0.02}], [number, "step", 0.0, 0.1]]
    calls += [[0, "get", ["radial_force"]], [1, "get", ["radial_force"]]]
    answers = run_fmpy([article_fmu, other], calls)
    assert answers[-2][0] == pytest.approx(550.9 * 2**1.422, rel=TOLERANCE)
    assert answers[-1][0] == pytest.approx(718.5 * 2**1.4, rel=TOLERANCE)


@pytest.fixture(scope="module", params=[build_fmu, build_native_fmu], ids=["Python", "native"])
def friction_fmu(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A tire whose force depends on its history."""
    friction = CATALOGUE["rate_independent_hysteresis"]
    values = tuple({"slip_force": 50.0, "reach": 1e-3}.get(p.name, p.start) for p in friction.parameters)
    tire = TireModel(effects=((friction, values),))
    path: Path = request.param(tire, tmp_path_factory.mktemp("friction")).path
    return path


def test_states_of_effects_are_saved_and_restored(run_fmpy: Run, friction_fmu: Path) -> None:
    def to(deflection: float, t: float) -> list[list[object]]:
        return [[0, "set", {"deflection": deflection}], [0, "step", t, 0.1], [0, "get", ["radial_force"]]]

    up = [*to(0.01, 0.0), *to(0.02, 0.1), [0, "save"]]
    there = [*to(0.018, 0.2), *to(0.02, 0.3)]
    answers = run_fmpy([friction_fmu], [*up, *there, [0, "restore"], [0, "get", ["radial_force"]], *there])
    at_save, first, restored, second = answers[5][0], answers[7:13], answers[14][0], answers[15:21]
    assert restored == at_save
    assert first == second
    assert first[-1][0] != at_save  # the loop did not close: the history counts


def test_friction_loop_through_the_fmu(run_fmpy: Run, friction_fmu: Path) -> None:
    """Far from a reversal the force is the law's plus or minus the slip force; S = 50 N, reach 1 mm."""
    path = [*np.linspace(0, 0.025, 26), *np.linspace(0.025, 0, 26)]
    calls: list[list[object]] = []
    for k, x in enumerate(path):
        calls += [[0, "set", {"deflection": x}], [0, "step", 0.1 * k, 0.1], [0, "get", ["radial_force"]]]
    forces = [answer[0] for answer in run_fmpy([friction_fmu], calls)[2::3]]
    law = article_force(1.2, math.inf)
    # 12 reaches after the reversal exp(-12) of 100 N is left: 6e-4 N
    assert forces[12] - law == pytest.approx(50.0, abs=1e-3)
    assert forces[26 + 13] - law == pytest.approx(-50.0, abs=1e-3)


def test_the_noise_of_the_reading_can_be_set_and_its_history_restored(run_fmpy: Run, tmp_path: Path) -> None:
    """10 kg on x = 10 mm + 0.5 a t^2: once nothing is taken for noise, 10 a beside the law's force."""
    tire = TireModel(effects=((CATALOGUE["inertia"], (10.0,)),), reading_noise=1e-4)
    fmu = build_fmu(tire, tmp_path).path
    a = 0.5

    def moved(first: int, last: int) -> list[list[object]]:
        calls: list[list[object]] = []
        for k in range(first, last):
            calls += [
                [0, "set", {"deflection": 0.01 + 0.5 * a * (0.01 * k) ** 2}],
                [0, "step", 0.01 * k, 0.01],
            ]
        return [*calls, [0, "get", ["radial_force"]]]

    set_to_nothing: list[object] = [0, "set", {"reading_noise": 0.0}]
    (exact,) = run_fmpy([fmu], [set_to_nothing, *moved(0, 40)])[-1]
    # the filter of exact readings follows a constant acceleration; what it starts from fades within ten readings
    assert exact - article_force(1.0 + 50.0 * a * 0.39**2, math.inf) == pytest.approx(10.0 * a, rel=1e-6)

    answers = run_fmpy([fmu], [*moved(0, 20), [0, "save"], *moved(20, 40), [0, "restore"], *moved(20, 40)])
    assert answers[-1] == answers[40 + 1 + 1 + 40]
    assert answers[-1][0] != exact


def test_reset_forgets_inputs_and_history(run_fmpy: Run, friction_fmu: Path) -> None:
    calls = [
        [0, "set", {"deflection": 0.02}],
        [0, "step", 0.0, 0.1],
        [0, "reset"],
        [0, "get", ["radial_force"]],
    ]
    assert run_fmpy([friction_fmu], calls)[-1] == [0.0]


def test_without_the_loader_the_fmu_runs_in_python_hosts(run_fmpy: Run, tmp_path: Path) -> None:
    fmu = build_fmu(TireModel(), tmp_path, with_loader=False).path
    answers = run_fmpy([fmu], [[0, "set", {"deflection": 0.01}], [0, "get", ["radial_force"]]])
    assert answers[-1][0] == pytest.approx(550.9, rel=TOLERANCE)


def test_tested_range_is_the_articles(run_fmpy: Run, either_fmu: Path) -> None:
    def inside(deflection: float, radius: float) -> bool:
        calls = [
            [0, "set", {"deflection": deflection, "surface_radius": radius}],
            [0, "get", ["in_tested_range"]],
        ]
        return bool(run_fmpy([either_fmu], calls)[-1][0])

    assert inside(0.025, math.inf)
    assert inside(-0.01, math.inf)
    assert inside(0.0127, 0.0127)
    assert not inside(0.0127, 0.0126)
    assert not inside(0.01, -0.37)
    assert not inside(0.032, 0.0127)  # deeper than 3.175 cm
    assert not inside(0.030, math.inf)  # 2628 N, above 2240 N


@pytest.mark.parametrize(
    "name", ["hull1996", "hull1996_second_reading", "wang_hull_off_road", "wang_hull_road"]
)
def test_tires_of_the_examples_build(run_fmpy: Run, repository: Path, tmp_path: Path, name: str) -> None:
    tire = read_tire(repository / "examples" / "tires" / f"{name}.json")
    fmu = build_fmu(tire, tmp_path).path
    answers = run_fmpy([fmu], [[0, "set", {"deflection": 0.01}], [0, "get", ["radial_force"]]])
    expected = {"wang_hull_off_road": 718.5, "wang_hull_road": 1500.0}.get(name, 550.9)
    assert answers[-1][0] == pytest.approx(expected, rel=TOLERANCE)
