"""The tire file of a part's law: it runs, what it cannot hold is refused, and the advice is a command that runs."""

import json
import shlex
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from click.testing import CliRunner
from part_readings import BOTH, MADE, X, recording
from radialtire import PowerLaw, Recalibrated, TireModel, read_tire
from rivals import looking_for, rivals
from tirelab.cli import main
from tirelab.errors import TirelabError
from tirelab.identification.part_laws import fit_laws, reading_noise
from tirelab.identification.part_tire import best_writable, curve_advice, springless, tire_of
from tirelab.recordings.recording import Recording
from tirelab.recordings.writing import write_recording
from tirelab.simulation.simulate import simulate


@pytest.mark.parametrize("name", ["linear", "power", "power_preload", "linear_gap", "power_gap"])
def test_a_tire_of_it_runs(name: str, tmp_path: Path) -> None:
    x, force, _ = MADE[name]
    part = recording(x, force)
    write_recording(part, tmp_path / "part.csv")
    out = tmp_path / "part.json"
    done = CliRunner().invoke(
        main, ["identify", str(tmp_path / "part.csv"), "--part", name, "--out", str(out)]
    )
    assert done.exit_code == 0, done.output
    assert "Laws compared" in done.output
    simulated = simulate(read_tire(out), part)
    np.testing.assert_allclose(simulated, force, atol=1.5)


def test_a_power_is_held_at_both_ends_only_where_the_recordings_show_it() -> None:
    """A part that was only pressed may lift off: below the length to which it has set it has no force."""
    force = 4e4 * np.sign(BOTH) * np.abs(BOTH) ** 1.3
    pressed, pulled = recording(X, 4e4 * X**1.3), recording(BOTH, force)
    held = {
        name: tire_of(next(fit for fit in fit_laws([r]) if fit.name == "power"), [r], "")
        for name, r in (("pressed", pressed), ("pulled", pulled))
    }
    assert not held["pressed"].two_sided
    assert held["pressed"].is_part
    assert held["pulled"].two_sided
    np.testing.assert_allclose(simulate(held["pressed"], pressed), 4e4 * X**1.3, atol=1.0)


def test_what_a_tire_file_cannot_hold_is_refused() -> None:
    far = recording(X + 0.02, 90e3 * X)
    fits = {fit.name: fit for fit in fit_laws([far])}
    with pytest.raises(TirelabError, match="the force begins at 20 mm, which is rather a gauge's zero"):
        tire_of(fits["linear_gap"], [far], "")
    with pytest.raises(TirelabError, match="cannot hold the law polynomial"):
        tire_of(fits["polynomial"], [far], "")


def test_a_force_that_falls_as_the_deflection_grows_is_no_spring() -> None:
    turned = recording(BOTH, 10.0 - 40e3 * BOTH)
    (linear,) = [fit for fit in fit_laws([turned]) if fit.name == "linear"]
    with pytest.raises(TirelabError, match=r"k = -40, a force that falls .* check the signs"):
        tire_of(linear, [turned], "")


@pytest.mark.parametrize(("stiffness", "said"), [(-40e3, True), (40e3, False)])
def test_a_curve_of_it_is_written_with_a_word(tmp_path: Path, stiffness: float, said: bool) -> None:
    path, out = tmp_path / "part.csv", tmp_path / "tire.json"
    write_recording(recording(BOTH, 10.0 + stiffness * BOTH), path)
    signed = ["--columns", "deflection=+deflection,force=+force"]
    done = CliRunner().invoke(
        main, ["identify", str(path), *signed, "--part", "piecewise", "--out", str(out)]
    )
    assert done.exit_code == 0, done.output
    words = "the force falls as the deflection grows, by 40 N/mm on the whole, as between magnets"
    assert (words in done.output) == said
    assert out.exists()


