"""What identification costs beside one numpy pass of `A * x**B`, in time and in memory.

Run with `python tests/benchmarks/bench_identify.py`. The recordings are the rig's with 10 N of noise: fourteen of 1e5
samples each, then a single one of 1e6. A function evaluation is one pass through all samples that gathers the errors
and their derivatives. Ratios and counts are asserted, seconds are reported.
"""

from __future__ import annotations

import gc
import math
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable
from pathlib import Path

import numpy as np
from radialtire import TireModel
from tirelab.article import press as rig
from tirelab.identification.identify import identify
from tirelab.identification.power_fit import inner_products
from tirelab.identification.surfaces import surfaces_of
from tirelab.recordings.recording import Recording

EVALUATION_MOST = 10.0
"""Most passes of numpy that one function evaluation may cost."""

MEMORY_MOST = 4.0
"""Most memory, the recordings included, as a multiple of theirs."""

SECONDS_MOST = 5.0
"""Time for the fourteen recordings."""


def best_of(run: Callable[[], object], repeats: int = 7) -> float:
    """Return the least time [s] of `repeats` runs."""
    times = []
    for _ in range(repeats):
        start = time.perf_counter()
        run()
        times.append(time.perf_counter() - start)
    return min(times)


def fourteen() -> tuple[Recording, ...]:
    """Return the rig's recordings with 1e5 samples each."""
    return rig.record_all(noise=rig.ForceNoise(10.0), sampling_rate=1e5 / rig.PERIOD)


def one() -> tuple[Recording, ...]:
    """Return a recording of 1e6 samples on flat ground."""
    return (rig.record(TireModel(), math.inf, noise=rig.ForceNoise(10.0), sampling_rate=1e6 / rig.PERIOD),)


def size(recordings: tuple[Recording, ...]) -> int:
    """Return the bytes of time, deflection, radius and force."""
    return sum(a.nbytes for r in recordings for a in (r.time, r.deflection, r.surface_radius, r.force))


def peak_memory() -> int:
    """Return the most memory that this process has used [B]; from Linux, whose getrusage counts the parent's too."""
    lines = Path("/proc/self/status").read_text(encoding="ascii").splitlines()
    return 1024 * next(int(line.split()[1]) for line in lines if line.startswith("VmHWM"))


def memory_of(recordings: tuple[Recording, ...]) -> float:
    """Return the peak memory of a process that holds and identifies `recordings`, as a multiple of their size."""
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "recordings.npz"
        np.savez(path, *(np.stack([r.time, r.deflection, r.surface_radius, r.force]) for r in recordings))
        finished = subprocess.run(
            [sys.executable, __file__, str(path)], capture_output=True, text=True, check=True
        )
    return float(finished.stdout)


def measure_memory(path: str) -> float:
    """Return what `memory_of` asks for, in the process that it starts."""
    identify(rig.record_all(noise=rig.ForceNoise(10.0)))
    gc.collect()
    before = peak_memory()
    with np.load(path) as arrays:
        recordings = tuple(Recording(name, *arrays[name]) for name in arrays.files)
    identify(recordings)
    return (peak_memory() - before) / size(recordings)


def main() -> None:
    """Measure, print, and fail where a bound is broken."""
    recordings = fourteen()
    deflections = [100.0 * r.deflection for r in recordings]
    numpy_pass = best_of(lambda: [550.9 * x**1.422 for x in deflections])
    surfaces = surfaces_of(recordings)
    evaluation = best_of(lambda: [inner_products(s, 550.9, 1.422) for s in surfaces])
    start = time.perf_counter()
    found = identify(recordings)
    seconds = time.perf_counter() - start
    large = one()
    start = time.perf_counter()
    identify(large)
    single = time.perf_counter() - start
    memory = memory_of(recordings), memory_of(large)

    print(f"one numpy pass of A * x**B over 14 x 1e5 samples: {1e3 * numpy_pass:.1f} ms")
    print(f"one function evaluation: {1e3 * evaluation:.1f} ms, {evaluation / numpy_pass:.2f} numpy passes")
    print(f"14 x 1e5 samples identified in {seconds:.2f} s, {seconds / numpy_pass:.0f} numpy passes")
    print(f"1 x 1e6 samples identified in {single:.2f} s")
    print(f"peak memory: {memory[0]:.2f} (14 x 1e5) and {memory[1]:.2f} (1e6) times the recordings' size")
    print(
        f"E0 = {found.constants[2].value:.6f} ± {found.constants[2].uncertainty:.6f} 1/cm, recorded with 0.2519"
    )
    assert evaluation <= EVALUATION_MOST * numpy_pass
    assert seconds <= SECONDS_MOST
    assert max(memory) <= MEMORY_MOST
    assert np.isclose(found.constants[2].value, 0.2519, rtol=0.0, atol=5.0 * found.constants[2].uncertainty)


if __name__ == "__main__":
    if len(sys.argv) > 1:
        print(measure_memory(sys.argv[1]))
    else:
        main()
