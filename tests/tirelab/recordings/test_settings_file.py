"""What the settings of several recordings say of one gauge."""

from __future__ import annotations

from pathlib import Path

from click.testing import CliRunner
from house_form import write_rows
from tirelab.cli import main
from tirelab.recordings.settings_file import opposite_signs


def settings(*signs: str) -> str:
    return "\n".join(
        f'[files."{i}.csv".columns]\ndeflection = "{sign}Gap"\nforce = "+Force"\n'
        for i, sign in enumerate(signs)
    )


def test_a_gauge_that_counts_both_ways_is_told() -> None:
    (said,) = opposite_signs(settings("+", "-", "+"))
    assert said.startswith("column 'Gap', deflection: counted positive in 0.csv, 2.csv, negative in 1.csv; ")


def test_one_that_counts_one_way_or_of_which_nothing_is_said_is_not() -> None:
    assert opposite_signs(settings("-", "-")) == ()
    assert opposite_signs(settings("-", "")) == ()
    assert opposite_signs("part = true\n") == ()


def test_inspect_tells_it_of_a_ramp_and_its_hold(tmp_path: Path) -> None:
    """The gap of a press falls by 1 mm; in the hold it drifts by 1 um the other way, while the force relaxes."""
    header = "time [s],Gap [mm],Force [N]"
    seconds = [0.1 * i for i in range(100)]
    ramp = write_rows(
        tmp_path / "ramp.csv", header, seconds, [10.0 - 0.1 * t for t in seconds], [0.5 * t for t in seconds]
    )
    hold = write_rows(
        *(tmp_path / "hold.csv", header, seconds),
        *([9.0 + 1e-4 * (10.0 - t) for t in seconds], [2.0 + 0.3 * (10.0 - t) for t in seconds]),
    )
    words = ["inspect", "--part", "--radius", "flat", "--out", str(tmp_path / "recording.toml")]
    signed = ["--columns", "deflection=-Gap [mm],force=+Force [N]"]
    first = CliRunner().invoke(main, [*words, str(ramp), *signed]).output
    assert "DOUBTFUL" not in first
    second = CliRunner().invoke(main, [*words, str(hold)]).output
    assert "column 'Gap [mm]', deflection: counted positive in hold.csv, negative in ramp.csv" in " ".join(
        second.split()
    )
