"""A recording beside the FMU: the figures, the words, the picture, and the command around them."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest
from click.testing import CliRunner
from foreign_models import spring_damper
from tirelab.cli import main
from tirelab.recordings.recording import Recording, read_recording
from tirelab.report.comparison import compare, plot


def recording(force: list[float]) -> Recording:
    n = len(force)
    return Recording(
        name="made <up>",
        time=np.arange(n) * 0.5,
        deflection=np.linspace(0.0, 0.02, n),
        surface_radius=np.full(n, -0.381),
        force=np.array(force),
    )


def test_rmse_and_peak_are_those_of_the_residual() -> None:
    """Residuals 3, -4, 0, 0: RMSE = sqrt(25 / 4) = 2.5 N, peak -4 N at the second sample."""
    result = compare(recording([13.0, 16.0, 30.0, 40.0]), np.array([10.0, 20.0, 30.0, 40.0]))
    assert result.rmse == 2.5
    assert (result.peak, result.at) == (-4.0, 1)
    words = " ".join(result.sentences())
    assert "RMSE 2.50 N (6.25 % of the largest force)" in words
    assert "peak error -4.0 N" in words
    assert "t = 0.5 s" in words
    assert "concave 38.1 cm" in words


def test_the_picture_is_drawn(tmp_path: Path) -> None:
    plot(compare(recording([1.0, 2.0, 3.0]), np.array([1.0, 2.5, 3.0])), tmp_path / "p.png")
    assert (tmp_path / "p.png").read_bytes().startswith(b"\x89PNG")


def run(*arguments: str | Path) -> tuple[int, str]:
    result = CliRunner().invoke(main, [str(a) for a in arguments])
    assert result.exception is None or isinstance(result.exception, SystemExit), result.exception
    return result.exit_code, result.output


def test_a_recording_of_the_very_tire_leaves_its_noise(shared: Path, tmp_path: Path) -> None:
    """White noise of 6 N over 1200 samples gives 6 N within 4 sigma / sqrt(2 * 1200) = 8 %; the key says 6.25 N."""
    file = shared / "recordings" / "concealed" / "dev_null_paper" / "train_0.csv"
    status, printed = run("compare", file, "--out", tmp_path)
    assert status == 0
    assert "RMSE 6.2" in printed
    assert (tmp_path / "train_0.compare.png").is_file()


def test_compare_with_a_tire_file_and_with_an_fmu_agree(repository: Path, tmp_path: Path) -> None:
    recorded = repository / "examples" / "recordings" / "press" / "slow.csv"
    tire = repository / "examples" / "tires" / "wang_hull_off_road.json"
    assert run("build", "--tire", tire, "--out", tmp_path)[0] == 0
    with_tire = run("compare", recorded, "--tire", tire, "--out", tmp_path)
    with_fmu = run("compare", recorded, "--fmu", tmp_path / "BicycleTire.fmu", "--out", tmp_path)
    assert with_tire[0] == with_fmu[0] == 0
    assert with_tire[1].splitlines()[-4:] == with_fmu[1].splitlines()[-4:]


def test_our_fmu_of_fmi_3_is_compared_as_that_of_fmi_2(repository: Path, tmp_path: Path) -> None:
    recorded = repository / "examples" / "recordings" / "press" / "slow.csv"
    told = []
    for fmi in ("2", "3"):
        out = tmp_path / fmi
        assert run("build", "--native", "--fmi", fmi, "--out", out)[0] == 0
        status, printed = run(
            "compare", recorded, "--fmu", out / "BicycleTire.fmu", "--out", out, "--json", "--quiet"
        )
        assert status == 0, printed
        told.append(json.loads(printed))
    assert told[1]["rmse"] == pytest.approx(told[0]["rmse"], rel=1e-12)
    assert told[1]["at"] == told[0]["at"]


def test_anyones_fmu_is_compared_and_ended_where_it_hangs(repository: Path, tmp_path: Path) -> None:
    """A spring of 1e5 N/m with a damper, pressed slowly: the spring's force is what it leaves out."""
    recorded = repository / "examples" / "recordings" / "press" / "slow.csv"
    named = ("--variables", "force=wheel_load", "--out", tmp_path, "--json", "--quiet")
    status, printed = run("compare", recorded, "--fmu", spring_damper(tmp_path), *named)
    assert status == 0
    r = read_recording(recorded)
    assert json.loads(printed)["rmse"] == pytest.approx(
        float(np.sqrt(np.mean((r.force - 1e5 * r.deflection) ** 2))), rel=0.05
    )
    (tmp_path / "hangs").mkdir()
    hangs = spring_damper(tmp_path / "hangs", "print('solving', flush=True); time.sleep(60)")
    status, printed = run("compare", recorded, "--fmu", hangs, "--fmu-timeout", "3", *named)
    assert status == 2
    assert "was ended after 3 s" in printed
    assert "its last message: solving" in printed


@pytest.mark.parametrize(
    ("arguments", "sentence"),
    [
        (["nothing.csv"], "nothing.csv"),
        (["press/slow.csv", "--fmu", "nothing.fmu"], "nothing.fmu: there is no such file; check the path"),
        (["press/slow.csv", "--tire", "nothing.json"], "nothing.json: No such file"),
        (["press/slow.csv", "--tire", "a.fmu"], "a.fmu is an FMU and no tire file; give it with --fmu a.fmu"),
        (["press/slow.csv", "--fmu", "a.fmu", "--tire", "b.json"], "--fmu and --tire both name a simulation"),
        (["press/slow.csv", "--fmu-timeout", "3"], "name the FMU, or leave them out"),
        (["press/slow.csv", "--out", "press/slow.csv"], "cannot be written"),
    ],
)
def test_bad_input_gets_one_sentence(
    repository: Path, monkeypatch: pytest.MonkeyPatch, arguments: list[str], sentence: str
) -> None:
    monkeypatch.chdir(repository / "examples" / "recordings")
    status, printed = run("compare", *arguments)
    assert status == 2
    assert sentence in printed
    assert "Traceback" not in printed
    assert "is native code" not in printed
    assert len([line for line in printed.splitlines() if line.startswith("Error:")]) == 1
