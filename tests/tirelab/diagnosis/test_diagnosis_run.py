"""A whole diagnosis of files: what it writes, and what it refuses in one sentence before it begins to work."""

from __future__ import annotations

import json
import shlex
from pathlib import Path
from typing import Any

import numpy as np
import polars as pl
import pytest
from radialtire import TireModel, read_tire
from tirelab.diagnosis import diagnosis_run, request_checks
from tirelab.diagnosis.diagnosis_run import run_diagnosis
from tirelab.diagnosis.outcome import command_line
from tirelab.errors import TirelabError
from tirelab.recordings.reading import Reading


@pytest.fixture
def idle(monkeypatch: pytest.MonkeyPatch) -> None:
    """No diagnosis may begin."""
    monkeypatch.setattr(diagnosis_run, "diagnose", lambda *_, **__: pytest.fail("it began to work"))


def refused(said: str, *arguments: Any, **options: Any) -> None:
    with pytest.raises(TirelabError, match=said) as caught:
        run_diagnosis(*arguments, **options)
    sentence = str(caught.value)
    assert "\n" not in sentence
    assert "Traceback" not in sentence
    assert not sentence.endswith(".")


def test_a_file_that_is_not_there_is_refused(idle: None, tmp_path: Path) -> None:
    refused("none.csv.*there is no such file", [tmp_path / "none.csv"], tmp_path / "out")
    assert not (tmp_path / "out").exists()


def test_a_folder_without_recordings_is_refused(idle: None, tmp_path: Path) -> None:
    (tmp_path / "notes.md").write_text("no recording")
    refused("holds no recording; a recording ends in one of .*csv", [tmp_path], tmp_path / "out")


def test_a_file_given_twice_is_refused(idle: None, damped_run: Any, tmp_path: Path) -> None:
    ride = damped_run.rides / "ride.csv"
    refused("ride.csv is given twice; give each recording once", [ride, damped_run.rides], tmp_path / "out")
    refused("ride.csv is given twice", [ride], tmp_path / "out", held_out=[ride])
    detour = damped_run.rides / ".." / damped_run.rides.name / "ride.csv"
    refused("ride.csv is given twice", [ride, detour], tmp_path / "out")


def test_a_deflection_beyond_the_wheel_is_refused_before_all_the_work(
    idle: None, damped_run: Any, tmp_path: Path
) -> None:
    """The FMU takes no more than the wheel's radius, 0.33 m."""
    lines = ["time [s],deflection [m],force [N],radius [m]"]
    lines += [f"{0.1 * i},{0.004 * i},{8.0 * i},inf" for i in range(100)]
    deep = tmp_path / "deep.csv"
    deep.write_text("\n".join(lines), encoding="utf-8")
    ride, out = damped_run.rides / "ride.csv", tmp_path / "out"
    refused(r"deep: the deflection is 0\.396 m at 9\.9 s, and a tire takes 0\.33 m at most", [deep], out)
    refused("deep: the deflection is 0.396 m", [ride], out, held_out=[deep])


def test_a_part_that_is_only_pulled_is_asked_for_its_signs(idle: None, tmp_path: Path) -> None:
    lines = ["time [s],deflection [mm],force [N],radius [m]"]
    lines += [f"{0.1 * i},{-50 + 0.3 * i},{-80 + 0.2 * i},inf" for i in range(100)]
    (tmp_path / "pulled.csv").write_text("\n".join(lines), encoding="utf-8")
    reading = Reading(columns={"deflection": "+deflection", "force": "+force"})
    said = "pulled: no deflection is above 0.*turn both signs, --columns deflection=-NAME,force=-NAME"
    refused(said, [tmp_path / "pulled.csv"], tmp_path / "out", reading=reading)


