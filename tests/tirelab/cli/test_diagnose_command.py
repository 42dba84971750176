"""tirelab diagnose: what it prints, what it writes, the contract of diagnosis.json, and its refusals."""

from __future__ import annotations

import csv
import io
import json
import shutil
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
import rich.console
from click.testing import CliRunner, Result
from diagnosis_contract import check_contract
from drives import Drive, flat_force, read, ride, saved
from radialtire import CATALOGUE, TireModel, read_tire
from rivals import looking_for
from tirelab.cli import diagnose as diagnose_command
from tirelab.diagnosis import diagnosis_run
from tirelab.diagnosis.verdict import Verdict
from tirelab.fmu.replay import replay
from tirelab.recordings.recording import Recording, read_recording


def run(*arguments: str | Path) -> Result:
    result = CliRunner().invoke(diagnose_command.command, [str(a) for a in arguments])
    assert result.exception is None or isinstance(result.exception, SystemExit), result.exception
    return result


@pytest.fixture(scope="module")
def rides(damped_run: Any) -> Path:
    """A folder with a recording to be fitted and one to be held out."""
    return damped_run.rides


@pytest.fixture(scope="module")
def done(damped_run: Any, tmp_path_factory: pytest.TempPathFactory) -> tuple[Result, Path]:
    """A diagnosis with a recording held out, its verdict already known: what was printed, and the folder."""
    rides, out = damped_run.rides, tmp_path_factory.mktemp("command") / "deep" / "out"
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(diagnosis_run, "diagnose", lambda *_, **__: damped_run.verdict)
        result = run(rides / "ride.csv", "--held-out", rides / "kept.csv", "--out", out)
    return result, out


@pytest.fixture
def known(damped_run: Any, monkeypatch: pytest.MonkeyPatch) -> None:
    """The verdict is already known."""
    monkeypatch.setattr(diagnosis_run, "diagnose", lambda *_, **__: damped_run.verdict)


def rmse(recording: Recording, force: Any) -> float:
    return float(np.sqrt(np.mean((recording.force - force) ** 2)))


def test_the_files_are_written_and_keep_the_contract(done: tuple[Result, Path]) -> None:
    result, out = done
    assert result.exit_code == 0, result.output
    names = {"tire.json", "BicycleTire.fmu", "diagnosis.json", "report.html", "plots.csv"}
    assert {f.name for f in out.iterdir()} - {"separating_test.csv"} == names
    content = json.loads((out / "diagnosis.json").read_text(), parse_constant=pytest.fail)
    check_contract(content)
    assert (out / "separating_test.csv").exists() == (content["verdict"]["separating_test"] is not None)
    assert [e["name"] for e in content["verdict"]["effects"]] == ["viscous_damping"]


def test_the_errors_are_those_of_the_corrected_fmu(done: tuple[Result, Path], rides: Path) -> None:
    """Before: the article's law by hand (its file is written to 12 digits). After: the FMU that was written."""
    _, out = done
    fit = json.loads((out / "diagnosis.json").read_text())["fit"]
    for name, prefix in (("ride", ""), ("kept", "held_out_")):
        recording = read_recording(rides / f"{name}.csv")
        assert fit[f"{prefix}before"] == pytest.approx(
            rmse(recording, flat_force(recording.deflection)), rel=1e-9
        )
        again = replay(out / "BicycleTire.fmu", recording)
        assert fit[f"{prefix}after"] == pytest.approx(rmse(recording, again), rel=1e-12)
        assert fit[f"{prefix}after"] < 0.5 * fit[f"{prefix}before"]


def test_the_corrected_tire_says_what_it_is(done: tuple[Result, Path]) -> None:
    _, out = done
    tire = read_tire(out / "tire.json")
    assert tire.name == f"{TireModel().name}, corrected"
    assert "tirelab diagnose with ride" in tire.source
    assert [effect.name for effect, _ in tire.effects] == ["viscous_damping"]


