"""The discriminating test: the waveform on which two fitted models differ most, whatever their parameters then do.

For every waveform that the rig can drive, both tires are simulated; what a refit of the alternative's own parameters
could take up is projected out of their difference (a T-optimal design, Atkinson & Fedorov 1975). The remainder,
over the noise and times the root of the number of samples, is the separation: the square root of twice the expected
gain in log likelihood.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np

from ..estimation.findings import FittedModel
from ..planning.waveforms import WAVEFORMS, Limits, sample_times
from ..preprocessing.motion import FloatArray
from ..report.titles import question
from ..simulation.simulate import simulate

DECISIVE = 5.7
"""Least separation S of a test worth driving: the log likelihood ratio of Gaussian hypotheses S apart has mean S^2/2
and deviation S; from here S^2/2 - 1.645 S > ln 1000, odds of 1000 to 1 in nineteen of twenty such tests."""


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


def discriminate(
    accepted: FittedModel, alternative: FittedModel, noise: float, limits: Limits
) -> DiscriminatingTest:
    """Return the test within `limits` on which the two fitted models differ most.

    noise [N]: of one sample. The alternative may follow the accepted model with its free parameters.
    """
    best: DiscriminatingTest | None = None
    radii = alternative.radii
    between = (accepted.names, alternative.names)
    known = [r for r in radii if r in (limits.surfaces or radii)] or list(limits.surfaces)
    surfaces = known if len(known) == 1 else [known[0], known[-1]]
    for name, waveform in WAVEFORMS.items():
        for radius in surfaces:
            path = waveform(limits)
            test = Test(name, sample_times(limits), path, np.full(path.size, radius))
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
    asked = question(*between)
    if separation < DECISIVE:
        return (
            f"No motion within the rig's limits decides {asked}: the forces would differ by at most {separation:.2g} "
            f"times the noise over all samples ({test.name} on {place}); {DECISIVE:g} times are needed."
        )
    rate = 1e3 * float(np.abs(np.diff(path) / np.diff(test.time)).max())
    return (
        f"Drive {test.name} to {1e3 * path.max():.1f} mm on {place}, at up to {rate:.0f} mm/s, for "
        f"{test.time[-1] - test.time[0]:.0f} s. It decides {asked}: the forces differ by {typical:.2g} times the noise "
        f"in a typical sample, by {separation:.0f} times the noise over all samples."
    )


def _surface(radius: float) -> str:
    if not np.isfinite(radius):
        return "flat ground"
    return f"a {'convex' if radius > 0.0 else 'concave'} surface of radius {100.0 * abs(radius):.4g} cm"
