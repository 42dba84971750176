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


def test_a_column_with_a_unit_of_time_is_asked_about(tmp_path: Path) -> None:
    names = NAMES.replace("Ch 1 Time", "Acq")
    said = refusal(blocks(tmp_path / "a.txt", f"{names}\n{UNITS}"), radius="flat")
    assert "no column for time" in said
    assert said.endswith("name it with --columns time=#1, or --columns time= where it was not measured")
