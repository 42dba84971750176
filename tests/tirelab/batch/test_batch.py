"""Batch diagnosis: what gets a verdict, what is diagnosed again, and what a broken recording does."""

from __future__ import annotations

import csv
import json
import os
import warnings
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import pytest
from loaded import loaded_by
from tirelab.batch.batch import Batch, diagnose_batch, find_items
from tirelab.computing.workers import Cores
from tirelab.errors import TirelabError
from tirelab.recordings.reading import Reading
from tirelab.recordings.recording import read_recording

HERE = Cores(jobs=1)
ROWS = "time [s],deflection [mm],radius [cm],force [N]\n" + "".join(
    f"{i},{i + 1},inf,{40 * i + 40}\n" for i in range(20)
)


def content(names: Sequence[str], confidence: float = 0.8, report: str | None = None) -> dict[str, Any]:
    """A diagnosis.json by the contract."""
    return {
        "schema": 1,
        "verdict": {
            "effects": [{"name": n, "parameters": {}, "share": 1.0} for n in names if n != "unknown"],
            "confidence": confidence,
            "alternatives": [["inertia"]] if names else [],
            "unexplained": "unknown" in names,
            "summary": "",
            "separating_test": None,
        },
        "where": [
            {
                "by": "direction",
                "from": -1.0,
                "to": -1.0,
                "unit": "1",
                "label": "unloading",
                "share": 0.7,
                "mean_residual": -1.0,
            },
            {"by": "time", "from": 1.0, "to": 2.0, "unit": "s", "share": 0.25, "mean_residual": 3.0},
        ],
        "fit": {"noise": 2.0, "before": 9.0, "after": 2.1, "held_out_before": None, "held_out_after": None},
        "tire": "tire.json",
        "corrected_fmu": None,
        "report": report,
    }


def stand_in(recordings: Sequence[Path], tire: Path | None, out: Path) -> None:
    """Reads the recordings as the tool does, and names what their files are called after."""
    names = sorted({read_recording(path).name.partition("_")[0] for path in recordings} - {"nothing"})
    if "crash" in names:
        raise RuntimeError("a fault of the program")
    (out / "report.html").write_text("<p>report</p>")
    (out / "diagnosis.json").write_text(json.dumps(content(names, report="report.html")))


class Counted:
    """The stand-in, and how often it was called."""

    def __init__(self) -> None:
        self.calls = 0

    def __call__(self, recordings: Sequence[Path], tire: Path | None, out: Path) -> None:
        """Diagnose."""
        self.calls += 1
        stand_in(recordings, tire, out)


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """Three recordings, one broken, a folder with two, a folder in it, a note, and a hidden folder."""
    folder = tmp_path / "folder"
    for name in (
        "lag_1.csv",
        "lag_2.csv",
        "nothing_1.csv",
        "day/lag_3.csv",
        "day/warm_4.csv",
        "day/late/lag_5.csv",
    ):
        (folder / name).parent.mkdir(parents=True, exist_ok=True)
        (folder / name).write_text(ROWS)
    (folder / "broken.csv").write_text("time [s],deflection [mm],radius [cm],force [N]\n0,1,inf,what\n")
    (folder / "notes.md").write_text("# notes")
    (folder / ".hidden").mkdir()
    (folder / ".hidden" / "lag_9.csv").write_text(ROWS)
    return folder


def run(folder: Path, out: Path, diagnoser: Any = stand_in, cores: Cores = HERE, **more: Any) -> Any:
    return diagnose_batch(Batch((folder,), out, diagnoser=diagnoser, **more), cores, lambda line: None)


def test_files_are_diagnosed_alone_and_folders_together(folder: Path, tmp_path: Path) -> None:
    items, skipped = find_items([folder], tmp_path / "out")
    assert {item.name: [path.name for path in item.recordings] for item in items} == {
        "folder/broken": ["broken.csv"],
        "folder/lag_1": ["lag_1.csv"],
        "folder/lag_2": ["lag_2.csv"],
        "folder/nothing_1": ["nothing_1.csv"],
        "folder/day": ["lag_3.csv", "warm_4.csv"],
        "folder/day/late": ["lag_5.csv"],
    }
    assert [path.name for path in skipped] == ["notes.md"]


