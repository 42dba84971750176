"""A mark between thousands that was read as decimal is doubted; decimals are not."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from tirelab.recordings.recording import read_recording
from tirelab.recordings.thousands_doubt import thousands_doubt

CYCLE = 1.0 - np.cos(np.linspace(0.0, 12.0, 400))


def grouped(values: np.ndarray) -> list[str]:
    """Whole numbers as a German table writes them: 1.016."""
    return [f"{round(value):,}".replace(",", ".") for value in values.tolist()]


@pytest.mark.parametrize("most", [1100.0, 2500.0, 90_000.0])
@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_whole_numbers_with_a_point_between_thousands_are_doubted(most: float, sign: float) -> None:
    read = np.array([float(text) for text in grouped(sign * 0.5 * most * CYCLE)])
    found = thousands_doubt(read)
    assert found is not None
    place, said = found
    assert read[place] != round(read[place])
    assert "one between thousands" in said


@pytest.mark.parametrize(
    "read",
    [
        np.round(900.0 * CYCLE, 3),
        np.round(1.5 * CYCLE, 3),
        np.round(900.0 * CYCLE, 1),
        np.round(300.0 * CYCLE),
        np.round(2.0 * CYCLE) / 2.0 + 1.0,
        np.linspace(1.0, 3.0, 2001).round(3),
        np.where(np.arange(400) % 2 == 0, 500.0, 500.0 + 1e-3 * np.arange(400)),
    ],
    ids=[
        "three digits",
        "small",
        "one digit",
        "whole",
        "halves",
        "a ramp over whole numbers",
        "side by side",
    ],
)
def test_decimals_are_not(read: np.ndarray) -> None:
    assert thousands_doubt(read) is None


def test_a_file_says_where(tmp_path: Path) -> None:
    force = grouped(700.0 * CYCLE)
    rows = "".join(
        f"{i / 10:.1f};{5.0 * d:.3f};{f}\n" for i, (d, f) in enumerate(zip(CYCLE, force, strict=True))
    )
    (tmp_path / "a.csv").write_text("Zeit [s];Weg [mm];Kraft [N]\n" + rows, encoding="utf-8")
    found = read_recording(
        tmp_path / "a.csv", radius="flat", columns={"deflection": "+Weg", "force": "+Kraft"}
    )
    assert any("column 'Kraft [N]': 1." in said and "between thousands" in said for said in found.doubts)
