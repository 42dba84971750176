"""The commands read what the options say: parts of files, sampling, settings; and propose a whole command."""

import json
import shlex
from pathlib import Path

import pytest
from click.testing import CliRunner, Result
from drives import damped, saved
from house_form import loading, write_rows
from rivals import looking_for
from tirelab.cli import main
from tirelab.preprocessing.samples import OF_TIME


def run(*words: object) -> Result:
    return CliRunner().invoke(main, [str(word) for word in words])


class TestCompare:
    def test_a_part_of_a_file(self, rig: Path, tmp_path: Path) -> None:
        for words in (["--from", "4s", "--to", "8s"], []):
            file = rig if words else f"{rig}@4s:8s"
            done = run("compare", file, *words, "--out", tmp_path)
            assert done.exit_code == 0, done.output
            assert "20 samples over 3.8 s" in done.output
            assert "note: 20 of 101 samples read: 4s to 8s" in done.output

    def test_without_time_nothing_is_said_of_it(self, tmp_path: Path) -> None:
        _, deflection, force = loading()
        file = write_rows(tmp_path / "a.csv", "Stroke [cm],Load [N]", deflection, force + 1.0)
        done = run("compare", file, "--radius", "flat", "--out", tmp_path)
        assert done.exit_code == 0, done.output
        assert "101 samples, forces up to" in done.output
        assert "at sample " in done.output
        done = run("compare", file, "--radius", "flat", "--sampling", "5Hz", "--out", tmp_path)
        assert "101 samples over 20 s" in done.output

    def test_what_is_proposed_replaces_what_was_said(self, tmp_path: Path) -> None:
        file = write_rows(tmp_path / "a.csv", "time,deflection,force", *loading())
        done = run("compare", file, f"--out={tmp_path}", "--units", "time=s")
        assert done.exit_code == 2
        proposed = shlex.split(done.stderr.splitlines()[-1].split("check: ", 1)[1])
        assert proposed == [
            *("tirelab", "compare", str(file), f"--out={tmp_path}"),
            *("--units", "time=s,deflection=cm,force=N", "--radius", "flat"),
        ]
        assert run(*proposed[1:]).exit_code == 0

    def test_what_is_proposed_stands_before_files_behind_two_dashes(
        self, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
    ) -> None:
        """Their names may begin with one: all words behind them are files."""
        write_rows(tmp_path / "-1 bar.csv", "time [s],deflection [cm],force [N]", *loading())
        monkeypatch.chdir(tmp_path)
        done = run("compare", "--", "-1 bar.csv")
        proposed = shlex.split(done.stderr.splitlines()[-1].split("check: ", 1)[1])
        assert proposed == ["tirelab", "compare", "--radius", "flat", "--", "-1 bar.csv"]
        assert run(*proposed[1:]).exit_code == 0

    def test_what_has_to_be_replaced_is_said(self, tmp_path: Path) -> None:
        rows = [f"{0.1 * i:.1f},{4.0 * i:.1f},{10 * i}" for i in range(100)]
        (tmp_path / "a.csv").write_text("\n".join(["Time (s),Load (N),Encoder (counts)", *rows]) + "\n")
        said = run("inspect", tmp_path / "a.csv", "--radius", "flat").stderr
        assert "The whole command, with NAME to replace and guesses to check: tirelab inspect" in said

    def test_doubts_are_said(self, tmp_path: Path) -> None:
        time, deflection, force = loading()
        file = write_rows(tmp_path / "a.csv", "time [s],x [cm],F [N]", time, deflection, force / 1e3)
        for command in (["compare"], ["identify"]):
            done = run(*command, file, "--radius", "flat", "--out", tmp_path / command[0])
            assert "about 1000 times too small for a tire at 25 mm of deflection: kN?" in " ".join(
                done.output.split()
            )


@pytest.fixture(scope="module")
def ride(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A ride with 500 N s/m of damping."""
    return saved(damped(1, samples=4000), tmp_path_factory.mktemp("parts") / "ride.csv")


class TestDiagnose:
    def test_parts_of_one_file_are_fitted_and_held_out(self, ride: Path, tmp_path: Path) -> None:
        end = float(ride.read_text(encoding="utf-8").splitlines()[-1].split(",")[0])
        half = f"{end / 2:g}s"
        with looking_for("viscous_damping", "inertia"):
            done = run("diagnose", ride, "--fit", f"0s:{half}", "--held-out", f"{half}:", "--out", tmp_path)
        assert done.exit_code == 0, done.output
        content = json.loads((tmp_path / "diagnosis.json").read_text(encoding="utf-8"))
        assert {e["name"] for e in content["verdict"]["effects"]} == {"viscous_damping"}
        assert "of 4000 samples read" in done.output

    def test_parts_that_share_samples_are_refused(self, ride: Path, tmp_path: Path) -> None:
        done = run("diagnose", ride, "--fit", "0s:10s", "--held-out", "5s:20s", "--out", tmp_path, "--quiet")
        assert done.exit_code == 2
        assert "give each part of a file once" in done.stderr

    @pytest.mark.parametrize("words", [["--fit", "some"], ["--fit", "1s:2s", "b.csv"], ["--held-out", "1s:"]])
    def test_a_range_needs_one_recording(self, ride: Path, words: list[str], tmp_path: Path) -> None:
        other = saved(damped(2, samples=400), tmp_path / "b.csv")
        words = [str(other) if word == "b.csv" else word for word in words]
        more = [other] if words[0] == "--held-out" else []
        done = run("diagnose", ride, *more, *words)
        assert done.exit_code == 2
        assert "range" in done.stderr

    def test_without_time_nothing_is_claimed_of_it(self, ride: Path, tmp_path: Path) -> None:
        lines = [line.split(",")[1:] for line in ride.read_text(encoding="utf-8").splitlines()]
        file = tmp_path / "timeless.csv"
        file.write_text("\n".join(map(",".join, lines)) + "\n", encoding="utf-8")
        timed = {"viscous_damping", "inertia", "force_lag", "warm_up", "pressure_leak", "force_drift"}
        with looking_for(*timed, "recalibration", "force_offset", "rate_independent_hysteresis"):
            done = run("diagnose", file, "--out", tmp_path / "out", "--quiet")
        assert done.exit_code == 0, done.output
        content = json.loads((tmp_path / "out" / "diagnosis.json").read_text(encoding="utf-8"))
        named = {e["name"] for e in content["verdict"]["effects"]}
        assert not named & timed
        assert not {place["by"] for place in content["where"]} & OF_TIME
        said = " ".join(done.output.split())
        for unseen in ("viscous damping", "pressure leak", "inertia"):
            assert f"+ {unseen} not seen the recording has no time" in said
        assert "was not measured" in said
        assert "one speed at each deflection" not in said


def test_settings_are_named_by_an_option(rig: Path, tmp_path: Path) -> None:
    settings = tmp_path / "bump.toml"
    settings.write_text('to = "8 s"\n', encoding="utf-8")
    done = run("compare", rig, "--settings", settings, "--out", tmp_path)
    assert "settings read from bump.toml" in done.output
    assert "40 of 101 samples read" in done.output


def test_a_text_that_is_shorter_than_the_rows_to_skip_is_refused(rig: Path, tmp_path: Path) -> None:
    done = run("compare", rig, "--skip-rows", "500", "--out", tmp_path)
    assert done.exit_code == 2
    assert "no table below its first 500 rows" in done.stderr
