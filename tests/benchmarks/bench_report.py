"""A report of 16 000 and of a million samples: `python tests/benchmarks/bench_report.py`.

Printed are the CPU time of writing it, its size, and the time until Chromium has drawn it and can be used.
The bars, 1 s and 3 s until then, are asserted.
"""

from __future__ import annotations

import sys
import tempfile
import time
from pathlib import Path

from tirelab.report.page import write_report

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "tirelab"))
from browser import Watched, browser
from drives import long_ride

BARS = {16_000: 1000.0, 1_000_000: 3000.0}
"""Longest time [ms] until the page can be used, by its number of samples."""

DIAGNOSIS = {
    "schema": 2,
    "verdict": {
        "effects": [],
        "confidence": 0.9,
        "alternatives": [],
        "unexplained": False,
        "remainder": {"share": 0.0, "size": 0.1, "rms": 0.6, "depends_on": []},
        "summary": "A page for the clock.",
        "separating_test": None,
    },
    "where": [],
    "tire": "tire.json",
    "corrected_fmu": "BicycleTire.fmu",
    "report": "report.html",
    "data": None,
    "tire_before": "before",
    "tire_after": "after",
    "command": "tirelab diagnose long.csv",
    "fit": {
        "noise": 5.0,
        "before": 8.0,
        "after": 5.0,
        "held_out_before": None,
        "held_out_after": None,
        "load": 1000.0,
    },
}


def main() -> None:
    with tempfile.TemporaryDirectory() as folder, browser() as chromium:
        for samples, bar in BARS.items():
            given, path = long_ride(samples), Path(folder, f"{samples}.html")
            before = time.process_time()
            write_report(path, DIAGNOSIS, *given)
            written = time.process_time() - before
            ready = []
            for _ in range(3):
                shown = Watched(chromium, viewport={"width": 1280, "height": 800})
                shown.page.goto(path.as_uri())
                shown.page.wait_for_selector("#explore[data-ready]")
                ready.append(float(shown.page.locator("#explore").get_attribute("data-ready")))
                shown.context.close()
            size = path.stat().st_size / 1e6
            print(
                f"{samples} samples: written in {written:.2f} s, {size:.2f} MB, ready in {min(ready):.0f} ms"
            )
            assert min(ready) <= bar


if __name__ == "__main__":
    main()
