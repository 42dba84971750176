"""The motion of a recording: smoothed deflection, rate, acceleration, direction and reversals.

The deflection is smoothed as strongly as the motion allows at each moment. A smoothing spline of order 3 (which
penalises the third derivative) has at the angular frequency w [1/sample] the gain

    H(w) = 1 / (1 + (w / w_c)^6)

Splines with several cut-offs w_c are fitted. How well each predicts a held-out sample follows without another fit: at
the leverage h, the residual r has the variance s^2 (1 - h), where s is the noise of the reading:

    log p = 1/2 log(1 - h) - r^2 / (2 s^2 (1 - h))

Summed over a window around each sample, log p is the weight of a spline, together with how often it is used in the
whole recording (leave-one-out: Wahba, "Spline Models for Observational Data", SIAM 1990; the weighted mean is
Bayesian). Long splines win where the motion is smooth, short ones at corners. Rate and acceleration are thus posterior
means and not noisy data, so that coefficients fitted to them are not biased towards zero.

In a reversal within one sample neither rate nor acceleration is known. A misfit that depends on direction, rate or
history jumps there, and cannot be judged. Where the misfit is the same before and after the reversal, what shows within
it comes from the deflection, which is read there as well as elsewhere, or from the reversed mass.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache, lru_cache

import numpy as np
from numpy.typing import NDArray
from scipy.fft import irfft, next_fast_len, rfft, rfftfreq
from scipy.linalg import solveh_banded
from scipy.ndimage import binary_closing, gaussian_filter1d, median_filter

from .gauge import deflection_noise
from .noise import NEGLIGIBLE, STANDS_OUT
from .spread import TRIMMED
from .turns import branches

FloatArray = NDArray[np.float64]
BoolArray = NDArray[np.bool_]
IndexArray = NDArray[np.intp]


CORNER = TRIMMED**2
"""The motion has a corner within a sample where five samples miss a cubic by this multiple of the noise variance (one
in 400 of pure noise does), by as much of what most of those around it do, and by more than NEGLIGIBLE of the travel per
sample."""

CORNER_SAMPLES = 6
"""Most samples in which one corner shows."""

SHORTEST = CORNER_SAMPLES + 1
"""Fewest samples of a piece between two corners: half of those in which each shows, and one more."""

SHORTEST_END = CORNER_SAMPLES // 2 + 1
"""Fewest samples of a piece between a corner and an end of the recording; in a shorter one no rate is known."""

AROUND = 4 * CORNER_SAMPLES + 1
"""Samples around one among which it stands out as a corner: those in which four show."""

MOST_PIECES = 1000
"""Budget: most pieces that are smoothed separately."""


@dataclass(frozen=True)
class Motion:
    """The motion of one recording; every array has the shape of its samples.

    deflection [m], rate [m/s], acceleration [m/s^2]: smoothed; noise [m]: standard deviation of the reading
    deepest: largest deflection so far [m]; cycle: number of the loading-unloading cycle; direction: +1 loading,
    -1 unloading, kept through holds
    resolved: False where the motion has a corner within a sample, so that its rate there is not known
    """

    deflection: FloatArray
    rate: FloatArray
    acceleration: FloatArray
    noise: float
    deepest: FloatArray
    cycle: FloatArray
    direction: FloatArray
    resolved: BoolArray


LONG, KEPT, KEPT_LONG = 50_000, 32, 2
"""Budget: number of samples from which a recording is long, and most recordings whose motion is kept, of the others and
of long ones; a diagnosis asks for each up to ten times."""


def motion_of(
    time: FloatArray, deflection: FloatArray, step: float = 0.0, *, timed: bool = True, keep: bool = True
) -> Motion:
    """Return the motion of a recording: time [s] rising, deflection [m]; its arrays are not to be written to.

    step [m]: of a gauge, see `destepped`; timed: whether the times were measured; keep: whether it is asked for again
    """
    t, x = (np.asarray(values, dtype=np.float64) for values in (time, deflection))
    kept = _kept if x.size <= LONG else _kept_long
    return kept(t.tobytes(), x.tobytes(), step, timed) if keep else _motion(t, x, step, timed)


def _motion_of_bytes(time: bytes, deflection: bytes, step: float, timed: bool) -> Motion:
    return _motion(np.frombuffer(time), np.frombuffer(deflection), step, timed)


_kept, _kept_long = (lru_cache(most)(_motion_of_bytes) for most in (KEPT, KEPT_LONG))


def _motion(time: FloatArray, deflection: FloatArray, step: float, timed: bool) -> Motion:
    noise = deflection_noise(deflection, timed=timed)
    # Lines between levels differ little from one sample to the next, and err by parts of a step all the same.
    smooth, rate, acceleration, resolved = _smoothed(time, deflection, max(noise, step / np.sqrt(12.0)))
    smooth = np.where(resolved, smooth, deflection)  # smoothing cuts a corner short
    direction, cycle = branches(smooth, noise)
    deepest = np.maximum.accumulate(smooth)
    return Motion(smooth, rate, acceleration, noise, deepest, cycle, direction, resolved)


def _smoothed(
    time: FloatArray, deflection: FloatArray, noise: float
) -> tuple[FloatArray, FloatArray, FloatArray, BoolArray]:
    """Return deflection, rate and acceleration, and where the motion is resolved."""
    step = float(np.median(np.diff(time)))
    if np.ptp(np.diff(time)) > 1e-3 * step:
        grid = np.linspace(time[0], time[-1], deflection.size)
        read = np.interp(grid, time, deflection)
        level, *rest, resolved = _smoothed(grid, read, noise)
        rate, acceleration = (np.interp(time, grid, r) for r in rest)
        return deflection - np.interp(time, grid, read - level), rate, acceleration, resolved
    resolved = _resolved(deflection, noise)
    parts = np.zeros((3, deflection.size))
    for begin, end in _pieces(resolved):
        own = deflection[begin:end]
        if own.size < min(SHORTEST_END, deflection.size):
            parts[:2, begin:end] = own, np.gradient(own, step)
            resolved[begin:end] = False
        else:
            parts[:, begin:end] = smoothed(own, step, noise)
    return parts[0], parts[1], parts[2], resolved


def _resolved(deflection: FloatArray, noise: float) -> BoolArray:
    """Return where five samples follow a cubic, or miss it by no more than most around them do: that is a motion of few
    samples a cycle, and a corner stands out.
    """
    resolved = np.ones(deflection.size, dtype=bool)
    travel = float(np.sqrt(max(np.mean(np.diff(deflection) ** 2) - 2.0 * noise**2, 0.0)))
    basis = np.linalg.qr(np.vander(np.arange(-2.0, 3.0), 4, increasing=True))[0]
    outside = np.linalg.qr(np.eye(5) - basis @ basis.T)[0][:, 0]
    misfit = np.convolve(deflection - deflection.mean(), outside[::-1], mode="valid") ** 2
    least = max(CORNER * noise**2, (NEGLIGIBLE * travel) ** 2)
    around = median_filter(misfit, AROUND, mode="reflect")
    resolved[2:-2] = misfit < np.maximum(least, CORNER * around)
    # Five samples with a corner a third of a sample from the middle one follow a cubic all the same.
    return np.asarray(~binary_closing(~resolved, np.ones(3)))


def _pieces(resolved: BoolArray) -> list[tuple[int, int]]:
    """Return begin and end of the pieces of the motion between its corners; a spline overshoots beside a corner.

    Pieces shorter than SHORTEST between two corners stay with their neighbours, as do longer unresolved parts, which
    are not one corner.
    """
    edges = np.flatnonzero(np.diff(np.concatenate([[False], ~resolved, [False]])))
    cuts = [0]
    for begin, end in edges.reshape(-1, 2).tolist():
        middle = (begin + end) // 2
        if end - begin <= CORNER_SAMPLES and (len(cuts) == 1 or middle - cuts[-1] >= SHORTEST):
            cuts.append(middle)
    if len(cuts) > MOST_PIECES:
        cuts = [0]
    return list(zip(cuts, [*cuts[1:], resolved.size], strict=True))


CUTOFFS = np.pi * np.geomspace(0.02, 2.0, 14)
"""Cut-off frequencies [1/sample]: from a hundred samples to almost the samples themselves."""

WINDOW = 2.0 * CORNER_SAMPLES
"""Standard deviation [samples] of the window over which log p is summed: as wide as two corners."""

WEIGHT_ROUNDS = 6
"""Number of expectation-maximisation steps in which the weights of the splines are found."""

PADDING = 400
"""Most samples that are reflected at each end."""

LEVERAGE = 0.97
"""Upper bound of a spline's leverage: the shortest one would leave no residual to compute log p from."""

