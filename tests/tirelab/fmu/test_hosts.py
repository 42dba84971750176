"""The FMU in other people's importers, each in a fresh process."""

from __future__ import annotations

import importlib.util
import os
import shutil
import stat
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from asked_forces import FORCES, INPUTS, forces

Run = Callable[..., Any]


@pytest.mark.parametrize("package", ["libcosimpy", "ecospy"])
def test_co_simulation_masters(run_host: Run, article_fmu: Path, package: str) -> None:
    if importlib.util.find_spec(package) is None:
        pytest.skip(f"{package} is not installed")
    printed = run_host(f"with_{package}.py", article_fmu, job=INPUTS)
    assert forces(printed) == pytest.approx(FORCES, rel=1e-12)


def test_pyfmi(run_host: Run, article_fmu: Path) -> None:
    if importlib.util.find_spec("pyfmi") is None:
        pytest.skip("PyFMI is not installed; PyPI has only its source, which wants the FMI Library")
    assert forces(run_host("with_pyfmi.py", article_fmu, "CS", job=INPUTS)) == pytest.approx(
        FORCES, rel=1e-12
    )


def test_fmutool_finds_it_compliant(run_host: Run, article_fmu: Path) -> None:
    pytest.importorskip("fmutool")
    printed = run_host("with_fmutool.py", article_fmu, job=None)
    assert "INFO: This FMU seems to be compliant with FMI-2.0." in printed
    assert "ERROR" not in printed
    assert "input : 2" in printed


def test_proxyfmu_a_host_without_python(
    run_host: Run, article_fmu: Path, proxyfmu: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """ecospy's proxyfmu is a compiled program of its own: the FMU has to bring its Python along."""
    shutil.copy(proxyfmu, tmp_path)
    (tmp_path / "proxyfmu").chmod(stat.S_IRWXU)
    monkeypatch.setenv("PATH", f"{tmp_path}{os.pathsep}{os.environ['PATH']}")
    printed = run_host("with_ecospy.py", f"proxyfmu://localhost?file={article_fmu}", job=INPUTS)
    assert forces(printed) == pytest.approx(FORCES, rel=1e-12)
