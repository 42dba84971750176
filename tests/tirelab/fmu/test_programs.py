"""The FMUs in programs that have no Python in them, where these are on PATH: fmusim and the FMU Compliance Checker.

No registry has them: whoever has built them from their repositories runs these tests with them on PATH.
"""

from __future__ import annotations

import csv
import os
import shutil
import subprocess
from collections.abc import Sequence
from pathlib import Path

import pytest
from radialtire import TireModel
from tirelab.fmu.native.pack import build_native_fmu

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


def run(command: Sequence[str | Path], folder: Path, *, python: bool) -> subprocess.CompletedProcess[str]:
    """Run a program in a folder; with a native FMU it finds on PATH nothing but `rm`, which both programs call."""
    environment = dict(os.environ)
    if not python:
        (folder / "bin").mkdir()
        (folder / "bin" / "rm").symlink_to(shutil.which("rm") or "/bin/rm")
        environment = {"PATH": str(folder / "bin"), "HOME": str(folder)}
    return subprocess.run(command, cwd=folder, capture_output=True, text=True, timeout=120, env=environment)


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
    assert "0 Warning(s)" in summary
    assert "0 Error(s)" in summary
    assert forces(tmp_path / "out.csv")[1.0] == pytest.approx(force, rel=1e-12)
