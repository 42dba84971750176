"""Archives are unpacked inside of their folder only."""

import zipfile
from pathlib import Path

import pytest
from tirelab.errors import TirelabError
from tirelab.fmu import unpacking
from tirelab.fmu.unpacking import unpack


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