def headline_of(verdict: Verdict) -> str:
    """The first line on a tire that lacks damping: the part of the load, from the sizes by hand."""
    damping = dict(verdict.tire.effects)[CATALOGUE["viscous_damping"]][0]
    (recording,) = verdict.recordings
    rate = np.gradient(recording.deflection, recording.time)
    share = damping * np.sqrt(np.mean(rate**2)) / np.sqrt(np.mean(recording.force**2))
    return f"Viscous damping, {100.0 * share:.0f} % of the load"


def test_the_terminal_report_is_short_and_plain(done: tuple[Result, Path], damped_run: Any) -> None:
    result, _ = done
    lines = result.stdout.splitlines()
    assert lines[0] == headline_of(damped_run.verdict)
    assert len(lines) < 50
    assert "\x1b" not in result.output
    assert max(map(len, lines)) <= diagnose_command.COLUMNS
    told = " ".join(" ".join(lines).split())
    for words in ("held-out", "where they differ", "N·s/m", "force for each m/s", "report.html"):
        assert words in told
    assert "\x1b" not in result.stderr


def test_progress_is_one_plain_line_for_each_stage_on_standard_error(
    done: tuple[Result, Path], damped_run: Any, tmp_path: Path
) -> None:
    """The verdict is known here, so that the stages of reading, building and replaying are left."""
    shown = [
        "reading ride.csv",
        "reading kept.csv",
        "building the corrected FMU",
        "replaying the corrected FMU on ride",
        "replaying the corrected FMU on kept",
        "writing the report",
    ]
    assert done[0].stderr.splitlines() == shown
    # The whole diagnosis says the same, and the stages between.
    assert [s for s in damped_run.stages if s in shown] == shown
    between = damped_run.stages[2 : damped_run.stages.index("building the corrected FMU")]
    assert {"comparing the effects' signatures", "fitting the sets that can win"} < set(between)
    assert all("\n" not in s and s == s.strip() for s in damped_run.stages)


def test_quiet_shows_no_progress(known: None, rides: Path, tmp_path: Path) -> None:
    result = run(rides / "ride.csv", "--quiet", "--out", tmp_path / "out")
    assert result.exit_code == 0, result.output
    assert result.stderr == ""


def test_a_terminal_shows_one_live_line_and_a_report_of_its_own_width(
    damped_run: Any, monkeypatch: pytest.MonkeyPatch
) -> None:
    screen = io.StringIO()
    genuine = rich.console.Console
    options = {"file": screen, "force_terminal": True, "width": 160, "_environ": {}}
    monkeypatch.setattr(rich.console, "Console", lambda **given: genuine(**{**given, **options}))
    with diagnose_command.progress(False, diagnose_command.STAGES) as progress:
        progress("reading \x1b]0;ride.csv")
    # The escape character of a file's name does not reach the terminal.
    assert "reading ?]0;ride.csv" in screen.getvalue()
    screen.truncate(0)
    monkeypatch.setattr(diagnose_command.sys, "stdout", SimpleNamespace(isatty=lambda: True))
    diagnose_command._print(damped_run.run, damped_run.out)
    assert max(map(len, screen.getvalue().splitlines())) > diagnose_command.COLUMNS
    assert f"\x1b[1m{headline_of(damped_run.verdict)}" in screen.getvalue()


def test_the_page_names_the_command_and_both_recordings(done: tuple[Result, Path]) -> None:
    page = (done[1] / "report.html").read_text(encoding="utf-8")
    for words in ("tirelab diagnose", "--held-out", "ride.csv", "kept.csv", "Hull, Wang &amp; Moore 1996"):
        assert words in page


