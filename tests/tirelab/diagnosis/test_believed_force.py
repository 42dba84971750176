"""Effects are found beside a simulated force that stands in the recordings, whatever simulated it."""

import json
from pathlib import Path

import numpy as np
import polars as pl
import pytest
from click.testing import CliRunner
from drives import ride
from tirelab.cli import main
from tirelab.diagnosis.believed_force import believed_of
from tirelab.errors import TirelabError
from tirelab.fmu import replay as fmu_replay
from tirelab.recordings.recording import Recording, read_recording

SHAPE = 700.0
DAMPING = 500.0


def driven(seed: int) -> Recording:
    """A ride of a part that is no tire of ours: F = 700 x^1.3 + 90 x^2, x in cm, and a damper the simulation lacks."""
    time, deflection, rate = ride(seed)
    x = 100.0 * np.maximum(deflection, 0.0)
    simulated = SHAPE * x**1.3 + 90.0 * x**2
    noise = 4.0 * np.random.default_rng(seed).standard_normal(time.size)
    force = simulated + DAMPING * rate * (deflection > 0.0) + noise
    return Recording(
        f"ride{seed}", time, deflection, np.full(time.size, np.inf), force, believed_force=simulated
    )


def test_what_is_diagnosed_has_the_misfit_of_the_simulation() -> None:
    recording = driven(1)
    found = believed_of([recording], [])
    assert found is not None
    from tirelab.simulation.simulate import simulate

    (beside,) = found.fitted
    assert recording.believed_force is not None
    np.testing.assert_allclose(
        beside.force - simulate(found.tire, beside), recording.force - recording.believed_force, atol=1e-9
    )


def test_some_without_it_are_refused_and_none_is_nothing() -> None:
    one = driven(1)
    bare = Recording("bare", one.time, one.deflection, one.surface_radius, one.force)
    assert believed_of([bare], [bare]) is None
    with pytest.raises(TirelabError, match="bare: has no simulated force"):
        believed_of([one], [bare])


def test_the_damper_is_found_and_the_corrected_simulation_written(tmp_path: Path) -> None:
    for seed in (1, 2):
        r = driven(seed)
        frame = {
            "time [s]": r.time,
            "x [m]": r.deflection,
            "F [N]": r.force,
            "sim [kN]": r.believed_force / 1e3,
        }
        pl.DataFrame(frame).write_csv(tmp_path / f"ride{seed}.csv")
    out = tmp_path / "out"
    words = ["diagnose", tmp_path / "ride1.csv", "--held-out", tmp_path / "ride2.csv", "--radius", "flat"]
    done = CliRunner().invoke(
        main, [*map(str, words), "--believed-force", "sim", "--out", str(out), "--quiet"]
    )
    assert done.exit_code == 0, done.output
    content = json.loads((out / "diagnosis.json").read_text(encoding="utf-8"))
    assert [e["name"] for e in content["verdict"]["effects"]] == ["viscous_damping"]
    assert content["corrected_fmu"] == content["correction"]["fmu"] == "Correction.fmu"
    assert content["correction"]["system"] is None
    assert {f.name for f in out.iterdir()} == {
        *("diagnosis.json", "report.html", "tire.json", "plots.csv", "Correction.fmu"),
        *("ride1.corrected.csv", "ride2.corrected.csv"),
        *(["separating_test.csv"] if content["verdict"]["separating_test"] else []),
    }
    for seed, key in ((1, "after"), (2, "held_out_after")):
        corrected = pl.read_csv(out / f"ride{seed}.corrected.csv")
        error = (corrected["force [N]"] - corrected["corrected_force [N]"]).to_numpy()
        before = (corrected["force [N]"] - corrected["believed_force [N]"]).to_numpy()
        missing = DAMPING * ride(seed)[2] * (ride(seed)[1] > 0.0)
        assert np.sqrt(np.mean(before**2)) == pytest.approx(np.hypot(np.std(missing), 4.0), rel=0.05)
        assert np.sqrt(np.mean(error**2)) == pytest.approx(content["fit"][key], rel=1e-6)
        assert np.sqrt(np.mean(error**2)) < 1.1 * 4.0
        inputs = {
            "deflection": corrected["deflection [m]"].to_numpy(),
            "surface_radius": corrected["radius [m]"].to_numpy(),
        }
        added = fmu_replay.driven(
            out / "Correction.fmu", corrected["time [s]"].to_numpy(), inputs, "additional_force"
        )
        np.testing.assert_allclose(
            corrected["believed_force [N]"].to_numpy() + added,
            corrected["corrected_force [N]"].to_numpy(),
            atol=1e-6,
        )
        recorded = read_recording(tmp_path / f"ride{seed}.csv", radius="flat")
        np.testing.assert_allclose(corrected["force [N]"].to_numpy(), recorded.force, atol=1e-8)


def test_two_simulations_are_refused(tmp_path: Path) -> None:
    r = driven(1)
    pl.DataFrame(
        {"time [s]": r.time, "x [m]": r.deflection, "F [N]": r.force, "sim [N]": -r.force}
    ).write_csv(tmp_path / "a.csv")
    words = [
        "diagnose",
        tmp_path / "a.csv",
        "--radius",
        "flat",
        "--believed-force",
        "sim",
        "--out",
        tmp_path / "o",
    ]
    recording = read_recording(tmp_path / "a.csv", radius="flat", columns={"believed_force": "sim"})
    np.testing.assert_allclose(recording.believed_force, recording.force)
    assert any("believed_force turned in sign" in note for note in recording.notes)
    tire = Path(__file__).parents[3] / "examples" / "tires" / "hull1996_second_reading.json"
    done = CliRunner().invoke(main, [*map(str, words), "--tire", str(tire), "--quiet"])
    assert done.exit_code == 2
    assert "both name a simulation" in done.stderr
