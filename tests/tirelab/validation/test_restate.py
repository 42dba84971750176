"""Confidences of a proof by the present weights."""

from __future__ import annotations

import json
import math
from collections.abc import Callable
from pathlib import Path

import pytest
from click.testing import CliRunner
from tirelab.diagnosis.confidence import EITHER, OF_EFFECT, OF_VERDICT, probability
from tirelab.validation.folders import Folders
from tirelab.validation.restate import main, restated, restated_scores
from tirelab.validation.score import Score

GROUNDS = dict.fromkeys(OF_VERDICT, 0.0) | {"significance": 1.0, "loudness": 4.0, "nothing": 0.0}


def verdict(*effects: float, doubted: float = 0.0, alike: int = 0) -> dict[str, object]:
    return {
        "grounds": {**GROUNDS, "alike": math.log1p(alike)},
        "effects": [{"name": "lag", "probability": p} for p in effects],
        "doubted": [{"name": "drift", "probability": doubted}],
    }


def test_it_is_the_present_probability_shared_and_no_surer_than_an_effect() -> None:
    present = probability("verdict", GROUNDS)
    assert restated(verdict(1.0)) == pytest.approx(present)
    assert restated(verdict(0.01)) == 0.01
    assert restated(verdict(1.0, doubted=0.45)) == pytest.approx(min(present, 0.55))
    # Two others share the odds: a third of them each.
    alone = probability("verdict", {**GROUNDS, "alike": math.log1p(2)})
    assert restated(verdict(1.0, alike=2)) == pytest.approx(alone / (alone + 3.0 * (1.0 - alone)))


def test_the_sets_that_leave_the_same_keep_their_share() -> None:
    """Two to one were stated; the sets are alike as before, whatever their probability together is now."""
    details = [{"probability": 0.3, "same": True}, {"probability": None, "same": False}]
    found = restated({**verdict(1.0), "confidence": 0.6, "alternative_details": details})
    assert found == pytest.approx(2.0 / 3.0 * probability("verdict", GROUNDS))


def test_what_an_effect_is_given_by_its_grounds_counts_where_they_are_kept() -> None:
    """A bottoming beside a refitted law: what was stated then, 0.99, is not asked."""
    grounds = {**dict.fromkeys(OF_EFFECT, 0.0), "odds": 1.0, "beside_law": 1.0}
    own = {"name": "bottoming", "probability": 0.99, "grounds": grounds}
    found = restated({"grounds": {**GROUNDS, "odds": 15.0}, "effects": [own], "doubted": []})
    assert found == pytest.approx(EITHER * probability("effect", grounds))


def test_the_verdicts_of_a_folder_are_restated_and_scored(
    tmp_path: Path, score: Callable[..., Score]
) -> None:
    folders = Folders(tmp_path)
    for number, (said, stated) in enumerate(
        (("lag", 0.9), ("friction", 0.2), ("lag", 0.8), ("friction", 0.3))
    ):
        kept = {**score("loud", "lag", said).to_json(), "confidence": 0.5}
        folders.score(f"{number:04d}").parent.mkdir(parents=True, exist_ok=True)
        folders.score(f"{number:04d}").write_text(json.dumps(kept), encoding="utf-8")
        folder = folders.verdict(f"{number:04d}")
        folder.mkdir(parents=True)
        (folder / "diagnosis.json").write_text(json.dumps({"verdict": verdict(stated)}), encoding="utf-8")
    found = [s.confidence for s in restated_scores(folders)]
    assert found == [min(probability("verdict", GROUNDS), p) for p in (0.9, 0.2, 0.8, 0.3)]
    told = CliRunner().invoke(main, [str(tmp_path)])
    assert told.exit_code == 0, told.output
    assert "0 of 2 held" in told.output
    assert told.output.startswith("Brier skill of the confidence: ")
    assert ", 4 trials" in told.output
    both = CliRunner().invoke(main, [str(tmp_path), str(tmp_path)])
    assert "0 of 4 held" in both.output
    assert ", 8 trials" in both.output


def test_a_folder_without_scores_is_refused(tmp_path: Path) -> None:
    told = CliRunner().invoke(main, [str(tmp_path)])
    assert told.exit_code == 1
    assert "holds no scores; finish `tirelab prove` there first" in told.output
