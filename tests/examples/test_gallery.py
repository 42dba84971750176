"""The gallery: its pictures are there, small, shown and drawn anew by the script."""

from __future__ import annotations

import re
import subprocess
import sys
from pathlib import Path

import matplotlib.image
import numpy as np
import pytest


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


def _close(drawn: Path, kept: Path) -> None:
    """A font or a line may lie a pixel elsewhere in another release of matplotlib; a curve may not."""
    one, other = matplotlib.image.imread(drawn), matplotlib.image.imread(kept)
    assert one.shape == other.shape
    assert np.mean(np.abs(one - other)) < 0.02


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
