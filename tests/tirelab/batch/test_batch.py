"""A shelf of recordings: one verdict each, a summary of all, and what is broken passed over."""

from __future__ import annotations

import csv
import json
import os
import warnings
from collections.abc import Iterator, Sequence
from html.parser import HTMLParser
from pathlib import Path
from typing import Any

import pytest
from tirelab.batch.batch import diagnose_each, find_items
from tirelab.batch.workers import Cores
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
def shelf(tmp_path: Path) -> Path:
    """Three recordings, one broken, a folder with two, a folder in it, a note, and a hidden folder."""
    shelf = tmp_path / "shelf"
    for name in (
        "lag_1.csv",
        "lag_2.csv",
        "nothing_1.csv",
        "day/lag_3.csv",
        "day/warm_4.csv",
        "day/late/lag_5.csv",
    ):
        (shelf / name).parent.mkdir(parents=True, exist_ok=True)
        (shelf / name).write_text(ROWS)
    (shelf / "broken.csv").write_text("time [s],deflection [mm],radius [cm],force [N]\n0,1,inf,what\n")
    (shelf / "notes.md").write_text("# notes")
    (shelf / ".hidden").mkdir()
    (shelf / ".hidden" / "lag_9.csv").write_text(ROWS)
    return shelf


def run(shelf: Path, out: Path, diagnoser: Any = stand_in, cores: Cores = HERE, **more: Any) -> Any:
    return diagnose_each([shelf], out, cores=cores, diagnoser=diagnoser, tell=lambda line: None, **more)


def test_files_are_diagnosed_alone_and_folders_together(shelf: Path, tmp_path: Path) -> None:
    items, passed_over = find_items([shelf], tmp_path / "out")
    assert {item.name: [path.name for path in item.recordings] for item in items} == {
        "shelf/broken": ["broken.csv"],
        "shelf/lag_1": ["lag_1.csv"],
        "shelf/lag_2": ["lag_2.csv"],
        "shelf/nothing_1": ["nothing_1.csv"],
        "shelf/day": ["lag_3.csv", "warm_4.csv"],
        "shelf/day/late": ["lag_5.csv"],
    }
    assert [path.name for path in passed_over] == ["notes.md"]


def test_the_summary_tells_what_is_missing_how_often_and_how_sure(shelf: Path, tmp_path: Path) -> None:
    result = run(shelf, tmp_path / "out")
    counts = {count.name: (count.times, count.confidence) for count in result.counts}
    assert counts == {"lag": (4, pytest.approx(0.8)), "warm": (1, 0.8), "none": (1, 0.8)}
    with (tmp_path / "out" / "summary.csv").open(encoding="utf-8-sig", newline="") as file:
        rows = {row["name"]: row for row in csv.DictReader(file)}
    assert rows["shelf/day"]["missing"] == "lag + warm"
    assert rows["shelf/day"]["rivals"] == "inertia"
    assert rows["shelf/day"]["error"] == ""
    assert rows["shelf/nothing_1"]["missing"] == "nothing"
    assert rows["shelf/nothing_1"]["error"] == rows["shelf/nothing_1"]["rivals"] == ""
    assert rows["shelf/lag_1"]["most of it in"] == "direction unloading (70 %)"
    assert float(rows["shelf/lag_1"]["before [N]"]) == 9.0
    assert (tmp_path / "out" / rows["shelf/lag_1"]["report"]).read_text() == "<p>report</p>"


def test_a_broken_file_is_a_line_of_the_summary(shelf: Path, tmp_path: Path) -> None:
    result = run(shelf, tmp_path / "out")
    (broken,) = result.failures
    assert broken.item.name == "shelf/broken"
    assert "broken.csv" in broken.error
    assert "what" in broken.error


def test_started_again_only_what_changed_is_diagnosed(shelf: Path, tmp_path: Path) -> None:
    counted = Counted()
    first = run(shelf, tmp_path / "out", counted)
    assert counted.calls == 6
    again = run(shelf, tmp_path / "out", counted)
    assert counted.calls == 6
    assert [row.names for row in again.rows] == [row.names for row in first.rows]
    os.utime(shelf / "lag_1.csv", ns=(1, 1))
    run(shelf, tmp_path / "out", counted)
    assert counted.calls == 7


