"""The command `ride`, from terrain and tire to a table, a picture and the share that is doubtful."""

from functools import partial
from pathlib import Path

import numpy as np
import pytest
import tirelab.terrain
from click.testing import CliRunner
from radialtire import CATALOGUE, PowerLaw, TestedRange, TireModel, write_tire
from tirelab.cli.ride import command
from tirelab.terrain.iso8608 import GEOMETRIC_MEAN


@pytest.fixture(autouse=True)
def in_a_folder_of_its_own(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)


@pytest.fixture
def undrawn(monkeypatch: pytest.MonkeyPatch) -> None:
    """Without the picture, which takes longer than the rest."""
    monkeypatch.setattr(tirelab.terrain, "draw_ride", lambda ride, path: None)


def run(*arguments: str | Path) -> str:
    """Return what the command prints."""
    result = CliRunner().invoke(command, [str(a) for a in arguments], catch_exceptions=False)
    assert result.exit_code == 0, result.output
    return result.output


@pytest.mark.usefixtures("undrawn")
def test_flat_ground_under_the_articles_tire(tmp_path: Path) -> None:
    output = run("--length", "4", "--load", "550.9", "--out", tmp_path / "new" / "flat")
    # F = 550.9 x^1.422 is 550.9 N at 1 cm.
    assert "deflection 10.0 to 10.0 mm" in output
    assert "radial force 551 to 551 N" in output
    assert "The article's model holds along all of the 3.3" in output
    header, *rows = (tmp_path / "new" / "flat" / "ride.csv").read_text().splitlines()
    assert header.startswith(
        "time [s],position [m],hub_height [m],deflection [m],surface_radius [m],radial_force [N]"
    )
    assert set(np.array([row.split(",")[4] for row in rows])) == {"inf"}


