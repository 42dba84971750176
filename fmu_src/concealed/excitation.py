"""The motions that the actuator is given: triangles, holds, multisines, sweeps, rides."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from scipy.interpolate import CubicSpline
from scipy.special import ndtr

from .motion import FloatArray, Motion, even_grid, rounded, stride_for

#: Data acquisition rates that a rig offers [Hz].
SAMPLE_RATES = (5.0, 10.0, 20.0, 25.0, 50.0, 100.0, 200.0, 250.0, 400.0)
FEWEST_RIG_SAMPLES, MOST_RIG_SAMPLES = 300, 16_000
#: Fastest motion of a servo-hydraulic actuator of this size [m/s].
ACTUATOR_SPEED = 0.5


@dataclass(frozen=True)
class DepthLimits:
    """The surfaces [m] that are mounted in turn, and how deep the tire may be pressed on each [m]."""

    surfaces: tuple[float, ...]
    deepest: tuple[float, ...]

    @property
    def shallowest(self) -> float:
        """The deflection that every surface allows [m]."""
        return min(self.deepest)

    def scaled(self, fraction: float) -> "DepthLimits":
        """The same surfaces, pressed less deep."""
        return DepthLimits(self.surfaces, tuple(fraction * deep for deep in self.deepest))


Excitation = Callable[[np.random.Generator, DepthLimits], Motion]


def article_triangle(rng: np.random.Generator, limits: DepthLimits) -> Motion:
    """The article's test: a triangle wave of 30 s, recorded at 5 Hz, some cycles on every surface."""
    cycles = int(rng.integers(2, 5)) if len(limits.surfaces) < 3 else 2
    knots = [cycles_of(deep, 30.0, cycles) for deep in limits.deepest]
    return polyline("article_triangle", knots, limits.surfaces, 0.2, 0.1)


def single_rate_triangle(rng: np.random.Generator, limits: DepthLimits) -> Motion:
    """A triangle wave at one constant rate, 3 to 60 mm/s (the range in which none was found to matter)."""
    rate = float(np.exp(rng.uniform(np.log(0.003), np.log(0.06))))
    cycles = int(rng.integers(3, 9))
    knots = [cycles_of(deep, 2.0 * deep / rate, cycles) for deep in limits.deepest]
    period = 2.0 * limits.shallowest / rate
    step = _sample_step(rng, knots, period / 6.0)
    return polyline("single_rate_triangle", knots, limits.surfaces, step, 0.03 * period)


def many_rates_triangle(rng: np.random.Generator, limits: DepthLimits) -> Motion:
    """Triangles at three or four rates over one and a half to two decades."""
    fastest = rng.uniform(0.10, 0.25)
    rates = fastest / np.logspace(0.0, rng.uniform(1.5, 2.0), int(rng.integers(3, 5)))
    if rng.random() < 0.5:
        rates = rates[::-1]
    knots = []
    for deep in limits.deepest:
        times, values = [0.0], [0.0]
        for rate in rates:
            cycles = int(np.clip(round(20.0 * rate / (2.0 * deep)), 1, 20))
            t, x = cycles_of(deep, 2.0 * deep / rate, cycles)
            values.extend(x[1:])
            times.extend(times[-1] + t[1:])
        knots.append((np.array(times), np.array(values)))
    period = 2.0 * limits.shallowest / fastest
    return polyline(
        "many_rates_triangle", knots, limits.surfaces, _sample_step(rng, knots, 0.5 * period), 0.1 * period
    )


def growing_triangle(rng: np.random.Generator, limits: DepthLimits) -> Motion:
    """A triangle of growing amplitude, two or three cycles on each step."""
    steps, repeats = int(rng.integers(3, 6)), int(rng.integers(2, 4))
    rate = float(np.exp(rng.uniform(np.log(0.005), np.log(0.04))))
    knots = []
    for deep in limits.deepest:
        peaks = np.repeat(np.linspace(rng.uniform(0.3, 0.5), 1.0, steps), repeats) * deep
        values = np.zeros(2 * peaks.size + 1)
        values[1::2] = peaks
        knots.append((np.concatenate([[0.0], np.cumsum(np.abs(np.diff(values)) / rate)]), values))
    period = limits.shallowest / rate
    step = _sample_step(rng, knots, period / 6.0)
    return polyline("growing_triangle", knots, limits.surfaces, step, 0.03 * period)


