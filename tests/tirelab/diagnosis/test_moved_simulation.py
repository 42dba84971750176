"""Effects before a simulation are tried with the simulation itself where its law does not stand for it."""

from __future__ import annotations

import importlib.util
import itertools
import json
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import polars as pl
import pytest
from click.testing import CliRunner
from numpy.typing import NDArray
from radialtire import CATALOGUE
from rivals import looking_for
from tirelab.cli import main
from tirelab.diagnosis import moved_simulation
from tirelab.diagnosis.asked import Before, log_odds
from tirelab.diagnosis.moved_simulation import diagnose_beside
from tirelab.diagnosis.simulation_correction import Believed, believed_of
from tirelab.diagnosis.verdict import FitErrors, Verdict
from tirelab.errors import TirelabError
from tirelab.estimation.findings import NamedEffect, Remainder
from tirelab.recordings.recording import Recording
from tirelab.regressors.dataset import dataset_of
from tirelab.simulation.simulate import upstream_names

FloatArray = NDArray[np.float64]
Simulation = Callable[[FloatArray], FloatArray]

STEP, COUNT, NOISE = 5e-3, 4000, 3.0

FOREIGN_MODELS = Path(__file__).parents[1] / "fmu" / "foreign_models.py"


def play(deflection: FloatArray) -> FloatArray:
    """The force of `foreign_models.PLAY` in even steps, which no law has: 150 kN/m and 800 N s/m beyond 2 mm."""
    beyond = np.maximum(np.abs(deflection) - 0.002, 0.0)
    rate = np.diff(deflection, prepend=deflection[0]) / STEP
    return np.asarray(np.sign(deflection) * 1.5e5 * beyond + 800.0 * rate * (beyond > 0.0))


def maxwell(deflection: FloatArray) -> FloatArray:
    """100 kN/m beside 60 kN/m in series with a damper of 0.3 s."""
    held, force = 0.0, [1e5 * float(deflection[0])]
    for before, now in itertools.pairwise(deflection.tolist()):
        held = (held + 6e4 * (now - before)) * float(np.exp(-STEP / 0.3))
        force.append(1e5 * now + held)
    return np.array(force)


def motion() -> tuple[FloatArray, FloatArray]:
    """Times [s] and a deflection [m] of three frequencies, with a rest of 2 s, both signs."""
    time = STEP * np.arange(COUNT)
    waves = [(0.008, 0.3, 0.0), (0.003, 1.1, 1.0), (0.0015, 2.3, 2.0)]
    x = sum(size * np.sin(2.0 * np.pi * f * time + phase) for size, f, phase in waves)
    return time, np.where(time > 18.0, x[int(18.0 / STEP)], x)


def rubbed(x: FloatArray) -> FloatArray:
    """Friction of 40 N that is taken up within 0.2 mm."""
    held, force = 0.0, []
    for step in np.diff(x, prepend=x[0]).tolist():
        held = min(max(held + 2e5 * step, -40.0), 40.0)
        force.append(held)
    return np.array(force)


def recorded(
    true: FloatArray, read: FloatArray, simulated: Simulation, added: FloatArray | float
) -> Recording:
    """The force at the deflection as it was, beside the one that was read; `added` [N] is what acts beside."""
    time, flat = STEP * np.arange(COUNT), np.full(COUNT, np.inf)
    noise = NOISE * np.random.default_rng(7).standard_normal(COUNT)
    return Recording("rig", time, read, flat, simulated(true) + added + noise, believed_force=simulated(read))


def beside(recording: Recording, simulated: Simulation, patch: pytest.MonkeyPatch) -> Believed:
    """The recording beside a simulation that is asked as its FMU would be."""
    patch.setattr(moved_simulation, "replay_foreign", lambda model, moved, *rest: simulated(moved.deflection))
    found = believed_of([recording], [])
    assert found is not None
    return replace(found, model=object())  # type: ignore[arg-type]


def diagnosed_of(believed: Believed, *names: str) -> Verdict:
    with looking_for(*names):
        return diagnose_beside(believed, None, lambda sentence: None)


BESIDE = ("recalibration", "viscous_damping", "rate_independent_hysteresis")


