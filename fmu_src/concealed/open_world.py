"""Physics outside any catalogue of tire effects: what the ground, the rig and its surroundings do."""

from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from .effects.effect import Conditions, Contact, Effect, Region
from .effects.machine import filtered
from .motion import BoolArray, FloatArray, Motion


@dataclass(frozen=True)
class KnobRipple(Effect):
    """Tread knobs meet the edge of the contact one by one: F = a sin(2 pi x/l + phase) in contact."""

    pitch: float
    phase: float

    name: ClassVar[str] = "knob_ripple"
    unit: ClassVar[str] = "N"
    limit: ClassVar[float] = 200.0

    @classmethod
    def drawn(cls, rng: np.random.Generator, conditions: Conditions) -> "KnobRipple":
        """Four to nine knobs over the deepest deflection: knobs stand 3 to 6 mm apart in x."""
        return cls(30.0, conditions.deepest / rng.uniform(4.0, 9.0), rng.uniform(0.0, 2.0 * np.pi))

    def parallel(self, contact: Contact) -> FloatArray:
        """Ripple [N]."""
        wave = np.sin(2.0 * np.pi * contact.deflection / self.pitch + self.phase)
        return self.strength * wave * contact.touching


@dataclass(frozen=True)
class StickSlip(Effect):
    """A squeaking guide: a saw tooth over the distance travelled s, F = a saw(s/l) sgn(v)."""

    pitch: float
    release: float

    name: ClassVar[str] = "stick_slip"
    unit: ClassVar[str] = "N"
    limit: ClassVar[float] = 250.0

    @classmethod
    def drawn(cls, rng: np.random.Generator, conditions: Conditions) -> "StickSlip":
        """Slips after every tenth to quarter of the stroke."""
        return cls(40.0, conditions.deepest * rng.uniform(0.1, 0.25), rng.uniform(0.75, 0.9))

    def machine(self, contact: Contact) -> FloatArray:
        """Saw tooth [N] of zero mean."""
        x = contact.motion.deflection
        path = np.cumsum(np.abs(np.diff(x, prepend=x[0]))) / self.pitch
        phase = path - np.floor(path)
        tooth = np.where(phase < self.release, phase / self.release, (1.0 - phase) / (1.0 - self.release))
        return self.strength * (tooth - 0.5) * np.tanh(contact.motion.rate / 1e-4)


@dataclass(frozen=True)
class EccentricWheel(Effect):
    """The wheel creeps round in its fork and is out of true by e sin(2 pi f t + phase)."""

    frequency: float
    phase: float

    name: ClassVar[str] = "eccentric_wheel"
    unit: ClassVar[str] = "m"
    limit: ClassVar[float] = 0.002

    @classmethod
    def drawn(cls, rng: np.random.Generator, conditions: Conditions) -> "EccentricWheel":
        """Some turns in the shortest recording, not in step with a drive."""
        shortest = min(m.duration for m in conditions.motions)
        slowest = min(m.sample_step for m in conditions.motions)
        return cls(
            0.2e-3, min(rng.uniform(5.3, 13.7) / shortest, 0.11 / slowest), rng.uniform(0.0, 2.0 * np.pi)
        )

    def gauge_error(self, motion: Motion) -> FloatArray:
        """Runout [m] that the gauge does not see."""
        return self.strength * np.sin(2.0 * np.pi * self.frequency * motion.time + self.phase)


@dataclass(frozen=True)
class OneSidedPlay(Effect):
    """A pin with a dead zone: while unloading, the frame loses the force f within a window of deflection."""

    middle: float
    width: float

    name: ClassVar[str] = "one_sided_play"
    unit: ClassVar[str] = "N"
    limit: ClassVar[float] = 300.0

    @classmethod
    def drawn(cls, rng: np.random.Generator, conditions: Conditions) -> "OneSidedPlay":
        """A window in the middle of the stroke."""
        return cls(
            40.0,
            conditions.deflection_quantile(rng.uniform(0.35, 0.65)),
            conditions.deepest * rng.uniform(0.03, 0.06),
        )

    def machine(self, contact: Contact) -> FloatArray:
        """Lost force [N]."""
        bump = np.exp(-0.5 * ((contact.motion.deflection - self.middle) / self.width) ** 2)
        return -self.strength * bump * unloading(contact)

    def active(self, contact: Contact) -> BoolArray:
        """Unloading, within two widths."""
        near = np.abs(contact.motion.deflection - self.middle) < 2.0 * self.width
        return near & unloading(contact)

    def regions(self, motion: Motion) -> list[Region]:
        """The window and the branch."""
        low, high = self.middle - 2.0 * self.width, self.middle + 2.0 * self.width
        return [
            Region("deflection", low, high, "m"),
            Region("direction", "unloading", "unloading", "1"),
        ]


