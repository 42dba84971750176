"""Errors of the measurement: white and slow noise, mains hum, steps of the converter, spikes, a noisy gauge."""

from dataclasses import dataclass

import numpy as np
from scipy.fft import dct, idct
from scipy.signal import butter, freqz, lfilter

from .motion import FloatArray

WHOLE = np.linspace(0.0, np.pi, 4096)
"""Angles [rad] of all frequencies up to half the sampling rate."""

UNFILTERED = 0.01
"""Part of the noise's power that comes in behind the filter: the converter's own."""


@dataclass(frozen=True)
class Instrument:
    """The errors of load cell and gauge.

    white, drifting (first-order Markov, of the correlation time [s]), pink (1/f) and hum: RMS [N];
    mains: its frequency [Hz], seen through the sampling; quantum: step of the converter [N];
    spikes: their number per recording and size over the noise; gauge: RMS of the deflection's white noise
    [m]; cut_off: of the filter that smoothed the white noise, over half the sampling rate, 0: there was none.
    """

    white: float
    drifting: float = 0.0
    correlation_time: float = 0.3
    pink: float = 0.0
    hum: float = 0.0
    mains: float = 50.0
    quantum: float = 0.0
    spikes: int = 0
    spike_size: float = 0.0
    gauge: float = 0.0
    cut_off: float = 0.0

    @property
    def noise(self) -> float:
        """RMS of the force error without spikes and without what the gauge adds [N]."""
        parts = (self.white, self.drifting, self.pink, self.hum)
        return float(np.sqrt(sum(p**2 for p in parts) + self.quantum**2 / 12.0))

    def force_error(self, rng: np.random.Generator, samples: int, step: float) -> FloatArray:
        """Additive error of the force [N], before the converter."""
        error = self.white * self._smoothed(rng, rng.standard_normal(samples))
        if self.drifting > 0.0:
            keep = float(np.exp(-step / self.correlation_time))
            steps = self.drifting * np.sqrt(1.0 - keep**2) * rng.standard_normal(samples)
            steps[0] = self.drifting * rng.standard_normal()
            error += lfilter([1.0], [1.0, -keep], steps)
        if self.pink > 0.0:
            error += idct(np.sqrt(self._pink_spectrum(samples)) * rng.standard_normal(samples), norm="ortho")
        if self.hum > 0.0:
            time = np.arange(samples) * step
            phase = rng.uniform(0.0, 2.0 * np.pi)
            error += self.hum * np.sqrt(2.0) * np.sin(2.0 * np.pi * self.mains * time + phase)
        for sample in rng.integers(0, samples, self.spikes):
            error[sample] += self.spike_size * self.noise * rng.choice((-1.0, 1.0)) * rng.uniform(0.5, 1.0)
        return error

    def read(self, rng: np.random.Generator, deflection: FloatArray) -> FloatArray:
        """What the gauge writes down [m] of the deflection that it shows [m]."""
        return deflection + self.gauge * rng.standard_normal(deflection.size)

    def converted(self, force: FloatArray) -> FloatArray:
        """Force [N] in whole steps of the converter."""
        return force if self.quantum == 0.0 else self.quantum * np.round(force / self.quantum)

    def spectrum(self, samples: int, step: float, stiffness: float) -> FloatArray:
        """Variance [N^2] of each coefficient of the orthonormal cosine transform of the error.

        stiffness [N/m]: RMS of the tangent, by which the noise of the gauge reaches the force.
        White noise of variance s^2 has s^2 in every coefficient.
        """
        angle = np.pi * np.arange(samples) / samples
        flat = self.quantum**2 / 12.0 + (self.gauge * stiffness) ** 2
        total = flat + self.white**2 * self._passed(angle)
        if self.drifting > 0.0:
            keep = float(np.exp(-step / self.correlation_time))
            total += self.drifting**2 * (1.0 - keep**2) / (1.0 - 2.0 * keep * np.cos(angle) + keep**2)
        if self.pink > 0.0:
            total += self._pink_spectrum(samples)
        if self.hum > 0.0:
            time = np.arange(samples) * step
            for wave in (np.sin, np.cos):
                line = self.hum * np.sqrt(2.0) * wave(2.0 * np.pi * self.mains * time)
                total += 0.5 * dct(line, norm="ortho") ** 2
        return total

    def _smoothed(self, rng: np.random.Generator, noise: FloatArray) -> FloatArray:
        """Return white noise as a filter of the second order leaves it, of the same RMS; the ends meet."""
        if self.cut_off == 0.0:
            return noise
        filtered = lfilter(*butter(2, self.cut_off), np.concatenate([noise, noise]))[noise.size :]
        filtered /= np.sqrt(np.mean(self._gain(WHOLE)))
        behind = rng.standard_normal(noise.size)
        return np.asarray(np.sqrt(1.0 - UNFILTERED) * filtered + np.sqrt(UNFILTERED) * behind)

    def _passed(self, angle: FloatArray) -> FloatArray:
        """Variance of the smoothed noise at each angle [rad], of RMS 1."""
        if self.cut_off == 0.0:
            return np.ones(angle.size)
        return (1.0 - UNFILTERED) * self._gain(angle) / float(np.mean(self._gain(WHOLE))) + UNFILTERED

    def _gain(self, angle: FloatArray) -> FloatArray:
        return np.asarray(np.abs(freqz(*butter(2, self.cut_off), worN=angle)[1]) ** 2)

    def _pink_spectrum(self, samples: int) -> FloatArray:
        """Variance [N^2] of each cosine coefficient of the 1/f part, without a mean."""
        fall = np.concatenate([[0.0], 1.0 / np.arange(1, samples)])
        return self.pink**2 * samples * fall / float(np.sum(fall))


