"""Inputs beside the motion: the pressure and the temperature of both kinds of FMU; and parts that pull."""

from __future__ import annotations

from pathlib import Path

import fmpy
import numpy as np
import pytest
from native_me import RADIAL_FORCE, Unit
from numpy.typing import NDArray
from radialtire import CATALOGUE, PowerLaw, TireModel
from sampled_motion import Motion
from tirelab.errors import TirelabError
from tirelab.fmu.build import build_fmu
from tirelab.fmu.native.pack import build_native_fmu
from tirelab.fmu.replay import replay
from tirelab.simulation.simulate import simulate

FloatArray = NDArray[np.float64]
KINDS = pytest.mark.parametrize("native", [False, True], ids=["python", "native"])


def motion(low: float = -0.002, high: float = 0.025, **measured: FloatArray) -> Motion:
    time = 2.0 + 0.01 * np.arange(300)
    x = low + (high - low) * 0.5 * (1.0 - np.cos(5.0 * time))
    return Motion(time, x, np.full(time.size, np.inf), measured)


def tire_with(name: str, *values: float) -> TireModel:
    effect = CATALOGUE[name]
    rest = tuple(p.start for p in effect.parameters[len(values) :])
    return TireModel(effects=((effect, (*values, *rest)),))


def built(tire: TireModel, folder: Path, *, native: bool) -> Path:
    return build_native_fmu(tire, folder).path if native else build_fmu(tire, folder).path


@KINDS
def test_the_pressure_is_an_input_that_starts_at_the_reference(tmp_path: Path, native: bool) -> None:
    fmu = built(tire_with("inflation_pressure", 0.8, 2.5e5), tmp_path, native=native)
    found = {v.name: v for v in fmpy.read_model_description(fmu).modelVariables}
    one = found["inflation_pressure"]
    assert (one.causality, one.unit, float(one.start)) == ("input", "Pa", 2.5e5)
    # at the reference, whoever leaves it alone, the force is that of the bare law: 0.8 of 0 more
    assert np.array_equal(replay(fmu, motion()), simulate(TireModel(), motion()))


@KINDS
def test_a_measured_pressure_is_replayed(tmp_path: Path, native: bool) -> None:
    tire = tire_with("inflation_pressure", 0.8, 2.5e5)
    time = motion().time
    pressed = motion(pressure=2.0e5 + 3e4 * (time - time[0]))
    # 1 + pFz1 dp of MF-Tyre 6.1, typed a second time
    expected = simulate(TireModel(), motion()) * (1.0 + 0.8 * (pressed.measured["pressure"] / 2.5e5 - 1.0))
    assert replay(built(tire, tmp_path, native=native), pressed) == pytest.approx(expected, rel=1e-12)


@KINDS
def test_a_tire_warms_with_time_until_its_temperature_is_known(tmp_path: Path, native: bool) -> None:
    tire = tire_with("warm_up", 0.1, 5.0)
    fmu = built(tire, tmp_path, native=native)
    bare, t = simulate(TireModel(), motion()), motion().time
    # time - step + step is rounded once more on its way through the FMI
    assert replay(fmu, motion()) == pytest.approx(bare * (1.0 - 0.1 * np.expm1(-(t - t[0]) / 5.0)), rel=1e-9)
    warm = 290.0 + 4.0 * (t - t[0])
    assert replay(fmu, motion(temperature=warm)) == pytest.approx(
        bare * (1.0 + 0.1 * (warm - 290.0) / 10.0), rel=1e-12
    )


@KINDS
def test_a_pressure_that_cannot_be_is_refused(tmp_path: Path, native: bool) -> None:
    fmu = built(tire_with("inflation_pressure", 0.8), tmp_path, native=native)
    for wrong in (1e9, np.nan):
        with pytest.raises(TirelabError, match=r"refused sample 0 .*inflation_pressure = .* is not allowed"):
            replay(fmu, motion(pressure=np.full(300, wrong)))


def test_a_tire_that_reads_no_channel_has_the_variables_it_had(tmp_path: Path) -> None:
    fmu = built(TireModel(), tmp_path, native=False)
    names = [v.name for v in fmpy.read_model_description(fmu).modelVariables if v.causality == "input"]
    assert names == ["deflection", "surface_radius"]


@KINDS
def test_a_part_that_is_held_at_both_ends_pulls(tmp_path: Path, native: bool) -> None:
    part = TireModel(PowerLaw(200.0, 1.3), two_sided=True)
    both = motion(low=-0.02)
    expected = 200.0 * np.sign(both.deflection) * np.abs(100.0 * both.deflection) ** 1.3
    fmu = built(part, tmp_path, native=native)
    assert replay(fmu, both) == pytest.approx(expected, rel=1e-12, abs=1e-12)


@KINDS
def test_a_part_has_no_wheel_beyond_whose_radius_it_could_not_go(tmp_path: Path, native: bool) -> None:
    """An isolator of half a metre to either side; of a tire 0.33 m is the most."""
    part = TireModel(PowerLaw(40.0, 1.0), two_sided=True, inflated=False, tested_range=None)
    both = motion(low=-0.5, high=0.5)
    fmu = built(part, tmp_path, native=native)
    assert replay(fmu, both) == pytest.approx(4e3 * both.deflection, rel=1e-12, abs=1e-12)
    variables = {v.name: v for v in fmpy.read_model_description(fmu).modelVariables}
    assert float(variables["deflection"].max) == 1000.0


@KINDS
def test_every_effect_acts_on_a_part_that_pulls_as_it_is_simulated(tmp_path: Path, native: bool) -> None:
    effects = tuple((e, e.nominal) for e in CATALOGUE.values() if e.name != "force_lag")
    part = TireModel(PowerLaw(200.0, 1.3), effects, two_sided=True)
    both = motion(low=-0.02, pressure=np.linspace(2e5, 4e5, 300), temperature=np.linspace(290.0, 300.0, 300))
    force = simulate(part, both)
    found = replay(built(part, tmp_path, native=native), both)
    assert force.min() < -100.0
    assert np.max(np.abs(found - force)) < 1e-8 * np.max(np.abs(force))


def test_a_solver_is_told_how_the_force_depends_on_the_pressure(tmp_path: Path) -> None:
    """dF/dp = g F0 / p0 of F = F0 (1 + g (p / p0 - 1)), by the directional derivative of Model Exchange."""
    fmu = built(tire_with("inflation_pressure", 0.8, 2.5e5), tmp_path, native=True)
    fmpy.extract(str(fmu), str(tmp_path / "unpacked"))
    unit = Unit(tmp_path / "unpacked", (0.02, 1e5, 2.0e5))
    reference = unit.names["inflation_pressure"]
    bare = 550.9 * 2.0**1.422
    assert unit.get() == pytest.approx(bare * (1.0 + 0.8 * (2.0 / 2.5 - 1.0)), rel=1e-12)
    assert unit.derivative(RADIAL_FORCE, [reference], [1.0]) == pytest.approx(0.8 * bare / 2.5e5, rel=1e-6)
