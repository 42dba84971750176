"""What the recorded motion can show: traits of effects that it cannot tell from others."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from radialtire import CATALOGUE

from .dataset import Dataset

FloatArray = NDArray[np.float64]

CELLS = 12
"""Parts of the deflection's span in which two visits are visits of the same deflection."""

RETURNS = 0.02
"""Part of the variance of time that must lie between visits of one deflection in one direction."""

SPEEDS = 0.5
"""Spread of the speed, at one deflection in one direction, over its mean, below which there is one speed."""

STILL = 0.02
"""Speed over its root mean square below which the tire rests."""


@dataclass(frozen=True)
class Excitation:
    """returns: part of the variance of time between visits of the same deflection in the same direction; speeds: spread
    of the speed there; timed: whether the samples' times are known.
    """

    returns: float
    speeds: float
    timed: bool = True

    @property
    def one_speed(self) -> bool:
        """Whether each deflection is passed at one speed only."""
        return self.speeds < SPEEDS

    def hidden(self, name: str) -> str:
        """Return why an effect of this name cannot be shown, or ""."""
        traits = CATALOGUE[name].traits
        if not self.timed and {"rate", "slow"} & set(traits):
            return "the recording has no time"
        if "slow" in traits and self.returns < RETURNS:
            return "no deflection was visited again: time cannot be told from deflection and direction"
        return ""

    def reasons(self, names: Sequence[str]) -> dict[str, str]:
        """Return why, of all the effects that cannot be shown."""
        return {name: why for name in names if (why := self.hidden(name))}

    def alike(self, name: str) -> tuple[str, ...]:
        """Return the effects that this motion cannot tell from one of this name: loops, where each deflection is passed
        at one speed.
        """
        if self.speeds >= SPEEDS or "loop" not in CATALOGUE[name].traits:
            return ()
        loops = (n for n, effect in CATALOGUE.items() if "loop" in effect.traits and n != name)
        return tuple(n for n in loops if not self.hidden(n))


def excitation_of(dataset: Dataset, *, timed: bool = True) -> Excitation:
    """Return what the motion of all recordings can show."""
    returns, speeds = zip(*[_of_one(e.time, e.deflection, e.rate) for e in dataset.experiments], strict=True)
    return Excitation(float(max(returns)), float(max(speeds)), timed)


def _of_one(time: FloatArray, deflection: FloatArray, rate: FloatArray) -> tuple[float, float]:
    span = (deflection - deflection.min()) / max(float(np.ptp(deflection)), 1e-300)
    moving = np.abs(rate) > STILL * float(np.sqrt(np.mean(rate**2)))
    direction = np.where(moving, np.where(rate > 0.0, 1, 2), 0)
    cell = np.minimum((span * CELLS).astype(int), CELLS - 1) + CELLS * direction
    # In a hold everything that relaxes passes for something slow: only visits on the way count.
    passing = time[moving]
    within = _within(passing, cell[moving]) / max(float(np.var(passing)), 1e-300) if passing.size else 0.0
    speed = np.abs(rate[moving])
    spread = np.sqrt(_within(speed, cell[moving])) / max(float(speed.mean()), 1e-300) if speed.size else 0.0
    return within, float(spread)


def _within(values: FloatArray, cell: NDArray[np.int_]) -> float:
    """Return the mean variance of the values within a cell."""
    count = np.bincount(cell)
    mean = np.bincount(cell, values) / np.maximum(count, 1)
    return float(np.mean((values - mean[cell]) ** 2))
