"""OpenModelica's compiler imports the native FMU, checks the blocks of examples/modelica, and simulates with them.

Its `omc` is in neither PyPI, Debian nor npm. It is looked for on PATH and in OPENMODELICAHOME/bin; the tests are
skipped where it is in neither.
"""

from __future__ import annotations

import csv
import os
import shutil
import subprocess
from pathlib import Path
from typing import NamedTuple

import numpy as np
import pytest
from numpy.typing import NDArray
from radialtire import CATALOGUE, TireModel
from radialtire.hull1996 import Hull1996
from scipy.integrate import solve_ivp
from tirelab.fmu.native.pack import build_native_fmu

Columns = dict[str, NDArray[np.float64]]

BLOCKS = Path("examples", "modelica")
TOLERANCE = 1e-8
"""Of the solver, relative."""

STATES = 'setCommandLineOptions("--allowNonStandardModelica=reinitInAlgorithms");'
"""What the class that importFMU writes needs where the FMU has continuous states."""

DRIVEN = """
model Driven "A sine, out of contact and back, on flat, then on convex and on concave ground"
  {block} tire{modifiers};
  constant Real omega = 4 * Modelica.Constants.pi;
equation
  tire.deflection = 0.004 + 0.006 * sin(omega * time);
  tire.surface_radius = if time < 0.5 then 1e5 elseif time < 1 then 0.254 else -0.381;
  {equations}
end Driven;
"""
FALLING = """
model Falling "3 kg fall from 5 mm onto the tire, on flat ground"
  {block} tire{modifiers};
  Real x(start = -0.005, fixed = true);
  Real v(start = 0, fixed = true);
equation
  der(x) = v;
  3 * der(v) = 3 * 9.81 - tire.radial_force;
  tire.deflection = x;
  tire.surface_radius = 1e5;
  {equations}
end Falling;
"""
MOTION = """
  tire.deflection_rate = 0.006 * omega * cos(omega * time);
  tire.deflection_acceleration = -0.006 * omega ^ 2 * sin(omega * time);
"""


class Case(NamedTuple):
    """A tire, the block for it, and what the block is given: modifiers, or equations for more inputs."""

    tire: TireModel
    block: str = "BicycleTireOM"
    modifiers: str = ""
    equations: str = ""


def tire_with(**effects: dict[str, float]) -> TireModel:
    acting = tuple(
        (CATALOGUE[name], tuple(given.get(p.name, p.start) for p in CATALOGUE[name].parameters))
        for name, given in effects.items()
    )
    return TireModel(effects=acting)


def compiler() -> str:
    """Return the program omc."""
    home = os.environ.get("OPENMODELICAHOME")
    found = shutil.which("omc") or (shutil.which("omc", path=str(Path(home, "bin"))) if home else None)
    if found is None:
        pytest.skip(
            "omc is neither on PATH nor in OPENMODELICAHOME/bin; openmodelica.org has it for some systems"
        )
    return found


def told(script: Path, folder: Path) -> str:
    """Run a script of omc in a folder; return what it said, which must be no error and no warning."""
    done = subprocess.run([compiler(), script], cwd=folder, capture_output=True, text=True, timeout=300)
    said = done.stdout + done.stderr
    assert done.returncode == 0, said
    assert "Error" not in said, said
    assert "LOG_ASSERT" not in said, said
    return said


def columns(table: Path) -> Columns:
    """Return the columns of a result."""
    with table.open() as file:
        names, *rows = csv.reader(file)
    return dict(zip(names, np.array(rows, dtype=float).T, strict=True))


