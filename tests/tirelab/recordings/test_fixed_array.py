"""A recording stays as it was when it was checked, whatever happens to the arrays that it was made of."""

from __future__ import annotations

import copy
import pickle
from collections.abc import Callable, Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import polars as pl
import pytest
import tirelab.recordings.recording
from tirelab.recordings.fixed_array import fix, fixed
from tirelab.recordings.recording import Recording, read_recording

T = np.linspace(0.0, 1.0, 50)


def recorded() -> tuple[Recording, list[np.ndarray]]:
    arrays = [T.copy(), 0.01 * T, np.full(50, np.inf), 600.0 * T]
    return Recording("press", *arrays), arrays


def test_what_is_written_to_the_arrays_afterwards_changes_nothing() -> None:
    recording, arrays = recorded()
    for array in arrays:
        array[3] = 99.0
    assert recording.deflection[3] == 0.01 * T[3]
    assert np.isinf(recording.surface_radius).all()
    parts = np.column_stack([T, 0.01 * T, np.full(50, np.inf), 600.0 * T])
    recording = Recording("press", *parts.T)
    parts[3] = 99.0
    assert recording.force[3] == 600.0 * T[3]


def test_a_read_only_view_of_an_array_that_can_be_written_to_is_copied() -> None:
    own = T.copy()
    view = own.view()
    view.flags.writeable = False
    kept = fixed(view)
    own[3] = 99.0
    assert kept[3] == T[3]


@pytest.mark.parametrize("copied", [copy.copy, copy.deepcopy, lambda r: pickle.loads(pickle.dumps(r))])
def test_copies_are_read_only(copied: Callable[[Recording], Recording]) -> None:
    one = copied(recorded()[0])
    for _, values in one.channels():
        with pytest.raises(ValueError, match="read-only"):
            values[3] = 99.0
    assert one.duration == 1.0
    assert len(replace(one, name="other")) == 50


def test_arrays_of_other_kinds_are_taken() -> None:
    whole = np.arange(50)
    kept = fixed(whole)
    whole[3] = 99
    assert kept[3] == 3.0
    assert fixed([1, 2]).tolist() == [1.0, 2.0]
    series = pl.Series([1.0, 2.0])
    assert not fixed(series.to_numpy()).flags.writeable


def test_what_is_fixed_is_not_copied() -> None:
    own = fix(T.copy())
    assert np.shares_memory(fixed(own), own)
    assert np.shares_memory(fixed(own[5:9]), own)
    recording = recorded()[0]
    assert np.shares_memory(replace(recording, name="other").force, recording.force)


def test_a_file_is_read_without_another_copy(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    time = 0.01 * np.arange(1000)
    deflection = 0.02 * np.sin(time) ** 2
    columns = {"time [s]": time, "deflection [m]": deflection, "force [N]": 6e4 * deflection}
    pl.DataFrame(columns).write_csv(tmp_path / "press.csv")
    named, read = tirelab.recordings.recording._arrays, []

    def spy(values: Mapping[str, np.ndarray]) -> dict[str, Any]:
        read.append(named(values))
        return read[-1]

    monkeypatch.setattr(tirelab.recordings.recording, "_arrays", spy)
    recording = read_recording(tmp_path / "press.csv", radius="flat")
    for name in ("time", "deflection", "surface_radius", "force"):
        assert np.shares_memory(getattr(recording, name), read[0][name])
