"""Blind trials with replacements of the diagnosis: committed to, blind, resumable, and scored."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import polars as pl
import pytest
from loaded import loaded_by
from matplotlib.figure import Figure
from radialtire import TireModel
from tirelab.computing.workers import Cores
from tirelab.errors import TirelabError
from tirelab.validation import BlindTrials, Folders, Proof, blind_trials, prove
from tirelab.validation.commitment import ChangedAnswerError, opened
from tirelab.validation.folders import read_json
from tirelab.validation.follow_up_test import read_test
from tirelab.validation.page import page

SEED = 31
HERE = Cores(jobs=1)
Diagnoser = Callable[[Sequence[Path], "Path | None", Path], None]


@pytest.fixture(scope="module")
def drawn(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Three trials, drawn once; every diagnosis fails."""

    def fails(recordings: Sequence[Path], tire: Path | None, out: Path) -> None:
        raise RuntimeError("no diagnosis <script>alert(1)</script>")

    root = tmp_path_factory.mktemp("drawn")
    prove(BlindTrials(Folders(root), SEED, 3, None, fails), HERE, lambda line: None)
    return root


def copied(drawn: Path, root: Path) -> Folders:
    """The same trials before any diagnosis."""
    for name in ("settings.json", "seals.sha256"):
        (root / name).write_bytes((drawn / name).read_bytes())
    for name in ("trials", "sealed", "tires"):
        (root / name).symlink_to(drawn / name)
    return Folders(root)


@pytest.fixture
def undiagnosed(drawn: Path, tmp_path: Path) -> Folders:
    """The drawn trials before any diagnosis."""
    return copied(drawn, tmp_path)


@dataclass(frozen=True)
class Run:
    """A run of all trials: its folders, what the diagnosis got, and the proof."""

    folders: Folders
    recordings: list[list[str]]
    proof: Proof


@pytest.fixture(scope="module")
def oracle_run(drawn: Path, tmp_path_factory: pytest.TempPathFactory, Oracle: Any) -> Run:
    """The drawn trials, diagnosed by an oracle."""
    folders = copied(drawn, tmp_path_factory.mktemp("oracle"))
    oracle = Oracle()
    return Run(folders, oracle.recordings, run(folders, oracle))


@pytest.fixture
def no_page(monkeypatch: pytest.MonkeyPatch) -> None:
    """Leaves out the page and its figures, which take most of a second."""
    monkeypatch.setattr(blind_trials, "page", lambda proof: "")
    monkeypatch.setattr(blind_trials, "overview", lambda scores, title: Figure())


def run(folders: Folders, diagnoser: Diagnoser, trials: int = 3) -> Proof:
    return prove(BlindTrials(folders, SEED, trials, None, diagnoser), HERE, lambda line: None)


@pytest.mark.usefixtures("no_page")
def test_commitment_hashes_are_shown_before_the_first_diagnosis(tmp_path: Path, oracle: Any) -> None:
    shown: list[str] = []

    def watched(recordings: Sequence[Path], tire: Path | None, out: Path) -> None:
        assert len(shown) == 2
        oracle(recordings, tire, out)

    proof = prove(BlindTrials(Folders(tmp_path), SEED, 2, "none", watched), HERE, shown.append)
    assert not proof.failures
    assert len(oracle.recordings) == 2
    for line in shown:
        key, commitment = line.split()
        assert hashlib.sha256((tmp_path / "sealed" / f"{key}.json").read_bytes()).hexdigest() == commitment
        assert f"{commitment}  sealed/{key}.json" in (tmp_path / "seals.sha256").read_text().splitlines()


def test_a_diagnosis_gets_training_recordings_alone(oracle_run: Run) -> None:
    assert len(oracle_run.recordings) == 3
    assert all(name.startswith("train_") for names in oracle_run.recordings for name in names)
    assert all(oracle_run.recordings)
    files = list((oracle_run.folders.root / "trials").resolve().rglob("*.*"))
    assert files
    assert all(path.suffix == ".csv" for path in files)