def ramp_and_hold(rng: np.random.Generator, limits: DepthLimits) -> Motion:
    """Quick ramps between levels, each level held for seconds."""
    rate = rng.uniform(0.01, 0.05)
    hold = rng.uniform(4.0, 15.0)
    levels = int(rng.integers(3, 6))
    return stairs(rng, limits, "ramp_and_hold", rate, [hold] * levels)


def staircase(rng: np.random.Generator, limits: DepthLimits) -> Motion:
    """Many small steps up and down, each held for a short time."""
    holds = list(rng.uniform(0.5, 3.0, int(rng.integers(8, 15))))
    return stairs(rng, limits, "staircase", rng.uniform(0.01, 0.03), holds)


def sine(rng: np.random.Generator, limits: DepthLimits) -> Motion:
    """A sine at one frequency about a mean deflection."""
    frequency = float(np.exp(rng.uniform(np.log(0.1), np.log(3.0))))
    duration = rng.uniform(15.0, 40.0) / frequency if frequency > 0.5 else rng.uniform(5.0, 12.0) / frequency
    swing = min(rng.uniform(0.25, 0.48), ACTUATOR_SPEED / (2.0 * np.pi * frequency * limits.shallowest))
    middle = rng.uniform(swing + 0.02, 0.99 - swing)
    step = _sample_step(rng, [(np.array([0.0, duration]), np.zeros(2))], 1.0 / frequency)

    def path(time: FloatArray) -> FloatArray:
        return middle - swing * np.cos(2.0 * np.pi * frequency * time)

    return _sampled("sine", path, duration, step, limits)


def multisine(rng: np.random.Generator, limits: DepthLimits) -> Motion:
    """Odd harmonics with random phases, two to six periods (the multisine of Pintelon & Schoukens)."""
    base = rng.uniform(0.08, 0.25)
    highest = rng.uniform(4.0, 10.0)
    harmonics = base * np.arange(1.0, highest / base, 2.0, dtype=np.float64)
    sizes = 1.0 / np.sqrt(1.0 + (harmonics / rng.uniform(0.5, 1.5)) ** 2)
    phases = rng.uniform(0.0, 2.0 * np.pi, harmonics.size)
    periods = int(rng.integers(2, 7))
    step = _dynamic_step(rng, highest, periods / base)
    one = np.arange(0.0, 1.0 / base, 0.002)
    crest = _sum_of_cosines(one, harmonics, sizes, phases)
    swing = rng.uniform(0.35, 0.48) / float(np.max(np.abs(crest)))
    top = float(np.max(np.abs(np.gradient(crest, 0.002)))) * swing * limits.shallowest
    swing *= min(1.0, ACTUATOR_SPEED / top)

    def path(time: FloatArray) -> FloatArray:
        return 0.5 + swing * _sum_of_cosines(time, harmonics, sizes, phases)

    return _sampled("multisine", path, periods / base, step, limits)


def sweep(rng: np.random.Generator, limits: DepthLimits) -> Motion:
    """A sine whose frequency runs up, linearly or by decades, about a mean deflection."""
    low, high = rng.uniform(0.05, 0.2), rng.uniform(5.0, 12.0)
    duration = rng.uniform(25.0, 60.0)
    logarithmic = bool(rng.random() < 0.5)
    swing = min(rng.uniform(0.15, 0.4), ACTUATOR_SPEED / (2.0 * np.pi * high * limits.shallowest))
    middle = rng.uniform(max(0.4, swing + 0.05), 0.98 - swing)

    def path(time: FloatArray) -> FloatArray:
        if logarithmic:
            growth = np.log(high / low) / duration
            phase = low * np.expm1(growth * time) / growth
        else:
            phase = low * time + 0.5 * (high - low) / duration * time**2
        return np.asarray(middle - swing * np.cos(2.0 * np.pi * phase), dtype=np.float64)

    return _sampled("sweep", path, duration, _dynamic_step(rng, high, duration), limits)


def ride(rng: np.random.Generator, limits: DepthLimits) -> Motion:
    """A ride over rough ground at a varying speed."""
    duration = rng.uniform(25.0, 40.0)
    rough, highest = _rough_ground(rng, duration)
    middle, swing = rng.uniform(-0.3, 0.3), rng.uniform(0.6, 1.0)

    def path(time: FloatArray) -> FloatArray:
        return np.asarray(ndtr(middle + swing * rough(time)), dtype=np.float64)

    return _sampled("ride", path, duration, _dynamic_step(rng, highest, duration), limits)