def test_the_summary_counts_what_is_missing(folder: Path, tmp_path: Path) -> None:
    result = run(folder, tmp_path / "out")
    counts = {count.name: (count.times, count.confidence) for count in result.counts}
    assert counts == {"lag": (4, pytest.approx(0.8)), "warm": (1, 0.8), "none": (1, 0.8)}
    with (tmp_path / "out" / "summary.csv").open(encoding="utf-8-sig", newline="") as file:
        rows = {row["name"]: row for row in csv.DictReader(file)}
    assert rows["folder/day"]["missing"] == "lag + warm"
    assert rows["folder/day"]["alternatives"] == "inertia"
    assert rows["folder/day"]["error"] == ""
    assert rows["folder/nothing_1"]["missing"] == "nothing"
    assert rows["folder/nothing_1"]["error"] == rows["folder/nothing_1"]["alternatives"] == ""
    assert rows["folder/lag_1"]["largest part in"] == "direction unloading (70 %)"
    assert float(rows["folder/lag_1"]["before [N]"]) == 9.0
    assert (tmp_path / "out" / rows["folder/lag_1"]["report"]).read_text() == "<p>report</p>"


def test_a_broken_file_is_a_line_of_the_summary(folder: Path, tmp_path: Path) -> None:
    result = run(folder, tmp_path / "out")
    (broken,) = result.failures
    assert broken.item.name == "folder/broken"
    assert "broken.csv" in broken.error
    assert "what" in broken.error


def test_a_second_run_diagnoses_only_what_changed(folder: Path, tmp_path: Path) -> None:
    counted = Counted()
    first = run(folder, tmp_path / "out", counted)
    assert counted.calls == 6
    again = run(folder, tmp_path / "out", counted)
    assert counted.calls == 6
    assert [row.names for row in again.rows] == [row.names for row in first.rows]
    os.utime(folder / "lag_1.csv", ns=(1, 1))
    run(folder, tmp_path / "out", counted)
    assert counted.calls == 7


def test_another_tire_or_other_options_diagnose_again(folder: Path, tmp_path: Path) -> None:
    counted = Counted()
    (tmp_path / "tire.json").write_text("{}")
    run(folder, tmp_path / "out", counted)
    run(folder, tmp_path / "out", counted, tire=tmp_path / "tire.json")
    run(folder, tmp_path / "out", counted, tire=tmp_path / "tire.json", reading=Reading(radius="flat"))
    assert counted.calls == 18


def test_a_crash_is_tried_again_and_a_broken_file_is_not(folder: Path, tmp_path: Path) -> None:
    (folder / "crash_1.csv").write_text(ROWS)
    counted = Counted()
    assert len(run(folder, tmp_path / "out", counted).failures) == 2
    run(folder, tmp_path / "out", counted)
    assert counted.calls == 8


def test_the_summary_may_lie_in_the_folder_of_recordings(folder: Path) -> None:
    counted = Counted()
    run(folder, folder / "out", counted)
    (folder / "out" / "verdicts" / "folder~lag_1" / "held.csv").write_text(ROWS)
    run(folder, folder / "out", counted)
    assert counted.calls == 6


def test_two_of_the_same_name_are_kept_apart(tmp_path: Path) -> None:
    for folder in ("a", "b"):
        (tmp_path / folder / "runs").mkdir(parents=True)
        (tmp_path / folder / "runs" / "lag_1.csv").write_text(ROWS)
    items, _ = find_items([tmp_path / "a" / "runs", tmp_path / "b" / "runs"], tmp_path / "out")
    assert [item.name for item in items] == ["runs/lag_1", "runs/lag_1-2"]


def test_a_name_is_no_formula_and_no_markup(tmp_path: Path) -> None:
    (tmp_path / "=<b>1.csv").write_text(ROWS)
    run(tmp_path / "=<b>1.csv", tmp_path / "out")
    assert b"\r\n'=<b>1," in (tmp_path / "out" / "summary.csv").read_bytes()
    assert "<b>" not in (tmp_path / "out" / "summary.html").read_text(encoding="utf-8")