def test_obstacle_at_a_place(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    few = partial(tirelab.terrain.animate_ride, frames=2)  # the ordinary 120 frames take 19 s
    monkeypatch.setattr(tirelab.terrain, "animate_ride", few)
    output = run("--length", "6", "--obstacle", "log@2.5", "--animation")
    assert output.splitlines()[-1] == "written: ride/ride.csv, ride/ride.png, ride/ride.gif"
    table = np.genfromtxt(tmp_path / "ride" / "ride.csv", delimiter=",", skip_header=1)
    assert table[np.argmax(table[:, 2]), 1] == pytest.approx(2.5, abs=0.01)
    assert (tmp_path / "ride" / "ride.png").read_bytes().startswith(b"\x89PNG")
    assert (tmp_path / "ride" / "ride.gif").read_bytes().startswith(b"GIF8")


@pytest.mark.usefixtures("undrawn")
def test_rough_ground_says_how_much_is_doubtful() -> None:
    assert "cannot be trusted along 9" in run("--iso-class", "D", "--seed", "1", "--length", "30")


@pytest.mark.usefixtures("undrawn")
def test_profile_from_a_file_is_smoothed_and_says_so(tmp_path: Path) -> None:
    s = np.arange(0.0, 6.0, 0.01)
    z = 0.05 * np.sin(np.pi * s)
    path = tmp_path / "trail.csv"
    path.write_text(
        "s [m],z [mm]\n" + "\n".join(f"{a:.4f},{1000.0 * b:.4f}" for a, b in zip(s, z, strict=True))
    )
    assert "note: smoothed over 0.05 m" in run(path)
    assert "note: smoothed" not in run(path, "--smoothing-length", "0")


@pytest.mark.usefixtures("undrawn")
def test_path_of_the_hub_from_a_file(tmp_path: Path) -> None:
    path = tmp_path / "hub.csv"
    path.write_text("s [m],h [cm]\n0.5,32\n1,32\n1.5,34\n2,32\n")
    output = run("--length", "4", "--hub-path", path)
    assert "deflection -10.0 to 10.0 mm" in output
    assert "25.0 % wheel off the ground" in output


@pytest.mark.usefixtures("undrawn")
def test_tire_file_and_its_effects(tmp_path: Path) -> None:
    tire = tmp_path / "tire.json"
    tire.write_text(
        '{"schema": 1, "name": "soft", "source": "a test", "law": {"name": "power_law", "parameters": '
        '{"coefficient": 500.0, "exponent": 1.0}}, "effects": [{"name": "viscous_damping", "parameters": '
        '{"damping": 300.0}}], "tested_range": null}'
    )
    output = run("--length", "4", "--tire", tire)
    assert "tire: soft" in output
    assert "deflection 10.0 to 10.0 mm" in output
    assert "elastic law alone; its effects (viscous_damping)" in output


@pytest.mark.parametrize(
    ("arguments", "sentence"),
    [
        (["--obstacle", "rock"], "--obstacle rock: give one of stick, log"),
        (["--obstacle", "log@x"], "--obstacle log@x"),
        (["--tire", "none.json"], "none.json"),
        (["none.csv"], "none.csv: No such file"),
        (["--load", "0"], "load 0 N"),
        (["--length", "4", "--out", "/dev/null/ride"], "cannot be written"),
        (
            ["trail.csv", "--columns", "s=Way"],
            "no column 'Way' among 's [m]', 'z [m]'; correct --columns s=NAME",
        ),
        (["trail.csv", "--columns", "x=s"], "--columns: 'x' is not a column of a profile; name s or z"),
        (["trail.csv", "--columns", "s"], "--columns: 's' has no =; write like s=Distance"),
        (["trail.csv", "--columns", 's="Way'], "a quote is not closed"),
        (["trail.csv", "--units", "z=mm,z=m"], "--units: z is given twice"),
        (["trail.csv", "--units", "z=kg"], "'kg' is not a unit of length"),
        (["track.gpx", "--units", "z=m"], "a GPX track has no columns to name"),
    ],
)
def test_faults_are_sentences(arguments: list[str], sentence: str) -> None:
    Path("trail.csv").write_text("s [m],z [m]\n0,0\n1,0\n2,0\n3,0\n4,0\n")
    result = CliRunner().invoke(command, arguments)
    assert result.exit_code == 2
    assert sentence in result.output
    assert len(result.output.splitlines()) == 1


def profile_of(path: str, *arguments: str) -> tuple[np.ndarray, str]:
    """Return the rows of the ride over the profile at `path`, and what was printed."""
    output = run(path, "--smoothing-length", "0", *arguments)
    return np.genfromtxt(Path("ride", "ride.csv"), delimiter=",", skip_header=1), output


@pytest.mark.usefixtures("undrawn")
def test_columns_and_units_of_a_profile_can_be_named() -> None:
    s = np.arange(0.0, 4.0, 0.02)
    z = 0.02 * np.sin(np.pi * s)
    rows = [f"{a:.4f},{1e3 * b:.6f},{100.0 * a:.4f}" for a, b in zip(s, z, strict=True)]
    Path("named.csv").write_text("chainage,Height of ground [mm],s [cm]\n" + "\n".join(rows))
    Path("plain.csv").write_text("s,z\n" + "\n".join(f"{a:.4f},{b:.9f}" for a, b in zip(s, z, strict=True)))
    expected, output = profile_of("plain.csv")
    assert "note: columns s and z of plain.csv have no units: read in metres" in output
    named, output = profile_of("named.csv", "--columns", 'z="Height of ground"')
    assert "no units" not in output
    np.testing.assert_allclose(named, expected, rtol=1e-6, atol=1e-6)
    named, _ = profile_of("named.csv", "--columns", "s=Chainage,z=Height of ground [mm]", "--units", "s=m")
    np.testing.assert_allclose(named, expected, rtol=1e-6, atol=1e-6)


def test_the_help_names_every_obstacle_and_class() -> None:
    text = " ".join(run("--help").split())
    assert f"({', '.join(tirelab.terrain.OBSTACLES)})" in text
    assert f"[{'|'.join(GEOMETRIC_MEAN)}]" in text


@pytest.mark.usefixtures("undrawn")
def test_the_pressure_is_given_with_its_unit(tmp_path: Path) -> None:
    effect = CATALOGUE["inflation_pressure"]
    write_tire(TireModel(effects=((effect, (1.0, 3e5, 1.0)),)), tmp_path / "tire.json")
    # F = 550.9 x^1.422 p / p0 is 550.9 N / 2 at 1 cm and half the pressure
    flat = ("--length", "4", "--load", "275.45", "--tire", tmp_path / "tire.json")
    assert "deflection 10.0 to 10.0 mm" in run(*flat, "--inflation-pressure", "1.5bar")
    wrong = CliRunner().invoke(command, [*map(str, flat), "--inflation-pressure", "1.5"])
    assert wrong.exit_code != 0
    assert "is no pressure" in wrong.output


@pytest.mark.usefixtures("undrawn")
@pytest.mark.parametrize(
    ("pressure", "said"), [("60bar", "60 bar is none that a bicycle tire has"), ("-0.9bar", "(0 to 15 bar)")]
)
def test_a_pressure_that_no_tire_has_is_refused(tmp_path: Path, pressure: str, said: str) -> None:
    write_tire(
        TireModel(effects=((CATALOGUE["inflation_pressure"], (1.0, 3e5, 1.0)),)), tmp_path / "tire.json"
    )
    options = ("--length", "4", "--tire", str(tmp_path / "tire.json"), f"--inflation-pressure={pressure}")
    refused = CliRunner().invoke(command, options)
    assert refused.exit_code == 2
    assert "--inflation-pressure: a gauge pressure of" in refused.output
    assert said in refused.output
    assert len(refused.output.splitlines()) == 1


@pytest.mark.usefixtures("undrawn")
def test_the_effect_that_acts_is_not_said_to_act_in_the_fmu_alone(tmp_path: Path) -> None:
    pressure, damping = CATALOGUE["inflation_pressure"], CATALOGUE["viscous_damping"]
    damped = (damping, tuple(p.start for p in damping.parameters))
    for effects in ((), (damped,)):
        write_tire(TireModel(effects=((pressure, (1.0, 3e5, 1.0)), *effects)), tmp_path / "tire.json")
        flat = ("--length", "4", "--load", "275.45", "--tire", tmp_path / "tire.json")
        output = run(*flat, "--inflation-pressure", "1.5bar")
        assert "the tire's law is that at 3 bar; its effect inflation_pressure takes it to 1.5 bar" in output
        assert ("other effects (viscous_damping) act in the FMU" in output) == bool(effects)
        assert "elastic law alone" not in output


@pytest.mark.usefixtures("undrawn")
def test_a_tire_beyond_its_own_tested_range(tmp_path: Path) -> None:
    flat_alone = TestedRange(-1e-5, 1e-5, 0.005, 150.0)
    write_tire(TireModel(PowerLaw(400.0, 1.5), tested_range=flat_alone), tmp_path / "small.json")
    small = ("--tire", tmp_path / "small.json")
    output = run("--length", "8", "--obstacle", "log", *small)
    assert (
        "This tire was measured to 0.5 cm and 150 N on ground that is flat; its model cannot be trusted"
        in output
    )
    assert "100.0 % deflection beyond the 0.5 cm tested" in output
    assert "100.0 % force beyond the 150 N tested" in output
    assert "% ground of other curvature than that tested, flat" in output
    held = run("--length", "4", "--load", "100", *small)
    assert "on ground that is flat; its model holds along all of the 3.3 m ridden." in held
    write_tire(TireModel(tested_range=None), tmp_path / "small.json")
    unknown = run("--length", "4", *small)
    assert "Where this tire was measured is not known; by the article's limits its model holds" in unknown
