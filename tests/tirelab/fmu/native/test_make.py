"""What is shipped with the package: the translated kernel and the binaries are those that the sources make."""

from __future__ import annotations

import subprocess
from pathlib import Path

import pytest
from tirelab.fmu.loader import Compiler
from tirelab.fmu.native.kernel import sources
from tirelab.fmu.native.make import HERE, PLATFORMS, VERSIONS, Platform, c_files, compile_for, source_files


def test_the_kernel_is_that_of_the_python() -> None:
    """Where this fails: python -m tirelab.fmu.native.make."""
    for name, text in sources().items():
        assert (HERE / name).read_text(encoding="utf-8") == text, f"{name} is not that of radialtire"


@pytest.mark.parametrize("fmi", VERSIONS)
def test_the_binary_for_linux_is_that_of_the_sources(fmi: int, tmp_path: Path) -> None:
    pytest.importorskip("ziglang")
    platform = PLATFORMS[0]
    assert platform.fmi3 == "x86_64-linux"
    compile_for(platform, fmi, tmp_path / "made")
    assert (tmp_path / "made").read_bytes() == platform.library(fmi).read_bytes()


@pytest.mark.slow
@pytest.mark.parametrize("fmi", VERSIONS)
@pytest.mark.parametrize("platform", PLATFORMS[1:], ids=lambda platform: str(platform.fmi3))
def test_the_other_binaries_are_those_of_the_sources(platform: Platform, fmi: int, tmp_path: Path) -> None:
    """Minutes, where ziglang has to make the C library of Windows first."""
    pytest.importorskip("ziglang")
    compile_for(platform, fmi, tmp_path / "made")
    assert (tmp_path / "made").read_bytes() == platform.library(fmi).read_bytes()


@pytest.mark.parametrize("fmi", VERSIONS)
def test_the_sources_compile_without_warnings(compiler: Compiler, fmi: int, tmp_path: Path) -> None:
    for name, content in source_files(fmi).items():
        (tmp_path / name).write_bytes(content)
    strict = ["-std=c99", "-O2", "-Wall", "-Wextra", "-Wno-unused-parameter", "-Werror", "-fPIC", "-shared"]
    command = [*compiler.command, *strict, "-o", str(tmp_path / "made.so"), *c_files(fmi), "-lm"]
    subprocess.run(command, cwd=tmp_path, check=True)
