"""Whether a verdict depends on the size of what was recorded, or on the order of the recordings.

    python tests/benchmarks/bench_scales.py DIR [--trials 16]

DIR is the folder of a `tirelab prove`. Its first trials are diagnosed as they are, and with forces, deflections and
times that are many times as large or as small, the law of the believed tire in proportion, and with the recordings in
reverse order. The lag of a gauge and the filter of an amplifier have a usual size of their own, and the curvature of a
surface stays as it is, so a few verdicts may change. The exit status is 1 where more than a tenth do.
"""

from __future__ import annotations

import argparse
import math
import sys
from collections.abc import Iterator, Sequence
from dataclasses import replace
from pathlib import Path

from radialtire import Recalibrated, TireModel, read_tire
from tirelab import diagnose, read_recording
from tirelab.recordings.recording import Recording
from tirelab.validation.folders import Folders

SCALES = {
    "force x 10000": (1e4, 1.0, 1.0),
    "force / 10000": (1e-4, 1.0, 1.0),
    "deflection x 8": (1.0, 8.0, 1.0),
    "deflection / 100": (1.0, 0.01, 1.0),
    "time x 100": (1.0, 1.0, 100.0),
    "time / 30": (1.0, 1.0, 1.0 / 30.0),
}
"""Factors on the forces, the deflections and the times; a gauge reads a wheel's radius at most."""


def scaled(recording: Recording, force: float, length: float, time: float) -> Recording:
    """Return a recording of another size, on the same surface."""
    r = recording
    return Recording(r.name, time * r.time, length * r.deflection, r.surface_radius, force * r.force)


def scaled_tire(tire: TireModel, radii: Sequence[float], force: float, length: float) -> TireModel:
    """Return the tire whose force at a deflection times `length` is the old one times `force`."""
    laws = [tire.law.coefficients(radius) for radius in radii]
    changes = [math.log(force) - exponent * math.log(length) for _, exponent in laws]
    rows = tuple((radius, change, 0.0) for radius, change in zip(radii, changes, strict=True))
    return replace(tire, law=Recalibrated(tire.law, rows), tested_range=None)


def variants(
    recordings: Sequence[Recording], tire: TireModel
) -> Iterator[tuple[str, Sequence[Recording], TireModel]]:
    """Yield the recordings as they are, then all that should have the same verdict."""
    yield "as recorded", recordings, tire
    radii = sorted({float(radius) for r in recordings for radius in r.surface_radius})
    for name, (force, length, time) in SCALES.items():
        own = [scaled(r, force, length, time) for r in recordings]
        yield name, own, tire if force == length == 1.0 else scaled_tire(tire, radii, force, length)
    if len(recordings) > 1:
        yield "reverse order", recordings[::-1], tire


def main() -> int:
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("folder", type=Path, metavar="DIR")
    parser.add_argument("--trials", type=int, default=16)
    given = parser.parse_args()
    folders = Folders(given.folder)
    count = same = 0
    for path in sorted(folders.root.glob("tires/*.json"))[: given.trials]:
        key, first = path.stem, None
        recordings = [read_recording(file) for file in folders.recordings(key, "train")]
        if sum(len(set(r.surface_radius.tolist())) for r in recordings) > 20:
            continue  # terrain: its law has no row for each radius
        for name, own, tire in variants(recordings, read_tire(folders.tire(key))):
            verdict = diagnose(own, tire)
            names = tuple(sorted(verdict.names))
            if first is None:
                first = names
                continue
            count, same = count + 1, same + (names == first)
            if names != first:
                told = " and ".join(names) or "nothing"
                print(
                    f"{key}, {name}: {told} ({verdict.confidence:.2f}), not {' and '.join(first) or 'nothing'}"
                )
    print(f"{same} of {count} verdicts are those of the recordings as they are")
    return int(same < 0.9 * count)


if __name__ == "__main__":
    sys.exit(main())
