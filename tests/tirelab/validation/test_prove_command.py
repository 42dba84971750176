"""The command `tirelab prove` as a user types it."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from click.testing import CliRunner
from tirelab.cli import main


def test_it_wants_a_seed() -> None:
    done = CliRunner().invoke(main, ["prove", "--out", "x"])
    assert done.exit_code == 2
    assert "--seed" in done.output


def test_two_places_to_work_are_one_too_many(tmp_path: Path) -> None:
    words = [
        "prove",
        "--trials",
        "1",
        "--seed",
        "1",
        "--out",
        str(tmp_path),
        "--jobs",
        "2",
        "--dask",
        "tcp://host:8786",
    ]
    done = CliRunner().invoke(main, words)
    assert done.exit_code == 2
    assert "give one of them" in done.output
    assert "Traceback" not in done.output


def test_a_file_in_the_way_is_a_sentence(tmp_path: Path) -> None:
    (tmp_path / "file").write_text("")
    done = CliRunner().invoke(
        main, ["prove", "--seed", "1", "--out", str(tmp_path / "file" / "proof"), "--jobs", "1"]
    )
    assert done.exit_code == 2
    assert "--out" in done.output


@pytest.mark.slow
def test_trials_through_the_users_own_command(tmp_path: Path) -> None:
    done = CliRunner().invoke(
        main, ["prove", "--trials", "3", "--seed", "12", "--out", str(tmp_path), "--jobs", "2"]
    )
    assert done.exit_code == 0, done.output
    proof = json.loads((tmp_path / "proof.json").read_text())
    assert proof["failed"] == 0
    assert [line.split()[0] for line in done.output.splitlines()[:3]] == ["0000", "0001", "0002"]
    for score in proof["scores"]:
        # the FMU and the simulation sum the same in another order
        assert score["held_out"]["fmu_difference"] < 1e-6
    assert all((tmp_path / "verdicts" / key / "report.html").is_file() for key in ("0000", "0001", "0002"))