@dataclass(frozen=True)
class AmplifierJump(Effect):
    """The amplifier's zero jumps and comes back: `strength` [N] within a share of the time."""

    begin: float
    end: float

    name: ClassVar[str] = "amplifier_jump"
    unit: ClassVar[str] = "N"
    limit: ClassVar[float] = 300.0

    @classmethod
    def drawn(cls, rng: np.random.Generator, conditions: Conditions) -> "AmplifierJump":
        """A few percent up to a fifth of the time."""
        begin = rng.uniform(0.15, 0.75)
        return cls(float(rng.choice((-1.0, 1.0))) * 20.0, begin, begin + rng.uniform(0.03, 0.2))

    def _inside(self, motion: Motion) -> BoolArray:
        share = motion.time / motion.duration
        return (share >= self.begin) & (share <= self.end)

    def channel(self, motion: Motion, force: FloatArray) -> FloatArray:
        """Force [N] with the jump."""
        return force + self.strength * self._inside(motion)

    def active(self, contact: Contact) -> BoolArray:
        """Within the span."""
        return self._inside(contact.motion)

    def regions(self, motion: Motion) -> list[Region]:
        """The span of time."""
        return [Region("time", self.begin * motion.duration, self.end * motion.duration, "s")]


@dataclass(frozen=True)
class Crosstalk(Effect):
    """A shaker next door: `strength` [N] at its own frequency, swelling and fading."""

    frequency: float
    swelling: float
    phase: float

    name: ClassVar[str] = "shaker_crosstalk"
    unit: ClassVar[str] = "N"
    limit: ClassVar[float] = 200.0

    @classmethod
    def drawn(cls, rng: np.random.Generator, conditions: Conditions) -> "Crosstalk":
        """Below a quarter of the slowest sampling rate, above the drive's own period."""
        slowest = max(m.sample_step for m in conditions.motions)
        return cls(
            12.0, rng.uniform(0.08, 0.23) / slowest, rng.uniform(1.3, 4.7), rng.uniform(0.0, 2.0 * np.pi)
        )

    def machine(self, contact: Contact) -> FloatArray:
        """Foreign force [N]."""
        time, share = contact.motion.time, contact.motion.time / contact.motion.duration
        loud = 1.0 + 0.5 * np.sin(2.0 * np.pi * self.swelling * share + self.phase)
        return self.strength * loud * np.sin(2.0 * np.pi * self.frequency * time + self.phase)


@dataclass(frozen=True)
class FrameResonance(Effect):
    """The load frame rings: a share of the force passes through a lightly damped mode of the frame.

    F + s (G - 1) F, G = w^2/(p^2 + 2 z w p + w^2), mode w = 2 pi f, damping ratio z.
    """

    frequency: float
    damping: float

    name: ClassVar[str] = "frame_resonance"
    unit: ClassVar[str] = "1"
    limit: ClassVar[float] = 1.5

    @classmethod
    def drawn(cls, rng: np.random.Generator, conditions: Conditions) -> "FrameResonance":
        """A mode that the drive excites: between 2 Hz and an eighth of the sampling rate."""
        quickest = 1.0 / min(m.sample_step for m in conditions.motions)
        return cls(0.3, min(rng.uniform(3.0, 9.0), quickest / 8.0), rng.uniform(0.01, 0.04))

    def channel(self, motion: Motion, force: FloatArray) -> FloatArray:
        """Ringing force [N]."""
        corner = 2.0 * np.pi * self.frequency
        mode = filtered(force, motion.step, np.array([1.0]), np.array([1.0, 2.0 * self.damping, 1.0]), corner)
        return force + self.strength * (mode - force)


@dataclass(frozen=True)
class BeadSnap(Effect):
    """The bead snaps out of the rim at one deflection and back at a smaller one: Preisach's relay."""

    snaps: float
    seats: float

    name: ClassVar[str] = "bead_snap"
    unit: ClassVar[str] = "N"
    limit: ClassVar[float] = 300.0

    @classmethod
    def drawn(cls, rng: np.random.Generator, conditions: Conditions) -> "BeadSnap":
        """Out at two thirds of the stroke, back a little below."""
        snaps = conditions.deepest * rng.uniform(0.55, 0.85)
        return cls(40.0, snaps, snaps - conditions.deepest * rng.uniform(0.03, 0.12))

    def parallel(self, contact: Contact) -> FloatArray:
        """Lost force [N] while the bead is out."""
        return -self.strength * self._out(contact.deflection).astype(float)

    def _out(self, deflection: FloatArray) -> BoolArray:
        decided = np.where(deflection >= self.snaps, 1, np.where(deflection <= self.seats, 0, -1))
        decided[0] = max(int(decided[0]), 0)
        last = np.maximum.accumulate(np.where(decided >= 0, np.arange(decided.size), 0))
        return np.asarray(decided[last] == 1)

    def active(self, contact: Contact) -> BoolArray:
        """While the bead is out."""
        return self._out(contact.deflection)

    def regions(self, motion: Motion) -> list[Region]:
        """Beyond the deflection at which the bead sits again."""
        return [Region("deflection", self.seats, None, "m")]


