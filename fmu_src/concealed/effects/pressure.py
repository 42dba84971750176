"""What changes the pressure: compression of the gas, a leak, warming."""

from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from ..motion import FloatArray, Motion
from ..tires import AMBIENT, INFLATION
from .effect import Conditions, Effect

#: Absolute over gauge pressure of the inflated tire [1].
ABSOLUTE = (INFLATION + AMBIENT) / INFLATION
#: Temperature of the air at the start [K].
ROOM = 293.15
#: Deflection at which the volume fraction is quoted [m].
QUOTED_DEFLECTION = 0.025


@dataclass(frozen=True)
class PolytropicGas(Effect):
    """p V^n = const with V = V_0 (1 - e (x/25 mm)^m (k_flat/k)^(1/2)): the contact patch displaces air.

    `strength` e is the volume lost at 25 mm on the flat over the whole [1]; polytropic index n, between slow
    (1) and quick (1.4); volume exponent m (5/2 for a parabolic cap); wheel radius [m] for the curvature.
    From work against pressure, integral F dx = p dV, a healthy tire has e = 1.7 % (20 J, 3.7 l).
    """

    index: float
    exponent: float
    wheel: float

    name: ClassVar[str] = "gas_compression"
    unit: ClassVar[str] = "1"
    limit: ClassVar[float] = 0.10
    elastic_only: ClassVar[bool] = True

    @classmethod
    def drawn(cls, rng: np.random.Generator, conditions: Conditions) -> "PolytropicGas":
        """Any index between isothermal and adiabatic."""
        return cls(0.02, rng.uniform(1.0, 1.4), rng.uniform(2.2, 2.6), 0.335)

    def gas_ratio(self, deflection: FloatArray, radius: FloatArray) -> FloatArray:
        """Gauge pressure over inflation pressure."""
        curvature = 1.0 / self.wheel + np.sign(radius) / (np.abs(radius) + 0.1)
        wide = 1.0 / np.sqrt(self.wheel * curvature)
        lost = self.strength * (np.maximum(deflection, 0.0) / QUOTED_DEFLECTION) ** self.exponent * wide
        return 1.0 + ABSOLUTE * ((1.0 - np.minimum(lost, 0.5)) ** -self.index - 1.0)


@dataclass(frozen=True)
class ExponentialLeak(Effect):
    """p = p_0 exp(-r t), leak rate r [1/s] (laminar: the loss follows the pressure)."""

    name: ClassVar[str] = "pressure_leak"
    unit: ClassVar[str] = "1/s"
    limit: ClassVar[float] = 1.0 / 150.0

    @classmethod
    def drawn(cls, rng: np.random.Generator, conditions: Conditions) -> "ExponentialLeak":
        """A leak that takes some percent in a recording."""
        return cls(0.05 / conditions.longest)

    def pressure_ratio(self, motion: Motion) -> FloatArray:
        """Pressure over inflation pressure."""
        return np.exp(-self.strength * motion.time)


@dataclass(frozen=True)
class OrificeLeak(Effect):
    """p' = -r (p p_0)^(1/2), so p = p_0 (1 - r t / 2)^2 until empty (throttle: the loss follows its root)."""

    name: ClassVar[str] = "pressure_leak"
    unit: ClassVar[str] = "1/s"
    limit: ClassVar[float] = 1.0 / 150.0

    @classmethod
    def drawn(cls, rng: np.random.Generator, conditions: Conditions) -> "OrificeLeak":
        """A leak that takes some percent in a recording."""
        return cls(0.05 / conditions.longest)

    def pressure_ratio(self, motion: Motion) -> FloatArray:
        """Pressure over inflation pressure."""
        return np.maximum(1.0 - 0.5 * self.strength * motion.time, 0.0) ** 2


@dataclass(frozen=True)
class WarmingAir(Effect):
    """The air warms in two steps, the gas soon and the casing later: T = T_0 + D sum w_i (1 - exp(-t/tau_i)).

    `strength` D [K] is the rise in the end. Gauge pressure at constant volume: 1 + (p_abs/p) (T - T_0)/T_0
    (1 psi per 10 degF near 40 psi).
    """

    quick_share: float
    quick: float
    late: float

    name: ClassVar[str] = "warm_up"
    unit: ClassVar[str] = "K"
    limit: ClassVar[float] = 45.0

    @classmethod
    def drawn(cls, rng: np.random.Generator, conditions: Conditions) -> "WarmingAir":
        """Time constants within the recording, so that the approach to the end can be seen."""
        quick = conditions.longest * rng.uniform(0.03, 0.12)
        return cls(8.0, rng.uniform(0.3, 0.7), quick, quick * rng.uniform(3.0, 8.0))

    def pressure_ratio(self, motion: Motion) -> FloatArray:
        """Pressure over inflation pressure."""
        rise = -self.quick_share * np.expm1(-motion.time / self.quick)
        rise = rise - (1.0 - self.quick_share) * np.expm1(-motion.time / self.late)
        return 1.0 + ABSOLUTE * self.strength * rise / ROOM
