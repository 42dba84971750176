"""A whole series with stand-ins for the diagnosis: sealed, blind, resumable, and scored."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Callable, Sequence
from html.parser import HTMLParser
from pathlib import Path
from typing import Any

import numpy as np
import polars as pl
import pytest
from radialtire import TireModel
from tirelab.batch.workers import Cores
from tirelab.errors import TirelabError
from tirelab.validation import Folders, Proof, Series, prove
from tirelab.validation.follow_up_test import read_test
from tirelab.validation.page import page
from tirelab.validation.seal import BrokenSealError

SEED = 31
HERE = Cores(jobs=1)
Diagnoser = Callable[[Sequence[Path], "Path | None", Path], None]


@pytest.fixture(scope="module")
def drawn(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Three trials, drawn and sealed once; every diagnosis fails."""

    def fails(recordings: Sequence[Path], tire: Path | None, out: Path) -> None:
        raise RuntimeError("no diagnosis <script>alert(1)</script>")

    root = tmp_path_factory.mktemp("drawn")
    prove(Series(Folders(root), SEED, 3, None, fails), HERE, lambda line: None)
    return root


@pytest.fixture
def undiagnosed(drawn: Path, tmp_path: Path) -> Folders:
    """The same trials before any diagnosis."""
    folders = Folders(tmp_path)
    for name in ("settings.json", "seals.sha256"):
        (tmp_path / name).write_bytes((drawn / name).read_bytes())
    for name in ("trials", "sealed", "tires"):
        (tmp_path / name).symlink_to(drawn / name)
    return folders


def run(folders: Folders, diagnoser: Diagnoser, trials: int = 3) -> Proof:
    return prove(Series(folders, SEED, trials, None, diagnoser), HERE, lambda line: None)


def test_seals_are_told_before_the_first_diagnosis(tmp_path: Path, oracle: Any) -> None:
    told: list[str] = []

    def watched(recordings: Sequence[Path], tire: Path | None, out: Path) -> None:
        assert len(told) == 2
        oracle(recordings, tire, out)

    prove(Series(Folders(tmp_path), SEED, 2, "none", watched), HERE, told.append)
    for line in told:
        key, seal = line.split()
        assert hashlib.sha256((tmp_path / "sealed" / f"{key}.json").read_bytes()).hexdigest() == seal
        assert f"{seal}  sealed/{key}.json" in (tmp_path / "seals.sha256").read_text().splitlines()


def test_a_diagnosis_is_handed_training_recordings_alone(undiagnosed: Folders, oracle: Any) -> None:
    run(undiagnosed, oracle)
    assert len(oracle.handed) == 3
    assert all(name.startswith("train_") for names in oracle.handed for name in names)
    assert not any(path.suffix != ".csv" for path in (undiagnosed.root / "trials").rglob("*.*"))


def test_an_oracle_is_exact_everywhere(undiagnosed: Folders, oracle: Any) -> None:
    proof = run(undiagnosed, oracle)
    assert [s.exact for s in proof.scores] == [True, True, True]


def test_the_believed_tire_errs_as_much_as_the_rig_says(undiagnosed: Folders, oracle: Any) -> None:
    for s in run(undiagnosed, oracle).scores:
        files = json.loads(undiagnosed.sealed(s.trial).read_text())["files"]
        *others, last = (f for name, f in sorted(files.items()) if name.startswith("heldout"))
        assert s.held_out is not None
        for errors, held in ((s.held_out.other, others), (s.held_out.alike, [last])):
            sizes = np.array([f["samples"] for f in held])
            squares = np.array([f["baseline_rmse"] for f in held]) ** 2
            # the files give deflection to 0.1 um and force to 1 mN: some 1e-2 N against RMSE of newtons
            assert errors.before == pytest.approx(float(np.sqrt(squares @ sizes / sizes.sum())), rel=1e-3)
            assert errors.floor <= 1.001 * errors.before


def test_started_again_it_diagnoses_only_what_is_new(undiagnosed: Folders, oracle: Any) -> None:
    first = run(undiagnosed, oracle, trials=2)
    seen = len(oracle.handed)
    second = run(undiagnosed, oracle)
    assert (seen, len(oracle.handed)) == (2, 3)
    assert second.scores[:2] == first.scores


def test_failures_are_recorded_and_not_thrown_again(drawn: Path, oracle: Any) -> None:
    proof = run(Folders(drawn), oracle)
    assert oracle.handed == []
    assert len(proof.failures) == 3
    assert all(s.error is not None and "no diagnosis" in s.error for s in proof.scores)
    assert json.loads((drawn / "proof.json").read_text())["failed"] == 3


def test_a_changed_answer_breaks_the_seal(undiagnosed: Folders, oracle: Any) -> None:
    run(undiagnosed, oracle)
    (undiagnosed.root / "sealed").unlink()
    for key in ("0000", "0001", "0002"):
        undiagnosed.sealed(key).parent.mkdir(exist_ok=True)
        undiagnosed.sealed(key).write_text("{}")
    with pytest.raises(BrokenSealError, match="was changed"):
        run(undiagnosed, oracle)


def test_another_seed_does_not_go_on_in_the_folder(undiagnosed: Folders, oracle: Any) -> None:
    with pytest.raises(TirelabError, match="holds the trials of seed 31"):
        prove(Series(undiagnosed, SEED + 1, 3, None, oracle), HERE, lambda line: None)


