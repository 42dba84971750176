"""A diagnosis.json read back: what it states, and the sentence where it is none."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest
from tirelab.diagnosis.diagnosis_file import NOTHING, DiagnosisFileError, read_corrected, read_stated


def written(folder: Path, **changes: Any) -> Path:
    """A diagnosis.json by hand; verdict_NAME changes an entry of its verdict."""
    verdict = {
        "effects": [{"name": "inertia", "parameters": {}, "share": 1.0}],
        "confidence": 0.8,
        "alternatives": [["force_lag"], []],
        "unexplained": False,
        "summary": "Left out: inertia.",
        "separating_test": None,
    }
    place = {"by": "time", "from": 1.0, "to": "inf", "unit": "s", "share": 0.5, "recording": "ride"}
    content = {
        "schema": 1,
        "verdict": verdict,
        "where": [place],
        "fit": {"noise": 2.0, "held_out_before": None},
        "tire": "tire.json",
        "corrected_fmu": None,
        "report": "report.html",
    }
    for name, value in changes.items():
        if name.startswith("verdict_"):
            verdict[name.removeprefix("verdict_")] = value
        else:
            content[name] = value
    (folder / "diagnosis.json").write_text(json.dumps(content))
    return folder


def test_what_is_written_is_read_back(tmp_path: Path) -> None:
    stated = read_stated(written(tmp_path))
    assert stated.names == {"inertia"}
    assert stated.alternatives == ({"force_lag"}, NOTHING)
    assert (stated.confidence, stated.unexplained, stated.summary) == (0.8, False, "Left out: inertia.")
    assert stated.fit == {"noise": 2.0, "held_out_before": None}
    assert (stated.tire, stated.corrected_fmu, stated.report) == (
        tmp_path / "tire.json",
        None,
        tmp_path / "report.html",
    )
    (place,) = stated.places
    assert (place.by, place.begin, place.end, place.unit) == ("time", 1.0, None, "s")
    assert (place.share, place.recording, place.label) == (0.5, "ride", "")


def test_a_whole_diagnosis_is_read_back(damped_run: Any) -> None:
    stated = read_stated(damped_run.out)
    assert stated.names == {"viscous_damping"}
    assert stated.confidence == damped_run.verdict.confidence
    assert stated.probabilities == {"viscous_damping": damped_run.verdict.effects[0].probability}
    assert stated.remainder == damped_run.verdict.remainder.size
    assert stated.tire == damped_run.out / "tire.json"
    assert len(stated.places) == len(damped_run.verdict.where)


def test_a_file_of_the_first_schema_states_its_confidence_of_every_effect(tmp_path: Path) -> None:
    stated = read_stated(written(tmp_path))
    assert stated.probabilities == {"inertia": 0.8}
    assert stated.remainder is None


def test_probabilities_and_the_remainder_are_read_back(tmp_path: Path) -> None:
    effects = [{"name": "inertia", "probability": 0.99}, {"name": "force_lag", "probability": 0.6}]
    stated = read_stated(
        written(tmp_path, schema=2, verdict_effects=effects, verdict_remainder={"share": 0.1, "size": 0.4})
    )
    assert stated.probabilities == {"inertia": 0.99, "force_lag": 0.6}
    assert stated.remainder == 0.4


def test_the_probability_of_the_alternatives_that_leave_the_same_is_read_back(tmp_path: Path) -> None:
    details = [{"probability": p, "same": same} for p, same in ((0.3, True), (0.1, True), (0.05, False))]
    found = read_stated(
        written(tmp_path, schema=2, verdict_alternative_details=[*details, {"probability": None}])
    )
    assert found.same == pytest.approx(0.4)
    assert read_stated(written(tmp_path)).same == 0.0


def test_nothing_and_something_unknown_have_names(tmp_path: Path) -> None:
    assert read_stated(written(tmp_path, verdict_effects=[])).names == NOTHING
    assert read_stated(written(tmp_path, verdict_unexplained=True)).names == {"inertia", "unknown"}


def test_the_ends_of_a_place_may_be_numbers_names_or_missing(tmp_path: Path) -> None:
    place = {"by": "radius", "from": "-inf", "to": "flat", "unit": "m", "share": 0.5, "label": "flat"}
    (found,) = read_stated(written(tmp_path, where=[place])).places
    assert (found.begin, found.end, found.recording, found.label) == (None, "flat", None, "flat")
    (found,) = read_stated(written(tmp_path, where=[{**place, "from": None, "to": "0.25"}])).places
    assert (found.begin, found.end) == (None, 0.25)


def test_the_file_of_the_next_test_is_found(tmp_path: Path) -> None:
    test = {"waveform": "sweep", "file": "separating_test.csv"}
    assert (
        read_stated(written(tmp_path, verdict_separating_test=test)).separating_test
        == tmp_path / "separating_test.csv"
    )
    assert read_stated(written(tmp_path, verdict_separating_test={"waveform": "s"})).separating_test is None


@pytest.mark.parametrize(
    ("changes", "said"),
    [
        ({"schema": 3}, "schema 3 is none of 1, 2"),
        ({"verdict_effects": [{"name": "inertia", "probability": 1.5}]}, "probability 1.5 does not lie"),
        ({"verdict_confidence": 1.5}, "confidence 1.5 does not lie between 0 and 1"),
        ({"verdict_effects": [{}]}, "it has no entry 'name'"),
        ({"where": [{"by": "time", "from": True, "to": 1.0, "unit": "s", "share": 1.0}]}, "True is no end"),
        ({"fit": None}, "an entry is of another kind"),
    ],
)
def test_what_is_no_diagnosis_is_refused_in_a_sentence(
    tmp_path: Path, changes: dict[str, Any], said: str
) -> None:
    with pytest.raises(DiagnosisFileError, match=said) as caught:
        read_stated(written(tmp_path, **changes))
    assert str(caught.value).startswith(f"{tmp_path / 'diagnosis.json'} is no diagnosis (")
    assert str(caught.value).endswith("; diagnose again")


def test_a_file_that_is_not_there_or_no_json_is_refused(tmp_path: Path) -> None:
    with pytest.raises(DiagnosisFileError, match="No such file or directory; diagnose again"):
        read_stated(tmp_path)
    for text in ("{", "[" * 100_000, '{"schema": 2, "verdict": ' + "1" * 5000 + "}"):
        (tmp_path / "diagnosis.json").write_text(text)
        for read in (read_stated, read_corrected):
            with pytest.raises(DiagnosisFileError, match=r"is no diagnosis \(.+\); diagnose again"):
                read(tmp_path)
