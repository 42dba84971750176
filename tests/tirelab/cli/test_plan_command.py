"""The command `plan`: limits in, drive files, a table and a picture out."""

import json
from pathlib import Path

import numpy as np
import polars as pl
import pytest
import tirelab.planning.responses as responses
from click.testing import CliRunner, Result
from radialtire import TireModel
from tirelab.cli import main
from tirelab.planning.menu import Drive
from tirelab.simulation.simulate import simulate


@pytest.fixture(autouse=True)
def two_effects(monkeypatch: pytest.MonkeyPatch) -> None:
    """All effects take longer than the rest of these tests together."""
    names = ("viscous_damping", "rate_independent_hysteresis")
    monkeypatch.setattr(responses, "candidates", lambda: names)


def run(*arguments: str | Path) -> Result:
    return CliRunner().invoke(main, ["plan", *map(str, arguments)])


SMALL = ("--time", "40s", "--sampling", "100Hz", "--size", "5%")


def test_a_plan_is_written_and_told(tmp_path: Path) -> None:
    (tmp_path / "rig.toml").write_text('stroke = "20 mm"\nspeed = "150 mm/s"\n')
    done = run("--rig", tmp_path / "rig.toml", *SMALL, "--out", tmp_path / "plan", "--quiet")
    assert done.exit_code == 0, done.output
    assert "to 20 mm and 1476 N, at up to 150 mm/s, 100 Hz, 5 N of noise" in done.output
    content = json.loads((tmp_path / "plan" / "plan.json").read_text())
    assert content["rig"]["speed"] == pytest.approx(0.15)
    listed = [
        float(line.split(": ")[1].split(" s,")[0]) for line in done.output.splitlines() if ".csv: " in line
    ]
    assert f", {sum(listed):g} s of 40 s:" in done.output
    for recording in content["recordings"]:
        table = pl.read_csv(tmp_path / "plan" / recording["file"])
        assert table["deflection [mm]"].max() <= 20.0
        assert table["time [s]"].max() == pytest.approx(recording["duration"], abs=0.011)
        assert recording["file"] in done.output
    assert (tmp_path / "plan" / "plan.png").is_file()
    assert "friction loop" in done.output


def test_no_drive_presses_the_tire_beyond_the_largest_force(tmp_path: Path) -> None:
    done = run(*SMALL, "--force", "500 N", "--out", tmp_path / "plan", "--quiet")
    assert done.exit_code == 0, done.output
    assert "the force stays within 500 N" in done.output
    content = json.loads((tmp_path / "plan" / "plan.json").read_text())
    assert content["rig"]["force"] == 500.0
    for recording in content["recordings"]:
        table = pl.read_csv(tmp_path / "plan" / recording["file"])
        time, depth = table["time [s]"].to_numpy(), 1e-3 * table["deflection [mm]"].to_numpy()
        pressed = Drive("", time, depth, np.full(time.size, np.inf))
        assert 0.95 * 500.0 < simulate(TireModel(), pressed).max() <= 500.0


def test_json_is_what_the_file_holds(tmp_path: Path) -> None:
    done = run(*SMALL, "--out", tmp_path / "plan", "--quiet", "--json")
    assert done.exit_code == 0, done.output
    assert json.loads(done.output) == json.loads((tmp_path / "plan" / "plan.json").read_text())


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (["--stroke", "20"], "--stroke: '20' is not a number with a unit; write for instance 20mm"),
        (["--size", "2"], "'2' is no part of the peak force; write for instance 2%"),
        (["--rig", "none.toml"], "none.toml: there is no such file"),
        (["--from", "nothing"], "nothing: there is no such file"),
    ],
)
def test_bad_input_is_one_sentence(arguments: list[str], words: str, tmp_path: Path) -> None:
    done = run(*arguments, "--out", tmp_path / "plan")
    assert done.exit_code == 2
    assert words in done.output
    assert "Traceback" not in done.output
    assert not (tmp_path / "plan").exists()