def test_an_oracle_is_exact_everywhere(oracle_run: Run) -> None:
    assert [s.exact for s in oracle_run.proof.scores] == [True, True, True]


def test_the_baseline_tire_errs_as_much_as_the_rig_says(oracle_run: Run) -> None:
    for s in oracle_run.proof.scores:
        files = json.loads(oracle_run.folders.sealed(s.trial).read_text())["files"]
        *others, last = (f for name, f in sorted(files.items()) if name.startswith("heldout"))
        assert s.held_out is not None
        for errors, held in ((s.held_out.other, others), (s.held_out.alike, [last])):
            sizes = np.array([f["samples"] for f in held])
            squares = np.array([f["baseline_rmse"] for f in held]) ** 2
            # the files give deflection to 0.1 um and force to 1 mN: some 1e-2 N against RMSE of newtons
            assert errors.before == pytest.approx(float(np.sqrt(squares @ sizes / sizes.sum())), rel=1e-3)
            floors = np.array([f["floor_rmse"] for f in held]) ** 2
            assert errors.noise_floor == pytest.approx(float(np.sqrt(floors @ sizes / sizes.sum())))
            assert errors.noise_floor <= 1.001 * errors.before


@pytest.mark.usefixtures("no_page")
def test_started_again_it_diagnoses_only_what_is_new(undiagnosed: Folders, oracle: Any) -> None:
    first = run(undiagnosed, oracle, trials=2)
    seen = len(oracle.recordings)
    second = run(undiagnosed, oracle)
    assert (seen, len(oracle.recordings)) == (2, 3)
    assert second.scores[:2] == first.scores


def test_failures_are_recorded_and_not_repeated(drawn: Path, oracle: Any) -> None:
    proof = run(Folders(drawn), oracle)
    assert oracle.recordings == []
    assert len(proof.failures) == 3
    assert all(s.error is not None and "no diagnosis" in s.error for s in proof.scores)
    assert json.loads((drawn / "proof.json").read_text())["failed"] == 3


@pytest.mark.usefixtures("no_page")
def test_a_changed_answer_is_refused(undiagnosed: Folders, oracle: Any) -> None:
    run(undiagnosed, oracle)
    (undiagnosed.root / "sealed").unlink()
    for key in ("0000", "0001", "0002"):
        undiagnosed.sealed(key).parent.mkdir(exist_ok=True)
        undiagnosed.sealed(key).write_text("{}")
    with pytest.raises(ChangedAnswerError, match="was changed"):
        run(undiagnosed, oracle)


@pytest.mark.usefixtures("no_page")
def test_another_seed_does_not_go_on_in_the_folder(undiagnosed: Folders, oracle: Any) -> None:
    with pytest.raises(TirelabError, match="holds the trials of seed 31"):
        prove(BlindTrials(undiagnosed, SEED + 1, 3, None, oracle), HERE, lambda line: None)


@pytest.mark.usefixtures("no_page")
def test_a_verdict_that_breaks_the_contract_is_a_failure(undiagnosed: Folders) -> None:
    def half(recordings: Sequence[Path], tire: Path | None, out: Path) -> None:
        (out / "diagnosis.json").write_text('{"schema": 1}')

    proof = run(undiagnosed, half, trials=1)
    assert "is no diagnosis" in str(proof.failures[0].error)


@pytest.mark.usefixtures("no_page")
def test_the_recommended_test_is_run_and_diagnosed_with_the_others(
    undiagnosed: Folders, diagnosis: Callable[..., None]
) -> None:
    got: list[list[str]] = []

    def in_doubt(recordings: Sequence[Path], tire: Path | None, out: Path) -> None:
        got.append([path.name for path in recordings])
        true = json.loads((out.parents[1] / "sealed" / f"{out.name}.json").read_text())["right"][0]
        if "test.csv" in got[-1]:
            diagnosis(out, true)
            return
        time = np.arange(200) * 0.01
        deflection = 0.005 * (1.0 - np.cos(time))
        table = {"time [s]": time, "deflection [mm]": 1e3 * deflection, "radius [cm]": np.full(200, np.inf)}
        pl.DataFrame(table).write_csv(out / "separating_test.csv")
        test = {"waveform": "sine", "file": "separating_test.csv"}
        diagnosis(out, ["warm_up"], alternatives=[true], separating_test=test)

    (found,) = run(undiagnosed, in_doubt, trials=1).scores
    assert got[1] == [*got[0], "test.csv"]
    assert found.discrimination is not None
    assert (found.discrimination.alternatives, found.discrimination.outcome) == (2, "decided rightly")
    assert found.among
    assert not found.exact