def slack(tmp_path: Path) -> list[str]:
    """Write a spring that is loose below 4 mm and pulled out of contact, with 10 % friction, and return the words."""
    time = np.arange(1200) / 50.0
    x = 0.002 + 0.01 * np.sin(2.0 * np.pi * time / 12.0)
    spring = 90e3 * np.maximum(x - 0.004, 0.0)
    force = spring * (1.0 + 0.1 * np.sign(np.cos(2.0 * np.pi * time / 12.0)))
    force += np.random.default_rng(8).standard_normal(1200)
    rows = np.column_stack([time, 1e3 * x, force])
    header = "time [s],deflection [mm],force [N]"
    np.savetxt(tmp_path / "slack.csv", rows, delimiter=",", header=header, comments="", fmt="%.6f")
    return [str(tmp_path / "slack.csv")]


def test_a_spring_with_a_gap_cannot_pull_and_is_read_as_a_part(tmp_path: Path) -> None:
    """The gap is a loss of contact, so its tire is one-sided; no ground is asked for all the same."""
    words = slack(tmp_path)
    out = tmp_path / "part.json"
    done = CliRunner().invoke(main, ["identify", *words, "--part", "linear_gap", "--out", str(out)])
    assert done.exit_code == 0, done.output
    tire = read_tire(out)
    assert not tire.two_sided
    assert tire.is_part
    deep, pulled = np.array([0.0141, 0.002, -0.02]), np.arange(3) / 10.0
    alone = Recording("alone", pulled, deep, np.full(3, np.inf), np.zeros(3))
    np.testing.assert_allclose(simulate(tire, alone), [90.0 * 10.1, 0.0, 0.0], rtol=0.02)
    compared = CliRunner().invoke(main, ["compare", *words, "--tire", str(out), "--out", str(tmp_path)])
    assert compared.exit_code == 0, compared.output
    # as printed, but for the surface, which a part has not
    run = ["diagnose", *words, "--tire", str(out), "--out", str(tmp_path / "d"), "--quiet"]
    with looking_for(*rivals("rate_independent_hysteresis")):
        diagnosed = CliRunner().invoke(main, run)
    assert diagnosed.exit_code == 0, diagnosed.output
    assert "friction" in diagnosed.output or "hysteresis" in diagnosed.output
    assert read_tire(tmp_path / "d" / "tire.json").is_part


def test_a_tire_is_no_part() -> None:
    assert not TireModel().is_part
    assert not TireModel(PowerLaw()).is_part
    assert not TireModel(inflated=False).is_part  # an airless tire still stands on a ground
    assert TireModel(PowerLaw(), two_sided=True).is_part
    assert TireModel(Recalibrated(PowerLaw()), inflated=False).is_part


def test_a_part_that_pulls_inside_the_gap_is_not_written_with_one() -> None:
    bushing = recording(BOTH, 90e3 * np.sign(BOTH) * np.maximum(np.abs(BOTH) - 0.003, 0.0))
    fits = {fit.name: fit for fit in fit_laws([bushing])}
    for law in ("linear_gap", "power_gap"):
        with pytest.raises(
            TirelabError, match=f"the law {law} has no force below .* choose one of constant, linear"
        ):
            tire_of(fits[law], [bushing], "")
    # pulled through the gap without a force: the gap's law is the right one, whichever its sign
    loose = recording(BOTH, 90e3 * np.maximum(BOTH - 0.003, 0.0))
    fits = {fit.name: fit for fit in fit_laws([loose])}
    assert next(iter(fits)) == "linear_gap"
    assert tire_of(fits["linear_gap"], [loose], "").effects[0][1] == pytest.approx((-0.003,), abs=5e-5)


def test_two_magnets_are_told_the_curve() -> None:
    """F = 20 N / (1 + x / 8 mm)^4 is a power with a gap of -8 mm and an exponent below all that a tire file holds."""
    x = 0.03 * np.arange(300) / 300.0
    magnets = recording(x, 20.0 / (1.0 + x / 0.008) ** 4, noise=0.01)
    fits = fit_laws([magnets])
    for fit in fits:
        if fit.name in ("power", "power_gap", "linear"):
            with pytest.raises(TirelabError, match=r"for a force that falls .* --part piecewise"):
                tire_of(fit, [magnets], "")
    assert next(f for f in fits if f.name == "power_gap").value("B") == pytest.approx(-4.0, abs=0.1)
    assert best_writable(fits, [magnets]) in ("constant", "piecewise")


