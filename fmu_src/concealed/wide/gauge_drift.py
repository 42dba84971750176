"""A zero of the gauge that wanders off, which `NAMES` lacks: drawn in trials of the kind `drift` only."""

from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from ..effects.effect import Conditions, Effect
from ..motion import FloatArray, Motion

#: The name that a catalogue has for it.
DEFLECTION_DRIFT = "deflection_drift"


@dataclass(frozen=True)
class WarmingGauge(Effect):
    """A gauge warms through two bodies: z = s ((1 - e^(-t/a)) - c (1 - e^(-t/b))), the rod later than the coil.

    s [m] may have either sign; time constants a < b [s] of coil and rod, c: part of it that the rod takes back.
    """

    quick: float
    slow: float
    back: float
    sign: float

    name: ClassVar[str] = DEFLECTION_DRIFT
    unit: ClassVar[str] = "m"
    limit: ClassVar[float] = 0.004

    @classmethod
    def drawn(cls, rng: np.random.Generator, conditions: Conditions) -> "WarmingGauge":
        """The coil within half a recording to three of them, the rod up to six times as late."""
        quick = conditions.longest * rng.uniform(0.5, 3.0)
        return cls(
            2e-4, quick, quick * rng.uniform(2.0, 6.0), rng.uniform(0.0, 0.3), float(rng.choice([-1.0, 1.0]))
        )

    def gauge_error(self, motion: Motion) -> FloatArray:
        """Drift [m] since the recording's start."""
        coil, rod = (-np.expm1(-motion.time / constant) for constant in (self.quick, self.slow))
        return np.asarray(self.sign * self.strength * (coil - self.back * rod))


@dataclass(frozen=True)
class SettlingMount(Effect):
    """A mount on rubber creeps by the logarithm of the time: z = -s ln(1 + t/t_0) / ln(1 + T/t_0), T: the longest
    recording's duration [s].
    """

    start: float
    duration: float

    name: ClassVar[str] = DEFLECTION_DRIFT
    unit: ClassVar[str] = "m"
    limit: ClassVar[float] = 0.004

    @classmethod
    def drawn(cls, rng: np.random.Generator, conditions: Conditions) -> "SettlingMount":
        """The logarithm begins after a tenth of the recording to twice as long."""
        return cls(2e-4, conditions.longest * rng.uniform(0.1, 2.0), conditions.longest)

    def gauge_error(self, motion: Motion) -> FloatArray:
        """Drift [m] since the recording's start."""
        whole = np.log1p(self.duration / self.start)
        return np.asarray(-self.strength * np.log1p(motion.time / self.start) / whole)


#: Its forms, in turn.
DRIFTING: tuple[type[Effect], ...] = (WarmingGauge, SettlingMount)
