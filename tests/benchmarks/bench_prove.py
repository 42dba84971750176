"""Duration of a proof: a dozen trials on all cores, and an estimate for 200.

Run: python tests/benchmarks/bench_prove.py

Nothing is asserted but that no trial failed: seconds depend on the machine. The limit is 200 trials in under 30 minutes
on two cores.
"""

import json
import os
import tempfile
import time
from pathlib import Path

import joblib
import numpy as np
from tirelab.computing.workers import Cores
from tirelab.validation import BlindTrials, Folders, prove

TRIALS = 12
SEED = 4096


def main() -> None:
    """Run the trials and print what they took."""
    with tempfile.TemporaryDirectory() as name:
        folders = Folders(Path(name))
        began = time.perf_counter()
        proof = prove(BlindTrials(folders, SEED, TRIALS), Cores(), lambda line: None)
        wall = time.perf_counter() - began
        outcomes = [json.loads(path.read_text()) for path in sorted(Path(name, "outcomes").iterdir())]
        seconds = np.array([outcome["seconds"] for outcome in outcomes])
        second = len(list(Path(name, "second_outcomes").glob("*")))
    assert not proof.failures, proof.failures
    ahead, *_ = os.getloadavg() if hasattr(os, "getloadavg") else (float("nan"),)
    print(
        f"{TRIALS} trials on {joblib.cpu_count()} cores in {wall:.0f} s (load {ahead:.1f}), {second} diagnosed twice"
    )
    print(f"one diagnosis: median {np.median(seconds):.1f} s, longest {seconds.max():.1f} s")
    print(f"200 trials: {200 / TRIALS * wall / 60:.0f} min (limit: 30 min on two cores)")


if __name__ == "__main__":
    main()