def test_a_metal_that_yields_is_told_the_curve() -> None:
    """F = 200 N + 20 N ln(x / 1 mm) is the limit of a power with a preload for an exponent that goes to 0."""
    x = 0.001 + 0.01 * np.arange(300) / 300.0
    bar = recording(x, 200.0 + 20.0 * np.log(1e3 * x), noise=0.01)
    (power,) = [fit for fit in fit_laws([bar]) if fit.name == "power_preload"]
    assert 0.0 < power.value("B") < 0.1
    with pytest.raises(TirelabError, match=r"for a force that levels off, .* --part piecewise; for a part"):
        tire_of(power, [bar], "")


def test_a_damper_without_a_spring_has_its_preload_alone() -> None:
    time = np.arange(2000) / 100.0
    x = 0.01 * np.sin(2.0 * np.pi * time)
    rate = 0.02 * np.pi * np.cos(2.0 * np.pi * time)
    force = 120.0 + 3000.0 * rate + np.random.default_rng(8).standard_normal(2000)
    damper = Recording("damper", time, x, np.full(2000, np.inf), force)
    (linear,) = [fit for fit in fit_laws([damper]) if fit.name == "linear"]
    tire = tire_of(linear, [damper], "damper")
    assert tire.two_sided
    assert not tire.inflated
    assert tire.preload == pytest.approx(120.0, abs=0.5)
    assert tire.law.coefficient < 10.0  # type: ignore[attr-defined]
    k, deviation = next((v, u) for symbol, v, u, _ in linear.constants if symbol == "k")
    assert springless(linear, tire).startswith(f"k = {k:.3g} ± {deviation:.2g} N/mm is no spring")
    assert f"the preload alone, {tire.preload:.4g} N" in springless(linear, tire)
    sprung = replace(linear, constants=(("F0", 120.0, 1.0, "N"), ("k", 12.5, 4.3, "N/mm")))
    assert springless(sprung, tire_of(sprung, [damper], "damper")) == ""
    # third differences leave the noise of 1 N, and of a sine of 6.3 rad/s in steps of 10 ms its part of 2.5e-4
    assert reading_noise([damper]) == pytest.approx(1.0, rel=0.1)


def test_a_damper_whose_force_falls_is_written_as_a_constant(tmp_path: Path) -> None:
    """Its gas or its mass may pull against the stroke: no tire file holds the line, and the command says what does."""
    time = np.arange(2000) / 100.0
    x = 5.0 + np.sin(2.0 * np.pi * time)
    force = 400.0 + 30.0 * np.gradient(x, time) - 30.0 * x
    rows = np.column_stack([time, x, force + np.random.default_rng(8).standard_normal(2000)])
    file = tmp_path / "damper.csv"
    np.savetxt(file, rows, delimiter=",", header="time [s],deflection [cm],force [N]", comments="")
    words = ["identify", str(file), "--columns", "deflection=+deflection [cm],force=+force [N]"]
    alone = CliRunner().invoke(main, [*words, "--radius", "flat"])
    assert alone.exit_code != 0
    assert "for a spring, a damper or a bush, --part compare" in alone.output
    line = CliRunner().invoke(main, [*words, "--part", "linear"])
    assert line.exit_code != 0
    assert "for a part without a spring, such as a damper, give --part constant" in line.output
    compared = CliRunner().invoke(main, [*words, "--part", "compare"])
    assert compared.exit_code == 0, compared.output
    (said,) = [row for row in compared.output.splitlines() if "proposed for a tire file" in row]
    command = shlex.split(said.split("`")[1])
    at = command.index("--part")
    assert command[at : at + 2] == ["--part", "constant"]
    done = CliRunner().invoke(main, [*command[1:], "--out", str(tmp_path / "part.json")])
    assert done.exit_code == 0, done.output
    assert (
        "--radius" in done.output
    )  # of what is called a part here alone, no other command knows that it is none
    (tmp_path / "recording.toml").write_text("part = true\n", encoding="utf-8")
    known = CliRunner().invoke(main, [*words, "--part", "constant", "--out", str(tmp_path / "part.json")])
    assert "tirelab diagnose" in known.output
    assert "--radius" not in known.output
    assert read_tire(tmp_path / "part.json").preload == pytest.approx(float(np.mean(force)), abs=1.0)


