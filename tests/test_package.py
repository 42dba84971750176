"""What is installed beside the Python files: every file that the code reads, and the mark that it is typed."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Any

import pytest
import tirelab

if sys.version_info >= (3, 11):
    import tomllib
else:
    import tomli as tomllib


@pytest.fixture(scope="module")
def settings(repository: Path) -> Any:
    return tomllib.loads((repository / "pyproject.toml").read_text(encoding="utf-8"))


def test_every_file_beside_the_code_is_installed(repository: Path, settings: Any) -> None:
    source = repository / "fmu_src"
    listed = {
        file
        for package, patterns in settings["tool"]["setuptools"]["package-data"].items()
        for pattern in patterns
        for file in source.joinpath(*package.split(".")).glob(pattern)
        if file.is_file()
    }
    beside = {
        file
        for package in ("tirelab", "radialtire", "concealed")
        for file in (source / package).rglob("*")
        if file.is_file() and file.suffix != ".py" and "__pycache__" not in file.parts
    }
    assert beside == listed


def test_it_says_how_to_be_cited(settings: Any) -> None:
    """The keys that CITATION.cff 1.2.0 requires; version and licence stand in one place."""
    cited = settings["tool"]["citation"]
    assert {"cff-version", "message", "title", "authors"} <= set(cited)
    assert {"version", "license"}.isdisjoint(cited)
    assert cited["title"] == settings["project"]["name"]
    assert [a["name"] for a in cited["authors"]] == [a["name"] for a in settings["project"]["authors"]]
    assert all({"type", "authors", "title"} <= set(reference) for reference in cited["references"])


def test_the_version_is_written_once(repository: Path, settings: Any) -> None:
    version = settings["project"]["version"]
    assert tirelab.__version__ == version
    holding = [
        path.name
        for path in (repository / "fmu_src").rglob("*.py")
        if f'"{version}"' in path.read_text(encoding="utf-8")
    ]
    assert holding == []


def test_the_packages_say_that_they_are_typed(repository: Path, settings: Any) -> None:
    for package in ("tirelab", "radialtire"):
        assert (repository / "fmu_src" / package / "py.typed").is_file()
    assert "Typing :: Typed" in settings["project"]["classifiers"]
