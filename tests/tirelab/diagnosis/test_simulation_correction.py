"""Effects are found beside a simulated force that stands in the recordings, whatever simulated it.

Beside the FMU of somebody else the effects are found, and simulation and correction together run as stated.
"""

from __future__ import annotations

import importlib.util
import json
import zipfile
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any
from xml.etree import ElementTree

import jsonschema
import numpy as np
import polars as pl
import pytest
from click.testing import CliRunner
from drives import Drive, ride, saved
from fmpy.ssp.simulation import simulate_ssp
from numpy.typing import NDArray
from radialtire import CATALOGUE, TireModel, read_tire
from rivals import looking_for, rivals
from scipy.signal import lsim
from tirelab.cli import main
from tirelab.diagnosis.outcome import Replayed
from tirelab.diagnosis.simulation_correction import (
    Believed,
    believed_of,
    deliver,
    simulated_by,
    write_corrected,
)
from tirelab.errors import TirelabError
from tirelab.fmu import replay as fmu_replay
from tirelab.fmu.build import build_fmu
from tirelab.fmu.foreign import Simulation, read_foreign
from tirelab.recordings.recording import Recording, read_recording
from tirelab.simulation.simulate import simulate

FloatArray = NDArray[np.float64]


SHAPE = 700.0
DAMPING = 500.0


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
    left = beside.force - simulate(shifted_by(found.tire, -0.005), beside)
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


SPRING, DAMPER, OFFSET, DRIFT, NOISE = 1e5, 300.0, 0.0015, 8.0, 4.0

FOREIGN_MODELS = Path(__file__).parents[1] / "fmu" / "foreign_models.py"


@dataclass(frozen=True)
class Done:
    """A diagnosis that was written: its folder, its diagnosis.json, and what was printed."""

    out: Path
    content: Any
    printed: str


def recorded(folder: Path, name: str, seed: int, offset: float, drift: float) -> Path:
    """A spring and a damper at a shifted deflection, and a drift [N/s] of the force, under 4 N of noise."""
    time, x, _ = ride(seed, samples=3000)
    force = SPRING * (x + offset) + DAMPER * np.append(0.0, np.diff(x) / np.diff(time))
    force += drift * time + NOISE * np.random.default_rng(seed).standard_normal(x.size)
    file = folder / f"{name}{seed}.csv"
    pl.DataFrame({"time [s]": time, "deflection [m]": x, "force [N]": force}).write_csv(file)
    return file


def diagnosed(*words: str | Path) -> str:
    with looking_for("recalibration", "deflection_offset", "force_offset", "force_drift", "viscous_damping"):
        done = CliRunner().invoke(main, ["diagnose", *map(str, words)])
    assert done.exit_code == 0, done.output
    return done.output


def models() -> Any:
    """The scripts of other exporters, which the tests of the FMUs have too."""
    spec = importlib.util.spec_from_file_location("foreign_models", FOREIGN_MODELS)
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


