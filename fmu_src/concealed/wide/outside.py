"""More physics outside any catalogue, beside that of `open_world`: it is drawn in trials of the kind `outside` only."""

from dataclasses import dataclass
from typing import ClassVar

import numpy as np
from scipy.signal import butter, sosfilt

from ..effects.effect import Conditions, Contact, Effect
from ..motion import FloatArray, Motion
from ..open_world import OPEN_WORLD


@dataclass(frozen=True)
class Chatter(Effect):
    """A guide sticks and slips: at each slip, every l [m] of travel, the frame rings with f [Hz] and dies away."""

    pitch: float
    frequency: float
    decay: float

    name: ClassVar[str] = "stick_slip_chatter"
    unit: ClassVar[str] = "N"
    limit: ClassVar[float] = 400.0

    @classmethod
    def drawn(cls, rng: np.random.Generator, conditions: Conditions) -> "Chatter":
        """Slips after each twelfth to fifth of the stroke; the ring lies below an eighth of the sampling rate."""
        quickest = 1.0 / max(m.sample_step for m in conditions.motions)
        frequency = min(rng.uniform(3.0, 12.0), quickest / 8.0)
        return cls(
            40.0, conditions.deepest * rng.uniform(0.08, 0.2), frequency, rng.uniform(1.5, 5.0) / frequency
        )

    def machine(self, contact: Contact) -> FloatArray:
        """Ringing force [N]."""
        x, time = contact.motion.deflection, contact.motion.time
        path = np.floor(np.cumsum(np.abs(np.diff(x, prepend=x[0]))) / self.pitch)
        ring = np.zeros_like(time)
        for start in np.flatnonzero(np.diff(path, prepend=0.0) > 0.0):
            age = time[start:] - time[start]
            near = age < 8.0 * self.decay
            ring[start:][near] += np.exp(-age[near] / self.decay) * np.cos(
                2.0 * np.pi * self.frequency * age[near]
            )
        return self.strength * ring


@dataclass(frozen=True)
class Thixotropy(Effect):
    """A sealant thins while it is sheared and sets at rest: F = f (1 - q) tanh(v/v_0), q' = (1 - q)|v|/l - q/T.

    Breakdown distance l [m], setting time T [s]; no temperature enters. Starts set (q = 0).
    """

    distance: float
    setting: float

    name: ClassVar[str] = "thixotropy"
    unit: ClassVar[str] = "N"
    limit: ClassVar[float] = 400.0

    @classmethod
    def drawn(cls, rng: np.random.Generator, conditions: Conditions) -> "Thixotropy":
        """Thins over one to four strokes; sets within a twentieth to a third of the recording."""
        return cls(
            40.0, conditions.deepest * rng.uniform(1.0, 4.0), conditions.longest * rng.uniform(0.05, 0.33)
        )

    def machine(self, contact: Contact) -> FloatArray:
        """Force of the sealant [N]."""
        rate, step = contact.motion.rate, contact.motion.step
        thinning = (np.abs(rate) / self.distance).tolist()
        broken, history = 0.0, []
        for speed in thinning:
            total = speed + 1.0 / self.setting
            settled = speed / total
            broken = settled + (broken - settled) * float(np.exp(-total * step))
            history.append(broken)
        return np.asarray(self.strength * (1.0 - np.array(history)) * np.tanh(rate / 1e-3))


@dataclass(frozen=True)
class Backlash(Effect):
    """A pin with play between actuator and gauge: after each reversal the tire waits for `strength` [m] of travel.

    Below the opening deflection [m] the pin hangs to one side and has no play.
    """

    opening: float

    name: ClassVar[str] = "load_path_backlash"
    unit: ClassVar[str] = "m"
    limit: ClassVar[float] = 0.003

    @classmethod
    def drawn(cls, rng: np.random.Generator, conditions: Conditions) -> "Backlash":
        """The pin opens in the upper half of the stroke."""
        return cls(0.2e-3, conditions.deepest * rng.uniform(0.4, 0.65))

    def gauge_error(self, motion: Motion) -> FloatArray:
        """Play [m] between the gauge and the tire."""
        half, at, places = 0.5 * self.strength, float(motion.deflection[0]), []
        for x in motion.deflection.tolist():
            at = min(max(at, x - half), x + half) if x > self.opening else x
            places.append(at)
        return np.array(places, dtype=np.float64) - motion.deflection


