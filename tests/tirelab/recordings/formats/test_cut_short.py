"""A file that ends within a number: its last row is left out, and it is said."""

from pathlib import Path

import pytest
from tirelab.recordings.recording import Recording, read_recording

ROWS = [f"{i / 10:.3f},{0.1 * min(i, 120 - i):.4f},{5.0 * min(i, 120 - i) + 0.25:.2f}" for i in range(121)]
"""A ramp up and down, so the last force is 0.25 N; every number of a column has as many decimals as the others."""


def read(path: Path, text: str, encoding: str = "utf-8") -> Recording:
    path.write_text("time [s],deflection [mm],force [N]\n" + text, encoding=encoding)
    return read_recording(path, radius="flat")


@pytest.mark.parametrize("encoding", ["utf-8", "utf-16"])
def test_a_row_that_ends_within_a_number_is_left_out(tmp_path: Path, encoding: str) -> None:
    recording = read(tmp_path / "a.csv", "\n".join([*ROWS[:100], "10.000,2.0000,100"]), encoding)
    assert len(recording) == 100
    (note,) = [note for note in recording.notes if "left out" in note]
    assert note == (
        "row 102 left out: the file ends in it, and '100' has fewer digits than its column has elsewhere"
    )


@pytest.mark.parametrize(
    "text",
    [
        "\n".join(ROWS),  # whole, only its line end is missing
        "\n".join([*ROWS[:100], "10.000,2.0000,100"]) + "\n",  # a line end: the number is whole
        "\n".join([*ROWS[:99], "9.900,2.1000,105", "10.000,2.0000,100"]),  # numbers without zeros behind
    ],
)
def test_a_number_that_is_whole_is_read(tmp_path: Path, text: str) -> None:
    recording = read(tmp_path / "a.csv", text)
    assert len(recording) == len(text.splitlines())