@pytest.mark.slow
def test_a_part_that_the_law_misfits_says_so_with_a_command_that_runs(tmp_path: Path) -> None:
    time = np.arange(2000) / 100.0
    x = 0.01 * np.sin(2.0 * np.pi * time)
    force = 120.0 + 3000.0 * 0.02 * np.pi * np.cos(2.0 * np.pi * time) + 2e4 * x
    force += np.random.default_rng(8).standard_normal(2000)
    # No radius: a part has no ground, and neither command asks for one.
    rows = np.column_stack([time, 100.0 * x, force])
    header = "time [s],deflection [cm],force [N]"
    np.savetxt(tmp_path / "damper.csv", rows, delimiter=",", header=header, comments="", fmt="%.6f")
    out = tmp_path / "part.json"
    signed = ["--columns", "deflection=+deflection [cm],force=+force [N]"]
    words = ["identify", str(tmp_path / "damper.csv"), *signed, "--part", "linear", "--out", str(out)]
    done = CliRunner().invoke(main, words)
    assert done.exit_code == 0, done.output
    (said,) = [line for line in done.output.splitlines() if "of noise" in line]
    command = shlex.split(said.split("`")[1])
    assert command[:2] == ["tirelab", "diagnose"]
    with looking_for(*rivals("viscous_damping")):
        diagnosed = CliRunner().invoke(main, [*command[1:], "--out", str(tmp_path / "d"), "--quiet"])
    assert diagnosed.exit_code == 0, diagnosed.output
    verdict = json.loads((tmp_path / "d" / "diagnosis.json").read_text(encoding="utf-8"))["verdict"]
    # The loop is an ellipse: no friction's. What made it is named, and nothing else.
    assert [e["name"] for e in verdict["effects"]] == ["viscous_damping"]
    assert "damping" in diagnosed.output
    words = ["identify", str(tmp_path / "damper.csv"), *signed, "--part", "compare", "--out", str(out)]
    laws = CliRunner().invoke(main, words)
    written, misfit = (shlex.split(line.split("`")[1]) for line in laws.output.splitlines() if "`" in line)
    assert written[:2] == ["tirelab", "identify"]
    assert (misfit[:2], misfit[-2:]) == (["tirelab", "diagnose"], ["--tire", str(out)])
    words = ["compare", str(tmp_path / "damper.csv"), *signed, "--tire", str(out), "--out", str(tmp_path)]
    compared = CliRunner().invoke(main, words)
    assert compared.exit_code == 0, compared.output


def shifter(tmp_path: Path) -> tuple[list[str], np.ndarray, np.ndarray]:
    """Write two slow strokes over five detents of 10 N with 6 N of friction; return words, deflection and law."""
    time = np.arange(0.0, 80.0, 0.04)
    x = 0.04 * (1.0 - np.cos(2.0 * np.pi * time / 40.0))
    detents = 10.0 * np.sin(2.0 * np.pi * x / 0.016)
    force = detents + 6.0 * np.sign(np.gradient(x)) + 0.1 * np.random.default_rng(8).standard_normal(x.size)
    rows = np.column_stack([time, 1e3 * x, force])
    header = "time [s],deflection [mm],force [N]"
    np.savetxt(tmp_path / "shifter.csv", rows, delimiter=",", header=header, comments="", fmt="%.6f")
    signed = ["--columns", "deflection=+deflection [mm],force=+force [N]"]
    return [str(tmp_path / "shifter.csv"), *signed], x, detents