UNUSED = 1e-6
"""Weight up to which a spline is left out of the mean: it changes nothing that is read to six digits."""

ARC = 5.0
"""Reach of an arc at an end, times a spline's cut-off: the spline follows what is longer without loss."""

FADED = 7.0
"""Reaches of an arc after which it is nothing: exp(-24)."""

FORGOTTEN = 20.0
"""Number of samples, times a spline's cut-off, after which it has forgotten its end: its impulse response falls by exp
of half the product, 5e-5."""


def smoothed(values: FloatArray, step: float, noise: float) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Return value, first and second derivative of even samples.

    values (n,) with n >= 3; step: between samples [s]; noise: standard deviation of the reading, in the values' unit
    """
    frame = _frame_of(values.size)
    scores = np.empty((CUTOFFS.size, values.size), dtype=np.float32)
    for i, cutoff in enumerate(CUTOFFS.tolist()):
        spline = _spline(values, cutoff, noise, frame)
        left = (values - spline.derivative(0)) / noise
        score = 0.5 * (np.log(1.0 - spline.leverage) - left**2 / (1.0 - spline.leverage))
        scores[i] = gaussian_filter1d(score, WINDOW, mode="nearest") * np.sqrt(4.0 * np.pi) * WINDOW
    sums = np.zeros((3, values.size))
    for cutoff, weight in zip(CUTOFFS.tolist(), _weights(scores), strict=True):
        if weight.max() > UNUSED:
            spline = _spline(values, cutoff, noise, frame)
            for order in range(3):
                sums[order] += weight * spline.derivative(order)
    return sums[0], sums[1] / step, sums[2] / step**2


@dataclass(frozen=True)
class _Frame:
    """Even samples, `count` of them, reflected about both ends, so many of them `before` the first, `whole` together.

    angle: angular frequencies [1/sample] of their spectrum
    """

    count: int
    before: int
    whole: int
    angle: FloatArray


def _frame_of(count: int) -> _Frame:
    before = min(count - 1, PADDING)
    whole = next_fast_len(count + 2 * before, real=True)
    return _Frame(count, before, whole, 2.0 * np.pi * rfftfreq(whole))


Ends = tuple[tuple[float, float], tuple[float, float]]
"""Value and curvature at the first and at the last sample."""


@dataclass(frozen=True)
class _Spline:
    """A smoothing spline: the line through its ends, an arc at each end, which reaches so far [samples], and what is
    filtered, by its spectrum.
    """

    frame: _Frame
    ends: Ends
    reach: float
    spectrum: NDArray[np.complex128]
    leverage: float

    def derivative(self, order: int) -> FloatArray:
        """Return the derivative (n,) by samples, of this order up to 2."""
        frame = self.frame
        factor = (1.0, 1j * frame.angle, -(frame.angle**2))[order]
        inner = irfft(factor * self.spectrum, frame.whole)[frame.before : frame.before + frame.count]
        return np.asarray(inner + _ends(self.ends, self.reach, frame.count, order))


def _spline(values: FloatArray, cutoff: float, noise: float, frame: _Frame) -> _Spline:
    """Return the smoothing spline of `values` with this cut-off [1/sample]; noise: of a sample.

    A reflected end has no curvature, so an arc with that of the spline is taken off at each end before. A motion that
    is recorded from its midst on would else begin with no acceleration.
    """
    ends = _end(values, cutoff, noise), _end(values[::-1], cutoff, noise)
    reach = min(ARC / cutoff, (values.size - 1) / 4.0)
    level = values - _ends(ends, reach, values.size, 0)
    pad = frame.before
    reflected = np.concatenate([-level[pad:0:-1], level, -level[-2 : -pad - 2 : -1]])
    # The samples that fill up to a quick length are detrended too: both ends are near zero.
    filled = np.concatenate(
        [reflected, np.linspace(reflected[-1], reflected[0], frame.whole - reflected.size)]
    )
    passed = 1.0 / (1.0 + (frame.angle / cutoff) ** 6)
    return _Spline(frame, ends, reach, rfft(filled) * passed, min(float(np.mean(passed)), LEVERAGE))


def _ends(ends: Ends, reach: float, count: int, order: int) -> FloatArray:
    """Return a derivative (n,) of the line and the arcs of `_Spline`.

    An arc is b/2 k^2 exp(-k^2 / 2 reach^2), k samples from an end with the curvature b.
    """
    (first, begin), (last, end) = ends
    slope = (last - first) / (count - 1)
    start, rise = ((first, slope), (slope, 0.0), (0.0, 0.0))[order]
    found = start + rise * np.arange(count, dtype=float)
    if begin or end:
        place = np.arange(min(count, int(FADED * reach) + 1), dtype=float)
        far = (place / reach) ** 2
        arc = (0.5 * place**2, place * (1.0 - 0.5 * far), 1.0 - 2.5 * far + 0.5 * far**2)[order]
        arc *= np.exp(-0.5 * far)
        found[: arc.size] += begin * arc
        found[count - arc.size :] += (-1.0) ** order * end * arc[::-1]
    return np.asarray(found)


def _end(values: FloatArray, cutoff: float, noise: float) -> tuple[float, float]:
    """Return value and curvature at the first sample of the spline with this cut-off and a free end; no curvature
    that does not stand out of the noise.
    """
    own = values[: SHORTEST + int(FORGOTTEN / cutoff)]
    if own.size < 4:
        return float(own[0]), 0.0
    weights = _weights_of_end(own.size, cutoff)
    level, bend = weights @ (own - own[0])
    found = float(bend) if abs(bend) > STANDS_OUT * noise * float(np.linalg.norm(weights[1])) else 0.0
    return float(own[0] + level), found


@cache
def _weights_of_end(count: int, cutoff: float) -> FloatArray:
    """Return the weights (2, n) of n samples in value and curvature at the first one of a spline with a free end.

    The spline minimises the sum of (values - f)^2 + (third differences of f)^2 / cutoff^6: E. T. Whittaker, Proc.
    Edinburgh Math. Soc. 41 (1923) 63. At a free end the third difference is zero.
    """
    matrix = _third_differences_squared(count) * cutoff**-6
    matrix[-1] += 1.0
    wanted = np.zeros((count, 2))
    wanted[0, 0] = 1.0
    wanted[:3, 1] = 1.0, -2.0, 1.0
    return np.asarray(solveh_banded(matrix, wanted, check_finite=False).T)


@cache
def _third_differences_squared(count: int) -> FloatArray:
    """Return the upper bands (4, n) of D^T D, D being the matrix of third differences of n values."""
    weights = (-1.0, 3.0, -3.0, 1.0)
    bands = np.zeros((4, count))
    for i, one in enumerate(weights):
        for j in range(i, 4):
            bands[3 - (j - i), j : j + count - 3] += one * weights[j]
    return bands


def _weights(scores: NDArray[np.float32]) -> NDArray[np.float32]:
    """Return the weight of each spline at every sample, (splines, n); its mean weight is its prior."""
    scores -= scores.max(axis=0)
    likelihoods, weights = np.exp(scores, out=scores), np.empty_like(scores)
    prior = np.full((scores.shape[0], 1), 1.0 / scores.shape[0], dtype=np.float32)
    for _ in range(WEIGHT_ROUNDS):
        np.multiply(prior, likelihoods, out=weights)
        weights /= weights.sum(axis=0)
        prior = weights.mean(axis=1, keepdims=True)
    return weights


SAME = 3.0 * float(np.sqrt(2.0))
"""Largest difference of the misfit before and after a reversal, in units of the noise: three standard deviations of a
difference."""


def followed_turns(misfit: FloatArray, resolved: BoolArray, noise: float) -> BoolArray:
    """Return which samples (n,) lie in reversals with the same misfit before and after; noise: of a sample of the
    misfit.
    """
    found = np.zeros(misfit.size, dtype=bool)
    for begin, end in runs(~resolved):
        if begin < 2 or end > misfit.size - 2:
            continue
        before, after = misfit[begin - 2 : begin], misfit[end : end + 2]
        # The two samples need not be read at the same deflection.
        slope = max(abs(float(before[1] - before[0])), abs(float(after[1] - after[0])))
        found[begin:end] = abs(float(after[0] - before[1])) < max(SAME * noise, slope)
    return found


def through_turns(
    time: FloatArray, rate: FloatArray, acceleration: FloatArray, turns: BoolArray
) -> tuple[FloatArray, FloatArray]:
    """Return rate [m/s] and acceleration [m/s^2] with a rate that changes linearly within each of the `turns`."""
    rate, acceleration = rate.copy(), acceleration.copy()
    for begin, end in runs(turns):
        whole = slice(begin - 1, end + 1)
        ends = time[[begin - 1, end]], rate[[begin - 1, end]]
        rate[whole] = np.interp(time[whole], *ends)
        acceleration[begin:end] = (ends[1][1] - ends[1][0]) / (ends[0][1] - ends[0][0])
    return rate, acceleration


def runs(inside: BoolArray) -> list[tuple[int, int]]:
    """Return begin and end of each run of samples `inside`."""
    edges = np.flatnonzero(np.diff(np.concatenate([[False], inside, [False]])))
    return [(int(a), int(b)) for a, b in edges.reshape(-1, 2)]
