"""The native FMU as an archive, from the command, and in fmpy with its own solver."""

from __future__ import annotations

import subprocess
import sys
import zipfile
from pathlib import Path
from xml.etree import ElementTree

import numpy as np
import pytest
from fmpy import simulate_fmu
from fmpy.model_description import read_build_description
from loader_bench import HERE, guid_of, unpacked_archive
from native_tires import drive, read, stepped, written
from radialtire import CATALOGUE, PowerLaw, TireModel
from tirelab.fmu.loader import Compiler
from tirelab.fmu.native.pack import build_native_fmu

DAMPED = TireModel(
    effects=tuple(
        (CATALOGUE[n], CATALOGUE[n].nominal) for n in ("viscous_damping", "viscoelastic_relaxation")
    )
)


def test_the_same_tire_gives_the_same_bytes_in_any_folder(tmp_path: Path) -> None:
    one, other = (build_native_fmu(DAMPED, tmp_path / name).path for name in ("one", "other"))
    assert one.read_bytes() == other.read_bytes()


def test_a_corrected_tire_differs_by_data_only(tmp_path: Path) -> None:
    one, other = (
        build_native_fmu(TireModel(), tmp_path / "a").path,
        build_native_fmu(DAMPED, tmp_path / "b").path,
    )
    with zipfile.ZipFile(one) as a, zipfile.ZipFile(other) as b:
        assert a.namelist() == b.namelist()
        changed = {name for name in a.namelist() if a.read(name) != b.read(name)}
    data = {"resources/tire.dat", "resources/tire.json"}
    assert changed == data | {"modelDescription.xml", "documentation/index.html"}


def test_five_platforms_and_sources_in_200_kilobytes(repository: Path, tmp_path: Path) -> None:
    command = [sys.executable, repository / "build_fmu.py", "--native", "--out", tmp_path]
    done = subprocess.run(command, capture_output=True, text=True, check=True)
    assert "Co-Simulation and Model Exchange, valid" in done.stdout
    fmu = tmp_path / "BicycleTire.fmu"
    with zipfile.ZipFile(fmu) as archive:
        names = set(archive.namelist())
    assert {
        "binaries/linux64/BicycleTire.so",
        "binaries/aarch64-linux/BicycleTire.so",
        "binaries/win64/BicycleTire.dll",
        "binaries/darwin64/BicycleTire.dylib",
        "binaries/aarch64-darwin/BicycleTire.dylib",
        "sources/kernel.c",
        "sources/buildDescription.xml",
    } <= names
    assert not any(name.endswith(".py") for name in names)
    assert fmu.stat().st_size < 200_000


def test_its_sources_make_the_same_tire_as_their_description_says(compiler: Compiler, tmp_path: Path) -> None:
    """Compiled with what buildDescription.xml names and nothing else, in a host that brings no mathematics along."""
    fmu = unpacked_archive(build_native_fmu(DAMPED, tmp_path).path, tmp_path / "fmu")
    assert len(read_build_description(str(fmu))) == 1  # valid by the schema of FMI 3.0
    description = ElementTree.parse(fmu / "sources" / "buildDescription.xml").getroot()
    files = description.find("BuildConfiguration/SourceFileSet")
    assert files is not None
    options = [f"-std={str(files.get('language')).lower()}", *str(files.get("compilerOptions")).split()]
    libraries = [f"-l{library.get('name')}" for library in description.iterfind("*/Library")]
    sources = [str(file.get("name")) for file in files.iterfind("SourceFile")]
    library, host, out = tmp_path / "made.so", tmp_path / "host", tmp_path / "out.bin"
    shared = [*compiler.command, *options, "-fPIC", "-shared", "-o", library, *sources, *libraries]
    subprocess.run(shared, cwd=fmu / "sources", check=True)
    subprocess.run([*compiler.command, "-std=c11", "-o", host, HERE / "drive.c", "-ldl"], check=True)
    moments = drive(200, 1)
    words = [
        host,
        library,
        guid_of(fmu),
        (fmu / "resources").as_uri(),
        written(moments, tmp_path / "in"),
        out,
    ]
    done = subprocess.run(words, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    assert read(out) == stepped(DAMPED, moments)


def test_fmpys_cvode_finds_where_the_contact_begins(tmp_path: Path) -> None:
    """The deflection passes 0 at 0.1 s and 0.3 s: two events, and the law's force on either side."""
    fmu = build_native_fmu(TireModel(), tmp_path).path
    time = np.linspace(0.0, 0.4, 401)
    columns = [("time", float), ("deflection", float), ("surface_radius", float)]
    rows = zip(time, 1e-3 * np.cos(5.0 * np.pi * time), np.full(time.size, 1e5), strict=True)
    found = simulate_fmu(
        str(fmu),
        fmi_type="ModelExchange",
        solver="CVode",
        input=np.array(list(rows), dtype=columns),
        output=["deflection", "radial_force"],
        stop_time=0.4,
        output_interval=0.01,
        relative_tolerance=1e-6,
    )
    x = 100.0 * np.maximum(found["deflection"], 0.0)
    np.testing.assert_allclose(found["radial_force"], 550.9 * x**1.422, rtol=1e-9, atol=1e-9)
    assert len(found) > 41
    for crossing in (0.1, 0.3):
        assert np.min(np.abs(found["time"] - crossing)) < 1e-6


@pytest.mark.parametrize("name", ["deflection_rate", "deflection_acceleration", "motion_given"])
def test_only_a_tire_that_needs_its_motion_has_inputs_for_it(tmp_path: Path, name: str) -> None:
    for tire, expected in ((TireModel(), False), (DAMPED, True)):
        with zipfile.ZipFile(build_native_fmu(tire, tmp_path).path) as archive:
            assert (f'name="{name}"' in archive.read("modelDescription.xml").decode()) == expected


@pytest.mark.parametrize("given", [True, False])
def test_in_co_simulation_the_motion_is_taken_as_given_where_it_is_said(tmp_path: Path, given: bool) -> None:
    """F = k x + c v of the inputs; else the rate of the deflection alone, which rests here."""
    stiffness, damping, x, v = 150_000.0, 300.0, 0.01, 0.1
    effect = CATALOGUE["viscous_damping"]
    values = tuple({"damping": damping}.get(p.name, p.start) for p in effect.parameters)
    tire = TireModel(law=PowerLaw(stiffness / 100.0, 1.0), effects=((effect, values),))
    names = ("time", "deflection", "surface_radius", "deflection_rate")
    rows = [(0.0, x, 1e5, v), (0.1, x, 1e5, v)]
    found = simulate_fmu(
        str(build_native_fmu(tire, tmp_path).path),
        fmi_type="CoSimulation",
        stop_time=0.1,
        output_interval=0.01,
        input=np.array(rows, dtype=[(n, float) for n in names]),
        start_values={"motion_given": given},
    )
    expected = stiffness * x + (damping * v if given else 0.0)
    assert found["radial_force"][-1] == pytest.approx(expected, rel=1e-9)
