"""How a user wants recordings read: a value that reads files, and the words of a command line that do the same."""

from pathlib import Path

import numpy as np
import pytest
from click.testing import CliRunner
from house_form import loading, write_rows
from hypothesis import given
from hypothesis import strategies as st
from tirelab.cli.options import SentenceCommand, reading_options
from tirelab.recordings.channels import assignments_text, parse_columns, parse_units
from tirelab.recordings.reading import Reading
from tirelab.recordings.units import parse_radius


def test_a_reading_reads_every_file_in_the_same_way(tmp_path: Path) -> None:
    time, deflection, force = loading()
    how = Reading({"force": 'Cell "A", raw'}, {"force": "N"}, 0.254)
    for name in ("a", "b"):
        path = write_rows(
            tmp_path / f"{name}.csv",
            'time [s];x [cm];"Cell ""A"", raw"',
            time,
            deflection,
            force,
            separator=";",
        )
        recording = how(path)
        assert recording.name == name
        np.testing.assert_allclose(recording.force, force, rtol=1e-5)
        assert np.all(recording.surface_radius == 0.254)


def test_without_wishes_the_file_decides(rig: Path) -> None:
    assert Reading().words() == []
    assert Reading()(rig).notes == ()


@pytest.mark.parametrize(
    ("radius", "words"),
    [
        ("flat", "flat"),
        ("-50.8cm", "-50.8cm"),
        (0.254, "0.254m"),
        (np.inf, "flat"),
        (np.float64(0.1), "0.1m"),
    ],
)
def test_its_words_mean_the_same_radius(radius: str | float, words: str) -> None:
    assert Reading(radius=radius).words() == ["--radius", words]
    assert parse_radius(words) == parse_radius(radius)


# Spaces at the ends of a column's name are not kept: no column starts with one.
values = st.text(st.characters(exclude_categories=["Cc", "Cs", "Zl", "Zp"]), max_size=12).map(str.strip)


@given(st.dictionaries(st.sampled_from(["time", "deflection", "force"]), values, min_size=1))
def test_any_column_can_be_written_on_a_command_line(columns: dict[str, str]) -> None:
    assert parse_columns(assignments_text(columns)) == columns


def test_a_command_gets_its_options_as_one_value() -> None:
    found = []

    @SentenceCommandOf
    def command(reading: Reading) -> None:
        found.append(reading)

    words = ["--columns", 'force="Load, cell",time=t', "--units", "force=kN", "--radius", "flat"]
    assert CliRunner().invoke(command, words).exit_code == 0
    assert found == [Reading({"force": "Load, cell", "time": "t"}, {"force": "kN"}, "flat")]
    assert parse_units(found[0].words()[3]) == {"force": "kN"}
    failed = CliRunner().invoke(command, ["--columns", "load=a"])
    assert failed.exit_code == 2
    assert "'load' is no channel" in failed.output


def SentenceCommandOf(function: object) -> SentenceCommand:
    import click

    return click.command(cls=SentenceCommand)(reading_options(function))  # type: ignore[arg-type]
