"""The hidden effects that a catalogue of tire physics has a name for, each in other equations than usual."""

from concealed.effects.damping import LinearDashpot, PowerDashpot, SaturatingDashpot
from concealed.effects.effect import Contact, Effect, Place, Scene
from concealed.effects.friction import BoucWenFriction, IwanFriction
from concealed.effects.machine import (
    GaugeZero,
    LoadCellZero,
    LowPass,
    MovingMass,
    PureDelay,
    RationalClip,
    SoftClip,
)
from concealed.effects.pressure import ExponentialLeak, OrificeLeak, PolytropicGas, WarmingAir
from concealed.effects.relaxation import PronySeries, Springpot
from concealed.effects.rim import QuadraticRim, SoftplusRim
from concealed.effects.series import YieldingWheel
from concealed.effects.softening import GatheringDamage, OgdenRoxburgh

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
    "Place",
    "Scene",
    *sorted(form.__name__ for form in FORMS),
]
