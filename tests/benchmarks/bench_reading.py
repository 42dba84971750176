"""How fast a clean recording of a million rows is read, and in how much memory, beside polars alone.

Run: python tests/benchmarks/bench_reading.py

The time and the memory of the process are printed beside what is wanted of them; a busy or slow machine may miss it.
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
from aims import beside
from tirelab.recordings.recording import read_recording

ROWS = 1_000_000
ROUNDS = 25
SLOWEST = 2.0
LARGEST = 4.0
WANTED_SECONDS = 1.0
WANTED_GIGABYTES = 1.0

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
print((peak - start) / sum(values.nbytes for _, values in recording.channels()), peak / 1e9)
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


def best_times(path: Path) -> tuple[float, float, float]:
    """The best time [s] of reading the recording, of parsing its text alone, in alternating rounds, and the least CPU
    time [s] of reading.
    """
    reading, parsing, computing = [], [], []
    for _ in range(ROUNDS):
        start = time.perf_counter()
        pl.read_csv(path)
        parsing.append(time.perf_counter() - start)
        start, worked = time.perf_counter(), time.process_time()
        read_recording(path)
        reading.append(time.perf_counter() - start)
        computing.append(time.process_time() - worked)
    return min(reading), min(parsing), min(computing)


def peak_memory(small: Path, large: Path) -> tuple[float, float]:
    """The peak growth of a fresh process while it reads, over the size of the recording's arrays, and its peak [GB]."""
    command = [sys.executable, "-c", _MEMORY, str(small), str(large)]
    growth, peak = subprocess.run(command, check=True, capture_output=True, text=True).stdout.split()
    return float(growth), float(peak)


def main() -> None:
    with tempfile.TemporaryDirectory() as folder:
        small, large = Path(folder, "small.csv"), Path(folder, "large.csv")
        write_clean(small, 1000)
        write_clean(large, ROWS)
        reading, parsing, computing = best_times(large)
        print(f"{ROWS} rows: reading {beside(reading, 's', WANTED_SECONDS)}, {computing:.2f} s of CPU")
        ratio, memory = reading / parsing, 0.0
        print(f"polars alone {parsing:.3f} s, ratio {ratio:.2f}")
        if Path("/proc/self/status").exists():
            memory, peak = peak_memory(small, large)
            print(f"memory {beside(peak, 'GB', WANTED_GIGABYTES)}")
            print(f"peak memory over the size of the recording: {memory:.2f}")
    assert ratio < SLOWEST
    assert memory < LARGEST


if __name__ == "__main__":
    main()
