"""Rate-independent hysteresis: Iwan's elements and the Bouc-Wen equation."""

from dataclasses import dataclass
from itertools import pairwise
from typing import ClassVar

import numpy as np

from ..motion import FloatArray
from .effect import Conditions, Contact, Effect


def jenkins(deflection: FloatArray, breakaway: FloatArray) -> FloatArray:
    """Jenkins elements (spring and slider in series): elongation over breakaway distance, in [-1, 1].

    z' = x'/r while |z| < 1, else it slides; solved exactly from one reversal of x to the next. Before the start the
    tire was pressed down from x = 0.
    deflection [m], shape (n,); breakaway distances r [m], shape (m,). Returns shape (m, n).
    Source: Iwan, J. Appl. Mech. 33, 893 (1966).
    """
    direction = np.sign(np.diff(deflection))
    moving = np.flatnonzero(direction)
    turns = moving[1:][np.diff(direction[moving]) != 0.0]
    bounds = np.concatenate([[0], turns, [deflection.size - 1]])
    states = np.empty((breakaway.size, deflection.size))
    states[:, 0] = np.minimum(1.0, max(float(deflection[0]), 0.0) / breakaway)
    for first, last in pairwise(bounds):
        path = (deflection[first + 1 : last + 1] - deflection[first]) / breakaway[:, None]
        states[:, first + 1 : last + 1] = np.clip(states[:, first, None] + path, -1.0, 1.0)
    return states


@dataclass(frozen=True)
class IwanFriction(Effect):
    """Many sliders with a spread of breakaway distances: F = f g(x) sum w_i z_i, with the slip force f [N].

    `reach` [m] is the median of the breakaway distances and `spread` their decades; `load_share` of the slip force
    grows in proportion to the elastic force (tread on the surface), the rest is constant (plies of the casing).
    """

    reach: float
    spread: float
    load_share: float
    reference: float

    name: ClassVar[str] = "rate_independent_hysteresis"
    unit: ClassVar[str] = "N"
    limit: ClassVar[float] = 150.0

    @classmethod
    def drawn(cls, rng: np.random.Generator, conditions: Conditions) -> "IwanFriction":
        """Breakaway distance from 1/60 to 1/8 of the deepest deflection."""
        reach = conditions.deepest * float(np.exp(rng.uniform(np.log(1.0 / 60.0), np.log(1.0 / 8.0))))
        load = float(rng.choice((0.0, 1.0, rng.uniform(0.3, 0.7))))
        return cls(0.03 * conditions.strongest, reach, rng.uniform(0.3, 0.9), load, conditions.strongest)

    def parallel(self, contact: Contact) -> FloatArray:
        """Slip force times the mean elongation of the elements."""
        breakaway = self.reach * 10.0 ** (self.spread * np.linspace(-0.5, 0.5, 11))
        mean: FloatArray = np.mean(jenkins(contact.deflection, breakaway), axis=0)
        return self.strength * slip_scale(contact, self.load_share, self.reference) * mean


@dataclass(frozen=True)
class BoucWenFriction(Effect):
    """r z' = x' (1 - |z|^n (b + (1 - b) sgn(x' z))), F = f g(x) z; independent of rate.

    Breakaway distance `reach` r [m], exponent n [1], pinch b [1]. Source: Wen, J. Eng. Mech. Div. ASCE 102, 249 (1976).
    """

    reach: float
    exponent: float
    pinch: float
    load_share: float
    reference: float

    name: ClassVar[str] = "rate_independent_hysteresis"
    unit: ClassVar[str] = "N"
    limit: ClassVar[float] = 150.0

    @classmethod
    def drawn(cls, rng: np.random.Generator, conditions: Conditions) -> "BoucWenFriction":
        """Breakaway distance from 1/50 to 1/8 of the deepest deflection, in half of the draws load-proportional."""
        reach = conditions.deepest * float(np.exp(rng.uniform(np.log(1.0 / 50.0), np.log(1.0 / 8.0))))
        load = float(rng.choice((0.0, 1.0)))
        return cls(
            0.03 * conditions.strongest,
            reach,
            rng.uniform(1.2, 2.5),
            rng.uniform(0.3, 0.5),
            load,
            conditions.strongest,
        )

    def parallel(self, contact: Contact) -> FloatArray:
        """Slip force times z, stepped along the path by at most a fifth of the breakaway distance."""
        steps = np.diff(contact.deflection, prepend=min(0.0, float(contact.deflection[0]))) / self.reach
        z, states = 0.0, []
        both, turning, exponent = self.pinch, 1.0 - self.pinch, self.exponent
        for step in steps.tolist():
            pieces = int(abs(step) / 0.2) + 1
            piece = step / pieces
            for _ in range(min(pieces, 400)):
                bent = abs(z) ** exponent
                middle = z + 0.5 * piece * (1.0 - bent * (both + (turning if piece * z > 0.0 else -turning)))
                bent = abs(middle) ** exponent
                z += piece * (1.0 - bent * (both + (turning if piece * middle > 0.0 else -turning)))
            states.append(z)
        slip = self.strength * slip_scale(contact, self.load_share, self.reference)
        return slip * np.array(states, dtype=np.float64)


def slip_scale(contact: Contact, load_share: float, reference: float) -> FloatArray:
    """Slip force over its largest value: partly constant in contact, partly with the load."""
    return (1.0 - load_share) * contact.touching + load_share * contact.elastic / reference
