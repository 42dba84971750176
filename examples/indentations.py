"""Indentation curves of an atomic force microscope and a nanoindenter: reading them, and where contact begins."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import least_squares
from tirelab.recordings.recording import Recording

FloatArray = NDArray[np.float64]


def read_jpk(path: Path) -> list[dict[str, FloatArray]]:
    """The segments of a JPK text export: columns [SI] by the names in each segment's `# columns:` line."""
    segments: list[tuple[list[str], list[list[float]]]] = []
    for line in path.read_text(encoding="latin-1").splitlines():
        if line.startswith("# columns:"):
            segments.append((line.split()[2:], []))
        elif line.strip() and not line.startswith("#"):
            segments[-1][1].append([float(word) for word in line.split()])
    return [dict(zip(names, np.array(rows).T, strict=True)) for names, rows in segments if rows]


def read_hysitron(path: Path) -> tuple[dict[str, FloatArray], float]:
    """The test in a Hysitron .hld file, columns by name; and the machine compliance [nm/uN] of its header."""
    lines = path.read_text(encoding="latin-1").splitlines()
    compliance = next(float(line.split()[2]) for line in lines if line.startswith("Machine Comp"))
    start = next(i for i, line in enumerate(lines) if line.startswith("Test Data Points"))
    count = int(lines[start].split(":")[1])
    names = lines[start + 1].split("\t")
    rows = [[float(word) for word in line.split("\t")] for line in lines[start + 2 : start + 2 + count]]
    return dict(zip(names, np.array(rows).T, strict=True)), compliance


def recorded(name: str, time: FloatArray, deflection: FloatArray, force: FloatArray) -> Recording:
    """A recording on the flat: time [s], deflection [m], force [N]."""
    return Recording(name, time, deflection, np.full(time.size, np.inf), force)


@dataclass(frozen=True)
class Indentation:
    """A sphere in a soft specimen: indentation [m] and force [N]; coefficient [N/cm^1.5] from the approach.

    turned: sample at which the hold ends; creep [um]: what the indentation grows in the hold
    """

    recording: Recording
    coefficient: float
    turned: int
    creep: float


CANTILEVER = 0.061
"""Stiffness of the cantilever [nN/nm], from the header of the files."""

ADHESION = 0.15
"""Part of the largest force below which the specimen clings to the sphere and its law ends."""


def indentation(path: Path) -> Indentation:
    """Contact point, baseline and Hertz's law F = b + A (d - d0)^1.5 fitted to the approach alone."""
    segments = read_jpk(path)
    time, height, force = (
        np.concatenate([s[name] for s in segments])
        for name in ("seriesTime", "measuredHeight", "vDeflection")
    )
    force, approach = 1e9 * force, slice(0, segments[0]["seriesTime"].size)
    pressed = 1e6 * (height[0] - height) - (force - np.median(force[:300])) / CANTILEVER * 1e-3

    def miss(p: FloatArray) -> FloatArray:
        return np.asarray(p[0] + p[1] * np.maximum(pressed[approach] - p[2], 0.0) ** 1.5 - force[approach])

    starts = np.quantile(pressed[approach], [0.2, 0.5, 0.8, 0.95])
    fits = [least_squares(miss, [np.median(force[:300]), 0.1, start]) for start in starts]
    baseline, coefficient, contact = min(fits, key=lambda fit: float(fit.cost)).x
    x, f = 1e-6 * (pressed - contact), 1e-9 * (force - baseline)
    first = int(np.argmax(x > 0.0))
    last = int(np.flatnonzero(f > ADHESION * f.max())[-1])
    hold = slice(approach.stop, approach.stop + segments[1]["seriesTime"].size)
    pressing = recorded(path.stem[:24], time[first:last], x[first:last], f[first:last])
    return Indentation(
        pressing,
        coefficient * 1e-9 * 1e4**1.5,
        hold.stop - first,
        float(pressed[hold][-100:].mean() - pressed[hold][:100].mean()),
    )


def power_law_fit(x: FloatArray, force: FloatArray) -> tuple[float, float, float]:
    """F = A (x - x0)^B by least squares: A, B, x0, in the units of what is given."""

    def miss(p: FloatArray) -> FloatArray:
        return np.asarray(np.exp(p[0]) * np.maximum(x - p[2], 1e-9) ** p[1] - force)

    starts = [[np.log(force.max() / x.max() ** b), b, -5.0] for b in (1.2, 1.6, 2.0)]
    fits = [least_squares(miss, start, x_scale=[0.1, 0.1, 5.0]) for start in starts]
    log_a, b, zero = min(fits, key=lambda fit: float(fit.cost)).x
    return float(np.exp(log_a)), float(b), float(zero)