def simulated(
    repository: Path, folder: Path, case: Case, model: str, *, stop: float, intervals: int = 1000
) -> Columns:
    """Build, import, check and simulate; return the result."""
    compiler()
    build_native_fmu(case.tire, folder)
    text = model.format(block=case.block, modifiers=case.modifiers, equations=case.equations)
    (folder / "model.mo").write_text(text, encoding="utf-8")
    name = text.split()[1]
    blocks = [repository / BLOCKS / f"{block}.mo" for block in ("BicycleTireOM", case.block)]
    (folder / "script.mos").write_text(
        f"""
        {STATES}
        loadModel(Modelica); getErrorString();
        importFMU("BicycleTire.fmu"); getErrorString();
        loadFile("BicycleTire_me_FMU.mo"); getErrorString();
        loadFile("{blocks[0].as_posix()}"); loadFile("{blocks[1].as_posix()}"); getErrorString();
        loadFile("model.mo"); getErrorString();
        checkModel({name}); getErrorString();
        simulate({name}, stopTime={stop}, numberOfIntervals={intervals}, tolerance={TOLERANCE},
            outputFormat="csv"); getErrorString();
        """,
        encoding="utf-8",
    )
    said = told(folder / "script.mos", folder)
    assert f"Check of {name} completed successfully" in said
    return columns(folder / f"{name}_res.csv")


def replayed(tire: TireModel, found: Columns) -> NDArray[np.float64]:
    """Return the forces of the tire itself on the motion of a result."""
    rows = [found[name] for name in ("time", "tire.deflection", "tire.surface_radius")]
    state, forces = tire.initial_state, []
    for time, deflection, radius in zip(*(row.tolist() for row in rows), strict=True):
        force, state = tire.step(deflection, radius, time, state)
        forces.append(force)
    return np.array(forces)


def elastic(deflection: NDArray[np.float64], flat_coefficient: float = 550.9) -> NDArray[np.float64]:
    """Return equation 2 of the article: on flat ground."""
    return flat_coefficient * np.maximum(100.0 * deflection, 0.0) ** 1.422


def refined(tire: TireModel, found: Columns, parts: int = 20) -> NDArray[np.float64]:
    """Return the forces on the same motion in steps that are finer by that many parts."""
    time, radius = found["time"], found["tire.surface_radius"]
    shares = np.arange(1, parts + 1) / parts
    fine = np.r_[time[0], (time[:-1, None] + shares * np.diff(time)[:, None]).ravel()]
    motion = {
        "time": fine,
        "tire.deflection": 0.004 + 0.006 * np.sin(4.0 * np.pi * fine),
        "tire.surface_radius": np.r_[radius[0], np.repeat(radius[1:], parts)],
    }
    return replayed(tire, motion)[::parts]


def test_the_script_beside_the_blocks(repository: Path, tmp_path: Path) -> None:
    """As its comment says; the wheel falls, bounces and falls again as the equation of motion says."""
    compiler()
    shutil.copytree(repository / BLOCKS, tmp_path / BLOCKS)
    build_native_fmu(TireModel(), tmp_path / "dist")
    folder = tmp_path / "dist" / "openmodelica"
    folder.mkdir()
    said = told(tmp_path / BLOCKS / "openmodelica.mos", folder)
    assert "Check of BicycleTireOM completed successfully" in said
    assert "Warning" not in said
    found = columns(folder / "DroppedWheel_res.csv")
    assert_falls(found, found["deflection"])
    np.testing.assert_allclose(found["tire.radial_force"], elastic(found["deflection"]), rtol=0, atol=1e-9)


def assert_falls(found: Columns, deflection: NDArray[np.float64], damping: float = 0.0) -> None:
    """3 kg fall from 5 mm. The solver's errors add up over a few hundred steps: a hundred times its tolerance."""

    def slopes(_: float, y: NDArray[np.float64]) -> list[float]:
        force = float(elastic(y[:1])[0]) + (damping * y[1] if y[0] > 0.0 else 0.0)
        return [y[1], 9.81 - max(force, 0.0) / 3.0]

    times, rows = np.unique(found["time"], return_index=True)
    exact = solve_ivp(
        slopes, (0.0, times[-1]), [-0.005, 0.0], "DOP853", t_eval=times, rtol=1e-11, atol=1e-14, max_step=1e-3
    )
    np.testing.assert_allclose(deflection[rows], exact.y[0], rtol=0, atol=100.0 * TOLERANCE)
    assert np.ptp(np.sign(deflection)) == 2.0


