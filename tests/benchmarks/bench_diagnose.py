"""A diagnosis beside lmfit on the same two recordings: `python tests/benchmarks/bench_diagnose.py [SAMPLES]`, and what
the whole command takes, from the files to the report.

The reference is what one would write in an afternoon: nine single effects, each fitted by lmfit with A and B of the law
free, the best one taken by BIC. It finds no sets, no noise model and no rivals; the diagnosis finds all of these.
Printed are seconds, their ratio, model evaluations, and samples per second and candidate.
"""

from __future__ import annotations

import os
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable
from dataclasses import dataclass
from multiprocessing import get_context
from pathlib import Path

import lmfit
import numpy as np
from aims import beside
from numpy.typing import NDArray
from scipy.signal import lfilter
from tirelab.diagnosis.diagnose import diagnose

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "tirelab"))
from drives import Drive, flat_force, read, ride

FloatArray = NDArray[np.float64]


@dataclass
class Count:
    """How often the reference's model was evaluated."""

    evaluations: int = 0


def reference(drives: list[Drive]) -> tuple[str, Count, float]:
    """Return the name that lmfit and BIC choose, the number of evaluations, and the seconds they took."""
    count = Count()
    started = time.perf_counter()
    scores = {}
    for name, (effect, start) in EFFECTS.items():
        parameters = lmfit.Parameters()
        parameters.add("A", 550.9, min=1.0)
        parameters.add("B", 1.422, min=0.5, max=3.0)
        for key, value in start.items():
            parameters.add(key, value)

        def residual(p: lmfit.Parameters, effect: Effect = effect) -> FloatArray:
            count.evaluations += 1
            values = p.valuesdict()
            return np.concatenate([effect(d, values) - d.force for d in drives])

        scores[name] = lmfit.minimize(residual, parameters).bic
    return min(scores, key=scores.__getitem__), count, time.perf_counter() - started


Effect = Callable[[Drive, dict[str, float]], FloatArray]


def _law(x: FloatArray, p: dict[str, float]) -> FloatArray:
    return np.asarray(p["A"] * np.maximum(100.0 * x, 0.0) ** p["B"])


def _rate(d: Drive) -> FloatArray:
    return np.gradient(d.deflection, d.time)


def _relaxation(d: Drive, p: dict[str, float]) -> FloatArray:
    force = _law(d.deflection, p)
    decay = np.exp(-(d.time[1] - d.time[0]) / max(abs(p["tau"]), 1e-3))
    return force + p["g"] * lfilter([1.0], [1.0, -decay], np.diff(force, prepend=force[0]))


def _friction(d: Drive, p: dict[str, float]) -> FloatArray:
    travel = np.diff(d.deflection, prepend=d.deflection[0])
    z, states = 0.0, []
    decay = np.exp(-np.abs(travel) / 1e-3).tolist()
    for side, rest in zip(np.sign(travel).tolist(), decay, strict=True):
        z = side + (z - side) * rest
        states.append(z)
    return _law(d.deflection, p) + p["slip"] * np.array(states)


EFFECTS: dict[str, tuple[Effect, dict[str, float]]] = {
    "offset": (lambda d, p: _law(d.deflection + p["x0"], p), {"x0": 1e-5}),
    "force": (lambda d, p: _law(d.deflection, p) + p["f0"], {"f0": 1.0}),
    "friction": (_friction, {"slip": 5.0}),
    "viscous_damping": (lambda d, p: _law(d.deflection, p) + p["c"] * _rate(d), {"c": 10.0}),
    "relaxation": (_relaxation, {"g": 0.01, "tau": 1.0}),
    "leak": (lambda d, p: _law(d.deflection, p) * np.exp(-p["r"] * d.time), {"r": 1e-4}),
    "inertia": (lambda d, p: _law(d.deflection, p) + p["m"] * np.gradient(_rate(d), d.time), {"m": 0.1}),
    "bottoming": (
        lambda d, p: _law(d.deflection, p) + p["k"] * np.maximum(d.deflection - p["xb"], 0.0),
        {"k": 1e3, "xb": 0.018},
    ),
    "lag": (lambda d, p: np.interp(d.time - p["t"], d.time, _law(d.deflection, p)), {"t": 1e-3}),
}


