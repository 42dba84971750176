"""The rig's own formulation of every named effect with free constants, for a least-squares fit."""

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import ClassVar

import numpy as np

from .bench import Bench
from .effects import BY_NAME, Conditions, Contact, Effect
from .effects.damping import PowerDashpot
from .effects.friction import IwanFriction
from .effects.machine import GaugeZero, LoadCellZero, LowPass, MovingMass, PureDelay, SoftClip
from .effects.pressure import ExponentialLeak, PolytropicGas, WarmingAir
from .effects.relaxation import Springpot, overstress
from .effects.rim import SoftplusRim
from .effects.series import YieldingWheel
from .effects.softening import GatheringDamage, OgdenRoxburgh
from .motion import FloatArray, Motion

#: A fitted strength may exceed the plausible one by this factor.
BEYOND_PLAUSIBLE = 2.0
#: Least strength of a fit over that of its start.
LEAST_STRENGTH = 1e-3
#: Factor up and down within which a positive constant of a hidden effect is fitted.
OWN_SPAN = 4.0


@dataclass(frozen=True)
class Free:
    """A positive constant that is fitted on its logarithm between two limits."""

    name: str
    low: float
    high: float


@dataclass(frozen=True)
class Template:
    """An effect whose constants are where a fit starts; its strength and the constants in `free` are fitted."""

    start: Effect
    free: tuple[Free, ...] = ()
    signed: bool = False

    @property
    def values(self) -> list[float]:
        """Where the fit starts: strength over that of `start`, logarithms of the constants."""
        return [1.0, *(float(np.log(np.clip(getattr(self.start, f.name), f.low, f.high))) for f in self.free)]

    @property
    def bounds(self) -> tuple[list[float], list[float]]:
        """Limits of the values."""
        most = BEYOND_PLAUSIBLE * self.start.limit / abs(self.start.strength)
        low = [-most if self.signed else 0.0, *(float(np.log(f.low)) for f in self.free)]
        return low, [most, *(float(np.log(f.high)) for f in self.free)]

    def made(self, values: FloatArray) -> Effect:
        """The effect of some values."""
        constants = {f.name: float(np.exp(v)) for f, v in zip(self.free, values[1:], strict=True)}
        factor = float(values[0])
        # a filter without delay has an infinite corner: the least strength is a thousandth
        if abs(factor) < LEAST_STRENGTH:
            factor = LEAST_STRENGTH if factor >= 0.0 else -LEAST_STRENGTH
        return replace(self.start, strength=self.start.strength * factor, **constants)


@dataclass(frozen=True)
class ThreeBranches(Effect):
    """Three Maxwell branches with time constants t, r t and r^2 t [s], shares g, g s2 and g s3 [1]."""

    shortest: float
    ratio: float
    second: float
    third: float

    name: ClassVar[str] = "viscoelastic_relaxation"
    unit: ClassVar[str] = "1"
    limit: ClassVar[float] = 0.35

    @classmethod
    def drawn(cls, rng: np.random.Generator, conditions: Conditions) -> "ThreeBranches":
        """One decade between the branches, around a tenth of the recording."""
        return cls(0.02, max(0.01 * conditions.longest, 1e-3), 10.0, 1.0, 1.0)

    def parallel(self, contact: Contact) -> FloatArray:
        """Overstress [N]."""
        total = np.zeros_like(contact.elastic)
        for power, share in enumerate((1.0, self.second, self.third)):
            constant = self.shortest * self.ratio**power
            total += share * overstress(contact.elastic, contact.motion.step, constant)
        return self.strength * total


def templates(bench: Bench, motions: tuple[Motion, ...], noise: float) -> Mapping[str, tuple[Template, ...]]:
    """The templates of every name but `recalibration`; a hidden effect has its own form alone, for it fits best.

    bench: the tire and what is hidden in it, where it has a form of `effects`; noise [N].
    """
    bare = Bench(bench.tire)
    conditions = Conditions(motions, tuple(bare.force(m) for m in motions), bench.tire, noise)
    found = _general(conditions)
    for effect in bench.effects:
        if type(effect) in BY_NAME.get(effect.name, ()):
            signed = effect.name in ("deflection_offset", "force_offset")
            found[effect.name] = (Template(effect, _own(effect), signed),)
    return found


