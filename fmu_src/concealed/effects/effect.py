"""What one hidden effect may do to the signal between the gauge and the load cell."""

import dataclasses
from abc import ABC, abstractmethod
from collections.abc import Mapping
from dataclasses import dataclass
from typing import ClassVar, TypeVar

import numpy as np

from ..motion import BoolArray, FloatArray, Motion
from ..tires import Tire

AnyEffect = TypeVar("AnyEffect", bound="Effect")


@dataclass(frozen=True)
class Conditions:
    """Conditions of the training tests; the constants of an effect are drawn to fit them.

    motions and elastic [N] forces of the training recordings on their fine grids; noise [N] of the load cell.
    """

    motions: tuple[Motion, ...]
    elastic: tuple[FloatArray, ...]
    tire: Tire
    noise: float

    @property
    def deepest(self) -> float:
        """Largest deflection [m]."""
        return max(float(np.max(m.deflection)) for m in self.motions)

    @property
    def strongest(self) -> float:
        """Largest elastic force [N]."""
        return max(float(np.max(f)) for f in self.elastic)

    @property
    def typical_rate(self) -> float:
        """RMS of the deflection rate, the largest among the recordings [m/s]."""
        return max(float(np.sqrt(np.mean(m.rate**2))) for m in self.motions)

    @property
    def longest(self) -> float:
        """Duration of the longest recording [s]."""
        return max(m.duration for m in self.motions)

    def deflection_quantile(self, share: float) -> float:
        """The deflection [m] below which a share of all recorded samples lies."""
        return float(np.quantile(np.concatenate([m.recorded(m.deflection) for m in self.motions]), share))


@dataclass(frozen=True)
class Contact:
    """Tire against surface on the fine grid: motion, the tire's deflection [m], its elastic force [N]."""

    motion: Motion
    deflection: FloatArray
    elastic: FloatArray

    @property
    def touching(self) -> FloatArray:
        """How far the contact has closed, 0 to 1: dry forces need some contact before they act."""
        return -np.expm1(-np.maximum(self.deflection, 0.0) / 0.3e-3)


@dataclass(frozen=True)
class Region:
    """Region of a localized effect: from `begin` to `end` of the coordinate `by`, None where there is no end."""

    by: str
    begin: float | str | None
    end: float | str | None
    unit: str


@dataclass(frozen=True)
class Effect(ABC):
    """One hidden effect; every hook does nothing unless a subclass overrides it.

    `strength` is its one free size in its own unit, zero when absent; `limit` is the largest that is
    plausible. The hooks are called in the order of the signal: gauge, pressure, spring, elastic, parallel,
    machine, channel.
    """

    strength: float

    name: ClassVar[str]
    unit: ClassVar[str]
    limit: ClassVar[float]
    #: Elastic effects are functions of deflection and surface alone: they compete with the law's own shape.
    elastic_only: ClassVar[bool] = False

    @classmethod
    @abstractmethod
    def drawn(cls, rng: np.random.Generator, conditions: Conditions) -> "Effect":
        """Draw the constants of this form to fit the conditions; the strength is set afterwards."""

    def with_strength(self: AnyEffect, strength: float) -> AnyEffect:
        """The same effect in another size."""
        return dataclasses.replace(self, strength=strength)

    def parameters(self) -> Mapping[str, object]:
        """Every constant of the effect, for the answer."""
        values: dict[str, object] = {"form": type(self).__name__, "unit_of_strength": self.unit}
        for field in dataclasses.fields(self):
            value = getattr(self, field.name)
            values[field.name] = list(value) if isinstance(value, tuple) else value
        return values

    def gauge_error(self, motion: Motion) -> FloatArray | float:
        """Deflection [m] of wheel and tire beyond what the gauge shows."""
        return 0.0

    def reading(self, deflection: FloatArray) -> FloatArray:
        """What the gauge shows [m] of a deflection [m], free of noise."""
        return deflection

    def pressure_ratio(self, motion: Motion) -> FloatArray | float:
        """Pressure over inflation pressure as a function of time."""
        return 1.0

    def gauge_pressure(self) -> float:
        """Gauge pressure over inflation pressure at which the tire was pressed."""
        return 1.0

    def gas_ratio(self, deflection: FloatArray, radius: FloatArray) -> FloatArray | float:
        """Pressure over inflation pressure as a function of the tire's deflection."""
        return 1.0

    def shortening(self, force: FloatArray) -> FloatArray | float:
        """Deflection [m] that a spring in series takes under a force [N]."""
        return 0.0

    def softening(self, contact: Contact) -> FloatArray | float:
        """Factor on the elastic force."""
        return 1.0

    def parallel(self, contact: Contact) -> FloatArray | float:
        """Force [N] beside the elastic one, in the contact: it can press, never pull."""
        return 0.0

    def machine(self, contact: Contact) -> FloatArray | float:
        """Force [N] that the machine adds outside of the contact."""
        return 0.0

    def channel(self, motion: Motion, force: FloatArray) -> FloatArray:
        """What the force channel makes of the force [N]."""
        return force

    def active(self, contact: Contact) -> BoolArray | None:
        """The samples in which a localized effect is active; None for an effect that is active everywhere."""
        return None

    def regions(self, motion: Motion) -> list[Region]:
        """Regions of a localized effect; empty for one that is active everywhere."""
        return []


class RateEffect(Effect):
    """An effect of the rate: where the motion is fast in one burst only, it is localized in that burst."""

    def active(self, contact: Contact) -> BoolArray | None:
        """Within the burst, if there is one."""
        if contact.motion.burst is None:
            return None
        begin, end = contact.motion.burst
        return (contact.motion.time >= begin) & (contact.motion.time <= end)

    def regions(self, motion: Motion) -> list[Region]:
        """The burst, if there is one."""
        return [] if motion.burst is None else [Region("time", *motion.burst, "s")]
