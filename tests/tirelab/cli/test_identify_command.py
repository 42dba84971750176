"""The command `tirelab identify`: recordings in, a tire file out, or a sentence."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest
from click.testing import CliRunner
from presses import triangle
from radialtire import Hull1996, read_tire
from tirelab.article import press as rig
from tirelab.cli.identify import command
from tirelab.recordings.recording import Recording
from tirelab.recordings.writing import write_recording


def test_the_command_closes_the_loop_through_files(tmp_path: Path) -> None:
    files = []
    for recording in rig.record_all():
        files.append(str(tmp_path / f"{recording.name}.csv"))
        write_recording(recording, files[-1])
    out = tmp_path / "new" / "tire.json"
    done = CliRunner().invoke(command, [*files, "--out", str(out), "--name", "the article's again"])
    assert done.exit_code == 0, done.output
    assert "convex 1.27 cm" in done.output
    tire = read_tire(out)
    assert tire.name == "the article's again"
    for parameter in Hull1996.parameters:
        # twelve digits in the files leave 1e-12 of 2000 N, and D1 moves by 0.035 of itself for each newton
        assert getattr(tire.law, parameter.name) == pytest.approx(
            getattr(Hull1996(), parameter.name), rel=1e-6
        )
    beside = json.loads((tmp_path / "new" / "tire.identification.json").read_text(encoding="utf-8"))
    assert [c["name"] for c in beside["constants"]] == [p.name for p in Hull1996.parameters]
    assert len(beside["surfaces"]) == 14
    assert np.array(beside["correlation"]).shape == (10, 10)


@pytest.mark.parametrize(
    ("arguments", "sentence"),
    [
        (["flat.csv", "--law", "hull1996"], "1 surface (flat) cannot determine the constants"),
        (["absent.csv"], "absent.csv"),
        (["flat.csv", "--out", "."], "cannot be written"),
        (["flat.csv", "--zero", "deflection=-400mm"], "a tire takes 0.33 m at most"),
        (["flat.csv", "--law", "spline"], "'spline' is not one of"),
        ([], "Missing argument"),
    ],
)
def test_the_command_tells_bad_input_in_a_sentence(
    arguments: list[str], sentence: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    write_recording(triangle(), "flat.csv")
    done = CliRunner().invoke(command, arguments)
    assert done.exit_code == 2
    assert sentence in done.output
    assert not Path("tire.json").exists()


def test_a_part_may_be_deflected_further_than_a_wheel(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    time = np.arange(0.0, 20.0, 0.02)
    x = 0.5 * np.sin(np.pi * time / 5.0)
    force = 4e3 * x + np.random.default_rng(6).normal(size=time.size)
    write_recording(Recording("isolator", time, x, np.full(time.size, np.inf), force), "isolator.csv")
    done = CliRunner().invoke(command, ["isolator.csv", "--part", "linear", "--out", "isolator.json"])
    assert done.exit_code == 0, done.output
    # of 1000 samples of 1 N over 0.35 m the slope is known to 0.09 N/m
    law = read_tire("isolator.json").law
    assert law.coefficients(np.inf) == pytest.approx((40.0, 1.0), abs=0.005)


def test_a_folder_is_read_by_the_order_of_names_and_a_stray_text_file_is_skipped(tmp_path: Path) -> None:
    folder = tmp_path / "set"
    folder.mkdir()
    for name in ("b", "a"):
        write_recording(triangle(), folder / f"{name}.csv")
    (folder / "notes.txt").write_text("The tire was warm.\n", encoding="utf-8")
    outs = [tmp_path / f"{name}.json" for name in ("folder", "files")]
    done = CliRunner().invoke(command, [str(folder), "--out", str(outs[0])])
    assert done.exit_code == 0, done.output
    assert "note: notes.txt skipped: it is no recording" in done.output
    files = [str(folder / f"{name}.csv") for name in ("a", "b")]
    assert CliRunner().invoke(command, [*files, "--out", str(outs[1])]).exit_code == 0
    assert outs[0].read_text(encoding="utf-8") == outs[1].read_text(encoding="utf-8")


def test_where_the_settings_say_a_part_the_laws_of_parts_are_pointed_out(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    write_recording(triangle(), "flat.csv")
    assert "--part compare compares" not in CliRunner().invoke(command, ["flat.csv"]).output
    Path("recording.toml").write_text("part = true\n", encoding="utf-8")
    done = CliRunner().invoke(command, ["flat.csv"])
    assert done.exit_code == 0
    assert (
        "this is the law of a tire, that cannot pull: --part compare compares the laws of parts"
        in done.output
    )
    assert (
        "this is the law of a tire" not in CliRunner().invoke(command, ["flat.csv", "--part", "power"]).output
    )
