"""What the recorded motion can show: traits of effects that it cannot tell from others."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from radialtire import CATALOGUE

from ..preprocessing.kinematics import STILL
from .channel_evidence import ChannelEvidence, channel_evidence
from .dataset import Dataset, Experiment

FloatArray = NDArray[np.float64]

CELLS = 12
"""Parts of the deflection's span in which two visits are visits of the same deflection."""

RETURNS = 0.02
"""Part of the variance of time that must lie between visits of one deflection in one direction."""

SPEEDS = 0.5
"""Spread of the speed, at one deflection in one direction, over its mean, below which there is one speed."""

UNDER_WAY = 0.3
"""Speed over its root mean square above which the direction is sure: a channel may change with it."""


NO_EVIDENCE = ChannelEvidence(frozenset(), {})
"""That of recordings whose channels were not looked at."""


@dataclass(frozen=True)
class Excitation:
    """returns: part of the variance of time between visits of the same deflection in the same direction; speeds: spread
    of the speed there; timed: whether the samples' times are known; surfaces: how many were pressed on; channels: what
    the recorded channels show.
    """

    returns: float
    speeds: float
    timed: bool = True
    surfaces: int = 1
    channels: ChannelEvidence = NO_EVIDENCE

    @property
    def one_speed(self) -> bool:
        """Whether each deflection is passed at one speed only."""
        return self.speeds < SPEEDS

    def hidden(self, name: str) -> str:
        """Return why an effect of this name cannot be shown, or ""."""
        if name in self.channels.unvaried:
            return self.channels.unvaried[name]
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

    def within_law(self, name: str) -> bool:
        """Whether a law of another shape could be all that an effect of this name is: it depends on the deflection
        alone, which on one surface is all that a law can be; not on a channel that was read beside it.
        """
        return self.surfaces == 1 and of_deflection(name)


def of_deflection(name: str) -> bool:
    """Whether an effect depends on deflection and surface alone, as a law does, and on no channel beside them."""
    return "static" in CATALOGUE[name].traits and CATALOGUE[name].reads is None


def excitation_of(dataset: Dataset, *, timed: bool = True) -> Excitation:
    """Return what the motion of all recordings can show; on one surface they show their speeds together."""
    visits = [_visits(e) for e in dataset.experiments]
    returns = [_share_within(v.time, v.cell) for v in visits]
    together: dict[float, list[_Visits]] = {}
    for experiment, own in zip(dataset.experiments, visits, strict=True):
        together.setdefault(float(np.median(experiment.surface_radius)), []).append(own)
    speeds = [
        _spread_within(np.concatenate([v.speed for v in same]), np.concatenate([v.cell for v in same]))
        for same in together.values()
    ]
    channels = channel_evidence(dataset, _common_cells(dataset.experiments))
    return Excitation(max(returns), max(speeds), timed, len(dataset.radii), channels)


@dataclass(frozen=True)
class _Visits:
    """The samples of one recording that move: time [s], speed [m/s], and the cell of deflection and direction."""

    time: FloatArray
    speed: FloatArray
    cell: NDArray[np.int_]


def _visits(e: Experiment) -> _Visits:
    # In a hold everything that relaxes passes for something slow: only visits on the way count.
    moving = _moving(e)
    cell = _cells(e, float(e.deflection.min()), float(e.deflection.max()))
    return _Visits(e.time[moving], np.abs(e.rate[moving]), cell[moving])


def _moving(e: Experiment, part: float = STILL) -> NDArray[np.bool_]:
    return np.asarray(np.abs(e.rate) > part * float(np.sqrt(np.mean(e.rate**2))))


def _cells(e: Experiment, low: float, high: float) -> NDArray[np.int_]:
    """Return the cell of deflection, between two ends [m], and direction of each block."""
    span = (e.deflection - low) / max(high - low, 1e-300)
    return np.asarray(np.minimum((span * CELLS).astype(int), CELLS - 1) + CELLS * (e.rate > 0.0))


def _common_cells(experiments: Sequence[Experiment]) -> list[NDArray[np.int_]]:
    """Return the cells of every recording's blocks on one scale of the deflection; -1 where the tire turns."""
    low = min(float(e.deflection.min()) for e in experiments)
    high = max(float(e.deflection.max()) for e in experiments)
    return [np.where(_moving(e, UNDER_WAY), _cells(e, low, high), -1) for e in experiments]


def _share_within(values: FloatArray, cell: NDArray[np.int_]) -> float:
    """Return the part of the variance of the values that is within the cells."""
    return _within(values, cell) / max(float(np.var(values)), 1e-300) if values.size else 0.0


def _spread_within(values: FloatArray, cell: NDArray[np.int_]) -> float:
    """Return the standard deviation of the values within a cell over their mean."""
    if not values.size:
        return 0.0
    return float(np.sqrt(_within(values, cell)) / max(float(values.mean()), 1e-300))


def _within(values: FloatArray, cell: NDArray[np.int_]) -> float:
    """Return the mean variance of the values within a cell."""
    count = np.bincount(cell)
    mean = np.bincount(cell, values) / np.maximum(count, 1)
    return float(np.mean((values - mean[cell]) ** 2))
