"""A damper of others, which has no spring: what it lacks is found beside it, and runs coupled to it."""

from __future__ import annotations

import io
import json
from pathlib import Path
from typing import Any

import numpy as np
import polars as pl
import pytest
from click.testing import CliRunner
from drives import FloatArray, ride
from fmpy.ssp.simulation import simulate_ssp
from foreign_models import damper
from rich.console import Console
from rivals import looking_for
from tirelab.cli import main
from tirelab.report.terminal import print_diagnosis

DAMPING, PRESS, SLIP, REACH, NOISE = 1500.0, 120.0, 60.0, 4e-4, 3.0
LACKING = ("rate_independent_hysteresis", "force_offset")
NEAR = ("viscous_damping", "viscoelastic_relaxation", "force_drift")
"""Effects that the damper lacks, and others that may pass for them."""

SIGNS = "time=time,deflection=+x,force=+F"


def stroke(seed: int) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Return time [s], deflection [m] about 0, and rate [m/s] from the last sample, as the FMU takes it."""
    time, deflection, _ = ride(seed)
    x = 2.0 * (deflection - 0.0115)
    return time, x, np.append(0.0, np.diff(x) / np.diff(time))


def friction(x: FloatArray) -> FloatArray:
    """Return the force [N] of an elastic element that slips at SLIP, REACH deep, sample by sample."""
    y, found = 0.0, np.zeros(x.size)
    for i in range(1, x.size):
        y = min(max(y + (x[i] - x[i - 1]) / REACH, -1.0), 1.0)
        found[i] = SLIP * y
    return found


def write(file: Path, seed: int, *, lacks: bool, simulated: bool = False) -> None:
    time, x, rate = stroke(seed)
    force = DAMPING * rate + lacks * (friction(x) + PRESS)
    noise = NOISE * np.random.default_rng(seed).standard_normal(time.size)
    frame = {"time [s]": time, "x [m]": x, "F [N]": force + noise}
    pl.DataFrame(frame | ({"sim [N]": DAMPING * rate} if simulated else {})).write_csv(file)


def diagnosed(folder: Path, *words: str) -> dict[str, Any]:
    given = ["diagnose", str(folder / "a.csv"), "--held-out", str(folder / "b.csv"), "--radius", "flat"]
    given += ["--columns", SIGNS, "--out", str(folder / "out"), "--quiet", *words]
    with looking_for(*LACKING, *NEAR):
        done = CliRunner().invoke(main, given)
    assert done.exit_code == 0, done.output
    content: dict[str, Any] = json.loads((folder / "out" / "diagnosis.json").read_text(encoding="utf-8"))
    return content


@pytest.fixture(scope="module")
def beside_fmu(tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, dict[str, Any]]:
    folder = tmp_path_factory.mktemp("damper")
    for name, seed in (("a", 1), ("b", 2)):
        write(folder / f"{name}.csv", seed, lacks=True)
    return folder, diagnosed(folder, "--fmu", str(damper(folder)))


def test_friction_and_preload_beside_a_damper(beside_fmu: tuple[Path, dict[str, Any]]) -> None:
    _, content = beside_fmu
    found = {e["name"]: e for e in content["verdict"]["effects"]}
    assert set(found) == set(LACKING)
    assert found["force_offset"]["parameters"]["offset"]["value"] == pytest.approx(PRESS, rel=0.05)
    slip = found["rate_independent_hysteresis"]["parameters"]["slip_force"]["value"]
    assert slip == pytest.approx(SLIP, rel=0.1)
    assert content["fit"]["before"] == pytest.approx(np.hypot(PRESS, SLIP), rel=0.1)
    assert content["fit"]["held_out_after"] < 1.5 * NOISE
    # A damper has no pressure: none is asked for, and none may leak.
    assert "pressure" not in json.dumps(content["verdict"])


def test_the_coupled_system_reaches_the_figures(beside_fmu: tuple[Path, dict[str, Any]]) -> None:
    folder, content = beside_fmu
    table = pl.read_csv(folder / "out" / "b.corrected.csv")[:1500]
    time, x, corrected, recorded = (
        table[f"{name} [{unit}]"].to_numpy()
        for name, unit in (("time", "s"), ("deflection", "m"), ("corrected_force", "N"), ("force", "N"))
    )
    step = float(time[1] - time[0]) / 10
    result = simulate_ssp(
        str(folder / "out" / content["correction"]["system"]),
        stop_time=time[-1] + 4 * step,
        step_size=step,
        input={"deflection": lambda t: float(np.interp(t, time, x))},
    )
    # fmpy hands a value on one step later, here a tenth of a sample; on straight lines the rate is the same there
    force = np.interp(time + step, result["time"], result["corrected_force"])
    assert np.max(np.abs(force - corrected)[5:-2]) < 0.2
    reached = np.sqrt(np.mean((force - recorded)[5:-2] ** 2))
    assert reached == pytest.approx(np.sqrt(np.mean((corrected - recorded)[5:-2] ** 2)), rel=1e-2)
    assert reached == pytest.approx(content["fit"]["held_out_after"], rel=0.1)


def test_report_and_terminal_tell_of_the_correction_and_not_of_a_tire(
    beside_fmu: tuple[Path, dict[str, Any]],
) -> None:
    folder, content = beside_fmu
    text = Console(file=io.StringIO(), width=200)
    sure = {**content["verdict"], "confidence": 0.95, "separating_test": None}
    print_diagnosis(text, {**content, "verdict": sure}, folder)
    assert isinstance(text.file, io.StringIO)
    printed = text.file.getvalue()
    page = (folder / "out" / "report.html").read_text(encoding="utf-8")
    for shown in (printed, page):
        assert "use this tire" not in shown
        assert "baseline tire" not in shown
        assert "Corrected.ssp" in shown
        assert "Correction.fmu" in shown
    assert "Nothing: use Corrected.ssp, which couples Damper.fmu with Correction.fmu." in printed
    assert "Beside: <bdi>Damper.fmu</bdi>" in page
    assert ">Coupled system (SSP)<" in page


@pytest.mark.slow
def test_beside_the_force_in_a_column(tmp_path: Path) -> None:
    for name, seed in (("a", 1), ("b", 2)):
        write(tmp_path / f"{name}.csv", seed, lacks=True, simulated=True)
    content = diagnosed(tmp_path, "--believed-force", "+sim")
    assert {e["name"] for e in content["verdict"]["effects"]} == set(LACKING)
    corrected = pl.read_csv(tmp_path / "out" / "b.corrected.csv")
    error = (corrected["force [N]"] - corrected["corrected_force [N]"]).to_numpy()
    assert np.sqrt(np.mean(error**2)) < 1.5 * NOISE


def test_a_damper_that_lacks_nothing_is_no_poor_recording(tmp_path: Path) -> None:
    for name, seed in (("a", 1), ("b", 2)):
        write(tmp_path / f"{name}.csv", seed, lacks=False, simulated=True)
    content = diagnosed(tmp_path, "--believed-force", "+sim")
    assert content["verdict"]["effects"] == []
    assert content["fit"]["before"] == pytest.approx(NOISE, rel=0.05)
