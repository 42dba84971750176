"""The small picture of a recording."""

from pathlib import Path

import numpy as np
from PIL import Image
from tirelab.recordings.recording import Recording
from tirelab.report.recording_picture import broken, draw_recordings


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
