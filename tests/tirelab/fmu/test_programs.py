"""The FMUs in programs that have no Python in them: fmusim, the FMU Compliance Checker, FMI4cpp, OMSimulator.

Neither PyPI, Debian nor npm has them (PyPI's OMSimulator is its Python part, which fetches the rest elsewhere): whoever
has built them from their repositories runs these tests with the first two on PATH, and with the libraries FMI4cpp and
OMSimulator where the compiler looks: installed for everybody, or named in CPATH and LIBRARY_PATH.
"""

from __future__ import annotations

import csv
import os
import shutil
import subprocess
from pathlib import Path

import pytest
from programs import FORCES, NOT_A_NUMBER, REFUSAL, ROWS, compiled, printed, run

INPUT = """"time","deflection","surface_radius"
0.0,0.0,1e5
1.0,0.02,1e5
"""
NO_NUMBER = """"time","deflection","surface_radius"
0.0,0.01,1e5
0.5,0.01,1e5
0.5,nan,1e5
1.0,nan,1e5
"""
NOWHERE = "and neither PyPI, Debian nor npm has it ready: it has to be built from its repository"
LAST_STEP, END = 550.9 * 1.8**1.422, 550.9 * 2.0**1.422
"""The force at 1.8 cm, the input that is held over the last step of 0.1 s, and at 2 cm."""


def program(name: str) -> str:
    found = shutil.which(name)
    if found is None:
        pytest.skip(f"{name} is not on PATH, {NOWHERE}")
    return found


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
def test_fmusim(three_fmus: dict[str, Path], tmp_path: Path, fmu: str, kind: str, force: float) -> None:
    done = fmusim(three_fmus[fmu], tmp_path, kind, INPUT)
    assert done.returncode == 0, done.stderr + done.stdout
    found = forces(tmp_path / "out.csv")
    assert len(found) == 11
    assert found[1.0] == pytest.approx(force, rel=1e-12)


@pytest.mark.parametrize("fmu", ["Python", "FMI 2", "FMI 3"])
def test_fmusim_ends_by_itself_after_an_input_that_no_tire_has(
    three_fmus: dict[str, Path], tmp_path: Path, fmu: str
) -> None:
    done = fmusim(three_fmus[fmu], tmp_path, "cs", NO_NUMBER)
    assert done.returncode == 3
    assert (done.stdout + done.stderr).count(REFUSAL) == 1


@pytest.mark.parametrize(
    ("fmu", "kind", "force"), [("Python", "cs", LAST_STEP), ("FMI 2", "cs", LAST_STEP), ("FMI 2", "me", END)]
)
def test_the_compliance_checker_finds_nothing(
    three_fmus: dict[str, Path], tmp_path: Path, fmu: str, kind: str, force: float
) -> None:
    (tmp_path / "in.csv").write_text(INPUT)
    words = ["-k", kind, "-h", "0.1", "-s", "1", "-i", "in.csv", "-o", "out.csv"]
    done = run([program("fmuCheck.linux64"), *words, three_fmus[fmu]], tmp_path, python=fmu == "Python")
    summary = (done.stdout + done.stderr).partition("FMU check summary")[2]
    assert done.returncode == 0, done.stderr
    assert "0 warning(s) and error(s)" in summary
    # a tolerance is a solver's: that the Python FMU declares none, FMI Library 3 finds worth a warning
    warnings = [line for line in (done.stdout + done.stderr).splitlines() if line.startswith("[WARNING]")]
    assert [line for line in warnings if fmu != "Python" or "experiment_tolerance" not in line] == []
    assert "0 Error(s)" in summary
    assert forces(tmp_path / "out.csv")[1.0] == pytest.approx(force, rel=1e-12)


@pytest.fixture(scope="module", params=["with_fmi4cpp.cpp fmi4cpp", "with_omsimulator.c OMSimulator"])
def host(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A program that runs an FMU with FMI4cpp, and one with OMSimulator."""
    source, library = request.param.split()
    places = os.environ.get("LIBRARY_PATH", "").split(os.pathsep)
    found = [f"-Wl,-rpath,{place}" for place in places if place]
    missing = f"the compiler finds no {library}, {NOWHERE}"
    program = tmp_path_factory.mktemp(library) / "host"
    return compiled(source, program, f"-l{library}", *found, missing=missing)


KINDS = pytest.mark.parametrize(("fmu", "kind"), [("Python", "cs"), ("FMI 2", "cs"), ("FMI 2", "me")])


@KINDS
def test_libraries_of_others(
    host: Path, three_fmus: dict[str, Path], tmp_path: Path, fmu: str, kind: str
) -> None:
    done = run([host, three_fmus[fmu], kind], tmp_path, python=fmu == "Python", said=ROWS)
    assert printed(done) == pytest.approx(FORCES, rel=1e-12)


@KINDS
def test_they_end_with_the_message_after_an_input_that_no_tire_has(
    host: Path, three_fmus: dict[str, Path], tmp_path: Path, fmu: str, kind: str
) -> None:
    done = run([host, three_fmus[fmu], kind], tmp_path, python=fmu == "Python", said=NOT_A_NUMBER)
    assert done.returncode == 3
    assert "forces" not in done.stdout
    assert REFUSAL in done.stdout
