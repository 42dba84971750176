"""A part that does not come back to its length, which `NAMES` lacks: drawn in trials of the kind `set` only."""

from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from ..effects.effect import Conditions, Contact, Effect
from ..motion import BoolArray, FloatArray

#: The name that a catalogue has for it.
PERMANENT_SET = "permanent_set"


@dataclass(frozen=True)
class SpringBack(Effect):
    """Below its largest deflection x_m the part springs back: F = F_m (F_e(u x_m)/F_m)^(1 + s (k - 1)).

    u = (x - s x_m)/((1 - s) x_m); F_m [N]: force at x_m; k [1]: exponent of the unloading over that of the loading,
    where all of the deflection stays.
    Source: Oliver & Pharr, J. Mater. Res. 7, 1564 (1992), for curves that are powers.
    """

    exponent: float

    name: ClassVar[str] = PERMANENT_SET
    unit: ClassVar[str] = "1"
    limit: ClassVar[float] = 0.95

    @classmethod
    def drawn(cls, rng: np.random.Generator, conditions: Conditions) -> "SpringBack":
        """Blunter or sharper than what it was pressed with, as in indentation."""
        return cls(0.05, rng.uniform(0.6, 1.4))

    def stays(self, largest: FloatArray) -> FloatArray:
        """Deflection [m] that stays after a largest one [m]."""
        return self.strength * largest

    def unloading(self, curve: FloatArray) -> FloatArray:
        """Force over that at the largest deflection, from the same of the law's own curve."""
        return np.asarray(curve ** (1.0 + self.strength * (self.exponent - 1.0)))

    def softening(self, contact: Contact) -> FloatArray:
        """Factor on the elastic force."""
        x = np.maximum(contact.deflection, 0.0)
        largest = np.maximum.accumulate(x)
        stays = self.stays(largest)
        part = np.clip((x - stays) / np.maximum(largest - stays, 1e-12), 0.0, 1.0)
        law, peak = (_elastic(contact, at) for at in (part * largest, largest))
        force = peak * self.unloading(law / np.maximum(peak, 1e-12))
        below = (x < largest) & (contact.elastic > 0.0)
        return np.where(below, force / np.where(below, contact.elastic, 1.0), 1.0)

    def active(self, contact: Contact) -> BoolArray:
        """Below the largest deflection so far."""
        return np.asarray(contact.deflection < np.maximum.accumulate(contact.deflection) - 1e-6)


@dataclass(frozen=True)
class CrushedCells(SpringBack):
    """Cells collapse at deflections that scatter about y [m] by w [m]: s w (g((x_m - y)/w) - g(-y/w)) stays.

    g(z) = ln(1 + e^z). Those that are left have the law's own curve, over what is left of the way.
    """

    onset: float
    scatter: float

    @classmethod
    def drawn(cls, rng: np.random.Generator, conditions: Conditions) -> "CrushedCells":
        """From up to four tenths of the deepest deflection on, in step or over a seventh of it."""
        deepest = conditions.deepest
        return cls(0.05, 1.0, deepest * rng.uniform(0.0, 0.4), deepest * rng.uniform(0.01, 0.15))

    def stays(self, largest: FloatArray) -> FloatArray:
        """Deflection [m] that stays after a largest one [m]."""
        soft = [np.logaddexp(0.0, (at - self.onset) / self.scatter) for at in (largest, 0.0)]
        return np.asarray(self.strength * self.scatter * (soft[0] - soft[1]))


def _elastic(contact: Contact, deflection: FloatArray) -> FloatArray:
    """The elastic force [N] at another deflection [m]: a power between those of the motion, and below the least."""
    touching = np.flatnonzero((contact.elastic > 0.0) & (contact.deflection > 0.0))
    x, first = np.unique(np.log(contact.deflection[touching]), return_index=True)
    force = np.log(contact.elastic[touching][first])
    slope = (np.interp(x[0] + 0.5, x, force) - force[0]) / min(0.5, x[-1] - x[0])
    at = np.log(np.maximum(deflection, 1e-12))
    return np.where(
        deflection > 0.0, np.exp(np.interp(at, x, force) + slope * np.minimum(at - x[0], 0.0)), 0.0
    )


#: Its forms, in turn.
PERMANENT: tuple[type[Effect], ...] = (SpringBack, CrushedCells)