@dataclass(frozen=True)
class CoarseInstrument(Instrument):
    """An instrument whose gauge writes whole steps: gauge_step [m]."""

    gauge_step: float = 0.0

    def read(self, rng: np.random.Generator, deflection: FloatArray) -> FloatArray:
        """What the gauge writes down [m]: the noisy deflection in whole steps."""
        noisy = super().read(rng, deflection)
        return noisy if self.gauge_step == 0.0 else self.gauge_step * np.round(noisy / self.gauge_step)

    def spectrum(self, samples: int, step: float, stiffness: float) -> FloatArray:
        """Variance [N^2] of each coefficient of the cosine transform; a gauge step q adds (stiffness q)^2 / 12."""
        return super().spectrum(samples, step, stiffness) + (self.gauge_step * stiffness) ** 2 / 12.0


def drawn_cut_off(rng: np.random.Generator) -> float:
    """Cut-off of an amplifier's filter over half the sampling rate; three of four have none that shows."""
    return float(np.exp(rng.uniform(np.log(0.1), np.log(0.6)))) if rng.random() < 0.25 else 0.0


def drawn_instrument(rng: np.random.Generator) -> Instrument:
    """An instrument with 3 to 12 N of noise; each kind of error is present or absent at random."""
    noise = float(np.exp(rng.uniform(np.log(3.0), np.log(12.0))))
    shares = {
        "drifting": rng.uniform(0.05, 0.4) if rng.random() < 0.4 else 0.0,
        "pink": rng.uniform(0.05, 0.25) if rng.random() < 0.25 else 0.0,
        "hum": rng.uniform(0.02, 0.2) if rng.random() < 0.3 else 0.0,
    }
    left = 1.0 - sum(shares.values())
    return Instrument(
        white=noise * float(np.sqrt(left)),
        **{kind: noise * float(np.sqrt(share)) for kind, share in shares.items()},
        correlation_time=float(np.exp(rng.uniform(np.log(0.05), np.log(3.0)))),
        mains=float(rng.choice((50.0, 60.0))) * (1.0 + rng.normal(0.0, 2e-4)),
        quantum=float(rng.choice((0.2735, 0.547, 1.0))) if rng.random() < 0.6 else 0.0,
        spikes=int(rng.integers(1, 6)) if rng.random() < 0.25 else 0,
        spike_size=rng.uniform(6.0, 20.0),
        gauge=rng.uniform(3e-6, 15e-6) if rng.random() < 0.6 else 0.0,
        cut_off=drawn_cut_off(rng),
    )