@pytest.mark.slow
def test_alternatives_come_with_a_test_that_the_rig_can_run(
    one_rate_press: Drive, one_rate_verdict: Verdict, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(diagnosis_run, "diagnose", lambda *_, **__: one_rate_verdict)
    file = saved(one_rate_press, tmp_path / "press.csv")
    result = run(file, "--out", tmp_path / "out", "--json", "--quiet")
    assert result.exit_code == 0, result.output
    content = json.loads(result.stdout, parse_constant=pytest.fail)
    assert result.stdout == (tmp_path / "out" / "diagnosis.json").read_text(encoding="utf-8")
    check_contract(content)
    assert content["fit"]["held_out_after"] < 0.5 * content["fit"]["held_out_before"]
    assert content["held_out_by"].startswith("time block ")
    assert content["verdict"]["alternatives"]
    test = content["verdict"]["separating_test"]
    assert test["file"] == "separating_test.csv"
    table = np.genfromtxt(tmp_path / "out" / test["file"], delimiter=",", names=True, deletechars="")
    assert table.dtype.names == ("time_[s]", "deflection_[cm]", "radius_[cm]")
    assert np.all(np.diff(table["time_[s]"]) > 0.0)
    assert table["deflection_[cm]"].max() == pytest.approx(100.0 * test["amplitude"], abs=1e-6)
    assert "Recommended next test" in (tmp_path / "out" / "report.html").read_text(encoding="utf-8")


def test_a_folder_means_its_recordings(known: None, damped_run: Any, rides: Path, tmp_path: Path) -> None:
    (tmp_path / "out").mkdir()
    (tmp_path / "out" / "separating_test.csv").write_text("of an earlier diagnosis")
    result = run(rides, "--out", tmp_path / "out")
    assert result.exit_code == 0, result.output
    page = (tmp_path / "out" / "report.html").read_text(encoding="utf-8")
    assert "ride.csv" in page
    assert "kept.csv" in page
    test = tmp_path / "out" / "separating_test.csv"
    assert test.exists() == (damped_run.verdict.test is not None)
    assert not test.exists() or test.read_text() != "of an earlier diagnosis"


def test_native_writes_a_second_fmu_with_the_same_forces(known: None, rides: Path, tmp_path: Path) -> None:
    """Both kinds hold the corrected tire; a later diagnosis without it takes the native one away."""
    result = run(rides / "ride.csv", "--out", tmp_path, "--native")
    assert result.exit_code == 0, result.output
    native = tmp_path / "native" / "BicycleTire.fmu"
    assert result.output.splitlines()[-1] == f"native FMU: {native}"
    recording = read_recording(rides / "kept.csv")
    force = replay(tmp_path / "BicycleTire.fmu", recording)
    np.testing.assert_allclose(replay(native, recording), force, rtol=1e-12, atol=1e-9)
    assert run(rides / "ride.csv", "--out", tmp_path).exit_code == 0
    assert not native.exists()


def test_an_fmu_that_does_something_else_is_reported(
    known: None, rides: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(diagnosis_run, "replay", lambda fmu, r, **most: replay(fmu, r, **most) + 3.0)
    result = run(rides / "ride.csv", "--out", tmp_path)
    assert result.exit_code == 0
    assert "on ride the corrected FMU differs by up to 3 N from the fitted simulation" in " ".join(
        result.stdout.split()
    )
    assert "differs by up to 3 N" in (tmp_path / "report.html").read_text(encoding="utf-8")


def test_changes_made_while_reading_are_reported(known: None, rides: Path, tmp_path: Path) -> None:
    turned = tmp_path / "turned.csv"
    rows = (rides / "ride.csv").read_text().splitlines()
    pairs = [row.rsplit(",", 1) for row in rows[1:]]
    turned.write_text("\n".join([rows[0], *(f"{left},{-float(force)!r}" for left, force in pairs)]) + "\n")
    result = run(turned, "--out", tmp_path / "out")
    assert result.exit_code == 0, result.output
    assert result.stdout.startswith("note: turned: ")


def test_what_is_doubtful_stands_on_the_page_too(known: None, rides: Path, tmp_path: Path) -> None:
    large = tmp_path / "large.csv"
    rows = (rides / "ride.csv").read_text().splitlines()
    pairs = [row.rsplit(",", 1) for row in rows[1:]]
    large.write_text(
        "\n".join([rows[0], *(f"{left},{1000.0 * float(force)!r}" for left, force in pairs)]) + "\n"
    )
    result = run(large, "--out", tmp_path / "out")
    assert result.exit_code == 0, result.output
    page = (tmp_path / "out" / "report.html").read_text(encoding="utf-8")
    assert "large: doubtful: row" in page
    assert "1000 times too large for a tire" in page


def test_bad_input_ends_with_one_sentence(rides: Path, tmp_path: Path) -> None:
    empty = tmp_path / "empty"
    empty.mkdir()
    short = tmp_path / "short.csv"
    short.write_text("\n".join((rides / "ride.csv").read_text().splitlines()[:40]) + "\n")
    silent = saved(_silent(), tmp_path / "silent.csv")
    for arguments, words in (
        ([rides / "none.csv"], "there is no such file"),
        ([empty], "holds no recording"),
        ([rides, rides / "ride.csv"], "is given twice"),
        ([rides / "ride.csv", "--held-out", rides / "ride.csv"], "is given twice"),
        ([short], "samples; at least 100 are needed"),
        ([silent], "does not follow its deflection"),
        ([rides / "ride.csv", "--tire", tmp_path / "none.json"], "name a tire file that can be read"),
        ([], "Missing argument"),
    ):
        with looking_for("viscous_damping", "inertia"):
            result = run(*arguments, "--out", tmp_path / "out")
        assert result.exit_code == 2, (words, result.output)
        assert words in " ".join(result.stderr.split())
        assert result.stdout == ""
    assert not (tmp_path / "out").exists()


def _silent() -> Drive:
    """A load cell that was not connected: noise alone."""
    time, deflection, _ = ride(3, samples=2000)
    return read("silent", time, deflection, np.full(time.size, 50.0), 3)


def test_a_folder_that_cannot_be_written_is_reported_at_once(
    rides: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(diagnosis_run, "diagnose", lambda *_, **__: pytest.fail("it began to work"))
    taken = tmp_path / "taken"
    taken.write_text("a file")
    result = run(rides / "ride.csv", "--out", taken / "deeper")
    assert result.exit_code == 2
    assert "cannot be written" in result.stderr


def test_each_gives_a_verdict_for_every_recording(rides: Path, tmp_path: Path) -> None:
    (tmp_path / "broken.csv").write_text("no table\n")
    (tmp_path / "more").mkdir()
    for name in ("ride", "kept"):
        shutil.copy(rides / f"{name}.csv", tmp_path / "more")
    (tmp_path / "more" / "tests.csv").write_text("operator,day\nA,1\n")
    rides = tmp_path / "more"
    with looking_for("viscous_damping", "inertia"):
        result = run("--each", rides, tmp_path / "broken.csv", "--jobs", "1", "--out", tmp_path / "out")
    assert result.exit_code == 0, result.output
    assert f"note: {rides / 'tests.csv'} skipped: it is no recording" in result.stdout
    summary = (tmp_path / "out" / "summary.csv").read_text(encoding="utf-8-sig")
    rows = list(csv.DictReader(io.StringIO(summary, newline="")))
    assert [row["missing"] for row in rows] == ["viscous damping", "viscous damping", ""]
    assert "broken.csv: no comma" in summary
    assert (tmp_path / "out" / "summary.html").is_file()
    again = run("--each", rides, tmp_path / "broken.csv", "--out", tmp_path / "out", "--json", "--quiet")
    told = json.loads(again.stdout)
    assert again.stderr == ""  # nothing is diagnosed again, and nothing but the document is said
    assert [item["verdict"] and item["verdict"]["effects"] for item in told["items"]] == [
        ["viscous_damping"],
        ["viscous_damping"],
        None,
    ]
    assert "no comma" in told["items"][2]["error"]
    assert told["missing"][0]["times"] == 2
    assert [Path(p).name for p in told["written"]] == ["summary.csv", "summary.html"]
    assert all((tmp_path / "out" / item["report"]).is_file() for item in told["items"][:2])


@pytest.mark.parametrize(
    "options", [("--each", "--held-out", __file__), ("--jobs", "2"), ("--dask", "tcp://nowhere:1")]
)
def test_options_that_cannot_be_combined_are_refused(
    rides: Path, tmp_path: Path, options: tuple[str, ...]
) -> None:
    result = run(rides, *options, "--out", tmp_path / "out")
    assert result.exit_code == 2
    assert "--each" in result.output
