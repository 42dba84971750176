"""The discriminating test: the waveform on which two fitted models differ most, after a refit of one of them.

For every waveform that the rig can drive, both tires are simulated. The part of their difference that a refit of the
alternative's own parameters could follow is projected out (a T-optimal design, Atkinson & Fedorov 1975). Where the
alternative is the accepted set and one effect more, it follows the accepted one exactly, without that effect: then the
accepted model is refitted to the alternative. The rest is judged as in a diagnosis, by its log likelihood under the
noise and the usual form errors of the effects on that waveform (`selection.search`). With the noise alone, a test would
count as decisive whose difference a slightly wrong form causes as well.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import partial
from itertools import islice

import numpy as np

from ..estimation.explanation import Explanation
from ..estimation.findings import FittedModel
from ..names import plain
from ..planning.force_limit import limits_within_force
from ..planning.waveforms import WAVEFORMS, Limits, motion, sample_times
from ..preprocessing.motion import FloatArray
from ..preprocessing.samples import RawDataset
from ..recordings.zero import millimetres
from ..regressors.dataset import BLOCKS
from ..report.titles import question
from ..report.words import number
from ..selection.search import beside_noise
from ..simulation.simulate import simulate
from .alternatives import USUAL_SPEED, Alternative

DECISIVE = 5.7
"""Least distance S of a test worth driving: the log likelihood ratio of Gaussian hypotheses S apart has mean S^2/2
and deviation S; from here S^2/2 - 1.645 S > ln 1000, odds of 1000 to 1 in nineteen of twenty such tests."""


MOST_TESTED = 3
"""Alternatives, likeliest first, for which a separating test is searched: each costs a fit."""

INVISIBLE = 0.01
"""Distance of a sample, in units of the noise, below which the message gives no number."""


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

    between: the two sets; gain: expected log likelihood ratio; separation: expected distance in units of the noise, all
    samples together; typical: root mean square distance of one sample in units of the noise; missed: root mean square
    of the form errors of the effects of the set that is not refitted, in the same unit; ground: whether the test is on
    a surface
    """

    test: Test
    between: tuple[tuple[str, ...], tuple[str, ...]]
    gain: float
    separation: float
    typical: float
    missed: float
    ground: bool = True

    @property
    def begins_at(self) -> float:
        """Least deflection [m], 0 of a tire."""
        return float(self.test.deflection.min()) if not self.ground else 0.0

    @property
    def sufficient(self) -> bool:
        """Whether the test separates the two sets."""
        return math.sqrt(2.0 * self.gain) >= DECISIVE

    @property
    def sentence(self) -> str:
        """What to do, or that no motion separates the two sets."""
        path, asked = self.test.deflection, question(*self.between)
        place = f" on {_surface(float(self.test.surface_radius[0]))}" if self.ground else ""
        differ = f"{plain(self.typical, 2)} times the noise in a typical sample"
        if self.missed > 0.0:
            differ += f", {plain(self.typical / self.missed, 2)} times what the forms of the effects may miss"
        if not self.sufficient:
            none = f"No motion within the rig's limits decides {asked}: the forces would differ by"
            if self.typical < INVISIBLE:
                return f"{none} less than a hundredth of the noise."
            return f"{none} at most {differ} ({self.test.name}{place})."
        rate = 1e3 * float(np.abs(np.diff(path) / np.diff(self.test.time)).max())
        first, last = (millimetres(x, float(np.abs(path).max())) for x in (self.begins_at, float(path.max())))
        begins = f" from {first.removesuffix(' mm')}" if float(first.split()[0]) else ""
        speed = f"{rate:.0f}" if rate >= 1.0 else number(rate, 1)
        return (
            f"Drive {self.test.name}{begins} to {last}{place}, at up to {speed} mm/s, for "
            f"{self.test.time[-1] - self.test.time[0]:.0f} s. It decides {asked}: the forces differ by {differ}."
        )

    def to_dict(self) -> dict[str, object]:
        """Return the entry `separating_test` of diagnosis.json."""
        t = self.test
        return {
            "waveform": t.name,
            "duration": float(t.time[-1]),
            "begins_at": self.begins_at,
            "amplitude": float(t.deflection.max()),
            "rate_max": float(np.abs(np.gradient(t.deflection, t.time)).max()),
            "surfaces": [
                "inf" if not np.isfinite(r) else float(r) for r in np.unique(t.surface_radius) if self.ground
            ],
            "between": [list(s) for s in self.between],
            "separation": self.separation,
            "gain": self.gain,
            "sentence": self.sentence,
        }


