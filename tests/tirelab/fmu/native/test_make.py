"""What is shipped with the package: the translated kernel and the binaries are those that the sources make."""

from __future__ import annotations

import json
import subprocess
from pathlib import Path

import pytest
from tirelab.fmu.loader import Compiler
from tirelab.fmu.native.kernel import sources
from tirelab.fmu.native.make import (
    HERE,
    MADE_FROM,
    PLATFORMS,
    VERSIONS,
    Platform,
    c_files,
    compile_for,
    made_from,
    source_files,
)


def require_the_same_ziglang() -> None:
    pytest.importorskip("ziglang")
    then, now = json.loads(MADE_FROM.read_text(encoding="utf-8"))["ziglang"], made_from()["ziglang"]
    if now != then:
        pytest.skip(f"the binaries were made by ziglang {then}, this is {now}: other bytes prove nothing")


def test_the_binaries_were_made_of_these_sources() -> None:
    """Whatever ziglang is installed here. Where this fails: python -m tirelab.fmu.native.make."""
    pytest.importorskip("ziglang")
    assert json.loads(MADE_FROM.read_text(encoding="utf-8"))["sources"] == made_from()["sources"]


def test_the_kernel_is_that_of_the_python() -> None:
    """Where this fails: python -m tirelab.fmu.native.make."""
    for name, text in sources().items():
        assert (HERE / name).read_text(encoding="utf-8") == text, f"{name} is not that of radialtire"


@pytest.fixture(scope="module")
def cache(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Where ziglang keeps the C libraries that it makes, for all tests here."""
    return tmp_path_factory.mktemp("cache")


@pytest.mark.parametrize("fmi", VERSIONS)
def test_the_binary_for_linux_is_that_of_the_sources(fmi: int, cache: Path, tmp_path: Path) -> None:
    require_the_same_ziglang()
    platform = PLATFORMS[0]
    assert platform.fmi3 == "x86_64-linux"
    compile_for(platform, fmi, tmp_path / "made", cache)
    assert (tmp_path / "made").read_bytes() == platform.library(fmi).read_bytes()


@pytest.mark.slow
@pytest.mark.parametrize("fmi", VERSIONS)
@pytest.mark.parametrize("platform", PLATFORMS[1:], ids=lambda platform: str(platform.fmi3))
def test_the_other_binaries_are_those_of_the_sources(
    platform: Platform, fmi: int, cache: Path, tmp_path: Path
) -> None:
    """Minutes, where ziglang has to make the C library of Windows first."""
    require_the_same_ziglang()
    compile_for(platform, fmi, tmp_path / "made", cache)
    assert (tmp_path / "made").read_bytes() == platform.library(fmi).read_bytes()


@pytest.mark.parametrize("fmi", VERSIONS)
def test_the_sources_compile_without_warnings(compiler: Compiler, fmi: int, tmp_path: Path) -> None:
    for name, content in source_files(fmi).items():
        (tmp_path / name).write_bytes(content)
    strict = ["-std=c99", "-O2", "-Wall", "-Wextra", "-Wno-unused-parameter", "-Werror", "-fPIC", "-shared"]
    command = [*compiler.command, *strict, "-o", str(tmp_path / "made.so"), *c_files(fmi), "-lm"]
    subprocess.run(command, cwd=tmp_path, check=True)
