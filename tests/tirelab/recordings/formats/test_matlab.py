"""The recording comes the same from MATLAB files, and what is none is refused."""

import sys
from pathlib import Path

import numpy as np
import pytest
import scipy.io
from one_recording import COLUMNS, DEFLECTION, FORCE, TIME, UNITS, assert_the_recording, refusal
from tirelab.recordings.recording import read_recording


class TestMatlab:
    def test_vectors_structs_and_matrices(self, tmp_path: Path) -> None:
        path = tmp_path / "a.mat"
        matrix = np.column_stack([DEFLECTION, DEFLECTION * 0.0, FORCE])
        scipy.io.savemat(
            path, {"t": TIME, "run": {"cell": {"F": FORCE}}, "x_F": matrix, "note": "rig 5", "Ts": 0.01}
        )
        named = {"time": "t", "deflection": "x_F:0", "force": "x_F:2"}
        assert_the_recording(read_recording(path, columns=named, units=UNITS, radius="flat"))
        named["force"] = "run.cell.F"
        assert_the_recording(read_recording(path, columns=named, units=UNITS, radius="flat"))

    def test_matrices_that_lie_on_their_side(self, tmp_path: Path) -> None:
        scipy.io.savemat(tmp_path / "a.mat", {"m": np.vstack(list(COLUMNS.values()))})
        named = {"time": "m:0", "deflection": "m:1", "force": "m:2"}
        assert_the_recording(read_recording(tmp_path / "a.mat", columns=named, units=UNITS, radius="flat"))

    def test_vectors_of_unequal_length_are_refused(self, tmp_path: Path) -> None:
        scipy.io.savemat(tmp_path / "a.mat", {"time": TIME, "deflection": DEFLECTION, "force": FORCE[::2]})
        assert "unequal numbers of samples ('time' 200, 'deflection' 200, 'force' 100)" in refusal(
            tmp_path / "a.mat", units=UNITS
        )

    def test_complex_numbers_are_refused(self, tmp_path: Path) -> None:
        scipy.io.savemat(tmp_path / "a.mat", {"time": TIME, "deflection": DEFLECTION, "force": FORCE * 1j})
        assert "complex numbers" in refusal(tmp_path / "a.mat", units=UNITS)

    def test_version_7_3_is_asked_to_be_saved_again_without_its_library(
        self, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
    ) -> None:
        monkeypatch.setitem(sys.modules, "h5py", None)
        (tmp_path / "a.mat").write_bytes(
            b"MATLAB 7.3 MAT-file, Platform: GLNXA64".ljust(512) + b"\x89HDF\r\n\x1a\n"
        )
        said = refusal(tmp_path / "a.mat")
        assert "needs h5py; install it: python -m pip install h5py" in said
        assert said.endswith("or in MATLAB, save it with save(..., '-v7')")
