"""The gallery: its pictures are there, small, shown and drawn anew by the script."""

from __future__ import annotations

import re
import subprocess
import sys
from pathlib import Path

import matplotlib.image
import numpy as np
import pytest
from scipy.ndimage import distance_transform_edt


def _draw(repository: Path, out: Path, *names: str) -> None:
    done = subprocess.run(
        [sys.executable, repository / "examples" / "gallery.py", "--out", out, *names],
        env={"PYTHONPATH": str(repository / "fmu_src"), "MPLCONFIGDIR": str(out), "HOME": str(out)},
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 0, done.stderr


def _pictures(repository: Path) -> list[Path]:
    return sorted((repository / "examples" / "docs").glob("*.png"))


def test_every_picture_is_small_and_shown(repository: Path) -> None:
    text = (repository / "examples" / "docs" / "README.md").read_text()
    assert set(re.findall(r"\]\(([^)]*\.png)\)", text)) == {p.name for p in _pictures(repository)}
    assert all(p.stat().st_size < 150_000 for p in _pictures(repository))


def _ink(picture: Path) -> np.ndarray:
    """Return where a picture is drawn upon."""
    ink: np.ndarray = matplotlib.image.imread(picture)[..., :3].min(axis=2) < 0.8
    return ink


def _farthest(one: np.ndarray, other: np.ndarray) -> float:
    """Return how far, as a part of the width, the ink of either picture is at most from that of the other."""
    away = max(distance_transform_edt(~b)[a].max() for a, b in ((one, other), (other, one)))
    return float(away / one.shape[1])


def _close(drawn: Path, kept: Path) -> None:
    """Another release of matplotlib may move all by the width of its letters; a curve stays in its place."""
    one, other = _ink(drawn), _ink(kept)
    assert np.abs(np.subtract(one.shape, other.shape)).max() <= 2
    height, width = np.minimum(one.shape, other.shape)
    assert _farthest(one[:height, :width], other[:height, :width]) < 0.015


def test_another_curve_is_seen(repository: Path) -> None:
    kept = _ink(repository / "examples" / "docs" / "law.png")
    other = kept.copy()
    other[:, 520:] = np.roll(kept[:, 520:], 20, axis=0)
    assert _farthest(other, kept) > 0.015


def test_pictures_are_the_scripts(repository: Path, tmp_path: Path) -> None:
    _draw(repository, tmp_path, "law", "ride_kerb")
    for name in ("law.png", "ride_kerb.png"):
        _close(tmp_path / name, repository / "examples" / "docs" / name)


@pytest.mark.slow
def test_all_pictures_are_the_scripts(repository: Path, tmp_path: Path) -> None:
    _draw(repository, tmp_path)
    assert {p.name for p in tmp_path.glob("*.png")} == {p.name for p in _pictures(repository)}
    for picture in _pictures(repository):
        _close(tmp_path / picture.name, picture)
