"""Archives of others are unpacked inside of their folder only, and what is wrong with them is said."""

import re
import shutil
import zipfile
from collections.abc import Callable
from pathlib import Path
from types import SimpleNamespace

import pytest
from tirelab.errors import TirelabError
from tirelab.fmu import unpacking
from tirelab.fmu.foreign import tire_inside
from tirelab.fmu.unpacking import description_in, text_in, unpack


@pytest.mark.parametrize(
    "name", ["../out.txt", "resources/../../out.txt", "/out.txt", "C:/out.txt", "..\\out.txt"]
)
def test_a_name_that_leads_out_is_refused_before_anything_is_written(tmp_path: Path, name: str) -> None:
    archive, inside = tmp_path / "model.fmu", tmp_path / "deep" / "inside"
    with zipfile.ZipFile(archive, "w") as members:
        members.writestr("modelDescription.xml", "<x/>")
        members.writestr(name, "out")
    inside.mkdir(parents=True)
    with pytest.raises(TirelabError, match="leads out of the folder"):
        unpack(archive, inside)
    assert sorted(p.name for p in tmp_path.rglob("*")) == ["deep", "inside", "model.fmu"]


def test_too_much_content_is_refused(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    archive = tmp_path / "model.fmu"
    with zipfile.ZipFile(archive, "w", zipfile.ZIP_DEFLATED) as members:
        members.writestr("zeros", bytes(100_000))
    monkeypatch.setattr(unpacking, "LARGEST", 99_999)
    with pytest.raises(TirelabError, match="unpacks to"):
        unpack(archive, tmp_path / "inside")
    assert not (tmp_path / "inside").exists()


def test_a_disk_without_room_is_said_before_it_is_full(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    archive = tmp_path / "model.fmu"
    with zipfile.ZipFile(archive, "w", zipfile.ZIP_DEFLATED) as members:
        members.writestr("zeros", bytes(100_000))
    monkeypatch.setattr(shutil, "disk_usage", lambda folder: SimpleNamespace(free=99_999))
    with pytest.raises(TirelabError, match=r"0\.0001 GB left; make room, or name another folder .*TMPDIR"):
        unpack(archive, tmp_path / "inside")
    assert not (tmp_path / "inside").exists()


def test_a_tire_that_is_no_text_of_a_few_kilobytes_is_not_read(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    archive = tmp_path / "model.fmu"
    with zipfile.ZipFile(archive, "w", zipfile.ZIP_DEFLATED) as members:
        members.writestr("resources/tire.json", b" " * 100_000)
        members.writestr("resources/bytes.json", b"\xff\xfe\x00")
    with pytest.raises(TirelabError, match=r"bytes\.json is not UTF-8 text; export it again"):
        text_in(archive, "resources/bytes.json")
    monkeypatch.setattr(unpacking, "LARGEST_TEXT", 99_999)
    with pytest.raises(TirelabError, match=r"tire\.json has 0 MB, and such a file has a few kB; do not use"):
        tire_inside(archive)


def cut(content: bytes) -> bytes:
    return content[: len(content) // 2]


def changed(content: bytes) -> bytes:
    """Other bytes in the compressed stream of the first member."""
    middle = len(content) // 4
    return (
        content[:middle] + bytes(b ^ 0x55 for b in content[middle : middle + 400]) + content[middle + 400 :]
    )


def encrypted(content: bytes) -> bytes:
    """The flag of a password, in the local header and in the directory."""
    for sign, at in ((rb"PK\x03\x04", 6), (rb"PK\x01\x02", 8)):
        for found in re.finditer(sign, content):
            place = found.start() + at
            content = content[:place] + bytes([content[place] | 1]) + content[place + 1 :]
    return content


def otherwise_compressed(content: bytes) -> bytes:
    """Method 96 (JPEG) in both headers."""
    for sign, at in ((rb"PK\x03\x04", 8), (rb"PK\x01\x02", 10)):
        for found in re.finditer(sign, content):
            place = found.start() + at
            content = content[:place] + b"\x60\x00" + content[place + 2 :]
    return content


@pytest.mark.parametrize("damaged", [cut, changed, encrypted, otherwise_compressed])
def test_what_is_damaged_is_said_with_what_to_do(tmp_path: Path, damaged: Callable[[bytes], bytes]) -> None:
    whole, archive = tmp_path / "whole.fmu", tmp_path / "model.fmu"
    noise = "".join(chr(32 + (i * i * 7919) % 90) for i in range(9_000))
    with zipfile.ZipFile(whole, "w", zipfile.ZIP_DEFLATED) as members:
        members.writestr("modelDescription.xml", f"<x>{noise}</x>")
        members.writestr("resources/tire.json", noise)
    archive.write_bytes(damaged(whole.read_bytes()))
    with pytest.raises(TirelabError, match=r"model\.fmu cannot be unpacked \(.+\); export it again"):
        unpack(archive, tmp_path / "inside")
    with pytest.raises(TirelabError, match=r"model\.fmu.* (cannot be read|breaks the FMI standard)"):
        description_in(archive, validate=False, again="export it again")


def test_a_description_without_a_version_is_said(tmp_path: Path) -> None:
    archive = tmp_path / "model.fmu"
    with zipfile.ZipFile(archive, "w") as members:
        members.writestr("modelDescription.xml", "<html/>")
    with pytest.raises(TirelabError, match="lacks what every FMU has, such as fmiVersion; export it again"):
        description_in(archive, validate=False, again="export it again")
    with pytest.raises(TirelabError, match="is a folder"):
        description_in(tmp_path, validate=False, again="export it again")