@pytest.mark.slow
def test_an_offset_before_a_spring_with_play_is_found_with_the_spring(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    _, x = motion()
    believed = beside(recorded(x, x + 4e-4, play, 0.0), play, monkeypatch)
    assert believed.rmse > 10.0 * NOISE, "no law stands for it"
    found = diagnosed_of(believed, *BESIDE)
    assert [e.name for e in found.effects] == ["deflection_offset"]
    offset = found.effects[0].parameters["offset"]
    assert offset.value == pytest.approx(-4e-4, abs=5.0 * offset.std)
    assert offset.std < 2e-6
    assert found.fit.before == pytest.approx(
        float(np.sqrt(np.mean((play(x) - play(x + 4e-4)) ** 2))), rel=0.1
    )
    assert found.fit.after < 1.05 * NOISE
    assert found.confidence > 0.8
    assert {e.name: v for e, v in found.tire.effects} == {"deflection_offset": (offset.value,)}
    assert "The simulation itself was given the deflection after the deflection offset" in found.summary


@pytest.mark.slow
def test_friction_beside_an_offset_before_it_are_both_found(monkeypatch: pytest.MonkeyPatch) -> None:
    _, x = motion()
    believed = beside(recorded(x, x + 4e-4, play, rubbed(x)), play, monkeypatch)
    found = diagnosed_of(believed, *BESIDE)
    assert {e.name for e in found.effects} == {"deflection_offset", "rate_independent_hysteresis"}
    assert found.effects[0].parameters["offset"].value == pytest.approx(-4e-4, rel=0.1)


def test_a_lag_that_the_simulation_refutes_is_not_named(monkeypatch: pytest.MonkeyPatch) -> None:
    """Of a damper beside a spring the law alone cannot tell a late gauge; beside a spring with a memory it would move
    that too.
    """
    time, x = motion()
    believed = beside(recorded(x, x, maxwell, 900.0 * np.gradient(x, time)), maxwell, monkeypatch)
    found = diagnosed_of(believed, "viscous_damping", "deflection_lag")
    assert [e.name for e in found.effects] == ["viscous_damping"]
    assert not any("deflection_lag" in a.names for a in found.alternatives)


def test_what_only_acts_beside_the_simulation_stays_what_it_is(monkeypatch: pytest.MonkeyPatch) -> None:
    _, x = motion()
    found = diagnosed_of(beside(recorded(x, x, play, rubbed(x)), play, monkeypatch), *BESIDE)
    assert [e.name for e in found.effects] == ["rate_independent_hysteresis"]


@pytest.mark.parametrize("name", upstream_names())
def test_a_strength_stays_within_its_bounds(name: str, monkeypatch: pytest.MonkeyPatch) -> None:
    """Friction of 400 N asks for more of an effect before the simulation than there can be."""
    _, x = motion()
    believed = beside(recorded(x, x, play, 10.0 * rubbed(x)), play, monkeypatch)
    dataset = dataset_of(believed.fitted, believed.tire)
    moved = moved_simulation._moved_by(name, believed, dataset, lambda sentence: None)
    for value, parameter in zip(moved.values if moved else (), CATALOGUE[name].parameters, strict=False):
        assert parameter.minimum <= value <= parameter.maximum


def test_a_simulation_that_fails_on_another_deflection_keeps_the_verdict(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    _, x = motion()
    believed = beside(recorded(x, x + 4e-4, play, 0.0), play, monkeypatch)

    def fails(*given: Any) -> FloatArray:
        raise TirelabError("beyond its range")

    monkeypatch.setattr(moved_simulation, "replay_foreign", fails)
    found = diagnosed_of(believed, "recalibration", "viscous_damping")
    assert "deflection_offset" not in {e.name for e in found.effects}
    assert found.confidence <= 0.5


def test_the_odds_are_even_where_the_gain_is_that_of_the_prior() -> None:
    """30 effective samples: 5 nats are a factor of exp(1/6) in the error."""
    assert log_odds(float(np.exp(1.0 / 6.0)), 1.0) == pytest.approx(0.0, abs=1e-9)
    assert log_odds(2.0, 1.0) > 10.0
    assert log_odds(1.0, 2.0) < -10.0


def test_a_held_out_recording_that_is_worse_lowers_the_probability() -> None:
    effect = NamedEffect("deflection_offset", {}, 1.0, 0.5)
    without, left = (
        FitErrors(1.0, 9.0, after, 9.0, held, "recordings given") for after, held in ((4.0, 2.0), (2.0, 4.0))
    )
    before = Before((effect,), (), without)
    assert before.judged(left).probability > 0.99
    kept = recorded(motion()[1], motion()[1], play, 0.0)
    assert replace(before, held_out=(kept,)).judged(left).probability < 0.01


def test_the_share_of_a_remainder_is_that_of_the_whole_misfit() -> None:
    """3 N are left of 6 N beside 4 N of noise with the other deflection, and of 25 N without it."""
    remainder = Remainder(0.45, 0.75, 3.0, ())
    errors = FitErrors(4.0, 25.0, 5.0, 25.0, 5.0, "recordings given")
    assert Before(errors=errors).of_the_whole(remainder, 4.0).share == pytest.approx(9.0 / (25.0**2 - 16.0))
    assert Before().of_the_whole(remainder, 4.0) is remainder


@pytest.mark.slow
def test_the_corrected_simulation_of_an_fmu_with_play_runs_as_stated(tmp_path: Path) -> None:
    """The FMU of pythonfmu from the command line: the correction moves its deflection."""
    spec = importlib.util.spec_from_file_location("foreign_models", FOREIGN_MODELS)
    assert spec is not None
    assert spec.loader is not None
    models = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(models)
    time, x = motion()
    recording = recorded(x, x + 4e-4, play, 0.0)
    file = tmp_path / "rig.csv"
    table = {"time [s]": time, "travel [m]": recording.deflection, "force [N]": recording.force}
    pl.DataFrame(table).write_csv(file)
    words = [file, "--radius", "flat", "--fmu", models.play(tmp_path), "--out", tmp_path / "out"]
    with looking_for(*BESIDE):
        done = CliRunner().invoke(main, ["diagnose", *map(str, words)])
    assert done.exit_code == 0, done.output
    content = json.loads((tmp_path / "out" / "diagnosis.json").read_text(encoding="utf-8"))
    assert [e["name"] for e in content["verdict"]["effects"]] == ["deflection_offset"]
    assert content["correction"]["moves"] is True
    assert content["fit"]["after"] < 1.05 * NOISE
    assert content["fit"]["before"] > 10.0 * NOISE
