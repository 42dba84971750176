"""FMUs and the hosts that run them, each host in a fresh process without the project."""

from __future__ import annotations

import importlib.util
import json
import os
import platform
import shutil
import subprocess
import sys
import tempfile
import zipfile
from collections.abc import Callable
from importlib import metadata
from pathlib import Path
from typing import Any

import pytest
from loader_bench import HERE, Bench, unpacked
from radialtire import TireModel
from tirelab.fmu.build import build_fmu
from tirelab.fmu.loader import NO_COMPILER, Compiler, compile_loader, find_compiler
from tirelab.fmu.native.pack import build_native_fmu

HOSTS = Path(__file__).parent / "hosts"


@pytest.fixture(scope="session")
def article_fmu(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The FMU of the article's tire, with the loader where there is a compiler."""
    return build_fmu(TireModel(), tmp_path_factory.mktemp("article")).path


@pytest.fixture(scope="session", params=["Python", "native"])
def either_fmu(
    request: pytest.FixtureRequest, article_fmu: Path, tmp_path_factory: pytest.TempPathFactory
) -> Path:
    """The article's tire as each kind of FMU, FMI 2.0."""
    if request.param == "Python":
        return article_fmu
    return build_native_fmu(TireModel(), tmp_path_factory.mktemp("native")).path


@pytest.fixture(scope="session")
def three_fmus(article_fmu: Path, tmp_path_factory: pytest.TempPathFactory) -> dict[str, Path]:
    """The article's tire as each kind: "Python", "FMI 2" and "FMI 3"."""
    natives = {
        f"FMI {fmi}": build_native_fmu(TireModel(), tmp_path_factory.mktemp(f"fmi{fmi}"), fmi=fmi).path
        for fmi in (2, 3)
    }
    return {"Python": article_fmu, **natives}


@pytest.fixture(scope="session")
def run_host() -> Callable[..., str]:
    """Runs a host script in isolation and returns what it printed; its failure is the test's."""
    return _run_host


@pytest.fixture(scope="session")
def run_fmpy() -> Callable[[list[Path], list[list[Any]]], list[Any]]:
    """Runs calls on instances of FMUs in one fresh process with fmpy and returns their answers."""

    def run(fmus: list[Path], calls: list[list[Any]]) -> list[Any]:
        answers = json.loads(_run_host("with_fmpy.py", job={"fmus": list(map(str, fmus)), "calls": calls}))
        assert isinstance(answers, list)
        return answers

    return run


def tbb_folder() -> str:
    """The folder of the oneTBB that ecospy needs: where pip put it, and where the linker does not look."""
    try:
        files = metadata.files("tbb") or []
    except metadata.PackageNotFoundError:
        files = []
    found = [Path(file.locate()).resolve().parent for file in files if file.name.startswith("libtbb.so")]
    return str(found[0] if found else Path(sys.prefix) / "lib")


@pytest.fixture(scope="session")
def proxyfmu() -> Path:
    """The program of ecospy that runs an FMU in a process of its own."""
    spec = importlib.util.find_spec("ecospy")
    program = Path(spec.origin).parent / "binaries" / "proxyfmu" if spec and spec.origin else None
    if program is None or not program.is_file():
        pytest.skip("ecospy has no proxyfmu here")
    return program


def _run_host(script: str, *arguments: Any, job: Any, timeout: float = 120.0) -> str:
    environment = {key: value for key, value in os.environ.items() if key != "PYTHONPATH"}
    environment["LD_LIBRARY_PATH"] = tbb_folder()
    with tempfile.TemporaryDirectory() as folder:  # proxyfmu writes its logs where it stands
        result = subprocess.run(
            [sys.executable, "-I", str(HOSTS / script), *map(str, arguments)],
            input=json.dumps(job),
            capture_output=True,
            text=True,
            env=environment,
            cwd=folder,
            timeout=timeout,
            check=False,
        )
    assert result.returncode == 0, f"{script} exited with {result.returncode}:\n{result.stderr}"
    return result.stdout


def wheel_of(requirement: str, folder: Path) -> zipfile.ZipFile:
    """The wheel of a package, without what the package needs; skips where it cannot be had."""
    words = ["download", "--quiet", "--no-deps", "--only-binary", ":all:", "--dest", str(folder), requirement]
    done = subprocess.run([sys.executable, "-m", "pip", *words], capture_output=True, timeout=300)
    wheels = list(folder.glob("*.whl"))
    if done.returncode or not wheels or sys.platform != "linux":
        pytest.skip(f"the package {requirement} cannot be had here, or not for this machine")
    return zipfile.ZipFile(wheels[0])


@pytest.fixture(scope="session")
def shipped(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The FMU add.fmu of OpenModelica (y = u1 + u2) that the package gemseo-fmu ships."""
    folder = tmp_path_factory.mktemp("shipped")
    with wheel_of("gemseo-fmu==3.1.1", folder) as wheel:
        return Path(wheel.extract("gemseo_fmu/problems/fmu_files/linux/add.fmu", folder))


@pytest.fixture(scope="session")
def cosim_on_windows(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The program cosim of the Open Simulation Platform for Windows, which the package pycosim ships."""
    folder, place = tmp_path_factory.mktemp("cosim"), "osp_cosim/win64/bin/"
    with wheel_of("pycosim==0.6.5", folder) as wheel:
        wheel.extractall(folder, [name for name in wheel.namelist() if name.startswith(place)])
    return folder / place / "cosim.exe"


@pytest.fixture(scope="session")
def tbb() -> str:
    """The folder of the oneTBB that ecos needs."""
    return tbb_folder()


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
