"""The catalogue's physics in forms that the catalogue does not hold; each has the name of its family."""

from dataclasses import dataclass
from typing import ClassVar

import numpy as np
from scipy.signal import fftconvolve

from ..effects.damping import LinearDashpot
from ..effects.effect import Conditions, Contact, Effect
from ..effects.friction import IwanFriction, jenkins
from ..effects.pressure import OrificeLeak
from ..effects.relaxation import Springpot
from ..effects.rim import QuadraticRim
from ..effects.series import YieldingWheel
from ..motion import BoolArray, FloatArray

#: Rate [m/s] over which a force that depends on the direction changes from one branch to the other.
BRANCH_RATE = 2e-3


@dataclass(frozen=True)
class UnevenDashpot(LinearDashpot):
    """F = c v while loading, u c v while unloading: real dampers are stiffer on the way back."""

    unevenness: float

    @classmethod
    def drawn(cls, rng: np.random.Generator, conditions: Conditions) -> "UnevenDashpot":
        """One and a half to two and a half times as stiff on the way back."""
        return cls(300.0, rng.uniform(1.5, 2.5))

    def parallel(self, contact: Contact) -> FloatArray:
        """Damping force [N]."""
        rate = contact.motion.rate
        return self.strength * np.where(rate > 0.0, rate, self.unevenness * rate) * contact.touching


@dataclass(frozen=True)
class RootDashpot(LinearDashpot):
    """F = c v_0 u / (|u| + 1/100)^(1/2) with u = v/v_0: a root of the rate, linear near rest."""

    reference: float

    @classmethod
    def drawn(cls, rng: np.random.Generator, conditions: Conditions) -> "RootDashpot":
        """Root around the typical rate."""
        return cls(300.0, conditions.typical_rate)

    def parallel(self, contact: Contact) -> FloatArray:
        """Damping force [N]."""
        ratio = contact.motion.rate / self.reference
        return self.strength * self.reference * ratio / np.sqrt(np.abs(ratio) + 0.01) * contact.touching


@dataclass(frozen=True)
class QuadraticDashpot(LinearDashpot):
    """F = c v |v| / v_0: oil through an orifice."""

    reference: float

    @classmethod
    def drawn(cls, rng: np.random.Generator, conditions: Conditions) -> "QuadraticDashpot":
        """Quadratic at the typical rate."""
        return cls(300.0, conditions.typical_rate)

    def parallel(self, contact: Contact) -> FloatArray:
        """Damping force [N]."""
        rate = contact.motion.rate
        return self.strength * rate * np.abs(rate) / self.reference * contact.touching


@dataclass(frozen=True)
class ReboundValve(LinearDashpot):
    """A valve that opens on the way back only, beyond a rate: F = -c (-v - v_0) below -v_0, else nothing."""

    threshold: float

    @classmethod
    def drawn(cls, rng: np.random.Generator, conditions: Conditions) -> "ReboundValve":
        """Threshold at a half to all of the typical rate."""
        return cls(300.0, conditions.typical_rate * rng.uniform(0.5, 1.0))

    def parallel(self, contact: Contact) -> FloatArray:
        """Damping force [N]."""
        beyond = np.maximum(-contact.motion.rate - self.threshold, 0.0)
        return -self.strength * beyond * contact.touching