@pytest.mark.parametrize("place", ["nowhere", "empty"])
def test_nothing_to_diagnose_is_a_sentence(tmp_path: Path, place: str) -> None:
    (tmp_path / "empty").mkdir()
    with pytest.raises(TirelabError, match=place):
        run(tmp_path / place, tmp_path / "out")


def test_the_page_links_reports_and_loads_nothing(folder: Path, tmp_path: Path) -> None:
    run(folder, tmp_path / "out")
    loaded = loaded_by((tmp_path / "out" / "summary.html").read_text(encoding="utf-8"))
    assert len(loaded) == 5
    assert all((tmp_path / "out" / link.replace("%7E", "~")).is_file() for link in loaded)


def test_a_dask_cluster_writes_the_same_summary(folder: Path, tmp_path: Path, cluster: Any) -> None:
    run(folder, tmp_path / "here")
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        run(folder, tmp_path / "there", cores=Cores(dask=cluster.scheduler_address))
    here, there = (
        (tmp_path / name / "summary.csv").read_text(encoding="utf-8-sig") for name in ("here", "there")
    )
    assert here == there


def test_every_item_is_shown_with_its_verdict_or_its_error(folder: Path, tmp_path: Path) -> None:
    shown: list[str] = []
    diagnose_batch(Batch((folder,), tmp_path / "out", diagnoser=stand_in), HERE, shown.append)
    assert len(shown) == 6
    assert "folder/day: lag + warm, confidence 80 %" in shown
    (broken,) = [line for line in shown if line.startswith("folder/broken: ")]
    assert "broken.csv" in broken


def test_recordings_are_read_as_the_batch_says(
    folder: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    calls: list[tuple[list[str], Any, Any]] = []

    def diagnosis(recordings: Sequence[Path], out: Path, *, tire: Path | None, reading: Reading) -> None:
        calls.append(([path.name for path in recordings], tire, reading))
        stand_in(recordings, tire, out)

    monkeypatch.setattr("tirelab.batch.batch.run_diagnosis", diagnosis)
    tire = tmp_path / "tire.json"
    tire.write_text("{}")
    batch = Batch((folder / "day",), tmp_path / "out", tire, Reading(radius="flat"))
    assert [row.names for row in diagnose_batch(batch, HERE, lambda line: None).rows] == [
        {"lag"},
        {"warm"},
        {"lag"},
    ]
    assert calls == [
        ([name], tire, Reading(radius="flat")) for name in ("lag_3.csv", "warm_4.csv", "lag_5.csv")
    ]


def test_a_verdict_that_is_gone_or_broken_is_diagnosed_again(folder: Path, tmp_path: Path) -> None:
    counted = Counted()
    run(folder, tmp_path / "out", counted)
    (tmp_path / "out" / "verdicts" / "folder~day" / "diagnosis.json").write_text("{")
    (tmp_path / "out" / "verdicts" / "folder~lag_1" / "diagnosis.json").unlink()
    (tmp_path / "out" / "outcomes" / "folder~lag_2.json").write_text("[]")
    run(folder, tmp_path / "out", counted)
    assert counted.calls == 6 + 3


def test_a_diagnosis_without_its_file_is_an_error_that_is_tried_again(folder: Path, tmp_path: Path) -> None:
    calls = []

    def nothing(recordings: Sequence[Path], tire: Path | None, out: Path) -> None:
        calls.append(out)

    for _ in range(2):
        (row,) = run(folder / "lag_1.csv", tmp_path / "out", nothing).rows
        assert "diagnosis.json" in row.error
    assert len(calls) == 2


def test_a_tire_file_that_is_gone_is_a_sentence(folder: Path, tmp_path: Path) -> None:
    with pytest.raises(TirelabError, match=r"gone\.json: No such file.*name a tire file"):
        run(folder, tmp_path / "out", tire=tmp_path / "gone.json")


def test_an_output_folder_that_cannot_be_made_is_a_sentence(folder: Path, tmp_path: Path) -> None:
    (tmp_path / "file").write_text("")
    with pytest.raises(TirelabError, match=r"cannot be written .*name another folder with --out"):
        run(folder, tmp_path / "file" / "out")
