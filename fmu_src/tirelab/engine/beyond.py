"""What is beyond the catalogue: smooth functions of every coordinate, that no physics is claimed for.

They take part in the search beside the effects. Where one of them is needed, the verdict is that something acts which
no effect explains, in that coordinate.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from scipy.signal import lfilter

from ..preprocessing.kinematics import FloatArray
from ..preprocessing.lines_and_segments import LEAST_LINE_TO_NOISE, MODULATION_ORDERS, modulated_waves
from .families import Family, law_columns, one_each, pairs, scale_of
from .place import Place
from .scene import Scene


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
    turned = np.clip(p.record.motion.since_reversal / p.scene.deepest, 0.0, 1.0)
    return np.stack(
        [p.elastic * c for c in _cosines(reach, 1, 4)]
        + [p.record.motion.direction * c for c in _cosines(turned, 1, 5)],
        axis=1,
    )


RESONANCES = 16
DAMPINGS = (0.012, 0.03, 0.08)
"""Damping ratios of the modes that are tried where a line stands out; between the lines the last one alone."""


def _resonance(p: Place) -> FloatArray:
    """The elastic force through a lightly damped mode, at frequencies from four in a recording up."""
    change = np.diff(p.elastic, prepend=p.elastic[0])

    def ringing(frequency: float, damping: float) -> list[FloatArray]:
        angle = 2.0 * np.pi * frequency * p.record.step
        radius = np.exp(-damping * angle)
        poles = [1.0, -2.0 * radius * np.cos(angle), radius**2]
        rings = lfilter([1.0], poles, change)
        return [p.taken(rings), p.taken(np.diff(rings, prepend=0.0))]

    lines = sorted({line for r in p.scene.records for line in r.outstanding.lines[:2]})
    modes = [(line, damping) for line in lines for damping in DAMPINGS]
    grid = np.geomspace(4.0 / p.scene.longest, 1.0 / (6.0 * p.scene.finest), RESONANCES)
    modes += [(float(frequency), DAMPINGS[-1]) for frequency in grid]
    return np.stack([column for mode in modes for column in ringing(*mode)], axis=1)


def _lines(p: Place, weight: FloatArray) -> FloatArray:
    """Return sines and cosines, steady and swelling, at the lines that stand out of a recording, times `weight`."""
    most = max(len(r.outstanding.lines) for r in p.scene.records)
    found: list[FloatArray] = []
    for line in p.record.outstanding.lines:
        found += [np.asarray(weight * wave) for wave in modulated_waves(p.record.time, line).T]
    return _own(p, _filled(found, most * (2 + 4 * MODULATION_ORDERS), weight))


def _filled(columns: list[FloatArray], count: int, like: FloatArray) -> list[FloatArray]:
    return columns + [np.zeros_like(like)] * (count - len(columns))


def _periodic(p: Place) -> FloatArray:
    return _lines(p, np.ones_like(p.elastic))


def _periodic_scale(p: Place) -> FloatArray:
    return _lines(p, p.stiffness)


def _periodic_way(p: Place) -> FloatArray:
    """A line over the way travelled, against the motion."""
    way = np.cumsum(np.abs(np.diff(p.record.motion.deflection, prepend=p.record.motion.deflection[0])))
    direction = p.record.motion.direction
    columns = []
    for line, loudness in p.record.kept_lines(way, direction, 3):
        heard = direction if loudness > LEAST_LINE_TO_NOISE else 0.0 * direction
        columns += [heard * f(2.0 * np.pi * line * way) for f in (np.sin, np.cos)]
    return _own(p, columns)


def _span(p: Place) -> FloatArray:
    """Within spans of time that stand out: an offset, and a part of the force (a channel that hangs has lost all)."""
    place = np.arange(p.elastic.size)
    columns = [
        np.where((place >= first) & (place < last), values, 0.0)
        for first, last in p.record.outstanding.segments
        for values in (p.scene.strongest, p.elastic)
    ]
    most = max(len(r.outstanding.segments) for r in p.scene.records)
    return _own(p, _filled(columns, 2 * most, p.elastic))


def worth_trying(families: Sequence[Family], scene: Scene) -> tuple[Family, ...]:
    """Return the families without those of lines and spans where no line or span stands out."""
    lines = any(r.outstanding.lines for r in scene.records)
    spans = any(r.outstanding.segments for r in scene.records)
    gone = {*(() if lines else ("period", "period, added")), *(() if spans else ("span",))}
    return tuple(f for f in families if f.name not in gone)


SURFACE = Family("surface", law_columns((0, 1, 2, 3)), agnostic=True)
"""A function of deflection and surface, for a catalogue in which the law may not be another tire's."""

AGNOSTIC_FAMILIES: tuple[Family, ...] = (
    Family("period, added", _periodic, agnostic=True, after_lag=True, slow=True, standing=True),
    Family("period", _periodic_scale, agnostic=True, slow=True, standing=True),
    Family("deflection", _fine_deflection, agnostic=True),
    Family("direction", _branch, agnostic=True),
    Family("rate", _rate, agnostic=True),
    Family("rate and deflection", _rate_and_deflection, agnostic=True),
    Family("acceleration", _acceleration, agnostic=True),
    Family("time", _time_scale, agnostic=True, slow=True),
    Family("time, added", _time_added, agnostic=True, after_lag=True, slow=True),
    Family("jump", _jump, one_each, agnostic=True, slow=True),
    Family("history", _history, agnostic=True),
    Family("resonance", _resonance, pairs, agnostic=True, remembers=True),
    Family("way", _periodic_way, agnostic=True),
    Family("span", _span, agnostic=True, after_lag=True, standing=True),
)
