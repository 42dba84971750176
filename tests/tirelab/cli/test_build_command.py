"""tirelab build: from a tire file, from a diagnosis, with what no effect explains."""

from __future__ import annotations

import json
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import fmpy
import numpy as np
import pytest
from click.testing import CliRunner, Result
from drives import flat_force, read, ride, saved
from radialtire import CATALOGUE, PowerLaw, TireModel
from radialtire.tirefile import to_text
from rivals import looking_for
from tirelab.cli import main
from tirelab.diagnosis.diagnosis_run import run_diagnosis
from tirelab.fmu.build import Correction
from tirelab.fmu.foreign import tire_inside
from tirelab.fmu.replay import driven, replay
from tirelab.recordings.recording import Recording, read_recording

RIPPLE, WAVES = 60.0, 5.0
"""[N], and waves over 20 mm: no effect of the catalogue has such a shape."""


def build(*words: str | Path) -> Result:
    return CliRunner().invoke(main, ["build", *map(str, words)])


def built(*words: str | Path) -> str:
    done = build(*words)
    assert done.exit_code == 0, done.output
    return done.output


@dataclass(frozen=True)
class Rippled:
    """A diagnosis of a tire with a ripple over the deflection: its folder, diagnosis.json, and a held-out recording."""

    out: Path
    content: Any
    kept: Recording


@pytest.fixture(scope="module")
def rippled(tmp_path_factory: pytest.TempPathFactory) -> Rippled:
    folder = tmp_path_factory.mktemp("rippled")
    files = []
    for seed in (1, 2):
        time, x, _ = ride(seed, samples=4000)
        force = flat_force(x) + RIPPLE * np.sin(2.0 * np.pi * WAVES * x / 0.02)
        files.append(saved(read(f"r{seed}", time, x, force, seed), folder / f"r{seed}.csv"))
    out = folder / "out"
    with looking_for("recalibration", "bottoming"):
        run_diagnosis(files[:1], out, held_out=files[1:])
    return Rippled(
        out, json.loads((out / "diagnosis.json").read_text(encoding="utf-8")), read_recording(files[1])
    )


def rmse(values: Any) -> float:
    return float(np.sqrt(np.mean(np.square(values))))


def test_a_diagnosis_is_enough_to_build_its_tire(rippled: Rippled, tmp_path: Path) -> None:
    alone = tmp_path / "sent.json"
    alone.write_text(json.dumps(rippled.content), encoding="utf-8")
    built("--from", alone, "--out", tmp_path / "alone")
    built("--from", rippled.out, "--out", tmp_path / "folder")
    first, second = (tmp_path / name / "BicycleTire.fmu" for name in ("alone", "folder"))
    assert first.read_bytes() == second.read_bytes() == (rippled.out / "BicycleTire.fmu").read_bytes()


def test_an_older_diagnosis_names_its_tire_file(rippled: Rippled, tmp_path: Path) -> None:
    older = {k: v for k, v in rippled.content.items() if k not in ("baseline_tire", "corrected_tire")}
    (tmp_path / "diagnosis.json").write_text(json.dumps(older), encoding="utf-8")
    done = build("--from", tmp_path, "--out", tmp_path / "out")
    assert done.exit_code == 2
    assert "tire.json" in done.output
    (tmp_path / "tire.json").write_text(
        (rippled.out / "tire.json").read_text(encoding="utf-8"), encoding="utf-8"
    )
    built("--from", tmp_path, "--out", tmp_path / "out")


def test_a_remainder_is_packed_on_request_and_reaches_its_figure(rippled: Rippled, tmp_path: Path) -> None:
    assert rippled.content["verdict"]["unexplained"]
    learned = next(c for c in rippled.content["verdict"]["corrections"] if c["by"] == "deflection")
    printed = built("--from", rippled.out, "--with-remainder", "--out", tmp_path)
    assert "a learned remainder over the deflection (no physics), from " in printed
    fmu = tmp_path / "BicycleTire.fmu"
    description = fmpy.read_model_description(str(fmu))
    assert "a learned remainder over the deflection (no physics)" in description.description
    error = rippled.kept.force - replay(fmu, rippled.kept)
    # the stated figure holds the end of the curve beyond its range, where the FMU fades
    assert 5.0 < rmse(error) < 1.05 * learned["held_out_after"]
    assert rmse(error) < 0.35 * rippled.content["fit"]["held_out_after"]
    # far outside of what was learned it is the corrected tire without it
    far = Recording("far", np.arange(3.0), np.full(3, 0.06), np.full(3, np.inf), np.zeros(3))
    np.testing.assert_array_equal(replay(fmu, far), replay(rippled.out / "BicycleTire.fmu", far))