@pytest.mark.slow
def test_detents_are_told_the_curve_and_friction_is_found_beside_it(tmp_path: Path) -> None:
    words, x, detents = shifter(tmp_path)
    out = tmp_path / "part.json"
    line = CliRunner().invoke(main, ["identify", *words, "--part", "constant", "--out", str(out)])
    (said,) = [row for row in line.output.splitlines() if "rises and falls with the deflection" in row]
    again, diagnose = (shlex.split(said.split("`")[i]) for i in (1, 3))
    compared = CliRunner().invoke(main, ["identify", *words, "--part", "compare", "--out", str(out)])
    (best,) = [row for row in compared.output.splitlines() if "proposed for a tire file" in row]
    assert shlex.split(best.split("`")[1]) == again
    done = CliRunner().invoke(main, again[1:])
    assert done.exit_code == 0, done.output
    assert "rises and falls" not in done.output
    tire = read_tire(out)
    assert tire.curve is not None
    moving = Recording("moving", np.arange(x.size) / 25.0, x, np.full(x.size, np.inf), detents)
    missed = np.sqrt(np.mean((simulate(tire, moving) - detents) ** 2))
    assert missed < 0.25 * np.sqrt(np.mean(detents**2))
    with looking_for(*rivals("rate_independent_hysteresis")):
        diagnosed = CliRunner().invoke(main, [*diagnose[1:], "--out", str(tmp_path / "d"), "--quiet"])
    assert diagnosed.exit_code == 0, diagnosed.output
    content = json.loads((tmp_path / "d" / "diagnosis.json").read_text(encoding="utf-8"))
    # a diagnosis keeps the curve with what it misses, and explains the friction
    assert content["fit"]["after"] < np.hypot(missed, 0.25 * 6.0)
    assert read_tire(tmp_path / "d" / "tire.json").curve == tire.curve


def cycled(force: np.ndarray, x: np.ndarray) -> Recording:
    return Recording("cycled", np.arange(x.size) / 50.0, x, np.full(x.size, np.inf), force)


def test_a_mass_that_moves_before_the_cell_is_not_told_to_have_detents() -> None:
    """1.6 kg of a grip at 5 and at 4 Hz: its force falls with the deflection in and out alike, by two amounts."""
    time = np.arange(1400) / 200.0
    x = 0.01 * np.sin(2.0 * np.pi * np.where(time < 3.5, 5.0, 4.0) * time)
    moved = 1.6 * np.gradient(np.gradient(x, time), time)
    moved += np.random.default_rng(1).normal(0.0, 0.5, x.size)
    one = Recording("grip", time, x, np.full(x.size, np.inf), moved)
    constant = next(fit for fit in fit_laws([one]) if fit.name == "constant")
    assert curve_advice(tire_of(constant, [one], "grip"), [one]) == ""
    untimed = replace(one, timed=False)  # no mass is told from a spring that pushes
    assert "detents" in curve_advice(tire_of(constant, [untimed], "grip"), [untimed])


def test_springs_and_dampers_are_not_told_the_curve() -> None:
    phase = 2.0 * np.pi * np.arange(4000) / 1000.0
    x = 0.01 * np.sin(phase)
    noise = np.random.default_rng(8).standard_normal(x.size)
    rate = np.cos(phase)
    parts = {
        "damper": 50.0 * np.where(rate > 0.0, 2.0, 1.0) * np.sign(rate) * np.abs(rate) ** 0.7,
        "mass": -80.0 * np.sin(phase) + 200.0,
        "stiffening": 2e4 * x + 3e8 * x**3,
        "friction": 30.0 * np.sign(rate),
        "noise": 0.0 * x,
    }
    for name, force in parts.items():
        recordings = [cycled(force + noise, x)]
        for fit in fit_laws(recordings):
            if fit.name in ("constant", "linear", "power", "power_preload") and not (
                name == "stiffening" and fit.name == "constant"
            ):
                try:
                    tire = tire_of(fit, recordings, "")
                except TirelabError:
                    continue
                assert curve_advice(tire, recordings) == "", (name, fit.name)


