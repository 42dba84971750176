"""In every format a damaged file is refused in one sentence."""

import builtins
import importlib
import zipfile
from pathlib import Path

import pytest
from one_recording import refusal
from tirelab.recordings.formats import LOADERS


class TestEveryFormat:
    @pytest.mark.parametrize(
        "suffix", [suffix for suffix in LOADERS if suffix not in (".csv", ".dat", ".asc")]
    )
    def test_an_empty_or_damaged_file_is_told_in_one_sentence(self, tmp_path: Path, suffix: str) -> None:
        path = tmp_path / f"a{suffix}"
        path.write_bytes(b"")
        assert "is empty" in refusal(path)
        for content in (
            b"MDF     4.10    ",
            b"PK\x03\x04" + b"\x00" * 60,
            b"PAR1" * 9,
            b"TDSm" + b"\xff" * 40,
            b"\x00" * 300,
        ):
            path.write_bytes(content)
            assert path.name in refusal(path)

    @pytest.mark.parametrize(
        ("start", "said"),
        [
            (b"PK\x03\x04", "Excel"),
            (b"\x1f\x8b", "gzip"),
            (b"PAR1", "Parquet"),
            (b"\x00", "not text"),
        ],
    )
    def test_what_only_calls_itself_csv_is_told(self, tmp_path: Path, start: bytes, said: str) -> None:
        (tmp_path / "a.csv").write_bytes(start + b"\x00\x01" * 20)
        assert said in refusal(tmp_path / "a.csv")

    @pytest.mark.parametrize(
        ("name", "content", "said"),
        [
            ("a.xls", b"anything", "damaged or cut short"),
            ("a.hdf5", b"anything", "damaged or cut short"),
            ("a.xyz", b"anything", "no table is found in its text"),
            ("a.xyz", b"\x01\x02", "recordings ending in '.xyz' cannot be read; export it as one of .csv"),
            ("a", b"\x01\x02", "recordings ending in '' cannot be read"),
            ("a.raw", b"|CF,2,1,1;", "is imc Famos; export it as text"),
            ("a.gz", b"\x1f\x8b\x08", "is gzip; unpack it"),
            ("a.csv", b"\x89PNG\r\n\x1a\n\x00", "is no text table but a picture (PNG); export it as text"),
            ("a.csv", b"{\\rtf1\\ansi}", "is no text table but rich text (RTF)"),
            (
                "a.xls",
                b"\n<HTML><table><tr><td>1</td></tr></table>",
                "cannot be read as a workbook: it is HTML; open it in a spreadsheet",
            ),
            (
                "a.xml",
                b"<?xml version='1.0'?><a/>",
                "is XML; open it in a spreadsheet program and save it as .xlsx",
            ),
        ],
    )
    def test_what_cannot_be_read_is_told(self, tmp_path: Path, name: str, content: bytes, said: str) -> None:
        (tmp_path / name).write_bytes(content)
        assert said in refusal(tmp_path / name)

    @pytest.mark.parametrize("name", ["a.zip", "a.csv", "a.xlsx", "a.npz"])
    def test_a_zip_archive_that_is_no_workbook_is_told(self, tmp_path: Path, name: str) -> None:
        with zipfile.ZipFile(tmp_path / name, "w") as archive:
            archive.writestr("run 1.csv", "time,force")
        assert "a zip archive of 'run 1.csv'; unpack it" in refusal(tmp_path / name)

    @pytest.mark.parametrize(
        ("suffix", "module", "package"),
        [
            (".mf4", "asammdf", "asammdf"),
            (".h5", "h5py", "h5py"),
            (".tdms", "nptdms", "npTDMS"),
            (".xlsx", "openpyxl", "openpyxl"),
            (".ods", "python_calamine", "python-calamine"),
        ],
    )
    def test_a_library_that_is_not_installed_is_named_with_what_can_be_typed(
        self, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, suffix: str, module: str, package: str
    ) -> None:
        def absent(name: str) -> object:
            if name == module:
                raise ImportError(name)
            return builtins.__import__(name)

        monkeypatch.setattr(importlib, "import_module", absent)
        (tmp_path / f"a{suffix}").write_bytes(b"anything")
        said = refusal(tmp_path / f"a{suffix}")
        assert f"needs {module}" in said
        # It was "pip install 'tirelab[...]'", and no such package is on the index.
        assert said.endswith(f"python -m pip install {package}")