@dataclass(frozen=True)
class StiffeningTread(Effect):
    """A tread that stiffens beyond a force F_t: F + s (F - F_t), on every surface at the same force."""

    threshold: float

    name: ClassVar[str] = "stiffening_tread"
    unit: ClassVar[str] = "1"
    limit: ClassVar[float] = 1.5

    @classmethod
    def drawn(cls, rng: np.random.Generator, conditions: Conditions) -> "StiffeningTread":
        """From a third to three quarters of the largest force on."""
        return cls(0.1, conditions.strongest * rng.uniform(0.35, 0.75))

    def parallel(self, contact: Contact) -> FloatArray:
        """Additional force [N]."""
        return self.strength * np.maximum(contact.elastic - self.threshold, 0.0)


@dataclass(frozen=True)
class LateralCrosstalk(Effect):
    """The load cell sees a share of a lateral force that wanders by itself between f/10 and f [Hz]."""

    frequency: float
    seed: int

    name: ClassVar[str] = "lateral_crosstalk"
    unit: ClassVar[str] = "N"
    limit: ClassVar[float] = 300.0

    @classmethod
    def drawn(cls, rng: np.random.Generator, conditions: Conditions) -> "LateralCrosstalk":
        """Up to thirty swings in the shortest recording."""
        shortest = min(m.duration for m in conditions.motions)
        return cls(20.0, rng.uniform(8.0, 30.0) / shortest, int(rng.integers(2**31)))

    def machine(self, contact: Contact) -> FloatArray:
        """Foreign force [N] of unit RMS times the strength."""
        motion = contact.motion
        rng = np.random.default_rng([self.seed, motion.time.size])
        edges = np.array([0.1, 1.0]) * min(self.frequency, 0.2 / motion.step)
        band = butter(2, edges, "bandpass", fs=1.0 / motion.step, output="sos")
        wander = sosfilt(band, rng.standard_normal(motion.time.size))
        return np.asarray(self.strength * wander / max(float(np.std(wander)), 1e-12))


@dataclass(frozen=True)
class WavyGauge(Effect):
    """An encoder that interpolates badly: it shows x + e sin(2 pi x/l), period l [m]."""

    period: float
    phase: float

    name: ClassVar[str] = "nonlinear_gauge"
    unit: ClassVar[str] = "m"
    limit: ClassVar[float] = 0.0005

    @classmethod
    def drawn(cls, rng: np.random.Generator, conditions: Conditions) -> "WavyGauge":
        """Four to nine periods over the stroke, so that the gauge stays monotonic."""
        return cls(0.05e-3, conditions.deepest / rng.uniform(4.0, 9.0), rng.uniform(0.0, 2.0 * np.pi))

    def reading(self, deflection: FloatArray) -> FloatArray:
        """What the gauge shows [m]."""
        wave = np.sin(2.0 * np.pi * deflection / self.period + self.phase)
        return np.asarray(deflection + self.strength * (wave - np.sin(self.phase)), dtype=np.float64)


@dataclass(frozen=True)
class ClippedGauge(Effect):
    """A gauge at the end of its travel: it shows no more than (1 - s) of the deepest deflection."""

    deepest: float

    name: ClassVar[str] = "clipped_gauge"
    unit: ClassVar[str] = "1"
    limit: ClassVar[float] = 0.3

    @classmethod
    def drawn(cls, rng: np.random.Generator, conditions: Conditions) -> "ClippedGauge":
        """Reached by some of the samples."""
        return cls(0.05, conditions.deepest)

    def reading(self, deflection: FloatArray) -> FloatArray:
        """What the gauge shows [m]."""
        return np.minimum(deflection, (1.0 - self.strength) * self.deepest)


#: What the catalogue lacks altogether.
OUTSIDE: tuple[type[Effect], ...] = (
    *OPEN_WORLD,
    Chatter,
    Thixotropy,
    Backlash,
    StiffeningTread,
    LateralCrosstalk,
    WavyGauge,
    ClippedGauge,
)