@pytest.mark.usefixtures("no_page")
def test_a_test_that_the_rig_refuses_has_failed(undiagnosed: Folders, diagnosis: Callable[..., None]) -> None:
    def uneven(recordings: Sequence[Path], tire: Path | None, out: Path) -> None:
        (out / "t.csv").write_text(
            "time [s],deflection [m],radius [m]\n" + "".join(f"{i**2},0.01,inf\n" for i in range(9))
        )
        diagnosis(out, ["warm_up"], alternatives=[["inertia"]], separating_test={"file": "t.csv"})

    (found,) = run(undiagnosed, uneven, trials=1).scores
    assert found.discrimination is not None
    assert found.discrimination.outcome == "failed"


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


def test_the_page_loads_nothing_and_escapes_its_text(drawn: Path) -> None:
    text = (drawn / "proof.html").read_text(encoding="utf-8")
    assert loaded_by(text) == []
    assert "url(" not in text.replace("url(#", "")
    assert "&lt;script&gt;" in text


def test_the_page_of_a_full_run_has_every_part(oracle_run: Run) -> None:
    text = page(oracle_run.proof)
    assert (oracle_run.folders.root / "proof.png").read_bytes().startswith(b"\x89PNG")
    for part in (
        "Acceptance criteria",
        "Confusion matrix",
        "Calibration of the stated confidence",
        "What counts as right",
        "Every trial",
    ):
        assert f"{part}</" in text
    assert text.count("<svg") == 5
    # an oracle: three of three exact, Wilson's interval of 3/3 from its closed form n / (n + z^2)
    assert "100.0 % (3 of 3)" in text
    assert f"{100.0 * 3.0 / (3.0 + 1.959964**2):.1f} to 100.0 %" in text


def test_a_trial_without_a_corrected_tire_keeps_the_baseline(oracle_run: Run) -> None:
    for s in oracle_run.proof.scores:
        assert s.held_out is not None
        for errors in (s.held_out.alike, s.held_out.other):
            assert errors.after == errors.before
        assert s.held_out.fmu_difference is None


@pytest.mark.usefixtures("no_page")
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


@pytest.mark.usefixtures("no_page")
def test_a_corrected_tire_that_cannot_be_used_is_a_failure(
    undiagnosed: Folders, diagnosis: Callable[..., None]
) -> None:
    def lost(recordings: Sequence[Path], tire: Path | None, out: Path) -> None:
        diagnosis(out, ["none"], tire="lost.json")

    (failed,) = run(undiagnosed, lost, trials=1).failures
    assert failed.held_out is None
    assert "its corrected tire fails on the recordings" in str(failed.error)
    assert "lost.json" in str(failed.error)


def test_a_folder_of_another_version_is_not_continued(undiagnosed: Folders, oracle: Any) -> None:
    settings = undiagnosed.root / "settings.json"
    settings.write_text(json.dumps({**json.loads(settings.read_text()), "schema": 2}))
    with pytest.raises(TirelabError, match="another version of this rig; name another folder"):
        run(undiagnosed, oracle)
    assert oracle.recordings == []


def test_a_trial_that_cannot_be_drawn_stops_the_proof(
    tmp_path: Path, oracle: Any, monkeypatch: pytest.MonkeyPatch
) -> None:
    def undrawable(*_: Any) -> str:
        raise RuntimeError("no luck")

    monkeypatch.setattr(blind_trials, "draw_and_commit", undrawable)
    with pytest.raises(TirelabError, match="trial 0000 cannot be drawn: RuntimeError: no luck"):
        run(Folders(tmp_path), oracle, trials=1)