def test_the_simulation_and_the_fmu_agree_with_a_remainder(rippled: Rippled, tmp_path: Path) -> None:
    from tirelab.simulation.simulate import simulate

    built("--from", rippled.out, "--with-remainder", "--out", tmp_path)
    tire = tire_inside(tmp_path / "BicycleTire.fmu")
    assert tire is not None
    assert tire.remainder is not None
    np.testing.assert_allclose(
        replay(tmp_path / "BicycleTire.fmu", rippled.kept), simulate(tire, rippled.kept), rtol=1e-9
    )


def test_a_remainder_in_a_native_fmu_is_refused_in_one_sentence(rippled: Rippled, tmp_path: Path) -> None:
    done = build("--from", rippled.out, "--with-remainder", "--native", "--out", tmp_path)
    assert done.exit_code == 2
    assert "a learned remainder runs in the Python FMU only; leave out --native" in done.output
    assert "the FMU has" not in done.output
    assert not (tmp_path / "BicycleTire.fmu").exists()


def test_a_remainder_is_no_baseline(rippled: Rippled, tmp_path: Path) -> None:
    built("--from", rippled.out, "--with-remainder", "--out", tmp_path)
    file = rippled.out.parent / "r1.csv"
    done = CliRunner().invoke(
        main,
        ["diagnose", str(file), "--fmu", str(tmp_path / "BicycleTire.fmu"), "--out", str(tmp_path / "o")],
    )
    assert done.exit_code == 2
    assert "diagnose the tire without it" in done.output


def test_what_does_not_repeat_is_not_packed(rippled: Rippled, tmp_path: Path) -> None:
    content = json.loads(json.dumps(rippled.content))
    for correction in content["verdict"]["corrections"]:
        correction["repeats"] = -0.5
    (tmp_path / "diagnosis.json").write_text(json.dumps(content), encoding="utf-8")
    done = build("--from", tmp_path, "--with-remainder", "--out", tmp_path)
    assert done.exit_code == 2
    assert "does not repeat" in done.output
    content["verdict"]["corrections"][0]["repeats"] = None
    (tmp_path / "diagnosis.json").write_text(json.dumps(content), encoding="utf-8")
    done = build("--from", tmp_path, "--with-remainder", "--out", tmp_path)
    assert done.exit_code == 2
    assert "visited once" in " ".join(done.output.split())


def test_a_correction_is_built_from_its_diagnosis(tmp_path: Path) -> None:
    drift = CATALOGUE["force_drift"]
    law = PowerLaw(coefficient=1000.0, exponent=1.0)
    tire = TireModel(law=law, effects=((drift, (2.0, 0.0)),))
    correction = Correction(TireModel(law=law), tire, 1e5, False)
    content = {
        "schema": 2,
        "verdict": {},
        "corrected_tire": json.loads(to_text(tire)),
        "correction": {"fmu": "Correction.fmu", **correction.to_dict()},
    }
    (tmp_path / "diagnosis.json").write_text(json.dumps(content), encoding="utf-8")
    printed = built("--from", tmp_path / "diagnosis.json", "--out", tmp_path)
    assert f"what {correction.believed.name} lacks, FMI 2.0" in printed
    time = np.array([0.0, 1.0, 2.5])
    added = driven(tmp_path / "Correction.fmu", time, {"deflection": np.full(3, 0.01)}, "additional_force")
    np.testing.assert_allclose(added, [0.0, 2.0, 5.0], atol=1e-9)
    refused = build("--from", tmp_path, "--native", "--out", tmp_path)
    assert refused.exit_code == 2
    assert "Python FMU only" in refused.output


@pytest.mark.parametrize(
    ("words", "match"),
    [
        (["--with-remainder"], "name its diagnosis.json with --from"),
        (["--from", "{here}/none.json"], "diagnose again"),
        (["--from", "{here}/text.json"], "is no diagnosis"),
        (["--from", "{here}/empty.json", "--tire", "{here}/tire.json"], "both name a tire"),
        (["--from", "{here}/known.json", "--with-remainder"], "known.json: nothing is unexplained"),
    ],
)
def test_bad_input_is_refused_in_one_sentence(words: list[str], match: str, tmp_path: Path) -> None:
    (tmp_path / "text.json").write_text("text")
    known = {"schema": 2, "verdict": {"effects": []}, "corrected_tire": json.loads(to_text(TireModel()))}
    (tmp_path / "known.json").write_text(json.dumps(known))
    done = build(*(word.replace("{here}", str(tmp_path)) for word in words), "--out", tmp_path / "out")
    assert done.exit_code == 2, done.output
    assert match in done.output
    assert not (tmp_path / "out").exists()


def test_a_name_of_others_controls_no_terminal(tmp_path: Path) -> None:
    file = tmp_path / "tire.json"
    file.write_text(to_text(TireModel(name="\x1b[31mred\x07 Größe")), encoding="utf-8")
    words = ["build", "--tire", str(file), "--native", "--out", str(tmp_path / "out")]
    done = CliRunner().invoke(main, words, color=True)
    assert done.exit_code == 0, done.output
    assert "\x1b" not in done.output
    assert "BicycleTire.fmu: ?[31mred? Größe, FMI 2.0" in done.output
