"""Simulations of others from recording to correction: FMI 3.0 in Model Exchange, and one that a package ships.

tests/tirelab/fmu/test_foreign_damper.py does the same beside a damper of FMI 2.0 and in the coupled system.
"""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import polars as pl
import pytest
from click.testing import CliRunner
from drives import FloatArray
from fmpy import simulate_fmu
from foreign_models import maxwell
from rivals import looking_for, rivals
from test_foreign_damper import NOISE, REACH, SLIP, friction, stroke
from tirelab.cli import main

Force = Callable[[FloatArray, FloatArray], FloatArray]


def of_maxwell(time: FloatArray, x: FloatArray) -> FloatArray:
    """Return 1e5 x - q [N], where q' = (2e4 x - q) / 0.5 s, exactly for straight lines between the samples."""
    q, found = 0.0, np.zeros(x.size)
    for i in range(1, x.size):
        step, slope = time[i] - time[i - 1], 2e4 * (x[i] - x[i - 1]) / (time[i] - time[i - 1])
        lag = q - (2e4 * x[i - 1] - 0.5 * slope)
        q = 2e4 * x[i] - 0.5 * slope + lag * np.exp(-step / 0.5)
        found[i] = 1e5 * x[i] - q
    found[0] = 1e5 * x[0]
    return found


def of_sum(_: FloatArray, x: FloatArray) -> FloatArray:
    """Return 100 kN/m x: y = u1 + u2 with u1 in centimetres and y in kilonewtons."""
    return 1e5 * x


def diagnosed_beside(fmu: Path, variables: str, force: Force, folder: Path) -> dict[str, Any]:
    """Hide a friction beside a simulation, and return what the diagnosis writes into `folder`/out."""
    for name, seed in (("a", 1), ("b", 2)):
        time, x, _ = stroke(seed)
        x = 0.5 * (x - x.min()) + 0.002  # deep enough that no friction makes it pull
        noise = NOISE * np.random.default_rng(seed).standard_normal(time.size)
        frame = {"time [s]": time, "x [m]": x, "F [N]": force(time, x) + friction(x) + noise}
        pl.DataFrame(frame).write_csv(folder / f"{name}.csv")
    words = ["diagnose", str(folder / "a.csv"), "--held-out", str(folder / "b.csv"), "--radius", "flat"]
    words += ["--columns", "time=time,deflection=x,force=F", "--fmu", str(fmu), "--variables", variables]
    with looking_for(*rivals("rate_independent_hysteresis")):
        done = CliRunner().invoke(main, [*words, "--out", str(folder / "out"), "--quiet"])
    assert done.exit_code == 0, done.output
    content: dict[str, Any] = json.loads((folder / "out" / "diagnosis.json").read_text(encoding="utf-8"))
    return content


def check(content: dict[str, Any], folder: Path) -> None:
    """The friction is found, and the simulation with what fmpy replays of its correction reaches the figures."""
    (found,) = content["verdict"]["effects"]
    assert found["name"] == "rate_independent_hysteresis"
    assert found["parameters"]["slip_force"]["value"] == pytest.approx(SLIP, rel=0.1)
    # All of its elements slip REACH after a turn: from -SLIP to SLIP.
    assert found["parameters"]["reach"]["value"] == pytest.approx(REACH, rel=0.5)
    table = pl.read_csv(folder / "out" / "b.corrected.csv")
    time, x, recorded, simulated = (
        table[f"{name} [{unit}]"].to_numpy()
        for name, unit in (("time", "s"), ("deflection", "m"), ("force", "N"), ("believed_force", "N"))
    )
    names = ("time", "deflection", "simulated_force")
    moved = np.rec.fromarrays([time, x, simulated], names=list(names))
    step = float(time[1] - time[0])
    result = simulate_fmu(
        str(folder / "out" / "Correction.fmu"),
        stop_time=time[-1],
        step_size=step,
        output_interval=step,
        input=moved,
        output=["additional_force"],
    )
    # An input is held over a step: what it gives is told at its end.
    added = np.interp(time + step, result["time"], result["additional_force"])
    reached = np.sqrt(np.mean((simulated + added - recorded)[2:-2] ** 2))
    assert reached == pytest.approx(content["fit"]["held_out_after"], rel=0.03)
    assert reached < 1.5 * NOISE < 0.1 * content["fit"]["held_out_before"]


def test_friction_beside_a_model_of_fmi_3_in_model_exchange(tmp_path: Path) -> None:
    content = diagnosed_beside(
        maxwell(tmp_path, "ModelExchange"), "deflection=x,force=f", of_maxwell, tmp_path
    )
    check(content, tmp_path)


@pytest.mark.slow
def test_friction_beside_one_that_a_package_ships(shipped: Path, tmp_path: Path) -> None:
    variables = 'deflection="u1 [cm]",force="y [kN]"'
    check(diagnosed_beside(shipped, variables, of_sum, tmp_path), tmp_path)
