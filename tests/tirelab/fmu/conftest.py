"""Compiles what the tests of the FMU's Linux binary need, once."""

import platform
import shutil
import subprocess

import pytest
from loader_bench import HERE, Bench, unpacked
from tirelab.fmu.loader import NO_COMPILER, Compiler, compile_loader, find_compiler


@pytest.fixture(scope="session")
def compiler() -> Compiler:
    """The machine's own compiler, if it has one: ziglang takes more time."""
    if (platform.system(), platform.machine()) != ("Linux", "x86_64"):
        pytest.skip("the loader is for Linux on x86-64")
    found = Compiler("cc", ("cc",), None) if shutil.which("cc") else find_compiler()
    if found is None:
        pytest.skip(NO_COMPILER)
    return found


@pytest.fixture(scope="session")
def bench(compiler: Compiler, tmp_path_factory: pytest.TempPathFactory) -> Bench:
    """The C host, the native FMU and the FMU under test."""
    folder = tmp_path_factory.mktemp("loader")
    host, native, loader = folder / "host", folder / "native.so", folder / "loader.so"
    strict = [*compiler.command, "-std=c11", "-O2", "-Wall", "-Wextra", "-Werror", "-pthread"]
    subprocess.run([*strict, "-o", host, HERE / "host.c", "-ldl", "-lm"], check=True)
    subprocess.run([*strict, "-shared", "-fPIC", "-o", native, HERE / "native.c", "-lm"], check=True)
    compile_loader(loader, compiler)
    return Bench(host, native, loader, unpacked(folder / "fmu", loader))
