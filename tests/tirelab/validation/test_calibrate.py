"""The calibration's regression, on rows whose law is known."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from click.testing import CliRunner
from scipy.special import expit
from tirelab.diagnosis.confidence import OF_EFFECT, OF_VERDICT
from tirelab.validation.calibrate import (
    Row,
    calibration_of,
    fitted_weights,
    main,
    probabilities,
    skill,
    skill_left_out,
    verdict_row,
)
from tirelab.validation.folders import Folders, write_json
from tirelab.validation.score import Score

TRUE = {"constant": -1.0, "odds": 0.8, "remainder_share": -2.0}


def rows(count: int, seed: int = 1) -> list[Row]:
    """Rows of the law TRUE with random grounds."""
    rng = np.random.default_rng(seed)
    found = []
    for i in range(count):
        grounds = {"odds": rng.normal(2.0, 3.0), "remainder_share": rng.uniform(0.0, 1.0)}
        line = TRUE["constant"] + sum(TRUE[n] * g for n, g in grounds.items())
        found.append(Row(str(i), grounds, bool(rng.random() < expit(line))))
    return found


def test_weights_of_many_rows_are_those_of_their_law() -> None:
    found = fitted_weights(rows(20_000), ["odds", "remainder_share"])
    # Standard errors at 20 000 rows are about 0.01, 0.07 and 0.05; three of each.
    assert found["odds"] == pytest.approx(0.8, abs=0.04)
    assert found["remainder_share"] == pytest.approx(-2.0, abs=0.25)
    assert found["constant"] == pytest.approx(-1.0, abs=0.2)


def test_a_ground_that_may_only_lower_gets_no_weight_where_it_seems_to_raise() -> None:
    turned = [
        Row(r.trial, {**r.grounds, "remainder_share": -r.grounds["remainder_share"]}, r.right)
        for r in rows(2000)
    ]
    assert fitted_weights(turned, ["odds", "remainder_share"])["remainder_share"] == 0.0


def test_a_ground_that_may_only_raise_gets_no_weight_where_it_seems_to_lower() -> None:
    turned = [Row(r.trial, {**r.grounds, "odds": -r.grounds["odds"]}, r.right) for r in rows(2000)]
    assert fitted_weights(turned, ["odds", "remainder_share"])["odds"] == 0.0


def test_skill_left_out_is_near_the_skill_on_other_rows_and_no_better_than_that_on_its_own() -> None:
    few = rows(150)
    names = ["odds", "remainder_share"]
    right = np.array([r.right for r in few], dtype=float)
    weights = fitted_weights(few, names)
    others = rows(5000, seed=2)
    elsewhere = skill(probabilities(others, weights), np.array([r.right for r in others], dtype=float))
    left_out = skill_left_out(few, names)
    assert left_out < skill(probabilities(few, weights), right)
    assert left_out == pytest.approx(elsewhere, abs=0.15)


def test_grounds_without_meaning_have_no_skill_left_out() -> None:
    rng = np.random.default_rng(5)
    noise = [Row(str(i), {"odds": rng.normal()}, bool(rng.random() < 0.7)) for i in range(300)]
    assert abs(skill_left_out(noise, ["odds"])) < 0.05


def test_a_calibration_states_rows_rate_skill_and_a_weight_for_every_ground() -> None:
    whole = [Row(r.trial, {**dict.fromkeys(OF_VERDICT, 0.0), **r.grounds}, r.right) for r in rows(200)]
    effects = [Row(r.trial, {**r.grounds, "share": 0.0, "beside_law": 0.0}, r.right) for r in whole]
    content = calibration_of(whole, effects, {"command": "x"})
    assert content["command"] == "x"
    assert content["verdict"]["rows"] == 200
    assert set(content["verdict"]["weights"]) == {"constant", *OF_VERDICT}
    assert content["verdict"]["right"] == pytest.approx(np.mean([r.right for r in whole]))


def test_a_verdict_is_right_where_all_that_it_names_is_there(score: Callable[..., Score]) -> None:
    """A known effect named where the catalogue lacks what acts is wrong, however unlikely it is called."""
    for named, right in (("viscous_damping unknown", False), ("unknown", True)):
        one = score("outside", "unknown", named, probabilities={"viscous_damping": 0.3})
        assert verdict_row(one, {}).right is right


@pytest.fixture
def proof(tmp_path: Path, score: Callable[..., Score]) -> Path:
    """The folder of a finished proof of twelve trials: a lag is hidden in each, and named in every other one."""
    folders = Folders(tmp_path / "proof")
    write_json(folders.root / "settings.json", {"seed": 7})
    for number in range(12):
        key, named = f"{number:04d}", "lag" if number % 2 else "friction"
        own = {**score("loud", "lag", named).to_json(), "trial": key}
        write_json(folders.score(key), own)
        odds = 5.0 if number % 2 else -1.0
        doubted = {
            "name": "drift",
            "probability": 0.2,
            "grounds": {**dict.fromkeys(OF_EFFECT, 0.0), "odds": -3.0},
        }
        verdict = {
            "grounds": {**dict.fromkeys(OF_VERDICT, 0.0), "odds": odds},
            "effects": [{"name": named, "grounds": {**dict.fromkeys(OF_EFFECT, 0.0), "odds": odds}}],
            "doubted": [doubted] if number == 3 else [],
        }
        write_json(folders.verdict(key) / "diagnosis.json", {"verdict": verdict})
    return folders.root


def test_finished_proofs_are_calibrated_on(proof: Path, tmp_path: Path) -> None:
    out = tmp_path / "calibration.json"
    told = CliRunner().invoke(main, ["--proof", str(proof), "--out", str(out)])
    assert told.exit_code == 0, told.output
    found = json.loads(out.read_text(encoding="utf-8"))
    assert found["seeds"] == [7]
    assert found["command"] == "python -m tirelab.validation.calibrate --proof DIR"
    assert (found["verdict"]["rows"], found["verdict"]["right"]) == (12, 0.5)
    # The twelve named effects, six of which are there, and the one that was left out.
    assert (found["effect"]["rows"], found["effect"]["right"]) == (13, pytest.approx(6 / 13))
    for of, names in (("verdict", OF_VERDICT), ("effect", OF_EFFECT)):
        assert set(found[of]["weights"]) == {"constant", *names}
        assert found[of]["weights"]["odds"] > 0.0


def test_a_proof_that_does_not_say_why_effects_were_doubted_is_refused(proof: Path, tmp_path: Path) -> None:
    file = Folders(proof).verdict("0003") / "diagnosis.json"
    content = json.loads(file.read_text(encoding="utf-8"))
    del content["verdict"]["doubted"][0]["grounds"]
    file.write_text(json.dumps(content), encoding="utf-8")
    told = CliRunner().invoke(main, ["--proof", str(proof), "--out", str(tmp_path / "calibration.json")])
    assert told.exit_code == 1
    assert "run its `tirelab prove` again" in told.output


def test_a_folder_that_is_no_finished_proof_is_refused(tmp_path: Path) -> None:
    told = CliRunner().invoke(main, ["--proof", str(tmp_path), "--out", str(tmp_path / "calibration.json")])
    assert told.exit_code == 1
    assert "holds no scores; finish `tirelab prove` there first" in told.output


def test_without_trials_nothing_is_calibrated(tmp_path: Path) -> None:
    told = CliRunner().invoke(main, ["--out", str(tmp_path / "calibration.json")])
    assert told.exit_code == 1
    assert "give --seed or --proof" in told.output
