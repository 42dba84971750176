"""The force of a part with a curve is that of its points, at its own deflection, in every way it is computed."""

import json
from pathlib import Path

import numpy as np
import pytest
from radialtire import CATALOGUE, ParameterError, PowerLaw, TireFileError, TireModel
from radialtire.part_curve import PartCurve
from radialtire.tirefile import from_text, to_text
from tirelab import build_fmu, replay
from tirelab.errors import TirelabError
from tirelab.fmu.native.pack import build_native_fmu
from tirelab.recordings.recording import Recording
from tirelab.simulation.simulate import simulate

AT, FORCE = (-0.01, 0.0, 0.03), (-20.0, 40.0, 10.0)

PART = TireModel(
    law=PowerLaw(100.0, 1.0), two_sided=True, preload=5.0, inflated=False, curve=PartCurve(AT, FORCE)
)
"""10 N/mm beside the curve."""


def stroke() -> Recording:
    time = np.arange(400) / 100.0
    x = 0.01 + 0.025 * np.sin(2.0 * np.pi * time / 4.0)
    return Recording("stroke", time, x, np.full(400, np.inf), np.zeros(400))


def expected(x: np.ndarray) -> np.ndarray:
    return 5.0 + 1e4 * x + np.interp(x, AT, FORCE)


def test_it_is_added_to_preload_and_spring() -> None:
    part = stroke()
    np.testing.assert_allclose(simulate(PART, part), expected(part.deflection), rtol=1e-12, atol=1e-9)
    stepped = [PART.step(x, np.inf, 0.0, PART.initial_state)[0] for x in part.deflection.tolist()]
    np.testing.assert_allclose(stepped, expected(part.deflection), rtol=1e-12, atol=1e-9)


def test_it_is_over_the_deflection_of_the_part_and_its_friction_feels_it() -> None:
    offset = (CATALOGUE["deflection_offset"], (0.002,))
    moved = TireModel(PART.law, (offset,), two_sided=True, preload=5.0, curve=PART.curve)
    part = stroke()
    np.testing.assert_allclose(
        simulate(moved, part), expected(part.deflection + 0.002), rtol=1e-12, atol=1e-9
    )
    friction = CATALOGUE["rate_independent_hysteresis"]
    values = friction.checked(tuple(0.1 if p.name == "friction" else p.start for p in friction.parameters))
    rubbing = TireModel(PART.law, (offset, (friction, values)), two_sided=True, preload=5.0, curve=PART.curve)
    state, forces = rubbing.initial_state, []
    for t, x in zip(part.time.tolist(), part.deflection.tolist(), strict=True):
        force, state = rubbing.step(x, np.inf, t, state)
        forces.append(force)
    np.testing.assert_allclose(forces, simulate(rubbing, part), rtol=1e-10, atol=1e-9)


@pytest.mark.parametrize(
    ("name", "given"),
    [
        ("viscoelastic_relaxation", {"share_1": 0.3, "relaxation_time_1": 0.5}),
        ("rate_independent_hysteresis", {"load_share": 0.1}),
        ("mullins_softening", {"share": 0.3}),
        ("pressure_leak", {"rate": 0.05}),
    ],
)
def test_a_straight_curve_is_acted_on_as_the_spring_that_it_is(name: str, given: dict[str, float]) -> None:
    """Its force without a deflection, here 40 N, may be the zero of a load cell: nothing acts on that."""
    effect = CATALOGUE[name]
    values = effect.checked(tuple(given.get(p.name, p.start) for p in effect.parameters))
    assert set(given) <= {p.name for p in effect.parameters}
    spring = TireModel(
        PowerLaw(100.0, 1.0), ((effect, values),), two_sided=True, preload=40.0, inflated=False
    )
    line = PartCurve((-0.02, 0.05), (40.0 - 0.02 * 9e3, 40.0 + 0.05 * 9e3))
    curved = TireModel(PowerLaw(10.0, 1.0), spring.effects, two_sided=True, inflated=False, curve=line)
    part = stroke()
    bare = TireModel(PowerLaw(100.0, 1.0), two_sided=True, preload=40.0, inflated=False)
    assert np.ptp(simulate(spring, part) - simulate(bare, part)) > 5.0
    np.testing.assert_allclose(simulate(curved, part), simulate(spring, part), rtol=1e-9, atol=1e-9)
    state, forces = curved.initial_state, []
    for t, x in zip(part.time.tolist(), part.deflection.tolist(), strict=True):
        force, state = curved.step(x, np.inf, t, state)
        forces.append(force)
    np.testing.assert_allclose(forces, simulate(curved, part), rtol=1e-10, atol=1e-9)


def test_the_tangent_is_that_of_spring_and_curve() -> None:
    _, state = PART.step(0.01, np.inf, 0.0, PART.initial_state)
    assert PART.stiffness(0.01, np.inf, state) == pytest.approx(1e4 - 30.0 / 0.03, rel=1e-6)


def test_the_fmu_runs_it_and_the_native_one_refuses_it(tmp_path: Path) -> None:
    part = stroke()
    built = build_fmu(PART, tmp_path)
    np.testing.assert_allclose(replay(built.path, part), expected(part.deflection), rtol=1e-9, atol=1e-9)
    with pytest.raises(TirelabError, match="a part with a curve runs in the Python FMU only"):
        build_native_fmu(PART, tmp_path)


def test_a_part_without_one_has_no_word_of_it_in_its_file() -> None:
    assert from_text(to_text(PART)) == PART
    assert "curve" not in json.loads(to_text(TireModel(PowerLaw(), two_sided=True)))


@pytest.mark.parametrize(
    ("given", "match"),
    [
        ({"at": [0.02, 0.01, 0.03]}, "rising"),
        ({"at": [0.01]}, "two points"),
        ({"force": [1.0, float("nan"), 2.0]}, "finite"),
        ({"force": "many"}, "list of numbers"),
    ],
)
def test_a_wrong_one_is_refused(given: dict[str, object], match: str) -> None:
    content = json.loads(to_text(PART))
    content["curve"] |= given
    with pytest.raises((TireFileError, ParameterError), match=match):
        from_text(json.dumps(content))


def test_a_tire_on_the_ground_has_none() -> None:
    with pytest.raises(ParameterError, match="needs a two-sided part"):
        TireModel(curve=PartCurve(AT, FORCE))


def test_a_spring_in_series_gives_way_to_no_curve() -> None:
    """It would give way to the force of the power law beside the curve alone, which is not that of the part."""
    spring = CATALOGUE["series_compliance"]
    values = tuple(p.start for p in spring.parameters)
    both = TireModel(PART.law, ((spring, values),), two_sided=True, curve=PART.curve)
    with pytest.raises(TireFileError, match="gives way to the force of the law, not to that of a curve"):
        from_text(to_text(both))
