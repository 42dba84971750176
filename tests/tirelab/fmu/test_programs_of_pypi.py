"""The FMUs in importers in C++ that packages of PyPI bring, each in a program without Python: libcosim, CasADi, ecos.

libcosim and CasADi are libraries around which the hosts in C and C++ are compiled; ecos is a program. cosim, libcosim's
own program, comes for Windows, and runs under Wine.
"""

from __future__ import annotations

import csv
import importlib.util
import math
import os
import shutil
import stat
from pathlib import Path

import pytest
from loader_bench import unpacked_archive
from programs import FORCES, INPUTS, NOT_A_NUMBER, REFUSAL, ROWS, compiled, printed, run

INSTALL = "sh tests/tirelab/fmu/hosts/install.sh"
SLOPES = [
    100.0 * 550.9 * 1.422 * 2.0**0.422,
    50.0 * FORCES[1] * (1.422 - 0.2469 * math.exp(-0.1651 * 25.4)),
    100.0 * FORCES[2] * (1.422 + 0.2128 * math.exp(-0.0289 * 38.1)),
]
"""dF/dx = B F / x [N/m] of the three inputs."""


def place_of(package: str) -> Path:
    """The folder of an installed package, which is not imported."""
    spec = importlib.util.find_spec(package)
    if spec is None or spec.origin is None:
        pytest.skip(f"{package} is not installed; it comes with the extra test")
    return Path(spec.origin).parent


@pytest.fixture(scope="module")
def libcosim(tmp_path_factory: pytest.TempPathFactory) -> list[Path]:
    """The words that run a host around libcosim."""
    library = place_of("libcosimpy") / "libcosimc" / "libcosimc.so"
    if not library.is_file():
        pytest.skip("libcosimpy has no library for this machine")
    program = tmp_path_factory.mktemp("libcosim") / "host"
    return [compiled("with_libcosim.c", program, "-ldl", missing="the compiler has no C library"), library]


@pytest.mark.parametrize("fmu", ["Python", "FMI 2"])
def test_libcosim(libcosim: list[Path], three_fmus: dict[str, Path], tmp_path: Path, fmu: str) -> None:
    """In Co-Simulation; it has no FMI 3.0."""
    words, python = [*libcosim, three_fmus[fmu], "cs"], fmu == "Python"
    assert printed(run(words, tmp_path, python=python, said=ROWS)) == pytest.approx(FORCES, rel=1e-12)
    refused = run(words, tmp_path, python=python, said=NOT_A_NUMBER)
    assert refused.returncode == 3
    assert "forces" not in refused.stdout
    assert refused.stdout.count(f"logStatusError] {REFUSAL}") == 1


@pytest.fixture(scope="module")
def casadi(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A host around CasADi's library in C++."""
    place = place_of("casadi")
    flags = ["-isystem", str(place / "include"), f"-L{place}", "-lcasadi", f"-Wl,-rpath,{place}"]
    program = tmp_path_factory.mktemp("casadi") / "host"
    return compiled("with_casadi.cpp", program, *flags, missing="this CasADi has no headers for C++")


@pytest.mark.slow
@pytest.mark.parametrize("fmu", ["FMI 2", "FMI 3"])
def test_casadi(casadi: Path, three_fmus: dict[str, Path], tmp_path: Path, fmu: str) -> None:
    """In Model Exchange, with the FMU's own directional derivatives; its headers take a compiler long."""
    words = [casadi, unpacked_archive(three_fmus[fmu], tmp_path / "fmu"), "me"]
    done = run(words, tmp_path, python=False, said=ROWS)
    assert printed(done) == pytest.approx(FORCES, rel=1e-12)
    assert printed(done, "slopes") == pytest.approx(SLOPES, rel=1e-6)
    refused = run(words, tmp_path, python=False, said=NOT_A_NUMBER)
    assert refused.returncode == 3
    assert "forces" not in refused.stdout


SCENARIO = """<?xml version="1.0" encoding="UTF-8"?>
<ecos:Scenario xmlns:ecos="http://github.com/Ecos-platform/libecos/resources/schema/ScenarioConfig">
{}</ecos:Scenario>
"""
ACTION = """  <ecos:action t="{}">
    <ecos:variable id="instance::deflection"><ecos:real value="{}"/></ecos:variable>
    <ecos:variable id="instance::surface_radius"><ecos:real value="{}"/></ecos:variable>
  </ecos:action>
"""


@pytest.mark.parametrize("fmu", ["Python", "FMI 2", "FMI 3"])
def test_ecos(three_fmus: dict[str, Path], tmp_path: Path, tbb: str, fmu: str) -> None:
    """The program of ecospy. It prints six decimals, steps on after an error, and tells messages where asked to."""
    if shutil.which("unzip") is None:
        pytest.skip(f"ecos calls unzip, which is not on PATH; {INSTALL}")
    program = Path(shutil.copy(place_of("ecospy") / "binaries" / "ecos", tmp_path))
    program.chmod(stat.S_IRWXU)
    given = [*INPUTS, (float("nan"), 1e5)]
    actions = (ACTION.format(0.25 * number, *pair) for number, pair in enumerate(given))
    (tmp_path / "scenario.xml").write_text(SCENARIO.format("".join(actions)))
    words = [program, "simulate", "--path", three_fmus[fmu], "--stopTime", "1", "--stepSize", "0.01"]
    words += ["--scenarioConfig", "scenario.xml", "-l", "debug", "--debugLogging"]
    done = run(words, tmp_path, python=fmu == "Python", more={"LD_LIBRARY_PATH": tbb})
    assert done.returncode == 0, done.stdout + done.stderr
    with (tmp_path / "BicycleTire.csv").open() as rows:
        table = [*csv.DictReader(rows, skipinitialspace=True)]
    found = [float(row["instance::radial_force[REAL]"]) for row in table]
    assert len(found) == 100
    assert [found[at] for at in (20, 45, 70)] == pytest.approx(FORCES, abs=1e-6)
    assert not found[-1] > 0.0
    assert REFUSAL in done.stdout + done.stderr


@pytest.mark.slow
def test_cosim_under_wine(cosim_on_windows: Path, three_fmus: dict[str, Path], tmp_path: Path) -> None:
    """The DLL in a C++ program of others with the FMI Library: it prints six digits, and ends with the message."""
    if shutil.which("wine") is None:
        pytest.skip(f"wine is not installed; {INSTALL}")
    shutil.copy(three_fmus["FMI 2"], tmp_path / "tire.fmu")
    environment = {"WINEDEBUG": "-all", "HOME": os.environ.get("HOME", str(tmp_path))}

    def words(deflection: float, radius: float) -> list[str | Path]:
        values = [f"deflection={deflection!r}", f"surface_radius={radius!r}"]
        return ["wine", cosim_on_windows, "run-single", "tire.fmu", *values, "--output-file", "out.csv"]

    for given, force in zip(INPUTS, FORCES, strict=True):
        done = run(words(*given), tmp_path, python=True, more=environment)
        assert done.returncode == 0, done.stdout + done.stderr
        with (tmp_path / "out.csv").open() as rows:
            *_, row = csv.DictReader(rows)
        assert float(row["radial_force [2 real output]"]) == pytest.approx(force, rel=5e-6)
    refused = run(words(float("nan"), 1e5), tmp_path, python=True, more=environment)
    assert refused.returncode == 1
    assert REFUSAL in refused.stderr
