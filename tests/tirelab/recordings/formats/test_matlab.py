"""The recording comes the same from MATLAB files, and what is none is refused."""

import sys
from pathlib import Path

import numpy as np
import pytest
import scipy.io
from one_recording import COLUMNS, DEFLECTION, FORCE, TIME, UNITS, assert_the_recording, refusal
from tirelab.recordings.formats.matlab import matlab_table
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

    def test_fields_of_a_struct_are_known_by_their_own_names(self, tmp_path: Path) -> None:
        run = {"time": TIME, "deflection_mm": DEFLECTION, "force_kN": FORCE, "operator": "N. N."}
        scipy.io.savemat(tmp_path / "a.mat", {"run": run})
        assert_the_recording(read_recording(tmp_path / "a.mat", units={"time": "s"}, radius="flat"))

    def test_structs_in_an_array_are_trials(self, tmp_path: Path) -> None:
        kind = [("time", "O"), ("deflection", "O"), ("force", "O")]
        runs = np.array([(TIME, DEFLECTION, k * FORCE) for k in (3.0, 1.0)], dtype=kind)
        scipy.io.savemat(tmp_path / "a.mat", {"run": runs})
        assert "2 trials" in refusal(tmp_path / "a.mat", units=UNITS)
        second = read_recording(f"{tmp_path / 'a.mat'}@trial2", units=UNITS, radius="flat")
        np.testing.assert_allclose(second.force, 1e3 * FORCE, rtol=3e-16)

    def test_vectors_in_cells(self, tmp_path: Path) -> None:
        forces = np.empty((1, 3), dtype=object)
        forces[0, :] = ["kN", 2.0 * FORCE, FORCE]
        scipy.io.savemat(tmp_path / "a.mat", {"time": TIME, "deflection": DEFLECTION, "f": forces})
        named = {"force": "f{3}"}
        assert_the_recording(read_recording(tmp_path / "a.mat", columns=named, units=UNITS, radius="flat"))

    def test_signals_that_simulink_logged_each_with_the_same_time(self, tmp_path: Path) -> None:
        """Its "structure with time": a scalar signal is 1 x 1 x samples, the clock stands beside every signal."""

        def logged(values: np.ndarray) -> dict[str, object]:
            signal = {"values": values.reshape(1, 1, -1), "dimensions": np.array([1.0, 1.0]), "label": ""}
            return {"time": TIME, "signals": signal, "blockName": "model/To Workspace"}

        scipy.io.savemat(tmp_path / "a.mat", {"deflection": logged(DEFLECTION), "force": logged(FORCE)})
        assert_the_recording(read_recording(tmp_path / "a.mat", units=UNITS, radius="flat"))

    def test_signals_that_simulink_logged_in_one_struct_are_known_by_their_labels(
        self, tmp_path: Path
    ) -> None:
        """Two scopes without a label, or with the same, keep their numbers."""
        labelled = [(DEFLECTION, "deflection"), (FORCE, "force"), (TIME, ""), (TIME, "gain"), (TIME, "gain")]
        signals = np.array(labelled, dtype=[("values", "O"), ("label", "O")])
        scipy.io.savemat(tmp_path / "a.mat", {"Data": {"time": TIME, "signals": signals}})
        table = matlab_table(tmp_path / "a.mat")
        assert [h.text for h in table.headers] == [
            *("Data.time", "Data.deflection", "Data.force", "Data(3)", "Data(4)", "Data(5)")
        ]
        assert_the_recording(read_recording(tmp_path / "a.mat", units=UNITS, radius="flat"))

    def test_a_field_called_signals_need_not_be_of_simulink(self, tmp_path: Path) -> None:
        run = {"time": TIME, "signals": np.column_stack([DEFLECTION, FORCE])}
        scipy.io.savemat(tmp_path / "a.mat", {"run": run})
        named = {"deflection": "run.signals:0", "force": "run.signals:1"}
        assert_the_recording(read_recording(tmp_path / "a.mat", columns=named, units=UNITS, radius="flat"))

    def test_a_file_with_an_object_of_a_class_is_read_without_it(
        self, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
    ) -> None:
        """SciPy cannot list a file that holds a `tcpip` or a `table`, and loads the object as something opaque."""
        run = {"time": TIME, "deflection": DEFLECTION, "force": FORCE}
        scipy.io.savemat(tmp_path / "a.mat", {"run": run, "rig": 5.0})
        kind = [(name, "O") for name in ("s0", "s1", "s2", "arr")]
        opaque = scipy.io.matlab.MatlabOpaque(np.array([(b"t", b"MCOS", b"tcpip", FORCE)], dtype=kind))
        loadmat = scipy.io.loadmat

        def unlisted(path: str) -> None:
            raise TypeError("'NoneType' object is not iterable")

        monkeypatch.setattr(scipy.io, "whosmat", unlisted)
        monkeypatch.setattr(scipy.io, "loadmat", lambda *a, **more: {**loadmat(*a, **more), "None": opaque})
        assert_the_recording(read_recording(tmp_path / "a.mat", units=UNITS, radius="flat"))

    @pytest.mark.parametrize(
        ("kind", "instead"),
        [
            ("timetable", "writetimetable(run, 'a.csv')"),
            ("tcpip", "save the vectors of numbers that it holds"),
        ],
    )
    def test_a_file_with_nothing_but_an_object_says_how_to_save_it(
        self, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, kind: str, instead: str
    ) -> None:
        """SciPy shows the numbers of all its objects as bytes of its own."""
        scipy.io.savemat(tmp_path / "a.mat", {"x": 1.0})
        fields = [(name, "O") for name in ("s0", "s1", "s2", "arr")]
        row = np.array([(b"run", b"MCOS", kind.encode(), FORCE)], dtype=fields)
        loaded = {
            "None": scipy.io.matlab.MatlabOpaque(row),
            "__function_workspace__": np.zeros((1, 9), np.uint8),
        }

        def unlisted(path: str) -> None:
            raise TypeError("'NoneType' object is not iterable")

        monkeypatch.setattr(scipy.io, "whosmat", unlisted)
        monkeypatch.setattr(scipy.io, "loadmat", lambda *a, **more: loaded)
        said = refusal(tmp_path / "a.mat", units=UNITS)
        assert (
            f"run is a {kind}, which only MATLAB opens; there, {instead}, and read what that writes" in said
        )

    def test_vectors_of_unequal_length_are_refused(self, tmp_path: Path) -> None:
        scipy.io.savemat(tmp_path / "a.mat", {"time": TIME, "deflection": DEFLECTION, "force": FORCE[::2]})
        assert "unequal numbers of samples ('time' 200, 'deflection' 200, 'force' 100)" in refusal(
            tmp_path / "a.mat", units=UNITS
        )
        values = {"time": TIME, "deflection": DEFLECTION, "force": FORCE, "temperature_degC": FORCE[::2]}
        scipy.io.savemat(tmp_path / "b.mat", values)
        told = "'temperature_degC' not read: it has 100 samples, the others 200"
        assert told in read_recording(tmp_path / "b.mat", units=UNITS, radius="flat").notes

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