def test_a_folder_that_cannot_be_written_is_refused(
    idle: None, damped_run: Any, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    taken = tmp_path / "taken"
    taken.write_text("a file")
    ride = damped_run.rides / "ride.csv"
    refused("cannot be written, .*taken is a file; name another folder with --out", [ride], taken / "deeper")
    # Root may write everywhere, so the answer of the system is given by hand.
    monkeypatch.setattr(request_checks.os, "access", lambda path, mode: False)
    refused("is not writable; name another folder with --out", [ride], tmp_path / "new")


@pytest.mark.parametrize("content", ["no json", "[1, 2]", '{"schema": 1, "law": {"name": "phlogiston"}}'])
def test_a_broken_tire_file_is_refused(idle: None, damped_run: Any, tmp_path: Path, content: str) -> None:
    broken = tmp_path / "broken.json"
    broken.write_text(content)
    refused("broken.json", [damped_run.rides / "ride.csv"], tmp_path / "out", tire=broken)
    refused("none.json", [damped_run.rides / "ride.csv"], tmp_path / "out", tire=tmp_path / "none.json")


def test_a_recording_that_cannot_be_diagnosed_leaves_no_folder(damped_run: Any, tmp_path: Path) -> None:
    short = tmp_path / "short.csv"
    short.write_text("\n".join((damped_run.rides / "ride.csv").read_text().splitlines()[:40]) + "\n")
    refused("has 39 samples; at least 100 are needed", [short], tmp_path / "out")
    assert not (tmp_path / "out").exists()


def test_everything_is_written(damped_run: Any) -> None:
    files = {f.name for f in damped_run.out.iterdir()}
    assert files - {"separating_test.csv"} == {
        "tire.json",
        "BicycleTire.fmu",
        "diagnosis.json",
        "report.html",
        "plots.csv",
    }
    assert ("separating_test.csv" in files) == (damped_run.verdict.test is not None)
    assert damped_run.verdict.alternatives or damped_run.verdict.test is None
    assert json.loads((damped_run.out / "diagnosis.json").read_text()) == damped_run.run.content
    tire = read_tire(damped_run.out / "tire.json")
    assert tire.name == f"{TireModel().name}, corrected"
    assert tire.effects == damped_run.verdict.tire.effects
    assert damped_run.run.warnings == ()


def test_the_stages_are_said_in_their_order(damped_run: Any) -> None:
    stages = list(damped_run.stages)
    assert stages[:3] == ["reading ride.csv", "reading kept.csv", "comparing the effects' signatures"]
    assert stages[-3:] == [
        "replaying the corrected FMU on ride",
        "replaying the corrected FMU on kept",
        "writing the report",
    ]
    between = ["fitting the sets that can win", "validating the correction on held-out data"]
    assert stages[3:5] == between


def test_the_command_line_repeats_the_diagnosis() -> None:
    reading = Reading()
    line = command_line(
        [Path("a b.csv"), Path("c.csv")], Path("out"), Path("t.json"), [Path("k.csv")], reading
    )
    assert shlex.split(line) == [
        *("tirelab", "diagnose", "a b.csv", "c.csv"),
        *("--tire", "t.json", "--out", "out", "--held-out", "k.csv"),
    ]
    assert "--tire" not in command_line([Path("a.csv")], Path("out"), None, [], reading)
    with_rig = command_line([Path("a.csv")], Path("out"), None, [], reading, Path("rig.toml"))
    assert "--rig rig.toml" in with_rig


def test_diagnose_files_writes_the_same(
    damped_run: Any, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(diagnosis_run, "diagnose", lambda *_, **__: damped_run.verdict)
    diagnosis_run.diagnose_files([damped_run.rides / "ride.csv"], None, tmp_path / "out")
    assert json.loads((tmp_path / "out" / "diagnosis.json").read_text())["data"] is None
    assert "plots.csv" not in (tmp_path / "out" / "report.html").read_text(encoding="utf-8")
    assert not (tmp_path / "out" / "plots.csv").exists()


def test_a_long_recording_is_replayed_in_part_and_said_so(
    damped_run: Any, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(diagnosis_run, "diagnose", lambda *_, **__: damped_run.verdict)
    monkeypatch.setattr(diagnosis_run, "MOST_REPLAYED", 1000)
    run = run_diagnosis(
        [damped_run.rides / "ride.csv"], tmp_path / "out", held_out=[damped_run.rides / "kept.csv"]
    )
    assert [w.split("; ")[0] for w in run.warnings] == [
        f"the corrected FMU was replayed on the first 1000 of 4000 samples of {name}, and its tire simulated on the "
        "others"
        for name in ("ride", "kept")
    ]
    assert run.content["fit"] == pytest.approx(damped_run.run.content["fit"], rel=1e-9)


def test_the_data_behind_the_plots_is_every_sample_with_its_forces(damped_run: Any) -> None:
    table = pl.read_csv(damped_run.out / "plots.csv")
    assert table["recording"].unique(maintain_order=True).to_list() == ["ride", "kept"]
    ride = table.filter(pl.col("used") == "fitted")
    fit = damped_run.run.content["fit"]
    for when in ("before", "after"):
        left = ride["force [N]"] - ride[f"force {when} [N]"]
        assert float(np.sqrt(np.mean(left.to_numpy() ** 2))) == pytest.approx(fit[when], rel=1e-6)