def hits(rng: np.random.Generator, limits: DepthLimits) -> Motion:
    """A gentle ride with a few hard hits that limits the full depth."""
    duration = rng.uniform(20.0, 40.0)
    rough, highest = _rough_ground(rng, duration)
    middle = rng.uniform(0.25, 0.4)
    moments = np.sort(rng.uniform(0.05, 0.95, int(rng.integers(3, 8)))) * duration
    widths = rng.uniform(0.05, 0.12, moments.size)

    def path(time: FloatArray) -> FloatArray:
        gentle = middle * (1.0 + 0.6 * np.tanh(rough(time)))
        pulses = np.exp(-0.5 * ((time[:, None] - moments) / widths) ** 2)
        strength = np.max(pulses, axis=1)
        return np.asarray(gentle + (0.97 - gentle) * strength, dtype=np.float64)

    return _sampled("hits", path, duration, _dynamic_step(rng, max(highest, 8.0), duration), limits)


def burst(rng: np.random.Generator, limits: DepthLimits) -> Motion:
    """A slow triangle with one short fast burst on top of it."""
    period = rng.uniform(8.0, 20.0)
    cycles = int(rng.integers(2, 4))
    frequency, width = rng.uniform(4.0, 9.0), rng.uniform(0.25, 0.5)
    moment = (int(rng.integers(0, cycles)) + rng.uniform(0.4, 0.6)) * period
    swing = min(rng.uniform(0.1, 0.2), ACTUATOR_SPEED / (2.0 * np.pi * frequency * limits.shallowest))

    def path(time: FloatArray) -> FloatArray:
        slow = 0.5 - 0.5 * np.cos(2.0 * np.pi * time / period)
        slow = 0.02 + 0.78 * slow
        fast = np.exp(-0.5 * ((time - moment) / width) ** 2) * np.sin(2.0 * np.pi * frequency * time)
        return np.asarray(slow + swing * fast, dtype=np.float64)

    duration = cycles * period
    span = (moment - 2.0 * width, moment + 2.0 * width)
    return _sampled("burst", path, duration, _dynamic_step(rng, frequency, duration), limits, span)


EXCITATIONS: dict[str, Excitation] = {
    function.__name__: function
    for function in (
        article_triangle,
        single_rate_triangle,
        many_rates_triangle,
        growing_triangle,
        ramp_and_hold,
        staircase,
        sine,
        multisine,
        sweep,
        ride,
        hits,
        burst,
    )
}


def cycles_of(deep: float, period: float, cycles: int) -> tuple[FloatArray, FloatArray]:
    """Times [s] and deflections [m] of the corners of some triangles."""
    values = np.zeros(2 * cycles + 1)
    values[1::2] = deep
    return even_grid(values.size, 0.5 * period), values


def stairs(
    rng: np.random.Generator, limits: DepthLimits, name: str, rate: float, holds: Sequence[float]
) -> Motion:
    """Levels up and down again, each held for a time [s], reached at a rate [m/s]."""
    up = (len(holds) + 1) // 2
    levels = np.concatenate([np.linspace(1.0 / up, 1.0, up), np.linspace(1.0, 0.1, len(holds) - up + 1)[1:]])
    if rng.random() < 0.3:
        levels = rng.permutation(levels)
    knots = []
    for deep in limits.deepest:
        times, values = [0.0], [0.0]
        for level, hold in zip(levels, holds, strict=True):
            times.append(times[-1] + max(abs(deep * level - values[-1]) / rate, 0.05))
            values.append(deep * level)
            times.append(times[-1] + hold)
            values.append(deep * level)
        times.append(times[-1] + values[-1] / rate)
        values.append(0.0)
        knots.append((np.array(times), np.array(values)))
    quickest = limits.shallowest / (up * rate)
    return polyline(name, knots, limits.surfaces, _sample_step(rng, knots, quickest), 0.2 * quickest)


