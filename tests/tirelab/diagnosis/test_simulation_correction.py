"""Effects are found beside a simulated force that stands in the recordings, whatever simulated it."""

from __future__ import annotations

import itertools
import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import polars as pl
import pytest
from click.testing import CliRunner
from drives import ride
from numpy.typing import NDArray
from radialtire import CATALOGUE
from rivals import looking_for, rivals
from tirelab.cli import main
from tirelab.diagnosis.diagnose import diagnose
from tirelab.diagnosis.outcome import Replayed
from tirelab.diagnosis.simulation_correction import (
    _refuse_other_units,
    believed_of,
    write_corrected,
)
from tirelab.errors import TirelabError
from tirelab.fmu import replay as fmu_replay
from tirelab.fmu.foreign import ForeignFmu, Terminal
from tirelab.recordings.recording import Recording, read_recording
from tirelab.simulation.simulate import simulate

FloatArray = NDArray[np.float64]


SHAPE = 700.0
DAMPING = 500.0


def of_size(factor: float) -> Recording:
    """A recorded force beside a simulated one of another size."""
    values = np.linspace(0.0, 0.01, 40)
    flat = np.full(40, np.inf)
    return Recording("a", values, values, flat, 1e5 * values, believed_force=factor * 1e5 * values)


@pytest.mark.parametrize("factor", [1e-3, 1e3, 1e-6])
def test_a_simulation_without_units_is_refused_where_its_force_is_of_another_size(factor: float) -> None:
    """Kilonewtons and millimetres are a factor of a thousand each; a believed simulation is not so far off."""
    silent = ForeignFmu(
        Path("a.fmu"), "2.0", "CoSimulation", False, Terminal("x", 0, 1.0), Terminal("f", 1, 1.0), None, ()
    )
    with pytest.raises(TirelabError, match="does not say all its units") as refused:
        _refuse_other_units(silent, [of_size(factor)])
    assert "--variables 'deflection=x [mm],force=f [kN]'" in str(refused.value)
    _refuse_other_units(silent, [of_size(3.0), of_size(0.1)])
    said = replace(silent, deflection=Terminal("x", 0, 1.0, "m"), force=Terminal("f", 1, 1.0, "N"))
    _refuse_other_units(said, [of_size(factor)])


@pytest.mark.parametrize(
    ("name", "file"),
    [("press@10s:20s", "press@10s_20s"), ("../up\\side", "_up_side"), ("Prüf 1, heiß", "Prüf 1, heiß")],
)
def test_a_name_from_outside_is_no_path(name: str, file: str, tmp_path: Path) -> None:
    values = np.linspace(0.0, 0.01, 4)
    r = Recording(name, values, values, np.full(4, np.inf), values, believed_force=values)
    inside = tmp_path / "in"
    inside.mkdir()
    write_corrected(inside, Replayed((r,), (values,), (values,)))
    assert [p.relative_to(tmp_path).as_posix() for p in tmp_path.rglob("*.csv")] == [
        f"in/{file}.corrected.csv"
    ]


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


def late(seed: int) -> Recording:
    """A spring beside a spring in series with a damper, which the simulation has; the gauge reads 12 ms late."""
    step, count = 2e-3, 10_000
    time = step * np.arange(count)
    x = 0.01 * np.sin(2.0 * np.pi * 0.7 * time) + 0.004 * np.sin(2.0 * np.pi * 2.3 * time + seed)

    def simulated(deflection: FloatArray) -> FloatArray:
        held, force = 0.0, [1e5 * float(deflection[0])]
        for before, now in itertools.pairwise(deflection.tolist()):
            held = (held + 6e4 * (now - before)) * float(np.exp(-step / 0.05))
            force.append(1e5 * now + held)
        return np.array(force)

    noise = 3.0 * np.random.default_rng(seed).standard_normal(count)
    read = np.interp(time - 0.012, time, x)
    flat = np.full(count, np.inf)
    return Recording("late", time, read, flat, simulated(x) + noise, believed_force=simulated(read))


@pytest.mark.slow
def test_a_verdict_beside_a_simulation_that_no_law_stands_for_says_what_it_could_not_try() -> None:
    found = believed_of([late(1)], [])
    assert found is not None
    verdict = diagnose(found.fitted, found.tire)
    assert verdict.remainder.size > 1.0
    assert verdict.confidence <= 0.5
    assert "of the simulation, more than is left here: an effect before the simulation" in verdict.summary


@pytest.mark.slow
def test_where_no_more_than_noise_is_left_nothing_is_doubted_of_the_simulation() -> None:
    found = believed_of([driven(1)], [])
    assert found is not None
    verdict = diagnose(found.fitted, found.tire)
    assert [effect.name for effect in verdict.effects] == ["viscous_damping"]
    assert verdict.confidence > 0.5
    assert "before the simulation" not in verdict.summary


def test_what_is_diagnosed_has_the_misfit_of_the_simulation() -> None:
    recording = driven(1)
    found = believed_of([recording], [])
    assert found is not None

    (beside,) = found.fitted
    assert recording.believed_force is not None
    np.testing.assert_allclose(
        beside.force - simulate(found.tire, beside), recording.force - recording.believed_force, atol=1e-9
    )


def test_a_part_that_pulls_has_a_simulation_that_is_held_at_both_ends_where_it_was_not_driven() -> None:
    """What it lacks is an offset of 5 mm, so the part pulls near the simulation's zero; a ground could not."""
    time, x, _ = ride(1, samples=1000)
    x -= float(np.min(x))
    noise = 4.0 * np.random.default_rng(1).standard_normal(x.size)
    lifted = 100.0 * (x - 0.005)
    recorded = SHAPE * np.sign(lifted) * np.abs(lifted) ** 1.3 + noise
    simulated = SHAPE * (100.0 * x) ** 1.3
    found = believed_of(
        [Recording("a", time, x, np.full(x.size, np.inf), recorded, believed_force=simulated)], []
    )
    assert found is not None
    assert found.tire.two_sided
    (beside,) = found.fitted
    shifted = replace(found.tire, effects=((CATALOGUE["deflection_offset"], (-0.005,)),))
    left = beside.force - simulate(shifted, beside)
    assert np.std(left) == pytest.approx(4.0, rel=0.1)


def test_a_simulation_of_ground_that_was_driven_into_the_air_stays_one() -> None:
    """It is known not to pull there, whatever the recorded part does."""
    time, x, _ = ride(1, samples=1000)
    lifted = x - 0.3 * float(np.max(x))
    simulated = SHAPE * (100.0 * np.maximum(lifted, 0.0)) ** 1.3
    found = believed_of(
        [Recording("a", time, lifted, np.full(x.size, np.inf), 1e5 * lifted, believed_force=simulated)], []
    )
    assert found is not None
    assert not found.tire.two_sided


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
    with looking_for(*rivals("viscous_damping")):
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
