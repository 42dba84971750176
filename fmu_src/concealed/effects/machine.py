"""What the machine adds: mass, zero errors, a slow or a short force channel."""

from dataclasses import dataclass
from typing import ClassVar

import numpy as np
from scipy.signal import bessel, butter, cont2discrete, lfilter, lfilter_zi

from ..motion import BoolArray, FloatArray, Motion
from .effect import Conditions, Contact, Effect, RateEffect, Region


@dataclass(frozen=True)
class MovingMass(RateEffect):
    """F = M a: the mass M [kg] between actuator and load cell; a from a spline through the motion."""

    name: ClassVar[str] = "inertia"
    unit: ClassVar[str] = "kg"
    limit: ClassVar[float] = 15.0

    @classmethod
    def drawn(cls, rng: np.random.Generator, conditions: Conditions) -> "MovingMass":
        """Any mass; the size is set afterwards."""
        return cls(2.0)

    def machine(self, contact: Contact) -> FloatArray:
        """Force of inertia [N]."""
        return self.strength * contact.motion.acceleration


@dataclass(frozen=True)
class GaugeZero(Effect):
    """The gauge's zero is off: the wheel stands `strength` [m] deeper than it shows (the article: 1 mm)."""

    name: ClassVar[str] = "deflection_offset"
    unit: ClassVar[str] = "m"
    limit: ClassVar[float] = 0.003
    elastic_only: ClassVar[bool] = True

    @classmethod
    def drawn(cls, rng: np.random.Generator, conditions: Conditions) -> "GaugeZero":
        """Either sign."""
        return cls(float(rng.choice((-1.0, 1.0))) * 0.5e-3)

    def gauge_error(self, motion: Motion) -> float:
        """Deflection [m] that the gauge does not show."""
        return self.strength


@dataclass(frozen=True)
class LoadCellZero(Effect):
    """The load cell's zero is off by `strength` [N] (the article: 22 N of preload)."""

    name: ClassVar[str] = "force_offset"
    unit: ClassVar[str] = "N"
    limit: ClassVar[float] = 250.0

    @classmethod
    def drawn(cls, rng: np.random.Generator, conditions: Conditions) -> "LoadCellZero":
        """Either sign."""
        return cls(float(rng.choice((-1.0, 1.0))) * 20.0)

    def channel(self, motion: Motion, force: FloatArray) -> FloatArray:
        """Shifted force [N]."""
        return force + self.strength


@dataclass(frozen=True)
class PureDelay(RateEffect):
    """F(t - T): transport time of the data acquisition, `strength` T [s]."""

    name: ClassVar[str] = "force_lag"
    unit: ClassVar[str] = "s"
    limit: ClassVar[float] = 0.08

    @classmethod
    def drawn(cls, rng: np.random.Generator, conditions: Conditions) -> "PureDelay":
        """Some milliseconds."""
        return cls(0.005)

    def channel(self, motion: Motion, force: FloatArray) -> FloatArray:
        """Delayed force [N]; at rest before the start."""
        return np.interp(motion.time - self.strength, motion.time, force)


@dataclass(frozen=True)
class LowPass(RateEffect):
    """A conditioning amplifier's low-pass of third, fourth or sixth order, Bessel or Butterworth.

    `strength` is its delay at zero frequency [s]; the corner follows from it.
    """

    order: int
    bessel: bool

    name: ClassVar[str] = "force_lag"
    unit: ClassVar[str] = "s"
    limit: ClassVar[float] = 0.08

    @classmethod
    def drawn(cls, rng: np.random.Generator, conditions: Conditions) -> "LowPass":
        """Some milliseconds."""
        return cls(0.005, int(rng.choice((3, 4, 6))), bool(rng.random() < 0.6))

    def channel(self, motion: Motion, force: FloatArray) -> FloatArray:
        """Filtered force [N]; at rest at the first value before the start."""
        design = bessel if self.bessel else butter
        b, a = design(self.order, 1.0, analog=True, **({"norm": "delay"} if self.bessel else {}))
        # group delay at zero of b0/(a_n + a_(n-1) s + ...) is a_(n-1)/a_n
        unit_delay = float(a[-2] / a[-1])
        return filtered(force, motion.step, b, a, unit_delay / self.strength)


@dataclass(frozen=True)
class SoftClip(Effect):
    """The amplifier's ceiling C: F - w ln(1 + exp((F - C)/w)), rounded over w [N].

    `strength` is how far the ceiling stands below the largest force, over that force [1].
    """

    largest: float
    rounding: float

    name: ClassVar[str] = "saturation"
    unit: ClassVar[str] = "1"
    limit: ClassVar[float] = 0.5

    @classmethod
    def drawn(cls, rng: np.random.Generator, conditions: Conditions) -> "SoftClip":
        """Reached by some of the samples."""
        return cls(0.1, conditions.strongest, conditions.noise * float(np.exp(rng.uniform(-1.5, 0.5))))

    @property
    def ceiling(self) -> float:
        """Largest force that can be shown [N]."""
        return self.largest * (1.0 - self.strength)

    def channel(self, motion: Motion, force: FloatArray) -> FloatArray:
        """Clipped force [N]."""
        return force - self.rounding * np.logaddexp(0.0, (force - self.ceiling) / self.rounding)

    def active(self, contact: Contact) -> BoolArray:
        """Where the tire presses harder than the ceiling allows."""
        return contact.elastic > self.ceiling - 2.0 * self.rounding

    def regions(self, motion: Motion) -> list[Region]:
        """From the ceiling on."""
        return [Region("force", self.ceiling - 2.0 * self.rounding, None, "N")]


@dataclass(frozen=True)
class RationalClip(SoftClip):
    """An amplifier that compresses: F / (1 + (F/C)^n)^(1/n) above zero, with n from the same rounding."""

    def channel(self, motion: Motion, force: FloatArray) -> FloatArray:
        """Clipped force [N]."""
        sharpness = float(np.clip(0.5 * self.ceiling / self.rounding, 12.0, 200.0))
        ratio = np.maximum(force, 0.0) / self.ceiling
        return force * np.exp(-np.logaddexp(0.0, sharpness * np.log(np.maximum(ratio, 1e-12))) / sharpness)


def filtered(force: FloatArray, step: float, b: FloatArray, a: FloatArray, corner: float) -> FloatArray:
    """Force through an analogue filter given for 1 rad/s and moved to `corner` [rad/s].

    Exact for a force that is linear between samples (first-order hold); starts at rest at the first value.
    """
    order = a.size - 1
    scaled = a * corner ** np.arange(order + 1)
    numerator = np.atleast_1d(b) * corner ** (order + np.arange(1 - np.size(b), 1))
    digital_b, digital_a, _ = cont2discrete((numerator, scaled), step, method="foh")
    digital_b = np.ravel(digital_b)
    # rounding must not change the gain at zero frequency: a lag keeps the mean of the force
    digital_b *= float(np.sum(digital_a) / np.sum(digital_b))
    start = lfilter_zi(digital_b, digital_a) * force[0]
    return np.asarray(lfilter(digital_b, digital_a, force, zi=start)[0], dtype=np.float64)
