"""The FMUs in programs that have no Python in them: fmusim, the FMU Compliance Checker, FMI4cpp, OMSimulator.

No registry has them: whoever has built them from their repositories runs these tests with the first two on PATH, and
with the libraries FMI4cpp and OMSimulator where the compiler looks: installed for everybody, or named in CPATH and
LIBRARY_PATH.
"""

from __future__ import annotations

import csv
import math
import os
import shutil
import subprocess
from collections.abc import Sequence
from pathlib import Path

import pytest
from radialtire import TireModel
from tirelab.fmu.native.pack import build_native_fmu

HOSTS = Path(__file__).parent / "hosts"
INPUT = """"time","deflection","surface_radius"
0.0,0.0,1e5
1.0,0.02,1e5
"""
NOT_A_NUMBER = """"time","deflection","surface_radius"
0.0,0.01,1e5
0.5,0.01,1e5
0.5,nan,1e5
1.0,nan,1e5
"""
INPUTS = [(0.02, 1e5), (0.02, 0.254), (0.01, -0.381)]
FORCES = [
    550.9 * 2**1.422,
    (550.9 - 337.8 * math.exp(-0.2519 * 25.4)) * 2 ** (1.422 - 0.2469 * math.exp(-0.1651 * 25.4)),
    550.9 + 7822.0 * math.exp(-0.1398 * 38.1),
]
"""Equations 2, 5 and 6 of the article on flat, convex and concave ground."""
LAST_STEP, END = 550.9 * 1.8**1.422, 550.9 * 2.0**1.422
"""The force at 1.8 cm, the input that is held over the last step of 0.1 s, and at 2 cm."""


@pytest.fixture(scope="module")
def fmus(article_fmu: Path, tmp_path_factory: pytest.TempPathFactory) -> dict[str, Path]:
    """The article's tire as each kind."""
    natives = {
        f"FMI {fmi}": build_native_fmu(TireModel(), tmp_path_factory.mktemp(f"fmi{fmi}"), fmi=fmi).path
        for fmi in (2, 3)
    }
    return {"Python": article_fmu, **natives}


def program(name: str) -> str:
    found = shutil.which(name)
    if found is None:
        pytest.skip(f"{name} is not on PATH; it is in no registry and has to be built from its repository")
    return found


def run(
    command: Sequence[str | Path], folder: Path, *, python: bool, said: str = ""
) -> subprocess.CompletedProcess[str]:
    """Run a program in a folder; with a native FMU it finds on PATH nothing but `rm`, which both programs call."""
    environment = dict(os.environ)
    if not python:
        (folder / "bin").mkdir()
        (folder / "bin" / "rm").symlink_to(shutil.which("rm") or "/bin/rm")
        environment = {"PATH": str(folder / "bin"), "HOME": str(folder)}
    return subprocess.run(
        command, input=said, cwd=folder, capture_output=True, text=True, timeout=120, env=environment
    )


def forces(path: Path) -> dict[float, float]:
    """The forces by their times; of rows of one time the last."""
    with path.open() as rows:
        return {float(row["time"]): float(row["radial_force"]) for row in csv.DictReader(rows)}


def fmusim(fmu: Path, folder: Path, kind: str, rows: str) -> subprocess.CompletedProcess[str]:
    (folder / "in.csv").write_text(rows)
    words = ["--interface-type", kind, "--input-file", "in.csv", "--stop-time", "1", "--set-stop-time"]
    words += ["--output-interval", "0.1", "--output-variable", "radial_force", "--output-file", "out.csv"]
    return run([program("fmusim"), *words, fmu], folder, python=fmu.parent.name.startswith("article"))


@pytest.mark.parametrize(
    ("fmu", "kind", "force"),
    [
        ("Python", "cs", LAST_STEP),
        ("FMI 2", "cs", LAST_STEP),
        ("FMI 3", "cs", LAST_STEP),
        ("FMI 2", "me", END),
        ("FMI 3", "me", END),
    ],
)
def test_fmusim(fmus: dict[str, Path], tmp_path: Path, fmu: str, kind: str, force: float) -> None:
    done = fmusim(fmus[fmu], tmp_path, kind, INPUT)
    assert done.returncode == 0, done.stderr + done.stdout
    found = forces(tmp_path / "out.csv")
    assert len(found) == 11
    assert found[1.0] == pytest.approx(force, rel=1e-12)