def _own(effect: Effect) -> tuple[Free, ...]:
    """The positive constants of a hidden effect."""
    fixed = ("strength", "reference", "largest", "wheel", "load_share", "order")
    values = {name: value for name, value in vars(effect).items() if name not in fixed}
    return tuple(
        Free(name, value / OWN_SPAN, value * OWN_SPAN)
        for name, value in values.items()
        if isinstance(value, float) and value > 0.0
    )


def _general(conditions: Conditions) -> dict[str, tuple[Template, ...]]:
    deep, strong, longest = conditions.deepest, conditions.strongest, conditions.longest
    shortest = min(m.sample_step for m in conditions.motions)
    rate = max(conditions.typical_rate, 1e-6)
    energy = 0.4 * strong * deep
    constants = (Free("shortest", 0.3 * shortest, longest), Free("ratio", 2.0, 30.0))
    shares = (Free("second", 1e-3, 1e3), Free("third", 1e-3, 1e3))
    branches = ThreeBranches(0.02, max(0.01 * longest, shortest), 10.0, 1.0, 1.0)
    knee = (Free("onset", 0.3 * deep, deep), Free("soft", 1e-3 * deep, 0.1 * deep))
    return {
        "deflection_offset": (Template(GaugeZero(0.5e-3), (), True),),
        "force_offset": (Template(LoadCellZero(20.0), (), True),),
        "rate_independent_hysteresis": (
            Template(
                IwanFriction(0.03 * strong, 0.03 * deep, 0.6, 0.5, strong),
                (
                    Free("reach", 2e-3 * deep, 0.5 * deep),
                    Free("spread", 0.05, 3.0),
                    Free("load_share", 0.01, 1.0),
                ),
            ),
        ),
        "viscous_damping": (Template(PowerDashpot(300.0, rate, 1.0), (Free("exponent", 0.5, 2.0),)),),
        "viscoelastic_relaxation": (
            Template(branches, (*constants, *shares)),
            Template(Springpot(0.03, 0.5, 0.35), (Free("order", 0.05, 0.95),)),
        ),
        "series_compliance": (Template(YieldingWheel(1e-6, 0.02), (Free("hardening", 2e-3, 1.0),)),),
        "gas_compression": (Template(PolytropicGas(0.02, 1.2, 2.4, 0.335), (Free("exponent", 2.0, 3.0),)),),
        "bottoming": tuple(Template(SoftplusRim(1e5, at * deep, 0.02 * deep), knee) for at in (0.75, 0.92)),
        "mullins_softening": (
            Template(
                OgdenRoxburgh(0.08, 0.2 * energy, 0.3),
                (Free("energy", 0.02 * energy, 2.0 * energy), Free("share", 0.02, 2.0)),
            ),
            Template(
                GatheringDamage(0.08, 0.7 * deep, 3.0),
                (Free("way", 0.05 * deep, 10.0 * deep), Free("power", 0.3, 10.0)),
            ),
        ),
        "pressure_leak": (Template(ExponentialLeak(0.05 / longest)),),
        "warm_up": (
            Template(
                WarmingAir(8.0, 0.5, 0.07 * longest, 0.4 * longest),
                (Free("quick", 0.01 * longest, longest), Free("late", 0.02 * longest, 3.0 * longest)),
            ),
        ),
        "inertia": (Template(MovingMass(2.0)),),
        "force_lag": (Template(PureDelay(0.005)), Template(LowPass(0.005, 4, True))),
        "saturation": tuple(
            Template(SoftClip(at, strong, conditions.noise), (Free("rounding", 1e-4 * strong, 0.1 * strong),))
            for at in (0.05, 0.2)
        ),
    }
