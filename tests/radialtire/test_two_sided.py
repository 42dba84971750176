"""Parts that are held at both ends: what pulls as it presses, and what a tire on the ground cannot do."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from driving import drive, values_of
from radialtire import (
    CATALOGUE,
    ParameterError,
    PowerLaw,
    TireFileError,
    TireModel,
    parameters_of,
    read_tire,
    with_parameters,
    write_tire,
)

TIME = np.linspace(0.0, 1.0, 81)
X = 0.02 * np.sin(2.0 * np.pi * TIME)
LAW = PowerLaw(200.0, 1.3)


def part(name: str = "", preload: float = 0.0, **changed: float) -> TireModel:
    effects = ((CATALOGUE[name], values_of(CATALOGUE[name], **changed)),) if name else ()
    return TireModel(LAW, effects, two_sided=True, preload=preload)


def test_it_pulls_as_it_presses_beside_its_preload() -> None:
    expected = 150.0 + 200.0 * np.sign(X) * np.abs(100.0 * X) ** 1.3
    assert drive(part(preload=150.0), TIME, X) == pytest.approx(expected, rel=1e-12, abs=1e-9)
    assert drive(TireModel(LAW), TIME, X).min() == 0.0


@pytest.mark.parametrize(
    ("name", "changed"),
    [
        ("series_compliance", {"compliance": 1e-6}),
        ("elastic_shape", {"bend": 0.05, "height_1": 0.1}),
        ("viscous_damping", {"damping": 300.0, "deflection_exponent": 0.5}),
    ],
)
def test_turned_round_it_has_the_force_turned_round(name: str, changed: dict[str, float]) -> None:
    tire = part(name, **changed)
    assert drive(tire, TIME, -X) == pytest.approx(-drive(tire, TIME, X), rel=1e-9, abs=1e-9)


def test_without_contact_to_lose_the_tangent_is_central() -> None:
    linear = TireModel(PowerLaw(200.0, 1.0), two_sided=True)
    assert linear.stiffness(0.0, float("inf"), linear.initial_state) == pytest.approx(2e4, rel=1e-6)


def test_a_tire_file_says_it(tmp_path: Path) -> None:
    write_tire(part(preload=-20.0), tmp_path / "part.json")
    assert read_tire(tmp_path / "part.json") == part(preload=-20.0)
    write_tire(TireModel(), tmp_path / "tire.json")
    assert "two_sided" not in (tmp_path / "tire.json").read_text()
    text = (tmp_path / "part.json").read_text().replace('"two_sided": true', '"two_sided": 1')
    (tmp_path / "wrong.json").write_text(text)
    with pytest.raises(TireFileError, match="two_sided must be true or false, not 1"):
        read_tire(tmp_path / "wrong.json")


def test_the_preload_is_a_parameter_of_such_a_part_alone() -> None:
    assert parameters_of(part(preload=5.0))["preload"][1] == 5.0
    assert with_parameters(part(), {"preload": 7.0}).preload == 7.0
    assert "preload" not in parameters_of(TireModel())
    with pytest.raises(ParameterError, match="preload = 5 N needs a two-sided part"):
        TireModel(preload=5.0)


def test_the_force_of_a_law_of_another_shape_is_continuous_at_no_deflection() -> None:
    """F = F0 + A x exp(c2 l^2 + h1) with l = ln(x / xr), held below xr / 100; h is h1 below 0.4 xr."""
    values = values_of(CATALOGUE["elastic_shape"], bend=0.01, reference=2e-4, height_1=0.05)
    shaped = ((CATALOGUE["elastic_shape"], values),)
    tire = TireModel(PowerLaw(1000.0, 1.0), shaped, two_sided=True, preload=10.0)
    x = np.array([-1e-5, -1e-10, 0.0, 1e-10, 1e-5])
    log_ratio = np.log(np.maximum(np.abs(x) / 2e-4, 0.01))
    expected = 10.0 + 1e5 * x * np.exp(0.01 * log_ratio**2 + 0.05)
    assert drive(tire, np.arange(5.0), x) == pytest.approx(expected, rel=1e-12)


def test_a_softened_part_is_soft_at_no_deflection_too() -> None:
    """Far below the largest deflection the fraction D (1 - exp(-1 / r)) of the force is lost."""
    tire = part("mullins_softening", preload=40.0, share=0.3, ratio=0.1)
    force = drive(tire, [0.0, 1.0, 2.0, 3.0], [0.0, 0.02, 1e-9, 0.0])
    kept = 1.0 - 0.3 * (1.0 - np.exp(-10.0))
    assert force[0] == pytest.approx(40.0, abs=1e-12)
    assert force[2:] == pytest.approx(40.0 * kept, rel=1e-3)


def test_a_pressure_multiplies_the_preload_of_a_gas_spring() -> None:
    """Gauge pressure over the reference one, where nothing but air carries."""
    effect = CATALOGUE["inflation_pressure"]
    values = (
        values_of(effect, casing_share=0.0)
        if "casing_share" in {p.name for p in effect.parameters}
        else effect.nominal
    )
    tire = TireModel(PowerLaw(1e-6, 1.0), ((effect, values),), two_sided=True, preload=200.0)
    single, double = (drive(tire, [0.0, 1.0], [0.0, 0.0], pressure=p)[-1] for p in (344.7e3, 689.4e3))
    assert double > 1.5 * single


@pytest.mark.parametrize(
    ("name", "changed"),
    [
        ("mullins_softening", {"share": 0.3}),
        ("warm_up", {"gain": 0.2, "time_constant": 20.0}),
        ("elastic_shape", {"bend": 0.05, "height_3": 0.1}),
        ("part_shape", {"lowest": -0.02, "highest": 0.02, "force_3": 40.0}),
        ("rate_independent_hysteresis", {"load_share": 0.1}),
        ("viscoelastic_relaxation", {"share_1": 0.3}),
    ],
)
def test_without_air_another_zero_of_the_load_cell_is_added_and_changes_nothing(
    name: str, changed: dict[str, float]
) -> None:
    def force(preload: float, *, inflated: bool) -> np.ndarray:
        return drive(replace(part(name, preload=preload, **changed), inflated=inflated), TIME, X)

    assert force(150.0, inflated=False) - 150.0 == pytest.approx(force(0.0, inflated=False), abs=1e-9)
    assert force(0.0, inflated=True) == pytest.approx(force(0.0, inflated=False), abs=1e-12)


def test_a_second_spring_that_sets_in_softly_has_begun_at_no_deflection() -> None:
    """K s ln(1 + exp((x - xb) / s)) on either side of 0."""
    tire = part("bottoming", preload=5.0, stiffness=1e5, onset=2e-3, softness=1e-3, power=1.0)
    x = np.array([-1e-9, 0.0, 1e-9])
    expected = 5.0 + 1e5 * 1e-3 * np.log1p(np.exp((x - 2e-3) / 1e-3))
    assert drive(tire, np.arange(3.0), x) == pytest.approx(expected, abs=1e-3)