def test_a_verdict_that_breaks_the_contract_is_a_failure(undiagnosed: Folders) -> None:
    def half(recordings: Sequence[Path], tire: Path | None, out: Path) -> None:
        (out / "diagnosis.json").write_text('{"schema": 1}')

    proof = run(undiagnosed, half, trials=1)
    assert "is no diagnosis" in str(proof.failures[0].error)


def test_the_suggested_test_is_run_and_diagnosed_along(
    undiagnosed: Folders, diagnosis: Callable[..., None]
) -> None:
    handed: list[list[str]] = []

    def in_doubt(recordings: Sequence[Path], tire: Path | None, out: Path) -> None:
        handed.append([path.name for path in recordings])
        true = json.loads((out.parents[1] / "sealed" / f"{out.name}.json").read_text())["right"][0]
        if "test.csv" in handed[-1]:
            diagnosis(out, true)
            return
        time = np.arange(200) * 0.01
        deflection = 0.005 * (1.0 - np.cos(time))
        table = {"time [s]": time, "deflection [mm]": 1e3 * deflection, "radius [cm]": np.full(200, np.inf)}
        pl.DataFrame(table).write_csv(out / "separating_test.csv")
        test = {"waveform": "sine", "file": "separating_test.csv"}
        diagnosis(out, ["warm_up"], alternatives=[true], separating_test=test)

    (found,) = run(undiagnosed, in_doubt, trials=1).scores
    assert handed[1] == [*handed[0], "test.csv"]
    assert found.separation is not None
    assert (found.separation.rivals, found.separation.outcome) == (2, "told right")
    assert found.among
    assert not found.exact


def test_a_test_that_the_rig_refuses_is_a_failed_separation(
    undiagnosed: Folders, diagnosis: Callable[..., None]
) -> None:
    def uneven(recordings: Sequence[Path], tire: Path | None, out: Path) -> None:
        (out / "t.csv").write_text(
            "time [s],deflection [m],radius [m]\n" + "".join(f"{i**2},0.01,inf\n" for i in range(9))
        )
        diagnosis(out, ["warm_up"], alternatives=[["inertia"]], separating_test={"file": "t.csv"})

    (found,) = run(undiagnosed, uneven, trials=1).scores
    assert found.separation is not None
    assert found.separation.outcome == "failed"


def test_a_test_file_may_have_its_own_units(tmp_path: Path) -> None:
    path = tmp_path / "t.csv"
    path.write_text("Time [ms],deflection [mm],surface radius [cm]\n0,1,inf\n10,2,25.4\n")
    time, deflection, radius = read_test(path)
    assert time == pytest.approx([0.0, 0.01])
    assert deflection == pytest.approx([1e-3, 2e-3])
    assert radius == pytest.approx([np.inf, 0.254])


def test_a_test_file_without_a_channel_says_which(tmp_path: Path) -> None:
    path = tmp_path / "t.csv"
    path.write_text("time [s],deflection [mm]\n0,1\n")
    with pytest.raises(TirelabError, match="radius"):
        read_test(path)


class Loaded(HTMLParser):
    """Collects what a page would load from elsewhere, and its scripts."""

    def __init__(self) -> None:
        super().__init__()
        self.found: list[str] = []

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        """Note tags and attributes that load something."""
        if tag in ("script", "link", "iframe", "img", "object"):
            self.found.append(tag)
        self.found += [
            str(v)
            for name, v in attrs
            if name in ("src", "href", "xlink:href") and not str(v).startswith("#")
        ]


def test_the_page_loads_nothing_and_escapes_what_it_tells(drawn: Path) -> None:
    text = (drawn / "proof.html").read_text(encoding="utf-8")
    loaded = Loaded()
    loaded.feed(text)
    assert loaded.found == []
    assert "url(" not in text.replace("url(#", "")
    assert "&lt;script&gt;" in text


def test_the_page_of_a_full_series_has_every_part(undiagnosed: Folders, oracle: Any) -> None:
    text = page(run(undiagnosed, oracle))
    assert (undiagnosed.root / "proof.png").read_bytes().startswith(b"\x89PNG")
    for part in ("Against the bar", "What was taken for what", "honest", "Every trial"):
        assert part in text
    assert text.count("<svg") == 4


def test_a_trial_without_a_corrected_tire_keeps_the_believed_one(undiagnosed: Folders, oracle: Any) -> None:
    for s in run(undiagnosed, oracle).scores:
        assert s.held_out is not None
        for errors in (s.held_out.alike, s.held_out.other):
            assert errors.after == errors.before
        assert s.held_out.fmu_difference is None


def test_the_corrected_fmu_is_run_on_held_out_samples(
    undiagnosed: Folders, diagnosis: Callable[..., None]
) -> None:
    from radialtire import write_tire
    from tirelab.fmu.build import build_fmu

    def article(recordings: Sequence[Path], tire: Path | None, out: Path) -> None:
        write_tire(TireModel(), out / "tire.json")
        build_fmu(TireModel(), out)
        diagnosis(out, ["none"], tire="tire.json")
        content = json.loads((out / "diagnosis.json").read_text())
        (out / "diagnosis.json").write_text(json.dumps({**content, "corrected_fmu": "BicycleTire.fmu"}))

    (found,) = run(undiagnosed, article, trials=1).scores
    assert found.held_out is not None
    assert found.held_out.fmu_difference is not None
    assert found.held_out.fmu_difference < 1e-9
