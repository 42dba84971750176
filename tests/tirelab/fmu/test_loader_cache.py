"""What ziglang has made is taken again as long as nothing that it was made from has changed."""

from __future__ import annotations

import importlib.util
import shutil
import sys
from dataclasses import replace
from pathlib import Path

import pytest
from tirelab.errors import TirelabError
from tirelab.fmu import loader
from tirelab.fmu.loader import Compiler, compile_loader

pytestmark = pytest.mark.skipif(
    sys.platform == "win32", reason="the compiler of these tests is a shell script"
)

SCRIPT = """#!/bin/sh
echo run >> "$0.runs"
while [ "$1" != -o ]; do shift; done
cat loader.c > "$2"
"""


@pytest.fixture
def counted(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Compiler:
    """A compiler like ziglang, with its own C library, that counts its runs; the cache is empty."""
    monkeypatch.setenv("TIRELAB_CACHE", str(tmp_path / "cache"))
    script = tmp_path / "compiler"
    script.write_text(SCRIPT)
    script.chmod(0o755)
    return Compiler("counted 1.0", (str(script),), "2.17")


def runs(compiler: Compiler) -> int:
    return len(Path(f"{compiler.command[0]}.runs").read_text().splitlines())


def test_the_second_time_it_is_not_compiled(counted: Compiler, tmp_path: Path) -> None:
    for name in ("one.so", "two.so"):
        assert compile_loader(tmp_path / name, counted) == counted
    assert runs(counted) == 1
    assert (tmp_path / "two.so").read_bytes() == (tmp_path / "one.so").read_bytes()
    assert len(list((tmp_path / "cache" / "loader").iterdir())) == 1


@pytest.mark.parametrize("file", ["loader.c", "interpreter.c", "interpreter.h", "fmi2.h", "make_slave.h"])
def test_another_source_is_compiled(
    counted: Compiler, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, file: str
) -> None:
    compile_loader(tmp_path / "one.so", counted)
    shutil.copytree(Path(loader.__file__).parent, tmp_path / "there")
    monkeypatch.setattr(loader, "__file__", str(tmp_path / "there" / "loader.py"))
    compile_loader(tmp_path / "two.so", counted)
    assert runs(counted) == 1
    with (tmp_path / "there" / file).open("a") as source:
        source.write("/* changed */\n")
    compile_loader(tmp_path / "two.so", counted)
    assert runs(counted) == 2
    changed = (tmp_path / "two.so").read_bytes() != (tmp_path / "one.so").read_bytes()
    assert changed == (file == "loader.c")


def test_another_compiler_version_flag_or_surrounding_compiles_anew(
    counted: Compiler, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    library = tmp_path / "one.so"
    compile_loader(library, counted)
    compile_loader(library, replace(counted, name="counted 1.1"))
    assert runs(counted) == 2
    compile_loader(library, replace(counted, command=(*counted.command, "-target", "other")))
    assert runs(counted) == 3
    monkeypatch.setenv("CPATH", str(tmp_path))
    compile_loader(library, counted)
    assert runs(counted) == 4
    monkeypatch.setattr(loader, "_FLAGS", ("-O3",))
    compile_loader(library, counted)
    assert runs(counted) == 5


def test_a_compiler_on_the_machines_own_library_compiles_each_time(counted: Compiler, tmp_path: Path) -> None:
    for _ in range(2):
        compile_loader(tmp_path / "one.so", replace(counted, glibc=None))
    assert runs(counted) == 2
    assert not (tmp_path / "cache").exists()


def test_a_cache_that_others_may_write_to_is_neither_read_nor_written(
    counted: Compiler, tmp_path: Path
) -> None:
    compile_loader(tmp_path / "one.so", counted)
    (kept,) = (tmp_path / "cache" / "loader").iterdir()
    kept.write_bytes(b"planted")
    (tmp_path / "cache").chmod(0o777)
    compile_loader(tmp_path / "two.so", counted)
    assert runs(counted) == 2
    assert (tmp_path / "two.so").read_bytes() == (tmp_path / "one.so").read_bytes()
    assert kept.read_bytes() == b"planted"


def test_without_a_cache_it_is_compiled_all_the_same(counted: Compiler, tmp_path: Path) -> None:
    (tmp_path / "cache").write_text("a file")
    compile_loader(tmp_path / "one.so", counted)
    assert (tmp_path / "one.so").read_bytes()


def test_what_failed_is_not_kept(counted: Compiler, tmp_path: Path) -> None:
    script = Path(counted.command[0])
    script.write_text(SCRIPT + "exit 1\n")
    with pytest.raises(TirelabError):
        compile_loader(tmp_path / "one.so", counted)
    assert list((tmp_path / "cache" / "loader").iterdir()) == []


@pytest.mark.slow
def test_ziglang_makes_the_same_bytes_twice(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    if importlib.util.find_spec("ziglang") is None:
        pytest.skip("ziglang is not installed")
    for name in ("one", "two"):
        monkeypatch.setenv("TIRELAB_CACHE", str(tmp_path / name))
        compile_loader(tmp_path / f"{name}.so")
    assert (tmp_path / "one.so").read_bytes() == (tmp_path / "two.so").read_bytes()
    compile_loader(tmp_path / "three.so")
    assert (tmp_path / "three.so").read_bytes() == (tmp_path / "two.so").read_bytes()
