"""The native FMU in a C host beside a reference in C (`pytest -s -n 0 tests/benchmarks/bench_native.py`).

Nanoseconds of one chain of two inputs, a step and an output, the least of 1000 short turns; each bar is asserted. A
loaded machine gives larger figures, of two threads above all: the reference tells how much larger.
"""

from __future__ import annotations

import subprocess
from pathlib import Path

import pytest
from loader_bench import HERE, Bench, numbers, unpacked_archive
from native_tires import NOISE
from radialtire import CATALOGUE, TireModel
from tirelab.fmu.loader import find_compiler
from tirelab.fmu.native.pack import build_native_fmu

STEPS, LIVES = 500, 50
BARE, SINGLE, ALL, LIFE = 1.5, 1000.0, 3000.0, 1e5
"""The bars: bare against the reference; one effect, all effects and a life of an instance [ns]."""


@pytest.fixture(scope="module")
def host(tmp_path_factory: pytest.TempPathFactory) -> Bench:
    """The C host and the reference; there is no FMU of the loader."""
    compiler = find_compiler()
    assert compiler is not None
    folder = tmp_path_factory.mktemp("host")
    program, reference = folder / "host", folder / "native.so"
    flags = [*compiler.command, "-std=c11", "-O2", "-pthread"]
    subprocess.run([*flags, "-o", program, HERE / "host.c", "-ldl", "-lm"], check=True)
    subprocess.run([*flags, "-shared", "-fPIC", "-o", reference, HERE / "native.c", "-lm"], check=True)
    return Bench(program, reference, reference, folder)


def unpacked(tire: TireModel, folder: Path) -> Path:
    return unpacked_archive(build_native_fmu(tire, folder).path, folder / "fmu")


def with_effects(*names: str, noise: float = 0.0) -> TireModel:
    effects = tuple((CATALOGUE[name], CATALOGUE[name].nominal) for name in names)
    return TireModel(effects=effects, reading_noise=noise)


def test_the_bars(host: Bench, tmp_path: Path) -> None:
    bare = unpacked(TireModel(), tmp_path / "bare")
    ours, reference, ratio = numbers(host.run("bench", 30_000, host.native, fmu=bare))
    rows = [("reference in C", 1e9 * reference), ("bare", 1e9 * ours)]
    for name, effect in CATALOGUE.items():
        tires = {name: with_effects(name)}
        if effect.differentiates:
            tires[f"{name}, noisy readings"] = with_effects(name, noise=NOISE)
        for title, tire in tires.items():
            (pace,) = numbers(host.run("pace", STEPS, fmu=unpacked(tire, tmp_path / title)))
            rows.append((title, pace))
    every = unpacked(with_effects(*CATALOGUE, noise=NOISE), tmp_path / "every")
    (all_effects,) = numbers(host.run("pace", STEPS, fmu=every))
    life = min(numbers(host.run("lives", LIVES, fmu=bare))[0] for _ in range(20))
    (crowd,) = numbers(host.run("crowd", 1_000_000, 1000, fmu=bare))
    rows += [("all effects, noisy readings", all_effects)]
    rows += [("an instance made and freed", life), ("a step of 1000 instances in two threads", crowd)]
    print()
    for title, nanoseconds in rows:
        print(f"{title:45} {nanoseconds:9.0f} ns")
    print(f"bare against the reference: {ratio:.2f}, the median of 101 turns")
    assert ratio <= BARE
    assert {title: pace for title, pace in rows[2:-3] if pace >= SINGLE} == {}
    assert all_effects < ALL
    assert life < LIFE