@pytest.mark.parametrize("fmu", ["Python", "FMI 2", "FMI 3"])
def test_fmusim_ends_by_itself_after_an_input_that_no_tire_has(
    fmus: dict[str, Path], tmp_path: Path, fmu: str
) -> None:
    done = fmusim(fmus[fmu], tmp_path, "cs", NOT_A_NUMBER)
    assert done.returncode == 3
    assert (done.stdout + done.stderr).count("deflection = nan m is not allowed") == 1


@pytest.mark.parametrize(
    ("fmu", "kind", "force"), [("Python", "cs", LAST_STEP), ("FMI 2", "cs", LAST_STEP), ("FMI 2", "me", END)]
)
def test_the_compliance_checker_finds_nothing(
    fmus: dict[str, Path], tmp_path: Path, fmu: str, kind: str, force: float
) -> None:
    (tmp_path / "in.csv").write_text(INPUT)
    words = ["-k", kind, "-h", "0.1", "-s", "1", "-i", "in.csv", "-o", "out.csv"]
    done = run([program("fmuCheck.linux64"), *words, fmus[fmu]], tmp_path, python=fmu == "Python")
    summary = (done.stdout + done.stderr).partition("FMU check summary")[2]
    assert done.returncode == 0, done.stderr
    assert "0 warning(s) and error(s)" in summary
    # a tolerance is a solver's: that the Python FMU declares none, FMI Library 3 finds worth a warning
    warnings = [line for line in (done.stdout + done.stderr).splitlines() if line.startswith("[WARNING]")]
    assert [line for line in warnings if fmu != "Python" or "experiment_tolerance" not in line] == []
    assert "0 Error(s)" in summary
    assert forces(tmp_path / "out.csv")[1.0] == pytest.approx(force, rel=1e-12)


def compiled(source: str, library: str, folder: Path) -> Path:
    """A host of ours that runs FMUs with a library of others, which the compiler has to find on this machine."""
    compiler = "g++" if source.endswith(".cpp") else "gcc"
    if shutil.which(compiler) is None:
        pytest.skip(f"{compiler} is not on PATH")
    host, places = folder / "host", os.environ.get("LIBRARY_PATH", "").split(os.pathsep)
    found = [f"-Wl,-rpath,{place}" for place in places if place]
    command = [compiler, "-Wall", "-Wextra", "-o", host, HOSTS / source, f"-l{library}", *found]
    done = subprocess.run(
        [*command, "-std=c++17"] if compiler == "g++" else command, capture_output=True, text=True
    )
    if "No such file or directory" in done.stderr:
        pytest.skip(
            f"{compiler} finds no {library}; it is in no registry and has to be built from its repository"
        )
    assert done.returncode == 0, done.stderr
    return host


@pytest.fixture(scope="module", params=["with_fmi4cpp.cpp fmi4cpp", "with_omsimulator.c OMSimulator"])
def host(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A program that runs an FMU with FMI4cpp, and one with OMSimulator."""
    source, library = request.param.split()
    return compiled(source, library, tmp_path_factory.mktemp(library))


KINDS = pytest.mark.parametrize(("fmu", "kind"), [("Python", "cs"), ("FMI 2", "cs"), ("FMI 2", "me")])


@KINDS
def test_libraries_of_others(host: Path, fmus: dict[str, Path], tmp_path: Path, fmu: str, kind: str) -> None:
    rows = "".join(f"{deflection!r} {radius!r}\n" for deflection, radius in INPUTS)
    done = run([host, fmus[fmu], kind], tmp_path, python=fmu == "Python", said=rows)
    assert done.returncode == 0, done.stdout + done.stderr
    (line,) = [line for line in done.stdout.splitlines() if line.startswith("forces ")]
    assert [float(word) for word in line.split()[1:]] == pytest.approx(FORCES, rel=1e-12)


@KINDS
def test_they_end_with_the_message_after_an_input_that_no_tire_has(
    host: Path, fmus: dict[str, Path], tmp_path: Path, fmu: str, kind: str
) -> None:
    done = run([host, fmus[fmu], kind], tmp_path, python=fmu == "Python", said="0.01 1e5\nnan 1e5\n")
    assert done.returncode == 3
    assert "forces" not in done.stdout
    assert "deflection = nan m is not allowed" in done.stdout
