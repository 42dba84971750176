"""What one hidden piece of physics may do to the signal on its way from the gauge to the load cell."""

import dataclasses
from abc import ABC, abstractmethod
from collections.abc import Mapping
from dataclasses import dataclass
from typing import ClassVar, TypeVar

import numpy as np

from concealed.motion import BoolArray, FloatArray, Motion
from concealed.tires import Tire

AnyEffect = TypeVar("AnyEffect", bound="Effect")


@dataclass(frozen=True)
class Scene:
    """What is known of a trial before its effects are chosen: they are chosen to fit.

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

    def force_quantile(self, share: float) -> float:
        """The elastic force [N] below which a share of all recorded samples lies."""
        pairs = zip(self.motions, self.elastic, strict=True)
        return float(np.quantile(np.concatenate([m.recorded(f) for m, f in pairs]), share))


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
class Place:
    """Where a confined effect is: from `begin` to `end` of a coordinate, None where there is no end."""

    by: str
    begin: float | str | None
    end: float | str | None
    unit: str


@dataclass(frozen=True)
class Effect(ABC):
    """One hidden piece of physics; every hook does nothing unless a kind of effect gives it a meaning.

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
    def drawn(cls, rng: np.random.Generator, scene: Scene) -> "Effect":
        """An effect of this form with constants drawn to fit the scene; its strength is set afterwards."""

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

    def pressure_ratio(self, motion: Motion) -> FloatArray | float:
        """Pressure over inflation pressure as a function of time."""
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

    def active(self, contact: Contact, force: FloatArray) -> BoolArray | None:
        """The samples to which a confined effect is confined; None for an effect that is everywhere."""
        return None

    def places(self, motion: Motion) -> list[Place]:
        """Where a confined effect is confined to; empty for one that is everywhere."""
        return []


class RateEffect(Effect):
    """An effect of the rate: where the motion is fast in one burst only, it is confined to that burst."""

    def active(self, contact: Contact, force: FloatArray) -> BoolArray | None:
        """Within the burst, if there is one."""
        if contact.motion.burst is None:
            return None
        begin, end = contact.motion.burst
        return (contact.motion.time >= begin) & (contact.motion.time <= end)

    def places(self, motion: Motion) -> list[Place]:
        """The burst, if there is one."""
        return [] if motion.burst is None else [Place("time", *motion.burst, "s")]