def _sample_step(
    rng: np.random.Generator, knots: Sequence[tuple[FloatArray, FloatArray]], quickest: float
) -> float:
    """A step [s] that resolves the quickest period and keeps the samples within the rig's limits."""
    duration = sum(float(times[-1]) for times, _ in knots)
    fits = [
        rate
        for rate in SAMPLE_RATES
        if FEWEST_RIG_SAMPLES <= rate * duration <= MOST_RIG_SAMPLES and rate * quickest >= 16.0
    ]
    if not fits:
        needed = max(FEWEST_RIG_SAMPLES / duration, 16.0 / quickest)
        return 1.0 / min(needed, MOST_RIG_SAMPLES / duration)
    return 1.0 / float(rng.choice(fits[:3]))


def _dynamic_step(rng: np.random.Generator, highest: float, duration: float) -> float:
    fits = [
        rate
        for rate in SAMPLE_RATES
        if rate >= 12.0 * highest and FEWEST_RIG_SAMPLES <= rate * duration <= MOST_RIG_SAMPLES
    ]
    return 1.0 / (float(rng.choice(fits)) if fits else MOST_RIG_SAMPLES / duration)


def polyline(
    name: str,
    knots: Sequence[tuple[FloatArray, FloatArray]],
    surfaces: Sequence[float],
    sample_step: float,
    blend: float,
) -> Motion:
    """Straight lines through corners (times [s], deflections [m]), surface after surface, rounded over `blend` [s]."""
    times, values, ends = [], [], []
    start = 0.0
    for t, x in knots:
        times.append(start + t)
        values.append(x)
        start += float(t[-1])
        ends.append(start)
    samples = min(int(start / sample_step + 1e-6) + 1, MOST_RIG_SAMPLES)
    stride = stride_for(sample_step, samples)
    step = sample_step / stride
    time = even_grid((samples - 1) * stride + 1, step)
    path = np.interp(time, np.concatenate(times), np.concatenate(values))
    mounted = np.minimum(np.searchsorted(np.array(ends), time, side="left"), len(surfaces) - 1)
    return Motion(name, time, rounded(path, step, blend), np.array(surfaces)[mounted], stride)


def _sampled(
    name: str,
    path: Callable[[FloatArray], FloatArray],
    duration: float,
    sample_step: float,
    limits: DepthLimits,
    span: tuple[float, float] | None = None,
) -> Motion:
    """A path given as a share of the allowed depth; the surfaces change at even times, at speed."""
    samples = min(int(duration / sample_step), MOST_RIG_SAMPLES)
    stride = stride_for(sample_step, samples)
    time = even_grid((samples - 1) * stride + 1, sample_step / stride)
    mounted = np.minimum(time * len(limits.surfaces) // (time[-1] + sample_step), len(limits.surfaces) - 1)
    radius = np.array(limits.surfaces)[mounted.astype(int)]
    return Motion(name, time, limits.shallowest * path(time), radius, stride, span)


def _sum_of_cosines(
    time: FloatArray, frequencies: FloatArray, sizes: FloatArray, phases: FloatArray
) -> FloatArray:
    total = np.zeros_like(time)
    for frequency, size, phase in zip(frequencies, sizes, phases, strict=True):
        total += size * np.cos(2.0 * np.pi * frequency * time + phase)
    return total


def _rough_ground(
    rng: np.random.Generator, duration: float
) -> tuple[Callable[[FloatArray], FloatArray], float]:
    """Band-limited noise of unit variance over the distance, passed at a varying speed; its highest frequency [Hz].

    Height spectrum 1/n^2 over the wavenumber above a corner, as of ISO 8608 roads.
    """
    speed, swing, slow = rng.uniform(3.0, 8.0), rng.uniform(0.1, 0.4), rng.uniform(8.0, 20.0)
    distance = np.arange(0.0, duration * speed * (1.0 + swing) + 10.0, 0.05)
    spectrum = np.fft.rfft(rng.standard_normal(distance.size))
    wavenumber = np.fft.rfftfreq(distance.size, 0.05)
    highest = rng.uniform(3.0, 8.0)
    shape = 1.0 / np.hypot(wavenumber, rng.uniform(0.05, 0.2))
    shape *= (wavenumber < highest / speed / (1.0 + swing)) & (wavenumber > 0.0)
    height = np.fft.irfft(spectrum * shape, distance.size)
    profile = CubicSpline(distance, height / np.std(height))

    def passed(time: FloatArray) -> FloatArray:
        travelled = speed * (time + swing * slow / (2.0 * np.pi) * (1.0 - np.cos(2.0 * np.pi * time / slow)))
        return np.asarray(profile(travelled), dtype=np.float64)

    return passed, highest
