"""The native FMU in other people's importers, each in a fresh process."""

from __future__ import annotations

import importlib.util
import json
import math
import os
import shutil
import stat
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from asked_forces import FORCES, INPUTS, forces
from loader_bench import unpacked_archive
from radialtire import PowerLaw, TireModel
from scipy.integrate import solve_ivp
from tirelab.fmu.native.pack import build_native_fmu

Run = Callable[..., Any]


@pytest.fixture(scope="module")
def fmus(tmp_path_factory: pytest.TempPathFactory) -> dict[int, Path]:
    """The article's tire in FMI 2.0 and 3.0."""
    return {
        fmi: build_native_fmu(TireModel(), tmp_path_factory.mktemp(f"fmi{fmi}"), fmi=fmi).path
        for fmi in (2, 3)
    }


@pytest.mark.parametrize("package", ["libcosimpy", "ecospy"])
def test_co_simulation_masters(run_host: Run, fmus: dict[int, Path], package: str) -> None:
    if importlib.util.find_spec(package) is None:
        pytest.skip(f"{package} is not installed")
    printed = run_host(f"with_{package}.py", fmus[2], job=INPUTS)
    assert forces(printed) == pytest.approx(FORCES, rel=1e-12)


@pytest.mark.parametrize(("fmi", "kind"), [(2, "CS"), (2, "ME"), (3, "ME")])
def test_pyfmi(run_host: Run, fmus: dict[int, Path], fmi: int, kind: str) -> None:
    """Of FMI 3.0 PyFMI has Model Exchange only."""
    if importlib.util.find_spec("pyfmi") is None:
        pytest.skip("PyFMI is not installed; PyPI has only its source, which wants the FMI Library")
    printed = run_host("with_pyfmi.py", fmus[fmi], kind, job=INPUTS)
    assert forces(printed) == pytest.approx(FORCES, rel=1e-12)


def test_ecos_with_fmi_3(run_host: Run, fmus: dict[int, Path]) -> None:
    if importlib.util.find_spec("ecospy") is None:
        pytest.skip("ecospy is not installed")
    assert forces(run_host("with_ecospy.py", fmus[3], job=INPUTS)) == pytest.approx(FORCES, rel=1e-12)


def test_proxyfmu_a_host_without_python(
    run_host: Run, fmus: dict[int, Path], proxyfmu: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """ecospy's proxyfmu is a program in C++ of its own, which has no Python in it."""
    shutil.copy(proxyfmu, tmp_path)
    (tmp_path / "proxyfmu").chmod(stat.S_IRWXU)
    monkeypatch.setenv("PATH", f"{tmp_path}{os.pathsep}{os.environ['PATH']}")
    printed = run_host("with_ecospy.py", f"proxyfmu://localhost?file={fmus[2]}", job=INPUTS)
    assert forces(printed) == pytest.approx(FORCES, rel=1e-12)


def test_fmutool_finds_it_compliant(run_host: Run, fmus: dict[int, Path]) -> None:
    pytest.importorskip("fmutool")
    printed = run_host("with_fmutool.py", fmus[2], job=None)
    assert "INFO: This FMU seems to be compliant with FMI-2.0." in printed
    assert "ERROR" not in printed


@pytest.mark.parametrize("fmi", [2, 3])
def test_a_mass_rings_on_it_in_casadi(run_host: Run, fmus: dict[int, Path], tmp_path: Path, fmi: int) -> None:
    """Model Exchange with directional derivatives: the motion of m x'' = W - A x^B from another integrator."""
    pytest.importorskip("casadi")
    mass, weight, start = 3.0, 2000.0, 0.015
    times = [0.004 * i for i in range(1, 11)]
    folder = unpacked_archive(fmus[fmi], tmp_path / "fmu")
    job = {"mass": mass, "weight": weight, "start": start, "times": times}
    found = json.loads(run_host("with_casadi.py", folder, job=job).splitlines()[-1])

    def law(x: float) -> float:
        return 550.9 * max(100.0 * x, 0.0) ** 1.422

    assert found["force"] == pytest.approx(law(start), rel=1e-14)
    assert found["slope"] == pytest.approx(1.422 * law(start) / start, rel=1e-9)
    assert found["by_coefficient"] == pytest.approx(law(start) / 550.9, rel=1e-6)
    exact = solve_ivp(
        lambda _, y: [y[1], (weight - law(y[0])) / mass],
        (0.0, times[-1]),
        [start, 0.0],
        "DOP853",
        t_eval=times,
        rtol=1e-12,
        atol=1e-14,
    )
    np.testing.assert_allclose(found["deflections"], exact.y[0], rtol=1e-8)


def test_the_law_of_another_tire_rings_at_its_frequency(run_host: Run, tmp_path: Path) -> None:
    """A straight line of 150 000 N/m in CasADi: x = x0 + a cos(omega t) to 1e-9."""
    pytest.importorskip("casadi")
    stiffness, mass, middle, amplitude = 150_000.0, 3.0, 0.01, 0.003
    fmu = build_native_fmu(TireModel(law=PowerLaw(stiffness / 100.0, 1.0)), tmp_path, fmi=3).path
    times = [0.003 * i for i in range(1, 15)]
    job = {
        "mass": mass,
        "weight": stiffness * middle,
        "start": middle + amplitude,
        "times": times,
    }
    printed = run_host("with_casadi.py", unpacked_archive(fmu, tmp_path / "fmu"), job=job)
    omega = math.sqrt(stiffness / mass)
    expected = middle + amplitude * np.cos(omega * np.array(times))
    np.testing.assert_allclose(json.loads(printed.splitlines()[-1])["deflections"], expected, atol=1e-9)