@pytest.mark.parametrize(
    ("modifiers", "tire"),
    [
        ("", TireModel()),
        (
            "(flat_coefficient=600, concave_exponent_rise=0.3)",
            TireModel(law=Hull1996(flat_coefficient=600.0, concave_exponent_rise=0.3)),
        ),
    ],
    ids=["as built", "with other parameters"],
)
def test_a_tire_that_is_driven(repository: Path, tmp_path: Path, modifiers: str, tire: TireModel) -> None:
    """The law is a function of what is connected: nothing is integrated, and the numbers are those of the replay."""
    case = Case(TireModel(), modifiers=modifiers)
    found = simulated(repository, tmp_path, case, DRIVEN, stop=1.5)
    np.testing.assert_allclose(found["tire.radial_force"], replayed(tire, found), rtol=0, atol=1e-9)
    assert set(found["tire.surface_radius"]) == {1e5, 0.254, -0.381}


STRUCTURED = """
model BicycleTire_fmu "What a tool with structured names makes of the FMU"
  record Law
    parameter Real flat_coefficient = 1, flat_exponent = 1;
    parameter Real convex_coefficient_drop = 1, convex_coefficient_decay = 1;
    parameter Real concave_coefficient_rise = 1, concave_coefficient_decay = 1;
    parameter Real convex_exponent_drop = 1, convex_exponent_decay = 1;
    parameter Real concave_exponent_rise = 1, concave_exponent_decay = 1;
  end Law;
  Law law;
  Modelica.Blocks.Interfaces.RealInput deflection, surface_radius;
  Modelica.Blocks.Interfaces.RealOutput radial_force, radial_stiffness;
  Modelica.Blocks.Interfaces.BooleanOutput in_tested_range;
equation
  radial_force = law.flat_coefficient * max(100 * deflection, 0) ^ law.flat_exponent;
  radial_stiffness = 0;
  in_tested_range = true;
end BicycleTire_fmu;
"""


def test_the_block_for_other_tools_is_modelica(repository: Path, tmp_path: Path) -> None:
    """importFMU gives no structured names: a class that has them stands for the FMU."""
    (tmp_path / "stand_in.mo").write_text(STRUCTURED, encoding="utf-8")
    (tmp_path / "check.mos").write_text(
        f"""
        loadModel(Modelica); getErrorString();
        loadFile("stand_in.mo"); getErrorString();
        loadFile("{(repository / BLOCKS / "BicycleTire.mo").as_posix()}"); getErrorString();
        checkModel(BicycleTire); getErrorString();
        """,
        encoding="utf-8",
    )
    assert "Check of BicycleTire completed successfully" in told(tmp_path / "check.mos", tmp_path)


FRICTION = {"slip_force": 30.0, "load_share": 0.02}
RELAXATION = {"share_1": 0.2, "relaxation_time_1": 0.05}


def test_friction_is_that_of_the_replay(repository: Path, tmp_path: Path) -> None:
    """A completed step at each row of the result, and more of them at events, where the motion does not turn."""
    tire = tire_with(rate_independent_hysteresis=FRICTION)
    found = simulated(repository, tmp_path, Case(tire), DRIVEN, stop=1.5)
    np.testing.assert_allclose(found["tire.radial_force"], replayed(tire, found), rtol=0, atol=1e-9)
    assert np.abs(replayed(TireModel(), found) - found["tire.radial_force"]).max() > 20.0


