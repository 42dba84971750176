"""FMUs of others: their variables are told apart, and their forces are those of their equations."""

from __future__ import annotations

import math
import zipfile
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
import pytest
from drives import ride
from foreign_models import maxwell, spring_damper
from numpy.typing import NDArray
from radialtire import CATALOGUE, TireModel
from scipy.signal import lsim
from tirelab.errors import TirelabError
from tirelab.fmu.build import build_fmu
from tirelab.fmu.foreign import Simulation, parse_variables, read_foreign, tire_inside
from tirelab.fmu.foreign_replay import replay_foreign
from tirelab.fmu.native.pack import build_native_fmu

FORCE = {"force": "wheel_load"}


@dataclass(frozen=True)
class Moved:
    """A motion on flat ground."""

    time: NDArray[np.float64]
    deflection: NDArray[np.float64]

    @property
    def surface_radius(self) -> NDArray[np.float64]:
        return np.full(self.time.size, math.inf)


def silent(sentence: str) -> None:
    """Say nothing."""


@pytest.fixture(scope="module")
def motion() -> Moved:
    time, deflection, _ = ride(1, samples=600)
    return Moved(time, deflection)


@pytest.fixture(scope="module")
def spring(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return spring_damper(tmp_path_factory.mktemp("spring"))


@pytest.mark.parametrize("build", [build_fmu, build_native_fmu], ids=["python", "native"])
def test_the_tire_inside_our_own_is_read(build: object, tmp_path: Path) -> None:
    damping = CATALOGUE["viscous_damping"]
    tire = TireModel(effects=((damping, damping.nominal),), name="mine")
    assert callable(build)
    assert tire_inside(build(tire, tmp_path).path) == tire


def test_anybody_elses_has_no_tire_inside(spring: Path) -> None:
    assert tire_inside(spring) is None


def test_what_is_no_archive_is_refused(tmp_path: Path) -> None:
    (tmp_path / "a.fmu").write_text("text")
    for read in (tire_inside, lambda path: read_foreign(Simulation(path))):
        with pytest.raises(TirelabError, match="cannot be read as an FMU"):
            read(tmp_path / "a.fmu")
        with pytest.raises(TirelabError, match="does not exist"):
            read(tmp_path / "b.fmu")


def test_names_tell_the_variables_and_what_is_taken_is_said(spring: Path) -> None:
    with pytest.raises(TirelabError, match="which variable is the force") as refused:
        read_foreign(Simulation(spring))
    assert "outputs wheel_load, power; say it with --variables force=NAME" in str(refused.value)
    found = read_foreign(Simulation(spring, FORCE))
    assert (found.deflection.name, found.force.name, found.radius) == ("displacement", "wheel_load", None)
    (said,) = found.notes
    assert "displacement is taken for the deflection" in said
    assert "left at their start: temperature" in said


def test_units_that_a_name_ends_in_are_taken_and_those_that_nothing_says_are_si(
    spring: Path, tmp_path: Path
) -> None:
    found = read_foreign(Simulation(spring_damper(tmp_path, displacement="travel_mm", wheel_load="load_kN")))
    assert (found.deflection.unit, found.force.unit) == ("mm", "kN")
    assert found.deflection.factor == pytest.approx(1e-3, rel=1e-12)
    assert found.force.factor == pytest.approx(1e3, rel=1e-12)
    assert (
        "travel_mm is taken for the deflection [mm], its load_kN for the force [kN]; left" in found.notes[0]
    )
    silent_of_units = read_foreign(Simulation(spring, FORCE))
    assert (silent_of_units.deflection.unit, silent_of_units.force.unit) == ("", "")
    assert "SI where it states no unit" in silent_of_units.notes[0]


def test_a_word_that_is_a_unit_elsewhere_is_none(tmp_path: Path) -> None:
    """A rod of 5 m, and a dyne: the deflection of a rod, and a dynamic force, are SI."""
    named = {"deflection": "x_rod", "force": "load_dyn"}
    found = read_foreign(
        Simulation(spring_damper(tmp_path, displacement="x_rod", wheel_load="load_dyn"), named)
    )
    assert (found.deflection.factor, found.force.factor) == (1.0, 1.0)
    assert (found.deflection.unit, found.force.unit) == ("", "")


def test_one_force_beside_another_may_be_a_part_of_it(tmp_path: Path) -> None:
    with pytest.raises(TirelabError, match="which variable is the force") as refused:
        read_foreign(Simulation(spring_damper(tmp_path, wheel_load="spring_force", power="piston_force")))
    assert "More than one may be it: spring_force, piston_force" in str(refused.value)


def test_units_and_signs_are_taken_as_said(spring: Path) -> None:
    named = parse_variables('deflection="-displacement [mm]",force="wheel_load [kN]"')
    found = read_foreign(Simulation(spring, named))
    assert found.deflection.factor == pytest.approx(-1e-3, rel=1e-12)
    assert found.force.factor == pytest.approx(1e3, rel=1e-12)


@pytest.mark.parametrize(
    ("text", "match"),
    [
        ("force=weight", "no real output 'weight'"),
        ("deflection=weight,force=power", "no real input 'weight'"),
        ('force="wheel_load [mm]"', "is not a unit of force"),
        ("moment=power", "no variable of a simulation"),
    ],
)
def test_wrong_names_are_refused(spring: Path, text: str, match: str) -> None:
    with pytest.raises(TirelabError, match=match):
        read_foreign(Simulation(spring, parse_variables(text)))


def test_a_spring_damper_of_fmi_2(spring: Path, motion: Moved) -> None:
    said: list[str] = []
    force = replay_foreign(read_foreign(Simulation(spring, FORCE)), motion, "ride", 120.0, said.append)
    rate = np.append(0.0, np.diff(motion.deflection) / np.diff(motion.time))
    np.testing.assert_allclose(force, 1e5 * motion.deflection + 300.0 * rate, rtol=1e-9)
    assert said[0] == "replaying SpringDamper.fmu on ride: 0 %"


def test_units_and_signs_are_those_of_the_replay(spring: Path, motion: Moved) -> None:
    plain = replay_foreign(read_foreign(Simulation(spring, FORCE)), motion, "ride", 120.0, silent)
    named = parse_variables('deflection="-displacement [cm]",force="-wheel_load [kN]"')
    other = replay_foreign(read_foreign(Simulation(spring, named)), motion, "ride", 120.0, silent)
    np.testing.assert_allclose(other, 1e5 * plain, rtol=1e-9)


@pytest.mark.parametrize(("kind", "within"), [("CoSimulation", 2e-2), ("ModelExchange", 1e-4)])
def test_a_maxwell_element_of_fmi_3(kind: str, within: float, motion: Moved, tmp_path: Path) -> None:
    """q' = (k x - q) / tau in closed form between samples; the one for Co-Simulation takes Euler steps."""
    pytest.importorskip("pythonfmu3")
    fmu = read_foreign(Simulation(maxwell(tmp_path, kind)))
    assert (fmu.version, fmu.kind) == ("3.0", kind)
    force = replay_foreign(fmu, motion, "ride", 120.0, silent)
    slow = lsim(([2e4], [0.5, 1.0]), motion.deflection, motion.time)[1]
    error = force - (1e5 * motion.deflection - slow)
    assert np.max(np.abs(error)) < within * np.max(np.abs(slow))


def test_uneven_times_for_an_fmu_of_even_steps(spring: Path, motion: Moved) -> None:
    fmu = replace(read_foreign(Simulation(spring, FORCE)), even_steps=True)
    step = float(np.median(np.diff(motion.time)))
    shaken = motion.time + 0.2 * step * np.random.default_rng(1).uniform(-1.0, 1.0, motion.time.size)
    still = Moved(shaken, 0.01 + 0.02 * shaken)
    force = replay_foreign(fmu, still, "ride", 120.0, silent)
    np.testing.assert_allclose(force[2:], (1e5 * still.deflection + 300.0 * 0.02)[2:], rtol=1e-9)


@pytest.mark.parametrize(
    ("misbehave", "match"),
    [
        ("raise ValueError('no such load')", r"failed .*; its last message: .*no such load"),
        (
            "print('solving', flush=True); time.sleep(60)",
            r"was ended after 4 s .*; its last message: solving",
        ),
        (
            "import os; print('bad pivot', flush=True); os.abort()",
            r"signal 6\) on ride; its last message: bad pivot",
        ),
        ("self.wheel_load = float('nan'); return True", "gives no number for ride at"),
    ],
    ids=["fails", "hangs", "crashes", "nan"],
)
def test_one_that_fails_is_ended_with_its_last_message(
    misbehave: str, match: str, motion: Moved, tmp_path: Path
) -> None:
    fmu = read_foreign(Simulation(spring_damper(tmp_path, misbehave), FORCE))
    with pytest.raises(TirelabError, match=match):
        replay_foreign(fmu, motion, "ride", 4.0 if "sleep" in misbehave else 120.0, silent)


def test_one_without_a_binary_for_this_machine_is_refused(spring: Path, tmp_path: Path) -> None:
    stripped = tmp_path / "stripped.fmu"
    with zipfile.ZipFile(spring) as old, zipfile.ZipFile(stripped, "w") as new:
        for name in old.namelist():
            if not name.startswith("binaries/"):
                new.writestr(name, old.read(name))
    with pytest.raises(TirelabError, match="no binary for this machine"):
        read_foreign(Simulation(stripped, FORCE))


@pytest.mark.slow
@pytest.mark.parametrize("kind", ["CoSimulation", "ModelExchange"])
def test_one_that_a_package_ships(kind: str, shipped: Path, motion: Moved) -> None:
    named = parse_variables('deflection="u1 [cm]",force="y [kN]"')
    fmu = replace(read_foreign(Simulation(shipped, named)), kind=kind)
    assert "OpenModelica" in fmu.notes[0]
    force = replay_foreign(fmu, motion, "ride", 300.0, silent)
    np.testing.assert_allclose(force, 1e5 * motion.deflection, rtol=1e-9)
