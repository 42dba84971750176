"""What to record after a diagnosis."""

import json
from pathlib import Path

import numpy as np
import polars as pl
import pytest
from radialtire import PowerLaw, TireModel
from radialtire.tirefile import to_text
from small_rig import RIG, few_effects
from tirelab.errors import TirelabError
from tirelab.planning.follow_up import Diagnosed, alternatives_asked, follow_up, read_diagnosed
from tirelab.planning.menu import drive_of
from tirelab.regressors.signature import LAW

FRICTION, DAMPING = "rate_independent_hysteresis", "viscous_damping"


def written(folder: Path, alternatives: list[list[str]]) -> Path:
    content = {
        "verdict": {"effects": [{"name": FRICTION}], "alternatives": alternatives},
        "fit": {"noise": 6.0},
        "data": "plots.csv",
    }
    (folder / "diagnosis.json").write_text(json.dumps(content))
    time = np.arange(100) * 0.1
    pl.DataFrame(
        {
            "recording": ["slow"] * 100 + ["kept"] * 100,
            "used": ["fitted"] * 100 + ["held-out"] * 100,
            "time [s]": np.tile(time, 2),
            "deflection [mm]": np.tile(time, 2),
            "radius [cm]": ["inf"] * 200,
        }
    ).write_csv(folder / "plots.csv")
    return folder / "diagnosis.json"


def test_verdict_alternatives_and_recorded_motions_are_read(tmp_path: Path) -> None:
    file = written(tmp_path, [[DAMPING], [FRICTION, LAW], [DAMPING, "unknown"]])
    for path in (file, tmp_path):
        found = read_diagnosed(path)
        assert found.names == {FRICTION}
        assert found.alternatives == ({DAMPING}, {FRICTION, LAW})
        (slow,) = found.recorded
        assert slow.name == "slow"
        assert slow.deflection.max() == pytest.approx(9.9e-3)
        assert np.isinf(slow.surface_radius).all()
        assert (found.rig.noise, found.rig.stroke, found.rig.surfaces) == (
            6.0,
            slow.deflection.max(),
            (np.inf,),
        )


def test_the_believed_tire_and_the_stroke_of_a_part_are_those_of_the_diagnosis(tmp_path: Path) -> None:
    """A damper that was pulled 12 mm and pushed 8 mm; beside a foreign simulation its tire is nothing."""
    file = written(tmp_path, [[DAMPING]])
    assert read_diagnosed(file).tire is None
    part = TireModel(name="damper", law=PowerLaw(10.0, 1.0), two_sided=True)
    content = json.loads(file.read_text()) | {"baseline_tire": json.loads(to_text(part))}
    file.write_text(json.dumps(content))
    table = pl.read_csv(tmp_path / "plots.csv")
    table.with_columns(pl.col("deflection [mm]") * 20.0 / 9.9 - 12.0).write_csv(tmp_path / "plots.csv")
    found = read_diagnosed(file)
    assert found.tire == part
    # it moves over 20 mm, from where it was pulled most: never beyond what was recorded
    assert (found.rig.start, found.rig.stroke) == pytest.approx((-0.012, 0.02))
    file.write_text(json.dumps(content | {"correction": {}}))
    assert read_diagnosed(file).tire is None
    file.write_text(json.dumps(content | {"baseline_tire": {"schema": 99}}))
    with pytest.raises(TirelabError, match="the believed tire cannot be read"):
        read_diagnosed(file)


@pytest.mark.parametrize(
    ("content", "words"),
    [
        ("{}", " is no diagnosis"),
        ("no JSON", " is no diagnosis"),
        ("[" * 100_000, " is no diagnosis"),
        (None, ": No such file"),
    ],
)
def test_what_is_no_diagnosis_is_told(content: str | None, words: str, tmp_path: Path) -> None:
    if content is not None:
        (tmp_path / "diagnosis.json").write_text(content)
    with pytest.raises(TirelabError, match=r"diagnosis\.json" + words):
        read_diagnosed(tmp_path / "diagnosis.json")


def test_what_differs_is_asked_for_in_both_directions() -> None:
    diagnosed = Diagnosed(
        frozenset({FRICTION}), (frozenset({DAMPING}), frozenset({FRICTION, "force_drift"})), 5.0, ()
    )
    asked = {
        (q.truth, q.alternative, q.nested)
        for q in alternatives_asked(diagnosed, (FRICTION, DAMPING, "force_drift"), 0.02)
    }
    assert asked == {
        (FRICTION, frozenset({DAMPING}), False),
        (DAMPING, frozenset({FRICTION}), False),
        ("force_drift", frozenset({FRICTION}), True),
    }


def test_friction_against_damping_takes_one_motion_of_several_rates(monkeypatch: pytest.MonkeyPatch) -> None:
    few_effects(monkeypatch)
    recorded = drive_of("slow triangles", 0.25, RIG.surfaces[0], RIG)
    diagnosed = Diagnosed(frozenset({FRICTION}), (frozenset({DAMPING}),), 5.0, (recorded,))
    plan = follow_up(diagnosed, TireModel(), RIG, 0.05)
    assert plan.told[0] == plan.told[2] == 2
    assert len(plan.drives) <= 2


def test_without_alternatives_there_is_nothing_to_plan() -> None:
    with pytest.raises(TirelabError, match="nothing is left to tell apart"):
        follow_up(Diagnosed(frozenset({FRICTION}), (), 5.0, ()), TireModel(), RIG)