@dataclass(frozen=True)
class ZeroDrift(Effect):
    """The amplifier's zero breathes with the air conditioning, two or three swings in a recording."""

    swings: float
    phase: float

    name: ClassVar[str] = "zero_drift"
    unit: ClassVar[str] = "N"
    limit: ClassVar[float] = 200.0

    @classmethod
    def drawn(cls, rng: np.random.Generator, conditions: Conditions) -> "ZeroDrift":
        """Swings that no exponential approach resembles."""
        return cls(12.0, rng.uniform(1.7, 3.4), rng.uniform(0.0, 2.0 * np.pi))

    def channel(self, motion: Motion, force: FloatArray) -> FloatArray:
        """Drifting force [N]."""
        share = motion.time / motion.duration
        wave = np.sin(2.0 * np.pi * self.swings * share + self.phase)
        return force + self.strength * (wave + 0.4 * np.sin(2.3 * np.pi * self.swings * share))


@dataclass(frozen=True)
class Adhesion(Effect):
    """A wet surface holds the tread: the force falls short over the last millimetres of unloading."""

    height: float

    name: ClassVar[str] = "adhesion"
    unit: ClassVar[str] = "N"
    limit: ClassVar[float] = 300.0

    @classmethod
    def drawn(cls, rng: np.random.Generator, conditions: Conditions) -> "Adhesion":
        """Within the shallowest tenth or two of the samples."""
        return cls(40.0, conditions.deflection_quantile(rng.uniform(0.1, 0.2)) * 0.6 + 0.5e-3)

    def machine(self, contact: Contact) -> FloatArray:
        """Pull [N], falling off with the deflection."""
        x = np.maximum(contact.motion.deflection, 0.0)
        return -self.strength * np.exp(-((x / self.height) ** 2)) * unloading(contact)

    def active(self, contact: Contact) -> BoolArray:
        """Unloading, near the surface."""
        return (contact.motion.deflection < 1.5 * self.height) & unloading(contact)

    def regions(self, motion: Motion) -> list[Region]:
        """The shallow end of the unloading branch."""
        return [
            Region("deflection", 0.0, 1.5 * self.height, "m"),
            Region("direction", "unloading", "unloading", "1"),
        ]


@dataclass(frozen=True)
class StuckChannel(Effect):
    """The force channel hangs now and then on an old value: `strength` is the share of time it hangs."""

    moments: tuple[float, ...]

    name: ClassVar[str] = "stuck_channel"
    unit: ClassVar[str] = "1"
    limit: ClassVar[float] = 0.15

    @classmethod
    def drawn(cls, rng: np.random.Generator, conditions: Conditions) -> "StuckChannel":
        """Two to six times in a recording."""
        return cls(0.04, tuple(np.sort(rng.uniform(0.05, 0.85, int(rng.integers(2, 7)))).tolist()))

    def _hanging(self, motion: Motion) -> BoolArray:
        share = (motion.time / motion.duration)[:, None] - np.array(self.moments)
        hanging = (share > 0.0) & (share < self.strength / len(self.moments))
        return np.asarray(np.any(hanging, axis=1))

    def channel(self, motion: Motion, force: FloatArray) -> FloatArray:
        """The last value before each hang [N]."""
        free = np.where(self._hanging(motion), 0, np.arange(force.size))
        return force[np.maximum.accumulate(free)]

    def active(self, contact: Contact) -> BoolArray:
        """While it hangs."""
        return self._hanging(contact.motion)

    def regions(self, motion: Motion) -> list[Region]:
        """Every span in which it hangs."""
        length = self.strength / len(self.moments)
        return [
            Region("time", m * motion.duration, (m + length) * motion.duration, "s") for m in self.moments
        ]


def unloading(contact: Contact) -> BoolArray:
    """Where the actuator goes back, faster than 0.1 mm/s: a hold is no unloading."""
    return contact.motion.rate < -1e-4


OPEN_WORLD: tuple[type[Effect], ...] = (
    KnobRipple,
    StickSlip,
    EccentricWheel,
    OneSidedPlay,
    AmplifierJump,
    Crosstalk,
    FrameResonance,
    BeadSnap,
    ZeroDrift,
    Adhesion,
    StuckChannel,
)