@pytest.fixture(scope="module")
def model(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return Path(models().spring_damper(tmp_path_factory.mktemp("model")))


def beside(model: Path, folder: Path, offset: float, drift: float) -> Done:
    files = [recorded(folder, "press", seed, offset, drift) for seed in (1, 2)]
    words = [files[0], "--held-out", files[1], "--radius", "flat", "--fmu", model]
    printed = diagnosed(*words, "--variables", "force=wheel_load", "--out", folder / "out")
    content = json.loads((folder / "out" / "diagnosis.json").read_text(encoding="utf-8"))
    return Done(folder / "out", content, printed)


@pytest.fixture(scope="module")
def shifted(model: Path, tmp_path_factory: pytest.TempPathFactory) -> Done:
    """The simulation reads a deflection whose zero is 1.5 mm off: an effect before it."""
    return beside(model, tmp_path_factory.mktemp("shifted"), OFFSET, 0.0)


@pytest.fixture(scope="module")
def drifting(model: Path, tmp_path_factory: pytest.TempPathFactory) -> Done:
    """The simulation lacks a drift of the load cell of 8 N/s: an effect beside it."""
    return beside(model, tmp_path_factory.mktemp("drifting"), 0.0, DRIFT)


def names(done: Done) -> list[str]:
    return [effect["name"] for effect in done.content["verdict"]["effects"]]


def test_an_offset_before_the_simulation_is_found_and_given_to_it(shifted: Done) -> None:
    assert names(shifted) == ["deflection_offset"]
    entry = shifted.content["correction"]
    assert entry["moves"] is True
    assert (entry["fmu"], entry["system"], entry["simulation"]) == (
        "Correction.fmu",
        "Corrected.ssp",
        "SpringDamper.fmu",
    )
    offset = shifted.content["verdict"]["effects"][0]["parameters"]["offset"]["value"]
    assert offset == pytest.approx(OFFSET, rel=0.02)


def test_a_drift_beside_the_simulation_is_found_and_added(drifting: Done) -> None:
    assert names(drifting) == ["force_drift"]
    assert drifting.content["correction"]["moves"] is False


@pytest.mark.parametrize("which", ["shifted", "drifting"])
def test_the_stated_errors_are_those_of_simulation_and_correction(
    which: str, request: pytest.FixtureRequest
) -> None:
    """Before: all that was put in; after: the noise alone."""
    done: Done = request.getfixturevalue(which)
    fit = done.content["fit"]
    for seed, key in ((1, ""), (2, "held_out_")):
        table = pl.read_csv(done.out / f"press{seed}.corrected.csv")
        force = table["force [N]"].to_numpy()
        for column, error in (("believed_force [N]", "before"), ("corrected_force [N]", "after")):
            difference = force - table[column].to_numpy()
            assert np.sqrt(np.mean(difference**2)) == pytest.approx(fit[key + error], rel=1e-6)
        assert fit[key + "after"] < 1.25 * NOISE
        assert fit[key + "before"] > 10.0 * NOISE


@pytest.mark.parametrize("which", ["shifted", "drifting"])
def test_fmpy_runs_the_system_and_reaches_the_stated_force(
    which: str, request: pytest.FixtureRequest
) -> None:
    """fmpy hands a value on one step later: as many steps, of a twentieth of the sampling, as there are components."""
    done: Done = request.getfixturevalue(which)
    samples, finer, late = 300, 20, 2 + done.content["correction"]["moves"]
    table = pl.read_csv(done.out / "press2.corrected.csv")[:samples]
    time, x, corrected = (
        table[name].to_numpy() for name in ("time [s]", "deflection [m]", "corrected_force [N]")
    )
    step = float(time[1] - time[0]) / finer
    result = simulate_ssp(
        str(done.out / "Corrected.ssp"),
        stop_time=time[-1] + 4 * step,
        step_size=step,
        input={"deflection": lambda t: float(np.interp(t, time, x))},
    )
    force = np.interp(time + late * step, result["time"], result["corrected_force"])
    # on straight lines the damper's rate is the same in a part of a sample; the ends are cut off
    assert np.max(np.abs(force - corrected)[5:-2]) < 0.05
    recorded_force = table["force [N]"].to_numpy()
    reached = np.sqrt(np.mean((force - recorded_force)[5:-2] ** 2))
    assert reached == pytest.approx(np.sqrt(np.mean((corrected - recorded_force)[5:-2] ** 2)), rel=1e-3)


def test_the_system_is_what_the_standard_says(shifted: Done, drifting: Done) -> None:
    """SSP 1.0: fmpy's copy of the schema is checked as it is written; here what it connects."""
    for done, through in ((shifted, True), (drifting, False)):
        with zipfile.ZipFile(done.out / "Corrected.ssp") as archive:
            assert set(archive.namelist()) == {
                "SystemStructure.ssd",
                "resources/Simulation.fmu",
                "resources/Correction.fmu",
            }
            root = ElementTree.fromstring(archive.read("SystemStructure.ssd"))
        space = "{http://ssp-standard.org/SSP1/SystemStructureDescription}"
        assert root.get("version") == "1.0"
        found = {
            (c.get("startElement"), c.get("startConnector"), c.get("endElement"), c.get("endConnector"))
            for c in root.iter(f"{space}Connection")
        }
        start = ("before", "tire_deflection") if through else (None, "deflection")
        assert (*start, "simulation", "displacement") in found
        assert ("simulation", "wheel_load", "correction", "simulated_force") in found
        assert ("correction", "corrected_force", None, "corrected_force") in found


def test_what_is_printed_says_what_was_taken_and_that_it_is_native_code(shifted: Done) -> None:
    printed = shifted.printed
    assert "its displacement is taken for the deflection" in printed
    assert "is native code" in printed
    assert printed.index("is native code") < printed.index("replaying SpringDamper.fmu")
    assert "Corrected.ssp" in printed


def test_the_file_follows_its_schema(shifted: Done, repository: Path) -> None:
    schema = json.loads((repository / "examples/docs/diagnosis.schema.json").read_text(encoding="utf-8"))
    jsonschema.validate(shifted.content, schema)


def test_our_own_fmu_is_its_tire(tmp_path: Path) -> None:
    time, x, rate = ride(1, samples=2000)
    tire = TireModel(name="mine")
    bare = Drive("a", time, x, np.full(x.size, np.inf), x)
    force = simulate(tire, bare) + 500.0 * rate + NOISE * np.random.default_rng(1).standard_normal(x.size)
    file = saved(Drive("a", time, x, np.full(x.size, np.inf), force), tmp_path / "a.csv")
    fmu = build_fmu(tire, tmp_path / "fmu").path
    printed = diagnosed(file, "--fmu", fmu, "--out", tmp_path / "out")
    assert "the baseline is the tire inside BicycleTire.fmu: mine" in printed
    assert "is native code" not in printed
    corrected = read_tire(tmp_path / "out" / "tire.json")
    assert [effect.name for effect, _ in corrected.effects] == ["viscous_damping"]
    assert corrected.law == tire.law
    assert (tmp_path / "out" / "BicycleTire.fmu").is_file()
    assert not (tmp_path / "out" / "Correction.fmu").exists()


def shifted_by(tire: TireModel, offset: float) -> TireModel:
    return replace(tire, effects=((CATALOGUE["deflection_offset"], (offset,)),))


@pytest.mark.parametrize(("kind", "within"), [("CoSimulation", 8.0), ("ModelExchange", 0.1)])
def test_beside_a_maxwell_element_of_fmi_3(kind: str, within: float, tmp_path: Path) -> None:
    """80 kN/m at rest, 100 kN/m in motion: no one law stands for it, so the better of the two ways is delivered."""
    pytest.importorskip("pythonfmu3")
    fmu = read_foreign(Simulation(models().maxwell(tmp_path, kind)))
    time, x, _ = ride(1, samples=1000)

    def maxwell(deflection: FloatArray) -> FloatArray:
        return np.asarray(1e5 * deflection - lsim(([2e4], [0.5, 1.0]), deflection, time)[1])

    flat = np.full(x.size, np.inf)
    noise = NOISE * np.random.default_rng(1).standard_normal(x.size)
    recording = Recording("a", time, x, flat, maxwell(x + OFFSET) + noise)
    believed = simulated_by(fmu, 300.0, [recording], [], lambda sentence: None)
    law = believed.tire.law.coefficients(np.inf)
    found = []
    for offset in (OFFSET, 0.6 * OFFSET):
        done = deliver(tmp_path / "out", believed, shifted_by(believed.tire, offset), lambda sentence: None)
        added = maxwell(x) + law[0] * ((100.0 * (x + offset)) ** law[1] - (100.0 * x) ** law[1])
        forces = {True: maxwell(x + offset), False: added}
        errors = {moves: np.sqrt(np.mean((recording.force - f) ** 2)) for moves, f in forces.items()}
        moves = done.correction.moves
        assert moves == (errors[True] < 1.1 * errors[False])
        assert any("delivered as an additional force" in note for note in done.notes()) != moves
        np.testing.assert_allclose(
            done.force(recording_of(believed), lambda s: None), forces[moves], atol=within
        )
        found.append(moves)
        with zipfile.ZipFile(tmp_path / "out" / "Corrected.ssp") as archive:
            assert f'implementation="{kind}"'.encode() in archive.read("SystemStructure.ssd")
    assert found[0], "the true offset before the simulation leaves the noise alone"


def recording_of(believed: Believed) -> Recording:
    (recording,) = believed.fitted
    return recording


@pytest.mark.parametrize(
    ("words", "match"),
    [
        (["--tire", "{fmu}"], "both name a simulation"),
        (["--fmu-timeout", "0"], "give seconds, more than 0"),
        (["--each"], "--each takes a tire file"),
        (["--variables", "force=weight"], "no real output 'weight'"),
        (["--variables", "force=wheel_load", "--fmu-timeout", "0.01"], "was ended after 0.01 s"),
    ],
)
def test_bad_options_are_refused_in_one_sentence(
    words: list[str], match: str, model: Path, tmp_path: Path
) -> None:
    file = recorded(tmp_path, "a", 1, 0.0, 0.0)
    given = [word.replace("{fmu}", str(model)) for word in words]
    out = tmp_path / "out"
    done = CliRunner().invoke(
        main, ["diagnose", str(file), "--radius", "flat", "--fmu", str(model), "--out", str(out), *given]
    )
    assert done.exit_code == 2, done.output
    assert match in done.output
    assert not out.exists()


def test_variables_without_an_fmu_are_refused(tmp_path: Path) -> None:
    file = recorded(tmp_path, "a", 1, 0.0, 0.0)
    done = CliRunner().invoke(main, ["diagnose", str(file), "--variables", "force=F"])
    assert done.exit_code == 2
    assert "those of --fmu" in done.output
