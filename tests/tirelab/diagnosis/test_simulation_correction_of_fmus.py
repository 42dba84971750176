"""Beside the FMU of somebody else effects are found, and simulation and correction together run as stated."""

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
from rivals import looking_for
from scipy.signal import lsim
from tirelab.cli import main
from tirelab.diagnosis.simulation_correction import (
    Believed,
    deliver,
    simulated_by,
)
from tirelab.fmu.build import build_fmu
from tirelab.fmu.foreign import Simulation, read_foreign
from tirelab.recordings.recording import Recording
from tirelab.report.titles import newtons
from tirelab.simulation.simulate import simulate

FloatArray = NDArray[np.float64]


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


@pytest.mark.slow
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


@pytest.mark.slow
def test_a_drift_beside_the_simulation_is_found_and_added(drifting: Done) -> None:
    assert names(drifting) == ["force_drift"]
    assert drifting.content["correction"]["moves"] is False


@pytest.mark.slow
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


def test_the_sentences_have_the_errors_of_the_table(shifted: Done) -> None:
    """Both are those of the replayed FMUs, which the law of the simulation alone does not give."""
    fit, told = shifted.content["fit"], " ".join(shifted.content["verdict"]["summary"].split())
    assert f"the RMS error from {newtons(fit['before'])} to {newtons(fit['after'])}" in told
    assert f"from {newtons(fit['held_out_before'])} to {newtons(fit['held_out_after'])}" in told


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