@dataclass(frozen=True)
class BreakawayFriction(Effect):
    """Friction with a peak after each reversal: F = f z (1 + p u e^(1 - u)), u = s/(3 r).

    z: Dahl's state of the breakaway distance r [m]; s [m]: distance since the reversal; p [1]: height of the peak.
    Source: Dahl, Aerospace Corp. TOR-0158 (1968), for z; the peak as LuGre's sticking force over its sliding one.
    """

    reach: float
    peak: float

    name: ClassVar[str] = "rate_independent_hysteresis"
    unit: ClassVar[str] = "N"
    limit: ClassVar[float] = 300.0

    @classmethod
    def drawn(cls, rng: np.random.Generator, conditions: Conditions) -> "BreakawayFriction":
        """Peaks of a fifth to a half."""
        return cls(
            0.03 * conditions.strongest, conditions.deepest * rng.uniform(0.02, 0.08), rng.uniform(0.2, 0.5)
        )

    def parallel(self, contact: Contact) -> FloatArray:
        """Friction [N]."""
        x = contact.deflection
        steps = np.diff(x, prepend=min(0.0, float(x[0]))) / self.reach
        decays = np.exp(-np.abs(steps)).tolist()
        state, since, direction, states = 0.0, 0.0, 1.0, []
        for step, decay in zip(steps.tolist(), decays, strict=True):
            if step * direction < 0.0:
                direction, since = -direction, 0.0
            since += abs(step)
            state = direction - (direction - state) * decay
            states.append((state, since))
        z, distance = np.array(states, dtype=np.float64).T
        u = distance / 3.0
        return np.asarray(self.strength * z * (1.0 + self.peak * u * np.exp(1.0 - u)) * contact.touching)


@dataclass(frozen=True)
class AsymmetricFriction(Effect):
    """Friction that slips at f while loading and at a f while unloading; the breakaway distance is the same."""

    reach: float
    asymmetry: float

    name: ClassVar[str] = "rate_independent_hysteresis"
    unit: ClassVar[str] = "N"
    limit: ClassVar[float] = 300.0

    @classmethod
    def drawn(cls, rng: np.random.Generator, conditions: Conditions) -> "AsymmetricFriction":
        """A third to twice as much while unloading, but not about the same."""
        asymmetry = float(rng.choice((rng.uniform(0.35, 0.65), rng.uniform(1.5, 2.0))))
        return cls(0.03 * conditions.strongest, conditions.deepest * rng.uniform(0.02, 0.08), asymmetry)

    def parallel(self, contact: Contact) -> FloatArray:
        """Friction [N]."""
        state = np.mean(jenkins(contact.deflection, self.reach * np.array([0.4, 0.7, 1.0, 1.4, 2.0])), axis=0)
        return np.asarray(
            self.strength * np.where(state > 0.0, state, self.asymmetry * state) * contact.touching
        )


@dataclass(frozen=True)
class BroadIwanFriction(IwanFriction):
    """Iwan's sliders with breakaway distances over two to three decades, the short ones stronger by a power law."""

    @classmethod
    def drawn(cls, rng: np.random.Generator, conditions: Conditions) -> "BroadIwanFriction":
        """Two to three decades around a thirtieth of the deepest deflection."""
        reach = conditions.deepest * rng.uniform(0.02, 0.05)
        return cls(
            0.03 * conditions.strongest,
            reach,
            rng.uniform(2.0, 3.0),
            rng.uniform(0.0, 1.0),
            conditions.strongest,
        )

    def parallel(self, contact: Contact) -> FloatArray:
        """Slip force times the weighted elongation of the sliders."""
        exponents = np.linspace(-0.5, 0.5, 25)
        weights = 10.0 ** (-0.3 * self.spread * exponents)
        states = jenkins(contact.deflection, self.reach * 10.0 ** (self.spread * exponents))
        slip = (1.0 - self.load_share) * contact.touching + self.load_share * contact.elastic / self.reference
        return np.asarray(self.strength * slip * (weights @ states) / np.sum(weights))


@dataclass(frozen=True)
class LoopedRim(QuadraticRim):
    """A stop that gives back less than it takes: the quadratic stop, g times as strong while unloading."""

    back: float

    @classmethod
    def drawn(cls, rng: np.random.Generator, conditions: Conditions) -> "LoopedRim":
        """Seven to nine tenths come back."""
        onset = min(conditions.deflection_quantile(1.0 - rng.uniform(0.08, 0.2)), 0.95 * conditions.deepest)
        return cls(1e5, onset, conditions.deepest * rng.uniform(0.01, 0.04), rng.uniform(0.7, 0.9))

    def parallel(self, contact: Contact) -> FloatArray:
        """Force of the stop [N]."""
        loading = 0.5 * (1.0 + np.tanh(contact.motion.rate / BRANCH_RATE))
        return np.asarray(super().parallel(contact) * (self.back + (1.0 - self.back) * loading))