def test_friction_below_a_falling_wheel(repository: Path, tmp_path: Path) -> None:
    """OpenModelica completes a step at each evaluation, its solver's iterations too: they leave no trace.

    What is left is that of any solver: it steps over the turn of the motion (at 1 ms once in a few rows).
    """
    tire = tire_with(rate_independent_hysteresis=FRICTION)
    found = simulated(repository, tmp_path, Case(tire), FALLING, stop=0.5, intervals=500)
    step, x, v = 1e-5, -0.005, 0.0
    force, state = tire.step(x, 1e5, 0.0, tire.initial_state)
    exact = [x]
    for i in range(1, 50_001):  # velocity Verlet
        pull = 9.81 - force / 3.0
        x += step * (v + 0.5 * step * pull)
        force, state = tire.step(x, 1e5, i * step, state)
        v += 0.5 * step * (pull + 9.81 - force / 3.0)
        exact.append(x)
    expected = np.interp(found["time"], step * np.arange(50_001), exact)
    np.testing.assert_allclose(found["x"], expected, rtol=0, atol=2e-6)


def test_relaxation_is_integrated_by_the_solver(repository: Path, tmp_path: Path) -> None:
    """Its error is the solver's, ten tolerances of a state of 600 N; that of the replay's steps of 0.075 ms is less."""
    tire = tire_with(viscoelastic_relaxation=RELAXATION)
    found = simulated(repository, tmp_path, Case(tire), DRIVEN, stop=1.5)
    largest = found["tire.radial_force"].max()
    np.testing.assert_allclose(
        found["tire.radial_force"], refined(tire, found), rtol=0, atol=10.0 * TOLERANCE * largest
    )
    assert np.abs(replayed(TireModel(), found) - found["tire.radial_force"]).max() > 20.0


DAMPING = 300.0
DAMPED = Case(tire_with(viscous_damping={"damping": DAMPING}), "BicycleTireMotionOM")


def test_damping_by_the_rate_that_is_connected(repository: Path, tmp_path: Path) -> None:
    found = simulated(repository, tmp_path, DAMPED._replace(equations=MOTION), DRIVEN, stop=0.49)
    rate = 0.006 * 4.0 * np.pi * np.cos(4.0 * np.pi * found["time"])
    force = np.where(found["tire.deflection"] > 0.0, elastic(found["tire.deflection"]) + DAMPING * rate, 0.0)
    np.testing.assert_allclose(found["tire.radial_force"], np.maximum(force, 0.0), rtol=0, atol=1e-9)


def test_damping_below_a_falling_wheel(repository: Path, tmp_path: Path) -> None:
    connected = "tire.deflection_rate = v; tire.deflection_acceleration = 0;"
    case = DAMPED._replace(equations=connected)
    found = simulated(repository, tmp_path, case, FALLING, stop=0.5, intervals=500)
    assert_falls(found, found["x"], DAMPING)


def test_a_rate_that_is_not_connected_is_told(repository: Path, tmp_path: Path) -> None:
    """The block for other tires leaves it open: omc counts too few equations, and does not take it for 0."""
    with pytest.raises(AssertionError, match="Too few equations"):
        simulated(repository, tmp_path, DAMPED._replace(block="BicycleTireOM"), DRIVEN, stop=0.5)


def test_parameters_of_an_effect(repository: Path, tmp_path: Path) -> None:
    """As the block's documentation says: a block that extends it."""
    built, other = (tire_with(force_offset={"offset": offset}) for offset in (20.0, -5.0))
    own = """
  block Own
    extends BicycleTireOM(
      radial_force(min=-Modelica.Constants.inf),
      fmu(force_offset_offset(fixed=true)=offset));
    parameter Real offset(final unit="N") = -5;
  end Own;
  Own"""
    case = Case(built)._replace(modifiers="")
    found = simulated(repository, tmp_path, case, DRIVEN.replace("{block} tire", own + " tire"), stop=1.5)
    np.testing.assert_allclose(found["tire.radial_force"], replayed(other, found), rtol=0, atol=1e-9)
