"""The motion that a misfit may follow: signals, shapes over a place, and visits of the same place."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import uniform_filter1d

FloatArray = NDArray[np.float64]
BoolArray = NDArray[np.bool_]
IntArray = NDArray[np.intp]


FEWEST_LAGS = 20
"""Fewest lags in a recording: the level of noise that is independent a lag apart is then known to a sixth. A kink is
tried in each of as many parts of it."""

FEWEST_EVENTS = 10
"""Fewest events that are no chance: samples of a hold, changes of a reading, memories of noise between two visits, or
for each shape that a misfit may have."""

KINDS = 4
"""Number of kinds of `Driven.shapes`."""

Visits = tuple[IntArray, IntArray, FloatArray]
"""Numbers of two samples of one place, pair by pair, and 1 where both go the same way, -1 where not: what depends on
the place has third differences of the other sign on the way back."""


@dataclass(frozen=True)
class Driven:
    """A motion. interval [s]: between its samples; at each of them deflection [m], rate [m/s], acceleration [m/s^2] and
    number of the surface (n,)
    """

    interval: float
    deflection: FloatArray
    rate: FloatArray
    acceleration: FloatArray
    surface: IntArray

    @property
    def signals(self) -> FloatArray:
        """What a misfit may follow (n, k): deflection, rate and all their products up to the third order, and
        acceleration.

        A loop of any width and shape has the third harmonic of the motion, which is three times as quick.
        """
        place, speed = self.deflection - self.deflection.mean(), self.rate
        powers = [(i, order - i) for order in (1, 2, 3) for i in range(order + 1)]
        return np.column_stack([*(place**i * speed**j for i, j in powers), self.acceleration])

    def late(self, memory: int) -> FloatArray:
        """Rate and acceleration (n, k) within a memory of a noise before and after each sample: which of two readings
        is the later one, and by how much, is not known, and a mass is none of what its own instant shows.
        """
        shifts = sorted({sign * shift for shift in (memory // 2, memory) for sign in (-1, 1)} - {0})
        at = np.arange(self.rate.size)
        each = (np.clip(at + shift, 0, at.size - 1) for shift in shifts)
        return np.column_stack([signal[own] for own in each for signal in (self.rate, self.acceleration)])

    @property
    def kinks(self) -> FloatArray:
        """Forces (n, k) that rise beyond one deflection each, as that of a stop, at FEWEST_LAGS deflections, and one
        that rises and falls between them.
        """
        each = _kinks(self.deflection, FEWEST_LAGS)
        return np.column_stack([each, each @ (-1.0) ** np.arange(FEWEST_LAGS)])

    def shapes(self, memory: int, *, coarser: bool = False) -> FloatArray:
        """Forces (n, k) of any shape over each place of `visits`: over the deflection, over the deflection with the
        other sign on the way back, and over the distance from the last reversal with the other sign on the way back.

        memory: of the noise beside them. Half as many parts of each place as `kinks` has: shapes have to be few beside
        the memories of a recording, to tell whether it has something of them; coarser: as few as that needs.
        """
        inwards, turned = _inwards(self.deflection, memory), _from_turn(self.deflection, memory)
        way, parts = np.where(inwards, 1.0, -1.0)[:, None], FEWEST_LAGS // 2
        if coarser:
            told = (self.deflection.size / memory - 1.0) / (KINDS * FEWEST_EVENTS)
            parts = int(min(max(told, 1.0), parts))
        over, after = _kinks(self.deflection, parts), _kinks(np.abs(turned), parts)
        return np.column_stack([over, way, way * over, way * after])

    def places(self, memory: int) -> Iterator[FloatArray]:
        """Return numbers (n,) [m] that are near where the place is, one for each meaning of place (`visits`)."""
        deflection, inwards = self.deflection, _inwards(self.deflection, memory)
        # Added to a place, they keep surfaces apart, and loading and unloading.
        apart = 2.0 * float(np.ptp(deflection))
        ground, way = 2.0 * apart * self.surface, apart * inwards
        for own in (deflection, deflection + way, np.abs(_from_turn(deflection, memory)) + way):
            yield own + ground

    def visits(self, memory: int) -> Iterator[Visits]:
        """Return pairs of samples of two visits of one place, for three meanings of place: the same deflection; the
        same deflection and direction; the same direction and distance from the last reversal; each on the same surface.

        Samples are of different visits if they are four memories apart, and at one place if they are at most half the
        path of one memory apart.
        """
        deflection, inwards = self.deflection, _inwards(self.deflection, memory)
        near = 0.5 * float(np.median(np.abs(deflection[memory:] - deflection[:-memory])))
        for place in self.places(memory):
            order = np.argsort(place, kind="stable")
            one, other = order[:-1], order[1:]
            pairs = (np.abs(one - other) > 4 * memory) & (place[other] - place[one] <= near)
            one, other = one[pairs], other[pairs]
            yield one, other, np.where(inwards[one] == inwards[other], 1.0, -1.0)


def _kinks(place: FloatArray, count: int) -> FloatArray:
    """Return (n, count) functions of a place (n,) that rise beyond one value of it each."""
    at = np.quantile(place, (np.arange(count) + 0.5) / count)
    return np.asarray(np.maximum(place[:, None] - at, 0.0))


def _inwards(deflection: FloatArray, memory: int) -> BoolArray:
    """Return at which samples (n,) the deflection grows, smoothed over the memory of a noise."""
    return np.asarray(np.gradient(uniform_filter1d(deflection, 2 * memory + 1, mode="nearest")) > 0.0)


def _from_turn(deflection: FloatArray, memory: int) -> FloatArray:
    """Return the distance (n,) from the last reversal."""
    begin = np.append(0, np.flatnonzero(np.diff(_inwards(deflection, memory))) + 1)
    turn = begin[np.searchsorted(begin, np.arange(deflection.size), side="right") - 1]
    return np.asarray(deflection - deflection[turn])
