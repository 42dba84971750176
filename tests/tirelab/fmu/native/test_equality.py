"""The native FMU in hosts without Python beside the Python of the same tire: the same bits."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
from collections.abc import Callable, Iterable, Sequence
from pathlib import Path

import pytest
from loader_bench import guid_of, unpacked_archive
from native_tires import drive, options, read, sensitivity, stepped, tires, written
from radialtire import CATALOGUE, TireModel
from tirelab.fmu.loader import Compiler
from tirelab.fmu.native.pack import build_native_fmu

HOST = Path(__file__).parents[1] / "drive.c"
MOMENTS, FEW, FEWEST = 10_000, 2000, 500
RANDOM_SETS = 20
INSTALL = "sh tests/tirelab/fmu/hosts/install.sh"

Run = Callable[[TireModel, list[tuple[float, float, float]], Path], list[float]]


def runner(command: Sequence[str], library: str, where: Callable[[Path], str] = str) -> Run:
    """A function that drives the native FMU of a tire in a host; where: how the host names a path."""

    def run(tire: TireModel, moments: list[tuple[float, float, float]], folder: Path) -> list[float]:
        fmu = unpacked_archive(build_native_fmu(tire, folder).path, folder / "fmu")
        out = folder / "out.bin"
        words = [where(fmu / library), guid_of(fmu), (fmu / "resources").as_uri()]
        files = [where(written(moments, folder / "in.bin")), where(out)]
        environment = {"HOME": os.environ.get("HOME", str(folder)), "PATH": "", "WINEDEBUG": "-all"}
        done = subprocess.run(
            [*command, *words, *files], capture_output=True, text=True, env=environment, timeout=300
        )
        assert done.returncode == 0, done.stderr
        return read(out)

    return run


def differing(
    run: Run, folder: Path, count: int, chosen: Iterable[tuple[str, TireModel]]
) -> dict[str, float]:
    """Run every tire and return the largest relative difference of those that are not equal bit by bit."""
    found = {}
    for number, (name, tire) in enumerate(chosen):
        moments = drive(count, number)
        expected = stepped(tire, moments)
        forces = run(tire, moments, folder / str(number))
        scale = max(map(abs, expected))
        if forces != expected:
            found[name] = max(abs(a - b) for a, b in zip(forces, expected, strict=True)) / scale
        shutil.rmtree(folder / str(number))
    return found


def host_in_c(compiler: Compiler, folder: Path) -> Run:
    """A host without Python, compiled for this machine."""
    host = folder / "drive"
    subprocess.run([*compiler.command, "-std=c11", "-O2", "-o", host, HOST, "-ldl"], check=True)
    return runner([str(host)], "binaries/linux64/BicycleTire.so")


def test_the_same_bits_in_a_host_in_c(compiler: Compiler, tmp_path: Path) -> None:
    """Every law and effect, plain and with options, and random sets; state saved and restored in mid-run."""
    run = host_in_c(compiler, tmp_path)
    assert differing(run, tmp_path, FEWEST, [*tires(RANDOM_SETS), *options()]) == {}


@pytest.mark.slow
def test_the_same_bits_at_ten_thousand_moments(compiler: Compiler, tmp_path: Path) -> None:
    """As above, long enough for wear, warmth and leaks to go their whole way."""
    run = host_in_c(compiler, tmp_path)
    assert differing(run, tmp_path, MOMENTS, [*tires(RANDOM_SETS), *options()]) == {}


def test_the_tires_have_every_optional_parameter() -> None:
    """Each one that the catalogue declares is another than its start: together with the effect's others, and alone."""
    declared = {
        (effect.name, parameter.name)
        for effect in CATALOGUE.values()
        for parameter in effect.parameters
        if parameter.optional
    }
    assert len(declared) > 40
    for chosen in (tires(0), options()):
        moved = {
            (effect.name, parameter.name)
            for name, tire in chosen
            if name != "every effect"
            for effect, values in tire.effects
            for parameter, value in zip(effect.parameters, values, strict=True)
            if parameter.optional and value != parameter.nominal_value
        }
        assert moved == declared


def test_the_last_digit_of_a_reading_decides_nothing() -> None:
    """So that a platform whose powers are rounded otherwise has the same force, with noisy readings too."""
    noisy = [(name, tire) for name, tire in tires(10) if tire.differentiates and tire.reading_noise > 0.0]
    assert any(
        {"deflection_lag", "viscous_damping"} <= {e.name for e, _ in tire.effects} for _, tire in noisy
    )
    for number, (name, tire) in enumerate(noisy):
        assert sensitivity(tire, drive(FEW, number)) < 1e-9, name


def zig(target: str, destination: Path, *flags: str) -> None:
    """Compile the host for another platform."""
    pytest.importorskip("ziglang")
    command = [
        sys.executable,
        "-m",
        "ziglang",
        "cc",
        "-target",
        target,
        "-O2",
        "-o",
        str(destination),
        str(HOST),
    ]
    subprocess.run([*command, *flags], check=True, capture_output=True)


@pytest.mark.slow
def test_the_same_bits_on_aarch64(tmp_path: Path) -> None:
    """Under qemu, with the C library of that platform."""
    emulator, library = shutil.which("qemu-aarch64"), Path("/usr/aarch64-linux-gnu")
    if emulator is None or not library.is_dir():
        pytest.skip(f"qemu-user and libc6-arm64-cross are not installed; {INSTALL}")
    host = tmp_path / "drive"
    zig("aarch64-linux-gnu.2.36", host, "-ldl")
    run = runner([emulator, "-L", str(library), str(host)], "binaries/aarch64-linux/BicycleTire.so")
    assert differing(run, tmp_path, MOMENTS, [*tires(RANDOM_SETS), *options()]) == {}


@pytest.mark.slow
def test_close_on_windows(tmp_path: Path) -> None:
    """Under Wine: another C library rounds powers otherwise, which the estimator of noisy rates enlarges."""
    emulator = shutil.which("wine")
    if emulator is None:
        pytest.skip(f"wine is not installed; {INSTALL}")
    host = tmp_path / "drive.exe"
    zig("x86_64-windows-gnu", host)

    def where(path: Path) -> str:
        return "Z:" + str(path).replace("/", "\\")

    run = runner([emulator, str(host)], "binaries/win64/BicycleTire.dll", where)
    chosen = [*tires(RANDOM_SETS), *options()]
    found = differing(run, tmp_path, MOMENTS, chosen)
    print({name: f"{value:.1e}" for name, value in found.items()})
    for name, tire in chosen:
        noisy = tire.differentiates and tire.reading_noise > 0.0
        assert found.get(name, 0.0) < (1e-9 if noisy else 1e-12), name
