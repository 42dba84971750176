"""How fast a clean recording of a million rows is read, and in how much memory, beside polars alone.

Run: python tests/benchmarks/bench_reading.py

Two ratios are asserted. Time: the best of several alternating rounds, reading against `polars.read_csv` of
the same file (the parser that reading is built on), at most 2. Memory: what the process grows by at its peak
while it reads, against the recording's own arrays, below 4. A busy machine slows the parser's threads as much
as ours, and the best round is the one least disturbed, so the ratios need no further margin.
"""

import subprocess
import sys
import tempfile
import time
from pathlib import Path

import numpy as np
import polars as pl
from tirelab.recordings.recording import read_recording

ROWS = 1_000_000
ROUNDS = 25
SLOWEST = 2.0
LARGEST = 4.0

_MEMORY = """
import sys, threading, time
from pathlib import Path
from tirelab.recordings.recording import read_recording

def anonymous():
    lines = Path("/proc/self/status").read_text().splitlines()
    return 1024 * next(int(line.split()[1]) for line in lines if line.startswith("RssAnon"))

small, large = map(Path, sys.argv[1:])
read_recording(small)
peak = start = anonymous()
done = threading.Event()

def watch():
    global peak
    while not done.is_set():
        peak = max(peak, anonymous())
        time.sleep(0.0005)

watcher = threading.Thread(target=watch)
watcher.start()
recording = read_recording(large)
done.set()
watcher.join()
print((peak - start) / sum(values.nbytes for _, values in recording.channels()))
"""


def write_clean(path: Path, rows: int) -> None:
    """A triangle-like loading of the flat law with the noise and the digits of a real logger."""
    noise = np.random.default_rng(1996)
    time_s = np.arange(rows) / 1000.0
    deflection = 1.5 * (1.0 - np.cos(time_s)) + 1e-3 * noise.normal(size=rows)
    force = 550.9 * np.clip(deflection, 0.0, None) ** 1.422 + 6.0 * noise.normal(size=rows)
    columns = {
        "time [s]": time_s.round(3),
        "deflection [cm]": deflection.round(5),
        "radius [cm]": np.full(rows, np.inf),
        "force [N]": force.round(3),
    }
    pl.DataFrame(columns).write_csv(path)


def best_times(path: Path) -> tuple[float, float]:
    """The best time [s] of reading the recording, and of parsing its text alone, in alternating rounds."""
    reading, parsing = [], []
    for _ in range(ROUNDS):
        start = time.perf_counter()
        pl.read_csv(path)
        parsing.append(time.perf_counter() - start)
        start = time.perf_counter()
        read_recording(path)
        reading.append(time.perf_counter() - start)
    return min(reading), min(parsing)


def peak_memory(small: Path, large: Path) -> float:
    """The peak growth of a fresh process while it reads, over the size of the recording's arrays."""
    command = [sys.executable, "-c", _MEMORY, str(small), str(large)]
    return float(subprocess.run(command, check=True, capture_output=True, text=True).stdout)


def main() -> None:
    with tempfile.TemporaryDirectory() as folder:
        small, large = Path(folder, "small.csv"), Path(folder, "large.csv")
        write_clean(small, 1000)
        write_clean(large, ROWS)
        reading, parsing = best_times(large)
        ratio = reading / parsing
        print(f"{ROWS} rows: reading {reading:.3f} s, polars alone {parsing:.3f} s, ratio {ratio:.2f}")
        assert ratio < SLOWEST
        if Path("/proc/self/status").exists():
            memory = peak_memory(small, large)
            print(f"peak memory over the size of the recording: {memory:.2f}")
            assert memory < LARGEST


if __name__ == "__main__":
    main()
