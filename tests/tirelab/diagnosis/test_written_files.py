"""The files of a diagnosis: samples with the forces before and after, and a sentence where they cannot be written."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import polars as pl
import pytest
from tirelab.diagnosis.outcome import DATA, Replayed
from tirelab.diagnosis.written_files import write_samples
from tirelab.errors import TirelabError
from tirelab.recordings.recording import Recording

TIME = np.array([0.0, 0.5, 1.0])


def replayed(name: str, force: float) -> Replayed:
    recording = Recording(name, TIME, 2e-3 * TIME, np.array([np.inf, 0.1, 0.1]), np.full(3, force))
    return Replayed((recording,), (np.full(3, force - 5.0),), (np.full(3, force - 1.0),))


def test_all_samples_with_what_they_were_used_for(tmp_path: Path) -> None:
    write_samples(tmp_path, (("fitted", replayed("slow", 50.0)), ("held-out", replayed("fast", 80.0))))
    table = pl.read_csv(tmp_path / DATA)
    assert table["used"].to_list() == ["fitted"] * 3 + ["held-out"] * 3
    assert table["recording"].to_list() == ["slow"] * 3 + ["fast"] * 3
    assert table["deflection [mm]"].to_list() == pytest.approx([0.0, 1.0, 2.0] * 2)
    assert table["radius [cm]"].to_list() == pytest.approx([np.inf, 10.0, 10.0] * 2)
    assert table["force before [N]"].to_list() == pytest.approx([45.0] * 3 + [75.0] * 3)
    assert table["force after [N]"].to_list() == pytest.approx([49.0] * 3 + [79.0] * 3)


def test_a_folder_that_cannot_be_written_to_is_told(tmp_path: Path) -> None:
    with pytest.raises(TirelabError, match=r"cannot be written .*; name another folder with --out"):
        write_samples(tmp_path / "nowhere", (("fitted", replayed("slow", 50.0)),))
