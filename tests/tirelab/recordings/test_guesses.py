"""What a table does not say is guessed by names, units and sizes, and strain and stress are not guessed at."""

from pathlib import Path

import numpy as np
import pytest
from house_form import loading, write_rows
from tirelab.recordings.asking import IncompleteRecording
from tirelab.recordings.choices import Choices
from tirelab.recordings.recording import RecordingError, understand


def proposed(path: Path, part: bool = True) -> list[str]:
    """Return the words of the command that is proposed for a file."""
    with pytest.raises(IncompleteRecording) as caught:
        understand(path, Choices(part=part))
    return caught.value.words()


@pytest.mark.parametrize(
    ("size", "unit"), [(0.005, "m"), (0.4, "mm"), (4.1, "mm"), (300.0, "mm"), (8000.0, "um")]
)
def test_a_part_is_measured_in_millimetres_where_it_can_be(tmp_path: Path, size: float, unit: str) -> None:
    _, deflection, force = loading()
    rows = (size * deflection / deflection.max(), force)
    path = write_rows(tmp_path / "a.csv", "displacement,force [N]", *rows)
    assert proposed(path) == ["--units", f"deflection={unit}"]


def test_what_a_scale_weighs_is_the_force_and_the_steps_of_a_motor_are_not(tmp_path: Path) -> None:
    time, deflection, force = loading()
    rows = (1e3 * time, np.round(1600 * deflection), deflection, 3.0 * force, force)
    path = write_rows(tmp_path / "a.csv", "Millis,Steps,Travel (mm),Scale raw,Scale (grams)", *rows)
    assert proposed(path) == ["--columns", "time=#1,force=#5", "--units", "time=ms,force=gf"]


@pytest.mark.parametrize("columns", ["A,B", "B,A"])
def test_what_a_drive_moves_evenly_is_the_deflection_however_large(tmp_path: Path, columns: str) -> None:
    force = loading()[2]
    there_and_back = 191.0 * (50.0 - np.abs(np.arange(101) - 50.0))
    rows = (there_and_back, force / 1e3) if columns == "A,B" else (force / 1e3, there_and_back)
    words = proposed(write_rows(tmp_path / "a.csv", columns, *rows))
    moved = "#1" if columns == "A,B" else "#2"
    assert words[1].startswith(f"deflection={moved},")
    assert words[3] == "deflection=um,force=N"


@pytest.mark.parametrize(
    "header",
    [
        "Time (s),True Strain,True Stress (MPa)",
        "Zeit (s),Dehnung (%),Spannung (MPa)",
        "Time (s),Engineering strain,Engineering stress",
    ],
)
def test_strain_and_stress_are_neither_and_said_to_be(tmp_path: Path, header: str) -> None:
    path = write_rows(tmp_path / "a.csv", header, *loading())
    with pytest.raises(
        RecordingError, match="say strain or stress, which are neither deflection nor force"
    ) as caught:
        understand(path, Choices(part=True))
    assert not isinstance(caught.value, IncompleteRecording)


def test_a_strain_that_is_a_length_may_be_the_deflection(tmp_path: Path) -> None:
    path = write_rows(tmp_path / "a.csv", "Time (s),Strain gauge travel (mm),Load (N)", *loading())
    assert understand(path, Choices(part=True)).plan.matches["deflection"].index == 1
    path = write_rows(tmp_path / "b.csv", "Time (s),Strain 1 (mm),Load (N)", *loading())
    assert proposed(path) == ["--columns", "deflection=#2"]