def discriminate(
    accepted: FittedModel, alternative: FittedModel, noise: float, limits: Limits
) -> DiscriminatingTest:
    """Return the test within `limits` that distinguishes the two fitted models best.

    noise [N]: of one sample. The alternative may follow the accepted model with its free parameters; an alternative
    that has all effects of the accepted model and more is followed by that model.
    """
    best: DiscriminatingTest | None = None
    between = (accepted.names, alternative.names)
    contains = set(accepted.names) < set(alternative.names)
    true, refitted = (alternative, accepted) if contains else (accepted, alternative)
    for test in _tests(alternative.radii, limits):
        difference = simulate(true.tire, test) - simulate(refitted.tire, test)
        sensitivities = refitted.sensitivities(test)
        if sensitivities.shape[1]:
            difference = (
                difference - sensitivities @ np.linalg.lstsq(sensitivities, difference, rcond=1e-8)[0]
            )
        samples = test.deflection.size
        typical = float(np.sqrt(np.mean(difference**2))) / noise
        missed = true.missed(test) / noise
        gain = expected_gain(samples, typical, missed)
        if best is None or gain > best.gain:
            separation = typical * float(np.sqrt(samples))
            ground = not accepted.baseline.is_part
            best = DiscriminatingTest(test, between, gain, separation, typical, missed, ground)
    assert best is not None
    return best


def _tests(radii: Sequence[float], limits: Limits) -> Iterator[Test]:
    """Yield the motions within limits, on the first and the last surface that was recorded and can be mounted."""
    known = [r for r in radii if r in (limits.surfaces or radii)] or list(limits.surfaces)
    surfaces = known if len(known) == 1 else [known[0], known[-1]]
    for name, waveform in WAVEFORMS.items():
        for radius in surfaces:
            path = motion(waveform, limits)
            yield Test(name, sample_times(limits), path, np.full(path.size, radius))


def expected_gain(samples: int, different: float, missed: float) -> float:
    """Return the expected log likelihood ratio of two sets on this many samples.

    different: root mean square difference of their forces; missed: root mean square of the true set's form errors; both
    in units of the noise of one sample
    """
    blocks = min(samples, BLOCKS)
    averaged = samples / blocks
    law = beside_noise(blocks).above(missed * math.sqrt(averaged))
    left = blocks + samples * missed**2
    return law.profile(left)[0] - law.profile(left + samples * different**2)[0]


def _peak(models: Sequence[FittedModel], limits: Limits) -> float:
    """Return the largest force [N] of either sign of all models over all tests within limits."""
    return max(
        float(np.abs(simulate(model.tire, test)).max())
        for test in _tests(models[0].radii, limits)
        for model in models
    )


def _surface(radius: float) -> str:
    if not np.isfinite(radius):
        return "flat ground"
    return f"a {'convex' if radius > 0.0 else 'concave'} surface of radius {plain(100.0 * abs(radius), 4)} cm"


def recommended(
    explanation: Explanation, alternatives: Sequence[Alternative], noise: float, limits: Limits
) -> DiscriminatingTest | None:
    """Return the test that separates the likeliest alternative that a test can; else the one that comes nearest."""
    nearest: DiscriminatingTest | None = None
    models = (explanation.alternative_model(alternative.names) for alternative in alternatives)
    for model in islice((m for m in models if m is not None), MOST_TESTED):
        within = limits_within_force(limits, partial(_peak, (explanation.model, model)))
        if within is None:
            continue
        test = discriminate(explanation.model, model, noise, within)
        if nearest is None or test.gain > nearest.gain:
            nearest = test
        if test.sufficient:
            break
    return nearest


def limits_of_rig(samples: RawDataset, given: Limits | None, *, timed: bool, part: bool) -> Limits:
    """Return the given limits, or those of a rig that drove these recordings, and can drive twice as fast.

    timed: whether the times of all samples were measured
    A tire is pressed from 0; a part moves from the least deflection that was recorded, which may be anywhere.
    """
    motions = [e.motion for e in samples.experiments]
    start = min(float(m.deflection.min()) for m in motions) if part else 0.0
    if given is not None:
        return replace(given, start=start)
    stroke = samples.max_deflection - start
    if not timed:
        return Limits(deepest=stroke, fastest=USUAL_SPEED, start=start)
    fastest = 2.0 * max(float(np.abs(m.rate).max()) for m in motions)
    return Limits(deepest=stroke, fastest=max(USUAL_SPEED, fastest), start=start)
