"""Simulations of one motion that keep what their stages gave: a tire that differs from one before in one effect runs
that effect and what depends on it. The forces are those of `simulate`, to the last bit.
"""

from __future__ import annotations

from collections.abc import Callable, Hashable
from typing import Any, Protocol, TypeVar

import numpy as np
from numpy.typing import NDArray
from radialtire import TireModel

from .channels import Sampled
from .simulate import Kinematics, Stages, elastic_stage, force_after_law, learned_force

FloatArray = NDArray[np.float64]
T = TypeVar("T")

KEPT = 96
"""Results that are kept, the last used ones: a Jacobian of six effects with ten parameters each."""


class Motion(Sampled, Kinematics, Protocol):
    """What is simulated, with its rate and acceleration."""


class KeptStages(Stages):
    """The stages of simulations of one motion."""

    def __init__(self, motion: Motion) -> None:
        self._motion = motion
        self._kept: dict[Hashable, tuple[tuple[Any, ...], Any]] = {}

    def simulate(self, tire: TireModel) -> FloatArray:
        """Return the radial force [N] of `tire` at every sample; it may be given out again: do not change it."""
        history, force = elastic_stage(tire, self._motion, self._motion, self)
        force = force_after_law(tire, history, force, self)
        return force if tire.remainder is None else force + learned_force(tire, self._motion, self._motion)

    def once(self, what: Hashable, of: tuple[Any, ...], make: Callable[[], T]) -> T:
        """Return what `make` gives, made anew only where it was not kept for the same values `of` the same objects."""
        key = (what, *map(id, of))
        # The objects are kept too, or another one could have their identity.
        kept = self._kept.pop(key, None) or (of, make())
        self._kept[key] = kept
        if len(self._kept) > KEPT:
            del self._kept[next(iter(self._kept))]
        found: T = kept[1]
        return found