def test_another_tire_or_other_options_diagnose_again(shelf: Path, tmp_path: Path) -> None:
    counted = Counted()
    (tmp_path / "tire.json").write_text("{}")
    run(shelf, tmp_path / "out", counted)
    run(shelf, tmp_path / "out", counted, tire=tmp_path / "tire.json")
    run(shelf, tmp_path / "out", counted, tire=tmp_path / "tire.json", reading=Reading(radius="flat"))
    assert counted.calls == 18


def test_a_crash_is_tried_again_and_a_broken_file_is_not(shelf: Path, tmp_path: Path) -> None:
    (shelf / "crash_1.csv").write_text(ROWS)
    counted = Counted()
    assert len(run(shelf, tmp_path / "out", counted).failures) == 2
    run(shelf, tmp_path / "out", counted)
    assert counted.calls == 8


def test_the_summary_may_lie_within_the_shelf(shelf: Path) -> None:
    counted = Counted()
    run(shelf, shelf / "out", counted)
    (shelf / "out" / "verdicts" / "shelf~lag_1" / "held.csv").write_text(ROWS)
    run(shelf, shelf / "out", counted)
    assert counted.calls == 6


def test_two_of_the_same_name_are_kept_apart(tmp_path: Path) -> None:
    for folder in ("a", "b"):
        (tmp_path / folder / "runs").mkdir(parents=True)
        (tmp_path / folder / "runs" / "lag_1.csv").write_text(ROWS)
    items, _ = find_items([tmp_path / "a" / "runs", tmp_path / "b" / "runs"], tmp_path / "out")
    assert [item.name for item in items] == ["runs/lag_1", "runs/lag_1-2"]


def test_a_name_is_no_formula_and_no_markup(tmp_path: Path) -> None:
    (tmp_path / "=<b>1.csv").write_text(ROWS)
    diagnose_each(
        [tmp_path / "=<b>1.csv"], tmp_path / "out", cores=HERE, diagnoser=stand_in, tell=lambda line: None
    )
    assert b"\r\n'=<b>1," in (tmp_path / "out" / "summary.csv").read_bytes()
    assert "<b>" not in (tmp_path / "out" / "summary.html").read_text(encoding="utf-8")


@pytest.mark.parametrize("place", ["nowhere", "empty"])
def test_nothing_to_diagnose_is_a_sentence(tmp_path: Path, place: str) -> None:
    (tmp_path / "empty").mkdir()
    with pytest.raises(TirelabError, match=place):
        run(tmp_path / place, tmp_path / "out")


class Loaded(HTMLParser):
    """Collects what a page would load from elsewhere."""

    def __init__(self) -> None:
        super().__init__()
        self.found: list[str] = []

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        """Note links."""
        if tag in ("script", "link", "iframe", "img", "object"):
            self.found.append(tag)
        self.found += [str(value) for name, value in attrs if name in ("src", "href")]


def test_the_page_links_reports_and_loads_nothing(shelf: Path, tmp_path: Path) -> None:
    run(shelf, tmp_path / "out")
    loaded = Loaded()
    loaded.feed((tmp_path / "out" / "summary.html").read_text(encoding="utf-8"))
    assert len(loaded.found) == 5
    assert all((tmp_path / "out" / link.replace("%7E", "~")).is_file() for link in loaded.found)


@pytest.fixture
def cluster() -> Iterator[Any]:
    distributed = pytest.importorskip("distributed")
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # of the cluster's own sockets and event loop
        with distributed.LocalCluster(
            n_workers=1, threads_per_worker=2, processes=False, dashboard_address=None
        ) as local:
            yield local


def test_a_dask_cluster_writes_the_same_summary(shelf: Path, tmp_path: Path, cluster: Any) -> None:
    run(shelf, tmp_path / "here")
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        run(shelf, tmp_path / "there", cores=Cores(dask=cluster.scheduler_address))
    here, there = (
        (tmp_path / name / "summary.csv").read_text(encoding="utf-8-sig") for name in ("here", "there")
    )
    assert here == there
