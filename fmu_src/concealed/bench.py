"""The test bench: a tire, the effects hidden in it, and the force that a motion causes."""

from dataclasses import dataclass, replace

import numpy as np

from .effects.effect import Contact, Effect
from .motion import BoolArray, FloatArray, Motion
from .tires import Tire

#: Wheel and tire in series are balanced to within this length [m]: a millinewton at 1e5 N/m.
BALANCE = 1e-8


@dataclass(frozen=True)
class Bench:
    """A tire and the effects that are hidden, in the order of the signal whatever the order in the tuple."""

    tire: Tire
    effects: tuple[Effect, ...] = ()

    def without(self, name: str) -> "Bench":
        """The same bench with every effect of that name taken out."""
        return Bench(self.tire, tuple(e for e in self.effects if e.name != name))

    def replacing(self, effect: Effect) -> "Bench":
        """The same bench with the effect of the same name replaced."""
        return Bench(self.tire, tuple(effect if e.name == effect.name else e for e in self.effects))

    def shown(self, deflection: FloatArray) -> FloatArray:
        """What the gauge shows [m] of the deflection [m] that the actuator makes, free of noise."""
        for effect in self.effects:
            deflection = effect.reading(deflection)
        return deflection

    def seen(self, motion: Motion) -> Motion:
        """The motion as the gauge shows it."""
        shown = self.shown(motion.deflection)
        return motion if shown is motion.deflection else replace(motion, deflection=shown)

    def contact(self, motion: Motion) -> Contact:
        """Deflection of the tire [m] and its elastic force [N], before anything acts in parallel."""
        gauge = motion.deflection
        pressure = np.ones_like(gauge)
        for effect in self.effects:
            gauge = gauge + effect.gauge_error(motion)
            pressure = pressure * effect.pressure_ratio(motion)
        deflection = self._balanced(gauge, motion.radius, pressure)
        return Contact(motion, deflection, self._elastic(deflection, motion.radius, pressure))

    def force(self, motion: Motion) -> FloatArray:
        """Force [N] at the output of the force channel on the fine grid, free of noise."""
        contact = self.contact(motion)
        force = np.where(contact.deflection > 0.0, np.maximum(self._pressing(contact), 0.0), 0.0)
        for effect in self.effects:
            force = force + effect.machine(contact)
        # the zero and the ceiling come after the filter: the amplifier's last stage
        for effect in sorted(self.effects, key=lambda e: CHANNEL_ORDER.get(e.name, 1)):
            force = effect.channel(motion, force)
        return force

    def contact_lost(self, motion: Motion) -> BoolArray:
        """The samples at which contact is lost although the tire is deflected: it would have to pull."""
        contact = self.contact(motion)
        return (contact.deflection > 0.0) & (self._pressing(contact) < 0.0)

    def _pressing(self, contact: Contact) -> FloatArray:
        """Force [N] in the contact if it could pull."""
        force = contact.elastic
        for effect in self.effects:
            force = force * effect.softening(contact)
        for effect in self.effects:
            force = force + effect.parallel(contact)
        return force

    def _elastic(self, deflection: FloatArray, radius: FloatArray, pressure: FloatArray) -> FloatArray:
        for effect in self.effects:
            pressure = pressure * effect.gas_ratio(deflection, radius)
        return self.tire.force(deflection, radius, pressure)

    def _balanced(self, total: FloatArray, radius: FloatArray, pressure: FloatArray) -> FloatArray:
        """The tire's own deflection [m] of the total [m], found by the Illinois method at all samples at once."""
        if all(np.all(np.asarray(e.shortening(np.array([1.0]))) == 0.0) for e in self.effects):
            return total

        def imbalance(tire: FloatArray) -> FloatArray:
            force = self._elastic(tire, radius, pressure)
            return tire + sum((e.shortening(force) for e in self.effects), start=np.zeros_like(tire)) - total

        low, high = np.minimum(total, 0.0), np.array(total)
        below, above = imbalance(low), imbalance(high)
        tire = high
        for _ in range(60):
            span = above - below
            tire = np.where(span > 0.0, high - above * (high - low) / np.where(span > 0.0, span, 1.0), high)
            miss = imbalance(tire)
            if float(np.max(np.abs(miss))) < BALANCE:
                break
            upper = miss > 0.0
            # Illinois: the end that stays twice is given half its weight, so that both ends close in
            below = np.where(upper, 0.5 * below, miss)
            above = np.where(upper, miss, 0.5 * above)
            low, high = np.where(upper, low, tire), np.where(upper, tire, high)
        return tire


#: Filter, then zero, then ceiling; whatever is not named stands between filter and ceiling.
CHANNEL_ORDER = {"force_lag": 0, "frame_resonance": 0, "saturation": 2, "stuck_channel": 3}
