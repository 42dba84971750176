"""What all commands share: an example, --out, --json and --quiet, whole files or none, a run that can be repeated."""

from __future__ import annotations

import hashlib
import json
import re
import shlex
import signal
import subprocess
import sys
from html import unescape
from pathlib import Path
from typing import Any

import click
import pytest
from click.testing import CliRunner, Result
from radialtire import TireModel, write_tire
from tirelab.cli import COMMANDS, main
from tirelab.cli.progress_bar import time_left
from tirelab.diagnosis import diagnosis_run


def run(*arguments: str | Path) -> Result:
    result = CliRunner().invoke(main, [str(a) for a in arguments])
    assert result.exception is None or isinstance(result.exception, SystemExit), result.exception
    return result


def hears_ctrl_c() -> None:
    """Undo what a shell does to programs in its background."""
    signal.signal(signal.SIGINT, signal.SIG_DFL)


def command(name: str) -> click.Command:
    found = main.get_command(click.Context(main), name)
    assert found is not None
    return found


@pytest.mark.parametrize(
    "name", [name for name in COMMANDS if name != "open"]
)  # it serves and prints no result
def test_every_command_has_the_same_options_of_output(name: str) -> None:
    options = {opt for parameter in command(name).params for opt in parameter.opts}
    assert {"--out", "--json", "--quiet"} <= options


@pytest.mark.parametrize("name", COMMANDS)
def test_the_example_in_the_help_is_a_command_that_is_understood(name: str) -> None:
    told = run(name, "--help").stdout
    lines = told[told.index("Example:\n") :].splitlines()[1:]
    assert lines
    for line in filter(str.strip, lines):
        program, used, *words = shlex.split(line)
        assert (program, used) == ("tirelab", name)
        with command(name).make_context(name, list(words)):
            pass


def test_the_page_on_the_command_line_says_what_the_help_says(repository: Path) -> None:
    page = (repository / "examples" / "docs" / "command_line.md").read_text(encoding="utf-8")
    told = run("--help").stdout
    for name in COMMANDS:
        assert f"| `{name}` |" in page or f"`tirelab {name}" in page
    for shell in ("bash", "zsh", "fish"):
        assert f"_TIRELAB_COMPLETE={shell}_source tirelab" in page
        assert f"_TIRELAB_COMPLETE={shell}_source tirelab" in told


