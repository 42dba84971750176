"""The hidden effects that a catalogue of tire physics has a name for, each in other equations than usual."""

from .damping import LinearDashpot, PowerDashpot, SaturatingDashpot
from .effect import Conditions, Contact, Effect, Region
from .friction import BoucWenFriction, IwanFriction
from .machine import (
    GaugeZero,
    LoadCellZero,
    LowPass,
    MovingMass,
    PureDelay,
    RationalClip,
    SoftClip,
)
from .pressure import ExponentialLeak, OrificeLeak, PolytropicGas, WarmingAir
from .relaxation import PronySeries, Springpot
from .rim import QuadraticRim, SoftplusRim
from .series import YieldingWheel
from .softening import GatheringDamage, OgdenRoxburgh

#: Every form of every effect that has a name, without `recalibration`, which is a property of the tire.
FORMS: tuple[type[Effect], ...] = (
    GaugeZero,
    LoadCellZero,
    IwanFriction,
    BoucWenFriction,
    LinearDashpot,
    PowerDashpot,
    SaturatingDashpot,
    PronySeries,
    Springpot,
    YieldingWheel,
    PolytropicGas,
    QuadraticRim,
    SoftplusRim,
    OgdenRoxburgh,
    GatheringDamage,
    ExponentialLeak,
    OrificeLeak,
    WarmingAir,
    MovingMass,
    PureDelay,
    LowPass,
    SoftClip,
    RationalClip,
)

#: The forms by their name.
BY_NAME: dict[str, tuple[type[Effect], ...]] = {
    name: tuple(form for form in FORMS if form.name == name) for name in dict.fromkeys(f.name for f in FORMS)
}

__all__ = [
    "BY_NAME",
    "FORMS",
    "Contact",
    "Effect",
    "Region",
    "Conditions",
    *sorted(form.__name__ for form in FORMS),
]
