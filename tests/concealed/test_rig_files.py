"""Trials on disk: recordings alone in their folder, answers elsewhere."""

import hashlib
import json
import math
from pathlib import Path

import numpy as np
import pytest
from click.testing import CliRunner
from concealed import Trial, draw, write, write_answer, write_baseline
from concealed.__main__ import main


@pytest.fixture(scope="module")
def trial() -> Trial:
    return draw(33, kind="masked")


def test_the_folder_holds_the_recordings_and_nothing_else(trial: Trial, tmp_path: Path) -> None:
    folder = tmp_path / "trial"
    write(trial, folder)
    expected = {f"train_{i}.csv" for i in range(len(trial.train))}
    expected |= {f"heldout_{i}.csv" for i in range(len(trial.heldout))}
    assert {path.name for path in folder.iterdir()} == expected
    text = (folder / "train_0.csv").read_text()
    assert text.startswith("time [s],deflection [cm],radius [cm],force [N]\n")
    for word in (*trial.answer.effects, *trial.answer.hidden, trial.answer.kind, "seed", "believed"):
        assert not any(word in path.read_text() for path in folder.iterdir())


def test_what_is_written_is_what_was_recorded(trial: Trial, tmp_path: Path) -> None:
    write(trial, tmp_path / "trial")
    for record in (*trial.train, *trial.heldout):
        table = np.genfromtxt(tmp_path / "trial" / record.name, delimiter=",", skip_header=1)
        assert table[:, 0] == pytest.approx(record.time, abs=1e-6)
        assert table[:, 1] == pytest.approx(100.0 * record.deflection, abs=1e-5)
        assert 1.0 / table[:, 2] == pytest.approx(0.01 / record.radius, rel=1e-5)
        assert table[:, 3] == pytest.approx(record.force, abs=1e-3)


def test_a_folder_with_something_else_in_it_is_refused(trial: Trial, tmp_path: Path) -> None:
    (tmp_path / "notes.txt").write_text("mine")
    with pytest.raises(FileExistsError, match=r"notes\.txt, which is no recording"):
        write(trial, tmp_path)


def test_the_answer_never_stands_beside_the_recordings(trial: Trial, tmp_path: Path) -> None:
    write(trial, tmp_path / "trial")
    with pytest.raises(ValueError, match="the answer belongs elsewhere"):
        write_answer(trial, tmp_path / "trial" / "answer.json")
    assert not (tmp_path / "trial" / "answer.json").exists()


def test_the_answer_is_strict_json_with_a_commitment_hash(trial: Trial, tmp_path: Path) -> None:
    path = tmp_path / "sealed" / "trial.json"
    commitment = write_answer(trial, path)
    assert commitment == hashlib.sha256(path.read_bytes()).hexdigest()

    def refuse(constant: str) -> None:
        raise AssertionError(f"{constant} is not JSON")

    answer = json.loads(path.read_text(), parse_constant=refuse)
    assert answer["kind"] == "masked"
    assert sorted(answer["right"][0]) == sorted(answer["effects"])
    assert answer["noise"] == pytest.approx(trial.noise)
    assert set(answer["files"]) == {record.name for record in (*trial.train, *trial.heldout)}
    for file in answer["files"].values():
        assert {"samples", "baseline_rmse", "floor_rmse", "read_floor_rmse"} <= set(file)


def test_the_baseline_tire_covers_every_surface(trial: Trial, tmp_path: Path) -> None:
    path = tmp_path / "baseline.json"
    write_baseline(trial, path)
    tire = json.loads(path.read_text())
    radii = [math.inf if s["radius [cm]"] == "inf" else s["radius [cm]"] for s in tire["surfaces"]]
    assert tire["law"] in {"hull1996", "table"}
    recorded = {round(100.0 * float(r), 6) for record in trial.train for r in np.unique(record.radius)}
    assert recorded <= set(radii)
    flat = tire["surfaces"][radii.index(math.inf)]
    assert tire["law"] == "table" or (flat["A"], flat["B"]) == (550.9, 1.422)


def test_trials_from_the_command_line(tmp_path: Path) -> None:
    arguments = ["--seed", "4", "--trials", "2", "--kind", "none", "--out", str(tmp_path)]
    first = CliRunner().invoke(main, arguments, catch_exceptions=False)
    assert first.exit_code == 0
    assert sorted(path.name for path in tmp_path.iterdir()) == [
        "baseline",
        "sealed",
        "trial_0000",
        "trial_0001",
    ]
    lines = [line.split() for line in first.output.splitlines()]
    for name, commitment in lines:
        assert commitment == hashlib.sha256((tmp_path / "sealed" / f"{name}.json").read_bytes()).hexdigest()
    assert CliRunner().invoke(main, arguments, catch_exceptions=False).output == first.output


@pytest.mark.parametrize(
    ("arguments", "complaint"),
    [
        (["--seed", "-1", "--trials", "1", "--out", "x"], "-1 is not in the range"),
        (["--seed", "1", "--trials", "0", "--out", "x"], "0 is not in the range"),
        (["--seed", "1", "--trials", "1", "--out", "x", "--kind", "rumour"], "rumour"),
        (["--seed", "1", "--trials", "1"], "--out"),
    ],
)
def test_bad_arguments_are_refused(arguments: list[str], complaint: str) -> None:
    done = CliRunner().invoke(main, arguments)
    assert done.exit_code == 2
    assert complaint in done.output
