"""How the FMU's Linux binary is compiled, and what comes out."""

import ctypes
import importlib.util
import re
import shutil
import subprocess
from pathlib import Path

import pytest
from loader_bench import FORCE_1_CM, Bench, numbers, unpacked
from tirelab.errors import TirelabError
from tirelab.fmu import loader
from tirelab.fmu.loader import OLDEST_GLIBC, SOURCES, Compiler, compile_loader, find_compiler

FUNCTIONS = [
    *("GetTypesPlatform", "GetVersion", "SetDebugLogging", "Instantiate", "FreeInstance", "SetupExperiment"),
    *("EnterInitializationMode", "ExitInitializationMode", "Terminate", "Reset"),
    *(verb + kind for verb in ("Get", "Set") for kind in ("Real", "Integer", "Boolean", "String")),
    *("GetFMUstate", "SetFMUstate", "FreeFMUstate", "SerializedFMUstateSize", "SerializeFMUstate"),
    *("DeSerializeFMUstate", "GetDirectionalDerivative", "SetRealInputDerivatives"),
    *("GetRealOutputDerivatives", "DoStep", "CancelStep", "GetStatus", "GetRealStatus", "GetIntegerStatus"),
    *("GetBooleanStatus", "GetStringStatus"),
]
"""Chapters 2 and 4 of the FMI 2.0 standard, for co-simulation."""


def test_has_all_of_fmi_2_for_co_simulation(bench: Bench) -> None:
    library = ctypes.CDLL(str(bench.loader))
    assert [name for name in FUNCTIONS if not hasattr(library, "fmi2" + name)] == []


def test_ziglang_makes_one_for_old_systems(bench: Bench, tmp_path: Path) -> None:
    compiler = find_compiler()
    if compiler is None or compiler.glibc is None:
        pytest.skip("ziglang is not installed")
    library = tmp_path / "zig.so"
    assert compile_loader(library) == compiler
    asked = {
        (int(major), int(minor)) for major, minor in re.findall(rb"GLIBC_(\d+)\.(\d+)", library.read_bytes())
    }
    assert asked
    assert max(asked) <= tuple(int(number) for number in OLDEST_GLIBC.split("."))
    fmu = unpacked(tmp_path / "fmu", library)
    assert numbers(bench.run("run", 0.01, fmu=fmu)) == pytest.approx([FORCE_1_CM] * 2, rel=1e-15)
    bench.run("threads", 4, fmu=fmu)


def test_compiles_to_the_same_bytes_anywhere(
    compiler: Compiler, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    shutil.copytree(Path(loader.__file__).parent, tmp_path / "there")
    compile_loader(tmp_path / "one.so", compiler)
    monkeypatch.setattr(loader, "__file__", str(tmp_path / "there" / "loader.py"))
    compile_loader(tmp_path / "two.so", compiler)
    assert (tmp_path / "one.so").read_bytes() == (tmp_path / "two.so").read_bytes()


def test_compiles_without_warnings(compiler: Compiler, tmp_path: Path) -> None:
    flags = ["-std=c11", "-O2", "-Wall", "-Wextra", "-Werror", "-fPIC", "-shared"]
    command = [*compiler.command, *flags, "-o", str(tmp_path / "loader.so"), *SOURCES]
    subprocess.run(command, cwd=Path(loader.__file__).parent, check=True)


def test_without_a_compiler_nothing_is_written(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(importlib.util, "find_spec", lambda name: None)
    monkeypatch.setenv("PATH", str(tmp_path))
    monkeypatch.delenv("CC", raising=False)
    assert compile_loader(tmp_path / "loader.so") is None
    assert not list(tmp_path.iterdir())


def test_the_compiler_of_the_environment(compiler: Compiler, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(importlib.util, "find_spec", lambda name: None)
    monkeypatch.setenv("CC", "env MODE=1 cc")
    assert find_compiler() == Compiler("env MODE=1 cc", ("env", "MODE=1", "cc"), None)


def test_a_compiler_that_fails_is_told_with_its_first_error(tmp_path: Path) -> None:
    script = tmp_path / "bad"
    script.write_text("#!/bin/sh\necho 'a warning' >&2\necho 'loader.c:1: error: no good' >&2\nexit 1\n")
    script.chmod(0o755)
    with pytest.raises(
        TirelabError, match=r"The C compiler bad cannot compile .*: loader\.c:1: error: no good$"
    ):
        compile_loader(tmp_path / "loader.so", Compiler("bad", (str(script),), None))
    with pytest.raises(TirelabError, match=r"The C compiler gone cannot be run: .*No such file"):
        compile_loader(tmp_path / "loader.so", Compiler("gone", (str(tmp_path / "gone"),), None))