def test_a_pad_whose_gauge_counts_from_elsewhere_is_asked_for_its_zero() -> None:
    """Pressed in the last 4 % of the stroke, and let go as far, with 2 N of noise on 13 N: a straight line and a power
    law from 5.8 mm on are found. What falls has no beginning.
    """
    way = np.linspace(-0.025, -0.0056, 400)
    pad = recording(
        np.concatenate([way, way[::-1]]), 13.0 * np.exp((np.concatenate([way, way[::-1]]) + 0.0056) / 1e-4)
    )
    fits = {fit.name: fit for fit in fit_laws([pad])}
    for name in ("linear_gap", "power_gap"):
        assert tire_of(fits[name], [pad], "").effects[0][1] == pytest.approx((0.0058,), abs=2e-4)
    falling = recording(way, 200.0 - 13.0 * (way - way[0]))
    no_force = {fit.name: fit for fit in fit_laws([falling])}["power_gap"]
    with pytest.raises(TirelabError, match=r"-25 to -5\.6 mm, .* --zero deflection="):
        tire_of(no_force, [falling], "")


@pytest.mark.parametrize(("stiffness", "depth"), [(3e9, 1e-4), (1e-3, 4e-6)])
def test_a_part_of_any_stiffness_is_written_with_its_spring(stiffness: float, depth: float) -> None:
    """A specimen of concrete of 3 GN/m, pressed by 0.1 mm, and a cell of 1 mN/m, pressed by 4 um."""
    way = np.abs(BOTH) * depth / np.max(np.abs(BOTH))
    noise = 1e-3 * stiffness * depth * np.random.default_rng(1).standard_normal(way.size)
    part = replace(recording(way, way), force=stiffness * way + noise)
    fits = fit_laws([part])
    proposed = best_writable(fits, [part])
    assert proposed not in ("", "constant")
    for name in (proposed, "linear", "piecewise"):
        tire = tire_of({fit.name: fit for fit in fits}[name], [part], "")
        np.testing.assert_allclose(simulate(tire, part), stiffness * way, atol=1e-3 * stiffness * depth)


def test_what_is_said_of_a_law_is_of_the_one_that_is_proposed(tmp_path: Path) -> None:
    """From 4 mm on a second spring bears: no power law follows it, a curve does, and its command runs."""
    time = np.arange(0.0, 20.0, 0.005)
    x = 0.01 * (1.0 - np.abs(1.0 - time / 10.0))
    force = 2e4 * x + 6e4 * np.maximum(x - 0.004, 0.0) + np.random.default_rng(8).standard_normal(x.size)
    write_recording(recording(x, force), tmp_path / "part.csv")
    out = tmp_path / "part.json"
    words = ["identify", str(tmp_path / "part.csv"), "--part", "compare", "--out", str(out)]
    lines = CliRunner().invoke(main, words).output.splitlines()
    left = {fit.name: fit.rmse for fit in fit_laws([recording(x, force)])}
    (best,) = [row for row in lines if "proposed for a tire file" in row]
    law = best.split("--part ")[1].split()[0]
    assert left[law] > 10.0
    assert any(f"the law {law} leaves {left[law]:.2g} N beside " in row for row in lines)
    (curve,) = [row for row in lines if f"a curve leaves {left['piecewise']:.2g} N" in row]
    done = CliRunner().invoke(main, shlex.split(curve.split("`")[1])[1:])
    assert done.exit_code == 0, done.output
    assert read_tire(out).curve is not None


def test_a_law_whose_coefficient_no_tire_file_holds_is_refused_in_a_sentence() -> None:
    """A wall of nanometres: the force at 1 cm would be 1e50 N and more."""
    x = np.linspace(0.5e-9, 1e-9, 400)
    wall = recording(x, 1e-6 * (x / 1e-9) ** 8.0, noise=1e-9)
    fits = fit_laws([wall])
    with pytest.raises(
        TirelabError, match=r"law power: coefficient = .* is not allowed; .* --part piecewise"
    ):
        tire_of({fit.name: fit for fit in fits}["power"], [wall], "")
    assert best_writable(fits, [wall]) not in ("power", "")
