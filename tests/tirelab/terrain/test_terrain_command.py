"""The command `ride`, from terrain and tire to a table, a picture and the share that is doubtful."""

from pathlib import Path

import numpy as np
import pytest
from click.testing import CliRunner
from tirelab.cli.ride import command


def run(*arguments: str | Path) -> str:
    """Return what the command prints."""
    result = CliRunner().invoke(command, [str(a) for a in arguments], catch_exceptions=False)
    assert result.exit_code == 0, result.output
    return result.output


def test_flat_ground_under_the_articles_tire(tmp_path: Path) -> None:
    output = run("--length", "4", "--load", "550.9", "--output", tmp_path / "ride.csv")
    # F = 550.9 x^1.422 is 550.9 N at 1 cm.
    assert "deflection 10.0 to 10.0 mm" in output
    assert "radial force 551 to 551 N" in output
    assert "The article's model holds along all of the 3.3" in output
    header, *rows = (tmp_path / "ride.csv").read_text().splitlines()
    assert header.startswith(
        "time [s],position [m],hub_height [m],deflection [m],surface_radius [m],radial_force [N]"
    )
    assert set(np.array([row.split(",")[4] for row in rows])) == {"inf"}


def test_obstacle_at_a_place(tmp_path: Path) -> None:
    run(
        "--length",
        "6",
        "--obstacle",
        "log@2.5",
        "--output",
        tmp_path / "r.csv",
        "--picture",
        tmp_path / "r.png",
    )
    table = np.genfromtxt(tmp_path / "r.csv", delimiter=",", skip_header=1)
    assert table[np.argmax(table[:, 2]), 1] == pytest.approx(2.5, abs=0.01)
    assert (tmp_path / "r.png").stat().st_size > 10_000


def test_rough_ground_says_how_much_is_doubtful() -> None:
    assert "cannot be trusted along 9" in run("--iso-class", "D", "--seed", "1", "--length", "30")


def test_profile_from_a_file_is_smoothed_and_says_so(tmp_path: Path) -> None:
    s = np.arange(0.0, 6.0, 0.01)
    z = 0.05 * np.sin(np.pi * s)
    path = tmp_path / "trail.csv"
    path.write_text(
        "s [m],z [mm]\n" + "\n".join(f"{a:.4f},{1000.0 * b:.4f}" for a, b in zip(s, z, strict=True))
    )
    assert "note: smoothed over 0.05 m" in run(path)
    assert "note: smoothed" not in run(path, "--smoothing-length", "0")


def test_path_of_the_hub_from_a_file(tmp_path: Path) -> None:
    path = tmp_path / "hub.csv"
    path.write_text("s [m],h [cm]\n0.5,32\n1,32\n1.5,34\n2,32\n")
    output = run("--length", "4", "--hub-path", path)
    assert "deflection -10.0 to 10.0 mm" in output
    assert "25.0 % wheel off the ground" in output


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
    ],
)
def test_faults_are_sentences(arguments: list[str], sentence: str) -> None:
    result = CliRunner().invoke(command, arguments)
    assert result.exit_code == 2
    assert sentence in result.output
    assert len(result.output.splitlines()) == 1