def drives_of(samples: int) -> list[Drive]:
    """Return two rides of `samples` samples with 400 N s/m of damping."""
    drives = []
    for seed in (1, 2):
        time_, deflection, rate = ride(seed, samples, 0.0025)
        drives.append(read(f"ride {seed}", time_, deflection, flat_force(deflection) + 400.0 * rate, seed))
    return drives


MOST_SECONDS, MOST_SECONDS_LONG, LONG, MOST_BYTES = 5.0, 60.0, 100_000, 1e9


def save(folder: str, samples: int) -> None:
    """Write two rides, or a long one alone."""
    for drive in drives_of(samples)[: 1 if samples >= LONG else 2]:
        table = np.column_stack([drive.time, drive.deflection, drive.force])
        name = str(Path(folder) / f"{drive.name}.csv")
        np.savetxt(name, table, "%.9g", ",", header="time [s],deflection [m],force [N]", comments="")


def whole_command(samples: int) -> tuple[float, float]:
    """Return the CPU time [s], user and system, of `tirelab diagnose` on saved rides, and its memory [bytes].

    The rides are saved by a process of its own: a command starts with the memory of the one that started it.
    """
    with tempfile.TemporaryDirectory() as folder:
        writer = get_context("spawn").Process(target=save, args=(folder, samples))
        writer.start()
        writer.join()
        names = sorted(map(str, Path(folder).glob("*.csv")))
        command = [
            sys.executable,
            "-m",
            "tirelab",
            "diagnose",
            *names,
            "--radius",
            "flat",
            "--quiet",
            "--out",
        ]
        running = subprocess.Popen([*command, str(Path(folder) / "out")], stdout=subprocess.DEVNULL)
        _, status, used = os.wait4(running.pid, 0)
        running.returncode = os.waitstatus_to_exitcode(status)
    assert running.returncode == 0
    return used.ru_utime + used.ru_stime, 1024.0 * used.ru_maxrss


def main(samples: int) -> None:
    """Print the comparison."""
    whole, size = whole_command(samples)
    diagnose(drives_of(2000))  # compile once
    drives = drives_of(samples)
    total = sum(d.time.size for d in drives)
    started = time.perf_counter()
    verdict = diagnose(drives)
    seconds = time.perf_counter() - started
    name, count, reference_seconds = reference(drives)
    said = ", ".join(verdict.names) or "nothing missing"
    print(f"two recordings of {samples} samples")
    _row("diagnosis", seconds, verdict.compared, total, verdict.evaluations, said)
    _row("lmfit", reference_seconds, len(EFFECTS), total, count.evaluations, name)
    more = verdict.compared / len(EFFECTS)
    print(
        f"lmfit takes {reference_seconds / seconds:.2f} times as long; the diagnosis compares {more:.0f} times the sets"
    )
    seconds, size = whole_command(drives if samples < LONG else drives[:1])
    aim = MOST_SECONDS if samples < LONG else MOST_SECONDS_LONG
    print(
        f"the whole command: {beside(whole, 's', aim)} of CPU, {beside(size / 1e9, 'GB', MOST_BYTES / 1e9)}"
    )


def _row(who: str, seconds: float, sets: int, samples: int, evaluations: int, said: str) -> None:
    speed = samples * sets / seconds
    print(
        f"{who:10s}{seconds:7.2f} s {sets:5d} sets {speed:9.3g} samples/s/set {evaluations:5d} simulations: {said}"
    )


if __name__ == "__main__":
    main(int(sys.argv[1]) if len(sys.argv) > 1 else 16_000)
