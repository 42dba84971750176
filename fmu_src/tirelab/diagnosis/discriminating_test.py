"""The discriminating test: the waveform on which two fitted models differ most, whatever their parameters then do.

For every waveform that the rig can drive, both tires are simulated; what a refit of the alternative's own parameters
could take up is projected out of their difference (a T-optimal design, Atkinson & Fedorov 1975). The remainder,
over the noise and times the root of the number of samples, is the separation: the square root of twice the expected
gain in log likelihood.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field

import numpy as np

from ..estimation.findings import FittedModel
from ..preprocessing.kinematics import FloatArray
from ..report.titles import set_title
from ..simulation.simulate import simulate

DECISIVE = 5.7
"""Least separation S of a test worth driving: the log likelihood ratio of Gaussian hypotheses S apart has mean S^2/2
and deviation S; from here S^2/2 - 1.645 S > ln 1000, odds of 1000 to 1 in nineteen of twenty such tests."""


@dataclass(frozen=True)
class Limits:
    """What the rig can do: largest deflection [m], fastest motion [m/s], sampling step [s], longest test [s]."""

    deepest: float = 0.025
    fastest: float = 0.25
    step: float = 0.005
    longest: float = 60.0


@dataclass(frozen=True)
class Test:
    """A motion to drive: arrays of one length; measured: channels that are held at a value, by their names."""

    name: str
    time: FloatArray
    deflection: FloatArray
    surface_radius: FloatArray
    measured: Mapping[str, FloatArray] = field(default_factory=dict)

    __test__ = False


@dataclass(frozen=True)
class DiscriminatingTest:
    """The test on which two sets of effects differ most.

    between: the two sets; separation: expected distance in units of the noise, over all samples together; typical: root
    mean square distance of one sample in units of the noise; sentence: what to do, or that no motion separates them
    """

    test: Test
    between: tuple[tuple[str, ...], tuple[str, ...]]
    separation: float
    typical: float
    sentence: str

    @property
    def sufficient(self) -> bool:
        """Whether the test separates the two sets."""
        return self.separation >= DECISIVE

    def to_dict(self) -> dict[str, object]:
        """Return the entry `separating_test` of diagnosis.json."""
        t = self.test
        return {
            "waveform": t.name,
            "duration": float(t.time[-1]),
            "amplitude": float(t.deflection.max()),
            "rate_max": float(np.abs(np.gradient(t.deflection, t.time)).max()),
            "surfaces": ["inf" if not np.isfinite(r) else float(r) for r in np.unique(t.surface_radius)],
            "between": [list(s) for s in self.between],
            "separation": self.separation,
            "sentence": self.sentence,
        }


Waveform = Callable[[Limits], FloatArray]


def _time(limits: Limits) -> FloatArray:
    return np.arange(int(limits.longest / limits.step), dtype=np.float64) * limits.step


def _triangle(limits: Limits, phase: FloatArray) -> FloatArray:
    return limits.deepest * (1.0 - np.abs(1.0 - 2.0 * (phase % 1.0)))


def three_rates(limits: Limits) -> FloatArray:
    """Triangles at a fortieth, a fifth and the whole of the fastest rate, a third of the time each."""
    t = _time(limits)
    third = np.minimum((3.0 * t / limits.longest).astype(int), 2)
    rate = limits.fastest * np.array([1.0 / 40.0, 1.0 / 5.0, 1.0])[third]
    return _triangle(limits, np.cumsum(rate * limits.step) / (2.0 * limits.deepest))


def ramp_and_hold(limits: Limits) -> FloatArray:
    """Quick ramps to six levels, each held for a sixth of the time."""
    t = _time(limits)
    levels = limits.deepest * np.array([0.35, 0.7, 1.0, 0.55, 0.85, 0.2])
    at = np.minimum((6.0 * t / limits.longest).astype(int), 5)
    return _no_faster(levels[at], 0.5 * limits.fastest * limits.step)


def sweep(limits: Limits) -> FloatArray:
    """A sine about half the largest deflection, from 0.05 Hz to what the fastest rate allows, by decades."""
    t = _time(limits)
    swing = 0.3 * limits.deepest
    high = limits.fastest / (2.0 * np.pi * swing)
    growth = np.log(high / 0.05) / limits.longest
    return np.asarray(
        0.5 * limits.deepest - swing * np.cos(2.0 * np.pi * 0.05 * np.expm1(growth * t) / growth)
    )


def growing(limits: Limits) -> FloatArray:
    """Triangles of growing depth, each depth twice, at a fifth of the fastest rate, and the first one again."""
    peaks = limits.deepest * np.array([0.3, 0.3, 0.5, 0.5, 0.75, 0.75, 1.0, 1.0, 0.3, 0.3])
    knots = np.zeros(2 * peaks.size + 1)
    knots[1::2] = peaks
    times = np.concatenate([[0.0], np.cumsum(np.abs(np.diff(knots)))])
    return np.interp(_time(limits), times * limits.longest / times[-1], knots)


def two_means(limits: Limits) -> FloatArray:
    """The same small sine about a low and a high mean deflection, slow and fast."""
    t = _time(limits)
    quarter = np.minimum((4.0 * t / limits.longest).astype(int), 3)
    mean = limits.deepest * np.array([0.3, 0.8, 0.3, 0.8])[quarter]
    swing = 0.18 * limits.deepest
    frequency = np.array([0.2, 0.2, 1.0, 1.0])[quarter] * min(4.0, limits.fastest / (2.0 * np.pi * swing))
    wave = mean + swing * np.sin(2.0 * np.pi * np.cumsum(frequency) * limits.step)
    return _no_faster(wave, limits.fastest * limits.step)


def rest_and_repeat(limits: Limits) -> FloatArray:
    """Three slow cycles, a rest of a third of the time without load, and the same cycles again."""
    t = _time(limits) / limits.longest
    phase = np.where(t < 1.0 / 3.0, 9.0 * t, np.where(t < 2.0 / 3.0, 0.0, 9.0 * (t - 2.0 / 3.0)))
    return _triangle(limits, phase)


WAVEFORMS: dict[str, Waveform] = {
    "triangles at three rates": three_rates,
    "ramp and hold": ramp_and_hold,
    "sweep": sweep,
    "growing triangles": growing,
    "small sines about two means": two_means,
    "cycles, rest, cycles": rest_and_repeat,
}


def _no_faster(path: FloatArray, step: float) -> FloatArray:
    limited = np.empty_like(path)
    here = 0.0
    for i, wanted in enumerate(path):
        here += float(np.clip(wanted - here, -step, step))
        limited[i] = here
    return limited


def discriminate(
    accepted: FittedModel, alternative: FittedModel, noise: float, limits: Limits
) -> DiscriminatingTest:
    """Return the test within `limits` on which the two fitted models differ most.

    noise [N]: of one sample. The alternative may follow the accepted model with its free parameters.
    """
    best: DiscriminatingTest | None = None
    radii = alternative.radii
    between = (accepted.names, alternative.names)
    surfaces = [radii[len(radii) // 2]] if len(radii) == 1 else [radii[0], radii[-1]]
    for name, waveform in WAVEFORMS.items():
        for radius in surfaces:
            path = waveform(limits)
            test = Test(name, _time(limits), path, np.full(path.size, radius))
            difference = simulate(accepted.tire, test) - simulate(alternative.tire, test)
            sensitivities = alternative.sensitivities(test)
            if sensitivities.shape[1]:
                difference = (
                    difference - sensitivities @ np.linalg.lstsq(sensitivities, difference, rcond=1e-8)[0]
                )
            typical = float(np.sqrt(np.mean(difference**2))) / noise
            separation = typical * float(np.sqrt(difference.size))
            if best is None or separation > best.separation:
                sentence = _sentence(test, between, separation, typical)
                best = DiscriminatingTest(test, between, separation, typical, sentence)
    assert best is not None
    return best


def _sentence(
    test: Test, between: tuple[tuple[str, ...], tuple[str, ...]], separation: float, typical: float
) -> str:
    place, path = _surface(float(test.surface_radius[0])), test.deflection
    first, second = (set_title(names) if names else "the baseline tire" for names in between)
    if separation < DECISIVE:
        return (
            f"No motion within the rig's limits separates {first} from {second}. The best motion tried, {test.name} on "
            f"{place}, makes them differ by {separation:.2g} times the noise over all samples; {DECISIVE:g} times are "
            "needed."
        )
    rate = 1e3 * float(np.abs(np.diff(path) / np.diff(test.time)).max())
    return (
        f"Drive {test.name} to {1e3 * path.max():.1f} mm on {place}, at up to {rate:.0f} mm/s, for "
        f"{test.time[-1] - test.time[0]:.0f} s. Then {first} and {second} differ by {typical:.2g} times the noise "
        f"in a typical sample, and by {separation:.0f} times the noise over all samples."
    )


def _surface(radius: float) -> str:
    if not np.isfinite(radius):
        return "flat ground"
    return f"a {'convex' if radius > 0.0 else 'concave'} surface of radius {100.0 * abs(radius):.4g} cm"
