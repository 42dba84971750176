"""What is installed beside the Python files: every file that the code reads, and the mark that it is typed."""

from __future__ import annotations

import sys
from contextlib import suppress
from importlib.metadata import PackageNotFoundError, metadata, version
from itertools import chain
from pathlib import Path
from typing import Any

import pytest
import tirelab
from packaging.requirements import Requirement
from packaging.specifiers import SpecifierSet
from packaging.version import Version

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
    own = settings["project"]["version"]
    assert tirelab.__version__ == own
    holding = [
        path.name
        for path in (repository / "fmu_src").rglob("*.py")
        if f'"{own}"' in path.read_text(encoding="utf-8")
    ]
    assert holding == []


def test_the_packages_say_that_they_are_typed(repository: Path, settings: Any) -> None:
    for package in ("tirelab", "radialtire"):
        assert (repository / "fmu_src" / package / "py.typed").is_file()
    assert "Typing :: Typed" in settings["project"]["classifiers"]


def test_no_requirement_leaves_out_the_oldest_python(settings: Any) -> None:
    """Where the release that is installed here wants a newer Python, the requirement allows an older release."""
    project = settings["project"]
    oldest = project["requires-python"].removeprefix(">=") + ".0"
    lines = [*project["dependencies"], *chain(*project["optional-dependencies"].values())]
    wanted = [Requirement(line) for line in lines if not line.startswith(project["name"])]
    assert len(wanted) > 30
    refused = []
    for requirement in wanted:
        with suppress(PackageNotFoundError):
            python = metadata(requirement.name).get("Requires-Python") or ""
            newest = Version(version(requirement.name))
            bounds = [Version(s.version) for s in requirement.specifier if s.operator == ">="]
            if not SpecifierSet(python).contains(oldest) and newest in bounds:
                refused.append(f"{requirement} wants Python {python}")
    assert refused == []
