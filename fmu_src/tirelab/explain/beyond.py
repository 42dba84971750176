"""What is beyond the catalogue: smooth functions of every coordinate, that no physics is claimed for.

They take part in the search beside the effects. Where one of them is needed, the verdict is that something acts which
no effect explains, in that coordinate.
"""

from __future__ import annotations

import numpy as np
from scipy.signal import lfilter

from .families import Family, one_each, pairs, scale_of
from .motion import FloatArray
from .place import Place


def _cosines(values: FloatArray, first: int, last: int) -> list[FloatArray]:
    return [np.cos(np.pi * j * values) for j in range(first, last + 1)]


def _depth(p: Place) -> FloatArray:
    return np.clip(p.deflection / p.scene.deepest, 0.0, 1.0)


def _fine_deflection(p: Place) -> FloatArray:
    return np.stack(_cosines(_depth(p), 3, 26), axis=1)


def _branch(p: Place) -> FloatArray:
    return np.stack([p.record.motion.direction * c for c in _cosines(_depth(p), 0, 10)], axis=1)


def _powers(values: FloatArray, last: int) -> list[FloatArray]:
    powers = [values]
    for _ in range(last - 1):
        powers.append(powers[-1] * values)
    return powers


def _rate(p: Place) -> FloatArray:
    depth = _depth(p)
    bent = np.tanh(p.record.motion.rate / (2.0 * scale_of(p, "rate")))
    return np.stack([w * c for w in _powers(bent, 6) for c in (1.0, depth, depth * depth)], axis=1)


def _rate_and_deflection(p: Place) -> FloatArray:
    bent = np.tanh(p.record.motion.rate / (2.0 * scale_of(p, "rate")))
    return np.stack([w * c for w in _powers(bent, 2) for c in _cosines(_depth(p), 1, 12)], axis=1)


def _acceleration(p: Place) -> FloatArray:
    depth = _depth(p)
    bent = np.tanh(p.record.motion.acceleration / (2.0 * scale_of(p, "acceleration")))
    return np.stack([w * c for w in _powers(bent, 3) for c in (1.0, depth)], axis=1)


MOST_SEPARATE = 4
"""Recordings whose course in time is followed one by one; more share what they have in common."""


def _own(p: Place, columns: list[FloatArray]) -> FloatArray:
    """Return the columns of one recording beside nothing in the place of the others'."""
    count = min(len(p.scene.records), MOST_SEPARATE)
    number = p.record.number % count
    wide = np.zeros((p.elastic.size, count * len(columns)))
    wide[:, number * len(columns) : (number + 1) * len(columns)] = np.stack(columns, axis=1)
    return wide


def _time_scale(p: Place) -> FloatArray:
    part = p.record.time / p.record.time[-1]
    return _own(p, [p.elastic * c for c in _cosines(part, 1, 16)])


def _time_added(p: Place) -> FloatArray:
    return _own(p, _cosines(p.record.time / p.record.time[-1], 1, 16))


def _jump(p: Place) -> FloatArray:
    part = p.record.time / p.record.time[-1]
    return _own(p, [p.elastic * (part > at) for at in np.linspace(0.04, 0.96, 16)])


def _history(p: Place) -> FloatArray:
    reach = np.clip(np.maximum.accumulate(p.deflection) / p.scene.deepest, 0.0, 1.0)
    turned = np.clip(p.record.motion.turned / p.scene.deepest, 0.0, 1.0)
    return np.stack(
        [p.elastic * c for c in _cosines(reach, 1, 4)]
        + [p.record.motion.direction * c for c in _cosines(turned, 1, 5)],
        axis=1,
    )


RESONANCES = 16


def _resonance(p: Place) -> FloatArray:
    """The elastic force through a lightly damped mode, at frequencies from four in a recording up."""
    columns = []
    for frequency in np.geomspace(4.0 / p.scene.longest, 1.0 / (6.0 * p.scene.finest), RESONANCES):
        angle = 2.0 * np.pi * frequency * p.record.step
        radius = np.exp(-0.08 * angle)
        poles = [1.0, -2.0 * radius * np.cos(angle), radius**2]
        change = np.diff(p.elastic, prepend=p.elastic[0])
        ringing = lfilter([1.0], poles, change)
        columns += [p.taken(ringing), p.taken(np.diff(ringing, prepend=0.0))]
    return np.stack(columns, axis=1)


LINES = 3
"""Lines of a spectrum that are tried."""

LOUD = 0.6
"""Lines weaker than this part of the noise are left to the noise: a hum of the mains is no physics of a tire."""


def _lines(p: Place, course: FloatArray, weight: FloatArray) -> FloatArray:
    """Return sine and cosine at the strongest lines of what the bare law leaves over the `course`, times `weight`."""
    columns = []
    for line, loudness in p.record.kept_lines(course, weight, LINES):
        heard = weight if loudness > LOUD else 0.0 * weight
        columns += [heard * f(2.0 * np.pi * line * course) for f in (np.sin, np.cos)]
    return _own(p, columns)


def _periodic(p: Place) -> FloatArray:
    return _lines(p, p.record.time, np.ones_like(p.elastic))


def _periodic_scale(p: Place) -> FloatArray:
    return _lines(p, p.record.time, p.stiffness)


def _periodic_way(p: Place) -> FloatArray:
    way = np.cumsum(np.abs(np.diff(p.record.motion.deflection, prepend=p.record.motion.deflection[0])))
    return _lines(p, way, p.record.motion.direction)


AGNOSTIC_FAMILIES: tuple[Family, ...] = (
    Family("period, added", _periodic, agnostic=True, after_lag=True),
    Family("period", _periodic_scale, agnostic=True),
    Family("deflection", _fine_deflection, agnostic=True),
    Family("direction", _branch, agnostic=True),
    Family("rate", _rate, agnostic=True),
    Family("rate and deflection", _rate_and_deflection, agnostic=True),
    Family("acceleration", _acceleration, agnostic=True),
    Family("time", _time_scale, agnostic=True),
    Family("time, added", _time_added, agnostic=True, after_lag=True),
    Family("jump", _jump, one_each, agnostic=True),
    Family("history", _history, agnostic=True),
    Family("resonance", _resonance, pairs, agnostic=True, remembers=True),
    Family("way", _periodic_way, agnostic=True),
)
