"""Where a recording is nearly all a hold, the law is identified from the ramp before it."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from click.testing import CliRunner
from radialtire import read_tire
from tirelab.cli import main


@pytest.mark.parametrize("law", ["power", "linear"])
def test_the_law_of_a_ramp_that_is_held_is_identified_from_the_ramp(tmp_path: Path, law: str) -> None:
    """A tendon pulled for 8 s and held for 3 minutes, in which the force falls by half: F = k x, 4 N/mm.

    Where the law of the hold falls no tire file holds it, and the refusal says the same.
    """
    time = np.arange(0.0, 188.0, 0.1)
    x = 0.7 * np.minimum(time / 8.0, 1.0) - 1e-4 * (time > 8.0) * (law == "linear") * np.exp(8.0 - time)
    force = 4.0 * x * (1.0 - 0.5 * np.where(time > 8.0, 1.0 - np.exp(-(time - 8.0) / 20.0), 0.0))
    rows = np.column_stack([time, x, force + 1e-3 * np.random.default_rng(3).standard_normal(time.size)])
    file = tmp_path / "tendon.csv"
    np.savetxt(file, rows, delimiter=",", header="time [s],extension [mm],load [N]", comments="")
    words = ["identify", str(file), "--columns", "deflection=+extension [mm],force=+load [N]"]
    said = CliRunner().invoke(main, [*words, "--part", law, "--out", str(tmp_path / "part.json")]).output
    compared = (
        CliRunner().invoke(main, [*words, "--part", "compare", "--out", str(tmp_path / "part.json")]).output
    )
    for told in (said, compared):
        assert "nearly all of tendon.csv is a hold" in told
        assert "tendon.csv@0s:7.9s" in told
    ramp = ["identify", f"{file}@0s:7.9s", *words[2:], "--part", law, "--out", str(tmp_path / "part.json")]
    done = CliRunner().invoke(main, ramp)
    assert done.exit_code == 0, done.output
    assert "is a hold" not in done.output
    assert read_tire(tmp_path / "part.json").law.coefficient == pytest.approx(40.0, rel=0.01)  # type: ignore[attr-defined]


def test_the_ramp_before_a_hold_is_named_of_a_part_of_a_file_too_and_a_hold_without_one_is_left_out(
    tmp_path: Path,
) -> None:
    """F = k x, 4 N/mm, pressed for 8 s and held for 3 minutes; the gauge drifts by a thousandth while it is held."""
    time = np.arange(0.0, 188.0, 0.1)
    x = 0.7 * np.minimum(time / 8.0, 1.0) + 7e-4 * np.maximum(time - 8.0, 0.0) / 180.0
    force = 4.0 * x * (1.0 - 0.5 * np.where(time > 8.0, 1.0 - np.exp(-(time - 8.0) / 20.0), 0.0))
    rows = np.column_stack([time, x, force + 1e-3 * np.random.default_rng(3).standard_normal(time.size)])
    for name, part in (("whole", rows), ("ramp", rows[:80]), ("hold", rows[80:])):
        np.savetxt(
            tmp_path / f"{name}.csv",
            part,
            delimiter=",",
            header="time [s],deflection [mm],load [N]",
            comments="",
        )
    whole, ramp, hold = (str(tmp_path / f"{name}.csv") for name in ("whole", "ramp", "hold"))
    words = ["--part", "linear", "--columns", "deflection=+deflection [mm],force=+load [N]"]
    words += ["--out", str(tmp_path / "part.json")]
    said = CliRunner().invoke(main, ["identify", f"{whole}@0s:180s", *words]).output
    assert "whole.csv@0s:7.9s" in said
    said = CliRunner().invoke(main, ["identify", ramp, hold, *words]).output
    assert "nearly all of hold.csv is a hold" in said
    advised = next(line for line in said.splitlines() if "identify the way there" in line)
    assert f"identify {ramp} --" in advised
