"""Rows of text among the rows of numbers: blocks of one acquisition that begin with names and units again."""

from pathlib import Path

import numpy as np
import pytest
from house_form import refusal
from tirelab.recordings.recording import read_recording

NAMES = "Ch 1 Time\tAxial Count\tCh 1 Displacement\tCh 1 Force"
UNITS = "sec\tsegments\tmm\tkN"


def blocks(path: Path, *heads: str, names: str = NAMES) -> Path:
    """A file of blocks of 40 rows at 10 Hz, 2 mm and 0.1 kN up to the middle and back, each below its head."""
    rows = [f"{i / 10:.1f}\t{i // 20}\t{0.1 * (20 - abs(20 - i % 40)):.1f}" for i in range(40 * len(heads))]
    rows = [f"{row}\t{0.05 * float(row.split()[-1]):.4f}" for row in rows]
    parts = ["\n".join([head, *rows[40 * n : 40 * n + 40]]) for n, head in enumerate(heads)]
    path.write_text("MTS793|MPT\n\n" + "\n".join(parts) + "\n", encoding="utf-8")
    return path


@pytest.mark.parametrize(
    "again", [f"{NAMES}\n{UNITS}", NAMES, UNITS, f"\nData Acquisition: 2\n{NAMES}\n{UNITS}"]
)
def test_names_and_units_that_are_written_again_are_no_other_table(tmp_path: Path, again: str) -> None:
    recording = read_recording(blocks(tmp_path / "a.txt", f"{NAMES}\n{UNITS}", again), radius="flat")
    np.testing.assert_allclose(recording.time, np.arange(80) / 10.0)
    assert (recording.deflection.max(), recording.force.max()) == pytest.approx((2e-3, 100.0))
    assert recording.timed


def test_other_units_below_are_refused(tmp_path: Path) -> None:
    other = f"{NAMES}\nsec\tsegments\tmm\tN"
    said = refusal(blocks(tmp_path / "a.txt", f"{NAMES}\n{UNITS}", other), radius="flat")
    assert "the unit is 'N' here and 'kN' above" in said


def test_names_with_the_number_of_a_specimen_before_them_are_written_again(tmp_path: Path) -> None:
    """Bluehill numbers the specimens of a table of results, in the first column; an extensometer is in brackets."""
    rows = "".join(f",{i / 10:.1f},{0.1 * i:.1f},{5.0 * i:.1f},0.1\n" for i in range(40))
    head = "{},Time,Extension,Load,Strain (Digital Strain 1)\n,(s),(mm),(N),(%)\n"
    path = tmp_path / "a.csv"
    path.write_text(head.format(1) + rows + head.format(2) + rows, encoding="utf-8")
    assert "time goes back from 3.9 s to 0 s" in refusal(path, radius="flat")
    second = read_recording(f"{path}@45:84", radius="flat")
    assert (second.deflection.max(), second.force.max()) == pytest.approx((3.9e-3, 195.0))


def test_a_column_with_a_unit_of_time_is_asked_about(tmp_path: Path) -> None:
    names = NAMES.replace("Ch 1 Time", "Acq")
    said = refusal(blocks(tmp_path / "a.txt", f"{names}\n{UNITS}"), radius="flat")
    assert "no column for time" in said
    assert said.endswith("name it with --columns time=#1, or --columns time= where it was not measured")


SPECIMEN = (
    'Results Table {0}\n,"Maximum Load","Extension at Maximum Load"\n,"[N]","[mm]"\n{0},"{1:.1f}","10.0"\n\n'
    "Time,Extension,Load\n(s),(mm),({2})\n{3}"
)


def specimens(path: Path, *units: str) -> Path:
    """Two specimens one below the other, each with its results, as Bluehill exports them."""
    x = 10.0 * (1.0 - np.abs(np.linspace(-1.0, 1.0, 101)))
    text = ""
    for number, unit in enumerate(units, 1):
        force = 40.0 * number * x / (1000.0 if unit == "kN" else 1.0)
        rows = "".join(
            f'"{i / 10:.1f}","{a:.2f}","{b:.6f}"\n' for i, (a, b) in enumerate(zip(x, force, strict=True))
        )
        text += SPECIMEN.format(number, force.max(), unit, rows)
    path.write_text(text)
    return path


def test_the_specimen_below_another_one_is_read_as_the_message_says(tmp_path: Path) -> None:
    path = specimens(tmp_path / "a.csv", "N", "N")
    said = refusal(path, radius="flat")
    assert said.endswith(
        "row 110: another table begins here; read the one above it, a.csv@8:108, or the one below row 114, "
        "--skip-rows 113"
    )
    assert read_recording(f"{path}@8:108", radius="flat").force.max() == pytest.approx(400.0)
    below = read_recording(path, radius="flat", skip_rows=113)
    assert (len(below), below.force.max()) == (101, pytest.approx(800.0))


def test_rows_of_another_table_are_not_read_by_the_names_and_units_of_the_first(tmp_path: Path) -> None:
    path = specimens(tmp_path / "a.csv", "N", "kN")
    said = refusal(Path(f"{path}@116:216"), radius="flat")
    assert "row 116: stands in a table of other names or units, which begins at row 114" in said
    assert said.endswith("--skip-rows 113")
    below = read_recording(f"{path}@116:216", radius="flat", skip_rows=113)
    assert (len(below), below.force.max()) == (101, pytest.approx(800.0))
    same = specimens(tmp_path / "b.csv", "N", "N")
    assert read_recording(f"{same}@116:216", radius="flat").force.max() == pytest.approx(800.0)


@pytest.mark.parametrize(
    "names", ["Time (s),Load (N),Extension (mm)", "Time (s),Extension (mm),Temperature (C)"]
)
def test_nor_are_those_below_other_names(names: str, tmp_path: Path) -> None:
    rows = [f"{i / 10:.1f},{i / 5:.2f},{8.0 * i:.1f}" for i in range(100)]
    lines = ["Time (s),Extension (mm),Load (N)", *rows, names, *rows]
    (tmp_path / "a.csv").write_text("\n".join(lines) + "\n")
    assert len(read_recording(f"{tmp_path / 'a.csv'}@2:101", radius="flat")) == 100
    said = refusal(Path(f"{tmp_path / 'a.csv'}@103:202"), radius="flat")
    assert "row 103: stands in a table of other names or units, which begins at row 102" in said
