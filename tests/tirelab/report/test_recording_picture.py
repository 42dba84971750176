"""The small picture of a recording."""

from pathlib import Path

import numpy as np
import pytest
from PIL import Image
from tirelab.recordings.recording import Recording
from tirelab.report.recording_picture import broken, draw_recordings, terminal_picture


def test_a_gap_in_time_breaks_the_lines() -> None:
    time = np.array([0.0, 0.1, 0.2, 1.8, 1.9])
    np.testing.assert_array_equal(broken(np.arange(5.0), time), [0.0, 1.0, 2.0, np.nan, 3.0, 4.0])
    np.testing.assert_array_equal(broken(np.arange(2.0), np.array([0.0, 9.0])), [0.0, 1.0])
    np.testing.assert_array_equal(broken(np.array([7.0]), np.array([0.0])), [7.0])


def test_nothing_is_drawn_inside_a_gap(tmp_path: Path) -> None:
    """Of a force that is even but for a gap, the columns of pixels in the middle hold no line."""
    even = np.arange(200) / 10.0
    held = np.zeros(200) + 0.01
    whole = Recording("whole", even, held, np.full(200, np.inf), 500.0 + np.arange(200.0))
    loose = Recording("loose", even + 40.0 * (np.arange(200) > 99), held, np.full(200, np.inf), whole.force)
    lines = []
    for recording in (whole, loose):
        draw_recordings([recording], tmp_path / "picture.png")
        pixels = np.asarray(Image.open(tmp_path / "picture.png").convert("RGB"), dtype=int)
        half = pixels[:, pixels.shape[1] // 2 :]
        blue = (half[..., 2] - half[..., 0] > 80) & (half[..., 0] < 120)
        inside = blue[:, int(0.35 * half.shape[1]) : int(0.65 * half.shape[1])]
        lines.append(int(np.count_nonzero(inside.any(axis=0))))
    assert lines[0] > 100
    assert lines[1] == 0


@pytest.mark.parametrize(
    ("stroke", "load", "below", "beside"),
    [
        (0.0105, 160.0, "0.0 2.5 5.0 7.5 10.0", "0 50 100 150"),
        (0.000105, 0.25, "0.000 0.025 0.050 0.075 0.100", "0.0 0.1 0.2"),
        (0.05, 1442.0, "0 10 20 30 40 50", "0 500 1,000"),
        (1.05e-10, 2.1e-9, "0 2.5e-08 5e-08 7.5e-08 1e-07", "0 1e-09 2e-09"),
        (0.02, 0.0, "0 5 10 15 20", "-1.0 -0.5 0.0 0.5 1.0"),
    ],
)
def test_labels_in_the_terminal_have_the_digits_of_their_step(
    stroke: float, load: float, below: str, beside: str
) -> None:
    path = np.linspace(0.0, 1.0, 500)
    recording = Recording("one", path, stroke * path, np.full(500, np.inf), load * path)
    lines = terminal_picture(recording).splitlines()
    assert lines[-1].split() == below.split()
    labels = [line.rpartition("│")[2].strip() for line in reversed(lines[2:-2])]
    assert list(filter(None, labels)) == beside.split()
    assert all(line.startswith(("┌", "│", "└")) for line in lines[1:-1])


def test_labels_stand_beside_what_they_say() -> None:
    path = np.linspace(0.0, 1.0, 500)
    recording = Recording("one", path, 0.01 * path, np.full(500, np.inf), 100.0 * path)
    lines = terminal_picture(recording, 60, 12).splitlines()
    assert len(lines) == 16
    assert [i for i, line in enumerate(lines) if not line.endswith(("│", "┐", "┘"))] == [
        0,
        2,
        4,
        7,
        10,
        13,
        15,
    ]
    assert [lines[i].split()[-1] for i in (2, 4, 7, 10, 13)] == ["100", "75", "50", "25", "0"]
    assert lines[-1].index("4") == 1 + int(0.4 * 60)