@dataclass(frozen=True)
class HealingSoftening(Effect):
    """Softening below the largest deflection so far, which the tread forgets within the time h [s].

    F_e (1 - s (1 - exp(-5 (1 - x/m)))), m' = -(m - x)/h while x < m.
    """

    healing: float

    name: ClassVar[str] = "mullins_softening"
    unit: ClassVar[str] = "1"
    limit: ClassVar[float] = 0.5

    @classmethod
    def drawn(cls, rng: np.random.Generator, conditions: Conditions) -> "HealingSoftening":
        """Heals in one to four times the longest recording."""
        return cls(0.08, conditions.longest * rng.uniform(1.0, 4.0))

    def softening(self, contact: Contact) -> FloatArray:
        """Factor on the elastic force."""
        keep, largest, memory = float(np.exp(-contact.motion.step / self.healing)), 0.0, []
        x = np.maximum(contact.deflection, 0.0)
        for depth in x.tolist():
            largest = max(depth, depth + (largest - depth) * keep)
            memory.append(largest)
        below = 1.0 - x / np.maximum(np.array(memory, dtype=np.float64), 1e-9)
        return np.asarray(1.0 + self.strength * np.expm1(-5.0 * below))

    def active(self, contact: Contact) -> BoolArray:
        """Below the largest deflection so far."""
        return np.asarray(contact.deflection < np.maximum.accumulate(contact.deflection) - 1e-6)


@dataclass(frozen=True)
class StretchedRelaxation(Effect):
    """Overstress that decays by a stretched exponential: F = g integral exp(-((t - s)/tau)^b) dF_e(s).

    Source: Kohlrausch (1854); Williams & Watts, Trans. Faraday Soc. 66, 80 (1970).
    """

    time_constant: float
    stretching: float

    name: ClassVar[str] = "viscoelastic_relaxation"
    unit: ClassVar[str] = "1"
    limit: ClassVar[float] = 0.5

    @classmethod
    def drawn(cls, rng: np.random.Generator, conditions: Conditions) -> "StretchedRelaxation":
        """Times that the recordings can show, stretched over some decades."""
        longest = max(0.1 * conditions.longest, 0.5)
        return cls(0.08, float(np.exp(rng.uniform(np.log(0.1), np.log(longest)))), rng.uniform(0.3, 0.6))

    def parallel(self, contact: Contact) -> FloatArray:
        """Overstress [N]."""
        changes = np.diff(contact.elastic, prepend=contact.elastic[0])
        age = (np.arange(changes.size) + 0.5) * contact.motion.step
        kernel = np.exp(-((age / self.time_constant) ** self.stretching))
        return np.asarray(self.strength * fftconvolve(changes, kernel)[: changes.size])


@dataclass(frozen=True)
class BindingSpring(YieldingWheel):
    """A series spring that binds up: d = s F_h ln(1 + F/F_h), so its stiffness grows linearly with the force."""

    @classmethod
    def drawn(cls, rng: np.random.Generator, conditions: Conditions) -> "BindingSpring":
        """Twice as stiff at a fifth to all of the largest force."""
        return cls(1.0 / 1e6, conditions.strongest * rng.uniform(0.2, 1.0))

    def shortening(self, force: FloatArray) -> FloatArray:
        """Deflection of the spring [m]."""
        return np.asarray(self.strength * self.hardening * np.log1p(np.maximum(force, 0.0) / self.hardening))


#: The foreign forms; a law that is no power of x is a tire, see `laws`.
FOREIGN: tuple[type[Effect], ...] = (
    UnevenDashpot,
    RootDashpot,
    QuadraticDashpot,
    ReboundValve,
    BreakawayFriction,
    AsymmetricFriction,
    BroadIwanFriction,
    LoopedRim,
    HealingSoftening,
    OrificeLeak,
    StretchedRelaxation,
    Springpot,
    BindingSpring,
)