@pytest.fixture(scope="module")
def pressed(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The recordings of the article's rig, as a folder."""
    folder = tmp_path_factory.mktemp("pressed")
    result = run("rig", "--noise", "10N", "--seed", "1", "--out", folder, "--json")
    assert result.exit_code == 0
    made = json.loads(result.stdout)["recordings"]
    assert {Path(r["file"]).name for r in made} == {f.name for f in folder.iterdir()}
    assert all(r["samples"] > 100 and 0.0 < r["force_max"] <= 2300.0 for r in made)
    return folder


def test_a_tire_an_fmu_and_a_comparison_in_json(pressed: Path, tmp_path: Path) -> None:
    result = run("identify", pressed, "--out", tmp_path / "tire.json", "--json")
    assert json.loads(result.stdout) == json.loads((tmp_path / "tire.identification.json").read_text())
    assert "reading" in result.stderr

    built = run("build", "--tire", tmp_path / "tire.json", "--out", tmp_path, "--json")
    content = json.loads(built.stdout)
    assert Path(content["fmu"]) == tmp_path / "BicycleTire.fmu"
    assert content["guid"].startswith("{")

    recording = sorted(pressed.glob("*.csv"))[0]
    compared = run("compare", recording, "--fmu", content["fmu"], "--out", tmp_path, "--json", "--quiet")
    told = json.loads(compared.stdout)
    assert compared.stderr == ""
    assert 5.0 < told["rmse"] < 20.0  # 10 N of noise, and a law that fits
    assert Path(told["plot"]).is_file()


def test_what_is_understood_and_the_laws_of_a_part_in_json(pressed: Path, tmp_path: Path) -> None:
    recording = sorted(pressed.glob("*.csv"))[0]
    target = tmp_path / "settings.toml"
    shown = run("inspect", recording, "--out", target, "--json", "--quiet")
    told = json.loads(shown.stdout)
    assert (shown.stderr, told["settings"], told["picture"], told["refused"]) == ("", [str(target)], None, 0)
    (one,) = told["recordings"]
    assert one["file"] == str(recording)
    assert {c["channel"] for c in one["channels"]} == {"time", "deflection", "radius", "force"}
    assert not recording.with_name("recording.toml").exists()

    out = tmp_path / "part.json"
    laws = run("identify", recording, "--part", "power_gap", "--out", out, "--json", "--quiet")
    told = json.loads(laws.stdout)
    assert told["tire"] == str(out)
    assert out.is_file()
    assert {"linear", "power", "mf_tyre"} <= {law["name"] for law in told["laws"]}
    assert min(law["rmse"] for law in told["laws"]) < 20.0  # 10 N of noise


def test_a_native_fmu_in_json(tmp_path: Path) -> None:
    told = json.loads(run("build", "--native", "--out", tmp_path, "--json", "--quiet").stdout)
    assert Path(told["fmu"]).is_file()
    assert {"linux64", "win64", "darwin64"} <= set(told["binaries"])


def test_a_ride_and_the_article_in_json(tmp_path: Path) -> None:
    ride = run("ride", "--length", "5", "--obstacle", "log", "--out", tmp_path / "ride", "--json", "--quiet")
    told = json.loads(ride.stdout)
    assert told["force"][0] < told["force_mean"] < told["force"][1]
    assert {Path(p).name for p in told["written"]} == {f.name for f in (tmp_path / "ride").iterdir()}
    assert ride.stderr == ""
    article = run("article", "--out", tmp_path / "article", "--json")
    assert json.loads(article.stdout) == json.loads((tmp_path / "article" / "article.json").read_text())
    assert article.stderr.splitlines()[0] == "computing the article's claims"


def test_quiet_leaves_the_result_alone(pressed: Path, tmp_path: Path) -> None:
    spoken = run("identify", pressed, "--out", tmp_path / "a.json")
    quiet = run("identify", pressed, "--out", tmp_path / "b.json", "--quiet")
    assert quiet.stderr == ""
    assert spoken.stderr.splitlines()[0] == "reading"
    assert "RMSE of the law" in quiet.stdout


@pytest.mark.parametrize(
    "arguments", [["article"], ["rig"], ["ride", "--length", "5"], ["build"]], ids=lambda a: a[0]
)
def test_a_folder_that_is_a_file_is_refused(arguments: list[str], tmp_path: Path) -> None:
    taken = tmp_path / "taken"
    taken.write_text("a file")
    result = run(*arguments, "--out", taken, "--quiet")
    assert result.exit_code == 2
    assert "cannot be written" in result.stderr
    assert taken.read_text() == "a file"


def test_interrupted_while_it_writes_it_leaves_the_last_diagnosis_whole(
    damped_run: Any, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    out = tmp_path / "out"
    out.mkdir()
    (out / "diagnosis.json").write_text("of an earlier diagnosis")
    monkeypatch.setattr(diagnosis_run, "diagnose", lambda *_, **__: damped_run.verdict)

    def interrupted(path: Path, *_: Any, **__: Any) -> None:
        path.write_text("<html>half of it")
        raise KeyboardInterrupt

    monkeypatch.setattr(diagnosis_run, "write_report", interrupted)
    result = run("diagnose", damped_run.rides / "ride.csv", "--out", out)
    assert result.exit_code == 1
    assert "Aborted!" in result.stderr
    assert [f.name for f in out.iterdir()] == ["diagnosis.json"]
    assert (out / "diagnosis.json").read_text() == "of an earlier diagnosis"


def test_interrupted_while_it_writes_inspect_leaves_the_settings_whole(
    pressed: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    target = tmp_path / "recording.toml"
    target.write_text('radius = "flat"\n')
    write = Path.write_text

    def interrupted(path: Path, text: str, **options: Any) -> int:
        write(path, text[: len(text) // 2], **options)
        raise KeyboardInterrupt

    monkeypatch.setattr(Path, "write_text", interrupted)
    result = run("inspect", sorted(pressed.glob("*.csv"))[0], "--out", target)
    assert result.exit_code == 1
    assert [(f.name, f.read_text()) for f in tmp_path.iterdir()] == [("recording.toml", 'radius = "flat"\n')]


@pytest.mark.parametrize(
    ("arguments", "sentence"),
    [
        (["open", __file__], "cannot be written"),
        (["plan", "--stroke", "-20mm"], "stroke"),
        (["inspect", "none.csv"], "there is no such file"),
        (["identify", "none.csv"], "no such file"),
        (["build", "--tire", "none.json"], "name a tire file that can be read"),
        (["compare", "none.csv"], "no such file"),
        (["diagnose", "none.csv"], "there is no such file"),
        (["ride", "none.csv"], "none.csv"),
        (["rig", "--tire", "none.json"], "name a tire file that can be read"),
        (["article", "--out", __file__], "cannot be written"),
        (["prove", "--seed", "1", "--trials", "1", "--out", __file__], "cannot be written"),
    ],
    ids=lambda value: value[0] if isinstance(value, list) else "",
)
def test_bad_input_of_every_command_ends_with_status_2_and_one_sentence(
    arguments: list[str], sentence: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    result = run(*arguments)
    assert result.exit_code == 2
    assert sentence in result.stderr
    assert "Traceback" not in result.output
    assert result.stdout == ""
    assert list(tmp_path.iterdir()) == []


def test_every_command_is_asked_for_its_refusal() -> None:
    (mark,) = test_bad_input_of_every_command_ends_with_status_2_and_one_sentence.pytestmark
    assert [arguments[0] for arguments, _ in mark.args[1]] == list(COMMANDS)


@pytest.mark.skipif(sys.platform == "win32", reason="Ctrl-C is not a signal there")
def test_ctrl_c_ends_the_program_with_one_line_and_no_files(damped_run: Any, tmp_path: Path) -> None:
    words = [
        sys.executable,
        "-m",
        "tirelab",
        "diagnose",
        damped_run.rides / "ride.csv",
        "--out",
        tmp_path / "out",
    ]
    with subprocess.Popen(
        words, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, preexec_fn=hears_ctrl_c
    ) as program:
        assert program.stderr is not None
        for line in program.stderr:
            if line.startswith("fitting"):
                break
        program.send_signal(signal.SIGINT)
        rest = program.stderr.read()
    assert program.returncode == 1
    assert rest.strip().endswith("Aborted!")
    assert "Traceback" not in rest
    assert not (tmp_path / "out").exists()


@pytest.mark.slow
def test_the_report_says_how_to_repeat_the_run(damped_run: Any) -> None:
    """Its command, run again, writes the same bytes, and its hashes are those of the files."""
    page = (damped_run.out / "report.html").read_text(encoding="utf-8")
    words = shlex.split(unescape(re.search(r"<code>(tirelab diagnose .*?)</code>", page)[1]))
    before = {
        name: (damped_run.out / name).read_bytes() for name in ("diagnosis.json", "tire.json", "plots.csv")
    }
    assert words[0] == "tirelab"
    done = run(*words[1:], "--quiet")
    assert done.exit_code == 0, done.stderr
    assert {name: (damped_run.out / name).read_bytes() for name in before} == before
    for name in ("ride.csv", "kept.csv"):
        digest = hashlib.sha256((damped_run.rides / name).read_bytes()).hexdigest()
        assert digest in page
    assert re.search(r"<dd>\d{4}-\d\d-\d\dT\d\d:\d\d:\d\d[+-]\d\d:\d\d</dd>", page)
    for name in ("tirelab ", "numpy ", "numba ", "fmpy "):
        assert name in page


def test_a_tire_file_belongs_to_what_is_needed(
    damped_run: Any, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(diagnosis_run, "diagnose", lambda *_, **__: damped_run.verdict)
    write_tire(TireModel(), tmp_path / "base.json")
    result = run(
        "diagnose", damped_run.rides / "ride.csv", "--tire", tmp_path / "base.json", "--out", tmp_path / "o"
    )
    assert result.exit_code == 0
    assert f"<bdi>{tmp_path / 'base.json'}</bdi>" in (tmp_path / "o" / "report.html").read_text()


@pytest.mark.parametrize(
    ("done", "spent", "now", "told"),
    [
        (0.0, 1.0, 2.0, ""),
        (0.25, 10.0, 10.0, "about 30 s left"),
        (0.25, 10.0, 25.0, "about 15 s left"),
        (0.25, 10.0, 60.0, "about 0 s left"),
        (0.1, 60.0, 60.0, "about 9 min left"),
    ],
)
def test_the_time_left_follows_from_the_part_that_is_done(
    done: float, spent: float, now: float, told: str
) -> None:
    """A quarter done in 10 s leaves 30 s."""
    assert time_left(done, spent, now) == told