def test_a_trial_that_cannot_be_scored_stops_the_proof(undiagnosed: Folders, oracle: Any) -> None:
    run_once = undiagnosed.outcome("0000")
    run_once.parent.mkdir()
    run_once.write_text("{")
    with pytest.raises(TirelabError, match=r"outcomes.0000\.json: cannot be read .* remove the file"):
        run(undiagnosed, oracle, trials=1)


def test_an_answer_that_is_gone_is_refused(undiagnosed: Folders) -> None:
    with pytest.raises(ChangedAnswerError, match=r"0009\.json: No such file.*start the proof again"):
        opened(undiagnosed, "0009", "0" * 64)


def test_all_kinds_come_in_turn(tmp_path: Path) -> None:
    trials = BlindTrials(Folders(tmp_path), SEED, 6, "all")
    kinds = [None, "loud", "press", "foreign", "outside", "beside", None]
    assert [trials.kind_of(n) for n in range(7)] == kinds
    assert BlindTrials(Folders(tmp_path), SEED, 6, "press").kind_of(3) == "press"


@pytest.mark.usefixtures("no_page")
def test_a_wide_kind_is_drawn_diagnosed_and_scored(tmp_path: Path, oracle: Any) -> None:
    proof = prove(BlindTrials(Folders(tmp_path), SEED, 2, "press", oracle), HERE, lambda line: None)
    assert [s.kind for s in proof.scores] == ["press", "press"]
    for s in proof.scores:
        assert set(s.probabilities) == set(s.right[0]) - {"none"}
        # without a corrected tire the baseline is what was written
        assert s.fitted is not None
        assert s.fitted.after == s.fitted.before
        files = json.loads(Folders(tmp_path).sealed(s.trial).read_text())["files"]
        assert s.fitted.before == pytest.approx(files["train_0.csv"]["baseline_rmse"], rel=1e-3)
    content = json.loads((tmp_path / "proof.json").read_text())
    figures = {c["figure"]: c["value"] for c in content["criteria"]}
    assert figures["press: truth is the verdict or a stated alternative"] == 1.0
    assert "Brier score of the confidence" not in figures


@pytest.mark.usefixtures("no_page")
def test_a_changed_derived_answer_is_refused(undiagnosed: Folders, oracle: Any) -> None:
    derived = undiagnosed.sealed("0000.derived")
    commitment = hashlib.sha256(derived.read_bytes()).hexdigest()
    assert f"{commitment}  sealed/0000.derived.json" in undiagnosed.commitments.read_text().splitlines()
    sealed = {path.name: path.read_bytes() for path in (undiagnosed.root / "sealed").glob("*.json")}
    (undiagnosed.root / "sealed").unlink()
    (undiagnosed.root / "sealed").mkdir()
    for name, content in sealed.items():
        (undiagnosed.root / "sealed" / name).write_bytes(content)
    derived.write_text('{"right": [["gas_compression"]]}')
    with pytest.raises(TirelabError, match=r"0000\.derived\.json.*was changed"):
        run(undiagnosed, oracle, trials=1)


def test_a_file_that_holds_no_object_is_a_sentence(tmp_path: Path) -> None:
    (tmp_path / "list.json").write_text("[1]")
    with pytest.raises(TirelabError, match=r"list\.json is no object"):
        read_json(tmp_path / "list.json")


def test_a_test_file_that_is_gone_is_a_sentence(tmp_path: Path) -> None:
    with pytest.raises(TirelabError, match=r"gone\.csv: no test can be read"):
        read_test(tmp_path / "gone.csv")


def test_a_column_that_is_no_channel_of_a_test_is_ignored(tmp_path: Path) -> None:
    path = tmp_path / "t.csv"
    path.write_text("time [s],deflection [m],radius [m],note\n0,0.01,inf,a\n1,0.02,inf,b\n")
    assert read_test(path)[1].tolist() == [0.01, 0.02]
