"""Rate and acceleration of a deflection that is measured with noise, at any sampling intervals.

An interacting-multiple-model estimator: four Kalman filters without look-ahead, each for one mode of motion, and the
probability of each mode. Two modes take the jerk as white noise, of the intensities of a press and of a ride; they
follow a corner quickly. Two take the rate of change of the jerk as white noise; they follow sweeps and impacts that
have only a few samples per cycle. Between two samples the mode may change (SWITCH). With e the innovation of a filter,
V its variance over the measurement noise s^2, and c the mode probability before, the mode probability after is
proportional to Student's

    c V^(-1/2) (1 + e^2 / (n V s^2))^(-(n + 1)/2)     with n = 4

and rate and acceleration are the means over the four modes. Only the noise s of the gauge has to be known. Where it is
below FINEST, the part may be smaller than a tire: of each sort, the slower mode is then that of a part as many times
smaller, and the quicker one that of a tire, which then has the shortest memory. Measurements free of noise are followed
by one filter of each sort with that memory, with mode probabilities proportional to the power -(n + 1) of their
innovations: on smooth motions the errors then fall with d^3 (rate) and d^2 (acceleration).

On a ride to 8 Hz and 5 mm, sampled at 400 Hz with 8e-6 m of noise, the errors are 3.0 mm/s and 0.8 m/s^2; plain
differences have 9 mm/s, most of it their delay of half an interval, and 3.2 m/s^2.

Times are scaled by d, the last interval or, where that was far shorter, FADES times the scale before it: a reading that
comes soon after another one does not make what is known before it forgotten. A filter holds x, d x', d^2 x''/2,
d^3 x'''/6 and their covariance over s^2.

References: H. A. P. Blom, Y. Bar-Shalom, "The interacting multiple model algorithm for systems with Markovian switching
coefficients", IEEE Trans. Automatic Control 33 (1988) 780-783; P. R. Belanger, P. Dobrovolny, A. Helmy, X. Zhang,
"Estimation of angular velocity and acceleration from shaft-encoder measurements", Int. J. Robotics Research 17 (1998)
1225-1233.
"""

from __future__ import annotations

import math

Moving = tuple[
    float, float, float, float, float, float, float, float, float, float, float, float, float, float
]
"""x, d x', d^2 x''/2, d^3 x'''/6 and their covariance P00 P01 P02 P03 P11 P12 P13 P22 P23 P33 over s^2."""

Track = tuple[tuple[Moving, Moving, Moving, Moving], tuple[float, float, float, float], float]
"""The motion in each mode, the mode probabilities, and the scale d [s] of the times."""

PRESS, RIDE = 1e-4, 10.0
"""Intensities [m^2/s^5] of the white noise that is the jerk."""

SMOOTH, SHARP = 1e2, 1e7
"""Intensities [m^2/s^7] of the white noise that is the rate of change of the jerk."""

SWITCH = 0.02
"""Probability that the mode changes before the next sample."""

FINEST = 1e-6
"""Noise [m] of a gauge for the strokes of a tire, at least; that of a smaller part is smaller, as its motion is."""

TAIL = 4.0
"""Degrees of freedom n of the innovations: few, so that an outlier for every filter decides little."""

EXACT = 1e-12
"""Noise [m] below which a measurement is exact, and innovation of such a one below which it has no influence."""

UNKNOWN = 1e4
"""Variance over s^2 of the scaled acceleration and jerk at the second sample: large, so the next samples decide."""

APART = 1e6
"""Largest squared difference over s^2 between two modes that counts when they are mixed: more is lost in rounding."""

PAUSE = 10.0
"""After an interval this many times the scale d the earlier motion is no guide: the track restarts."""

FADES = 0.5
"""Smallest scale d over the one before it: with finer samples it reaches their interval within a few of them."""

SOONEST = 1e-30
"""Least interval over d that is told from none, so that no power of it underflows."""

JERK_MAX, SNAP_MAX = 32.0, 128.0
"""Largest intensities, scaled by d: a memory (s^2/q)^(1/5 or 1/7) below d/2 counts as d/2. Shorter, it overshoots."""


def begin(deflection: float) -> Track:
    """Return the track after the first measurement [m]."""
    at = (deflection, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0)
    return (at, at, at, at), (0.25, 0.25, 0.25, 0.25), 0.0


def follow(track: Track, interval: float, deflection: float, noise: float) -> Track:
    """Return the track after a measurement `deflection` [m], `interval` > 0 [s] after the last one.

    noise: standard deviation s >= 0 [m] of a measurement.
    """
    modes, probability, last = track
    # The difference, taken as free of acceleration until there are more samples.
    if last <= 0.0 or interval > PAUSE * last:
        return _second(deflection, deflection - modes[0][0]), probability, interval
    ratio = max(interval / last, SOONEST)
    scale = max(interval, FADES * last)
    part = 1.0 if ratio >= FADES else ratio / FADES
    if noise < EXACT:
        return _exactly(modes, probability, ratio, part, deflection, scale)
    certainty = 1.0 / (noise * noise)
    fifth = interval * interval * interval * interval * interval * certainty
    seventh = fifth * interval * interval
    # The motion of a part as many times smaller than a tire as the noise is smaller than FINEST, in its units.
    smaller = min(noise / FINEST, 1.0)
    part_of_tire = smaller * smaller
    jerk_max = _jerk_max(part)
    snap_max = _snap_max(part)
    whole = _mean(modes, probability, certainty)
    other = SWITCH / 3.0
    same = 1.0 - SWITCH - other
    c0, c1, c2, c3 = (
        other + same * probability[0],
        other + same * probability[1],
        other + same * probability[2],
        other + same * probability[3],
    )
    press = _predicted(_mixed(modes[0], whole, other / c0, certainty), ratio)
    ride = _predicted(_mixed(modes[1], whole, other / c1, certainty), ratio)
    smooth = _predicted(_mixed(modes[2], whole, other / c2, certainty), ratio)
    sharp = _predicted(_mixed(modes[3], whole, other / c3, certainty), ratio)
    press = _jerked(press, min(PRESS * part_of_tire * fifth, jerk_max))
    ride = _jerked(ride, min(RIDE * fifth, jerk_max))
    smooth = _snapped(smooth, min(SMOOTH * part_of_tire * seventh, snap_max))
    sharp = _snapped(sharp, min(SHARP * seventh, snap_max))
    l0 = math.log(c0) + _log_likelihood(press, deflection, certainty)
    l1 = math.log(c1) + _log_likelihood(ride, deflection, certainty)
    l2 = math.log(c2) + _log_likelihood(smooth, deflection, certainty)
    l3 = math.log(c3) + _log_likelihood(sharp, deflection, certainty)
    best = max(l0, l1, l2, l3)
    w0, w1, w2, w3 = math.exp(l0 - best), math.exp(l1 - best), math.exp(l2 - best), math.exp(l3 - best)
    total = w0 + w1 + w2 + w3
    return (
        (
            _scaled(_updated(press, deflection), 1.0 / part),
            _scaled(_updated(ride, deflection), 1.0 / part),
            _scaled(_updated(smooth, deflection), 1.0 / part),
            _scaled(_updated(sharp, deflection), 1.0 / part),
        ),
        (w0 / total, w1 / total, w2 / total, w3 / total),
        scale,
    )


def rate(track: Track) -> float:
    """Return the rate [m/s] of the deflection at the last sample, 0 before the second one."""
    modes, probability, last = track
    if last <= 0.0:
        return 0.0
    scaled = 0.0
    for i in range(4):
        scaled += probability[i] * modes[i][1]
    return scaled / last


def acceleration(track: Track) -> float:
    """Return the acceleration [m/s^2] of the deflection at the last sample, 0 before the second one."""
    modes, probability, last = track
    if last <= 0.0:
        return 0.0
    scaled = 0.0
    for i in range(4):
        scaled += probability[i] * modes[i][2]
    return 2.0 * scaled / (last * last)


def _exactly(
    modes: tuple[Moving, Moving, Moving, Moving],
    probability: tuple[float, float, float, float],
    ratio: float,
    part: float,
    deflection: float,
    scale: float,
) -> Track:
    """Return the track after an exact measurement: two filters of the shortest memory, each for itself.

    ratio, part: the interval over the scale before and over the scale now, which is `scale` [s].
    """
    ride = _jerked(_predicted(modes[1], ratio), _jerk_max(part))
    sharp = _snapped(_predicted(modes[3], ratio), _snap_max(part))
    before = SWITCH + (1.0 - 2.0 * SWITCH) * probability[3] / (probability[1] + probability[3])
    w1 = (1.0 - before) * _exact_likelihood(ride, deflection)
    w3 = before * _exact_likelihood(sharp, deflection)
    ride = _scaled(_updated(ride, deflection), 1.0 / part)
    sharp = _scaled(_updated(sharp, deflection), 1.0 / part)
    return (ride, ride, sharp, sharp), (0.0, w1 / (w1 + w3), 0.0, w3 / (w1 + w3)), scale


def _jerk_max(part: float) -> float:
    """Return the largest intensity of the jerk, scaled by an interval that is `part` of the scale d."""
    return JERK_MAX * part * part * part * part * part


def _snap_max(part: float) -> float:
    """Return the largest intensity of the jerk's rate, scaled by an interval that is `part` of the scale d."""
    return SNAP_MAX * part * part * part * part * part * part * part


def _second(x: float, v: float) -> tuple[Moving, Moving, Moving, Moving]:
    """Return the motion in each mode at the second sample, from the difference v of the two."""
    u = UNKNOWN
    jerked = (x, v, 0.0, 0.0, 1.0, 1.0, 0.0, 0.0, 2.0 + u, u, 0.0, u, 0.0, 0.0)
    snapped = (x, v, 0.0, 0.0, 1.0, 1.0, 0.0, 0.0, 2.0 + 2.0 * u, u, -u, u, 0.0, u)
    return jerked, jerked, snapped, snapped


def _mean(
    modes: tuple[Moving, Moving, Moving, Moving],
    probability: tuple[float, float, float, float],
    certainty: float,
) -> Moving:
    """Return mean and covariance of the motion over all modes."""
    whole, weight = modes[0], probability[0]
    for i in range(1, 4):
        weight += probability[i]
        whole = _mixed(whole, modes[i], probability[i] / weight if weight > 0.0 else 0.0, certainty)
    return whole


def _mixed(a: Moving, b: Moving, share: float, certainty: float) -> Moving:
    """Return mean and covariance of a motion that is b with the probability `share`, and a otherwise."""
    remainder = 1.0 - share
    d0, d1, d2, d3 = b[0] - a[0], b[1] - a[1], b[2] - a[2], b[3] - a[3]
    farthest = certainty * max(d0 * d0, d1 * d1, d2 * d2, d3 * d3)
    apart = remainder * share * (certainty if farthest < APART else certainty * APART / farthest)
    return (
        a[0] + share * d0,
        a[1] + share * d1,
        a[2] + share * d2,
        a[3] + share * d3,
        remainder * a[4] + share * b[4] + apart * d0 * d0,
        remainder * a[5] + share * b[5] + apart * d0 * d1,
        remainder * a[6] + share * b[6] + apart * d0 * d2,
        remainder * a[7] + share * b[7] + apart * d0 * d3,
        remainder * a[8] + share * b[8] + apart * d1 * d1,
        remainder * a[9] + share * b[9] + apart * d1 * d2,
        remainder * a[10] + share * b[10] + apart * d1 * d3,
        remainder * a[11] + share * b[11] + apart * d2 * d2,
        remainder * a[12] + share * b[12] + apart * d2 * d3,
        remainder * a[13] + share * b[13] + apart * d3 * d3,
    )


def _scaled(moving: Moving, r: float) -> Moving:
    """Return the motion with its times scaled by r times the scale before."""
    if r == 1.0:
        return moving
    x, v, a, j, p00, p01, p02, p03, p11, p12, p13, p22, p23, p33 = moving
    rr = r * r
    rrr = rr * r
    return (
        x,
        v * r,
        a * rr,
        j * rrr,
        p00,
        p01 * r,
        p02 * rr,
        p03 * rrr,
        p11 * rr,
        p12 * rrr,
        p13 * rr * rr,
        p22 * rr * rr,
        p23 * rr * rrr,
        p33 * rrr * rrr,
    )


def _predicted(moving: Moving, r: float) -> Moving:
    """Return the motion predicted one interval ahead, which is r times the scale before and the scale now."""
    x, v, a, j, p00, p01, p02, p03, p11, p12, p13, p22, p23, p33 = _scaled(moving, r)
    # x + v + a + j, v + 2 a + 3 j, a + 3 j, j: the rows of the covariance, then its columns
    q00, q01, q02, q03 = (
        p00 + p01 + p02 + p03,
        p01 + p11 + p12 + p13,
        p02 + p12 + p22 + p23,
        p03 + p13 + p23 + p33,
    )
    q11, q12, q13 = p11 + 2.0 * p12 + 3.0 * p13, p12 + 2.0 * p22 + 3.0 * p23, p13 + 2.0 * p23 + 3.0 * p33
    q22, q23 = p22 + 3.0 * p23, p23 + 3.0 * p33
    return (
        x + v + a + j,
        v + 2.0 * a + 3.0 * j,
        a + 3.0 * j,
        j,
        q00 + q01 + q02 + q03,
        q01 + 2.0 * q02 + 3.0 * q03,
        q02 + 3.0 * q03,
        q03,
        q11 + 2.0 * q12 + 3.0 * q13,
        q12 + 3.0 * q13,
        q13,
        q22 + 3.0 * q23,
        q23,
        p33,
    )


def _jerked(moving: Moving, q: float) -> Moving:
    """Return the motion after an interval of white jerk of scaled intensity q; the jerk itself is not estimated."""
    x, v, a, _, p00, p01, p02, _, p11, p12, _, p22, _, _ = moving
    return (
        x,
        v,
        a,
        0.0,
        p00 + q / 20.0,
        p01 + q / 8.0,
        p02 + q / 12.0,
        0.0,
        p11 + q / 3.0,
        p12 + q / 4.0,
        0.0,
        p22 + q / 4.0,
        0.0,
        0.0,
    )


def _snapped(moving: Moving, q: float) -> Moving:
    """Return the motion after an interval in which the jerk's rate was white, of scaled intensity q."""
    x, v, a, j, p00, p01, p02, p03, p11, p12, p13, p22, p23, p33 = moving
    return (
        x,
        v,
        a,
        j,
        p00 + q / 252.0,
        p01 + q / 72.0,
        p02 + q / 60.0,
        p03 + q / 144.0,
        p11 + q / 20.0,
        p12 + q / 16.0,
        p13 + q / 36.0,
        p22 + q / 12.0,
        p23 + q / 24.0,
        p33 + q / 36.0,
    )


def _log_likelihood(moving: Moving, deflection: float, certainty: float) -> float:
    """Return the log likelihood of a measurement [m], without the terms that all modes share."""
    spread = moving[4] + 1.0
    innovation = deflection - moving[0]
    return -0.5 * (
        math.log(spread) + (TAIL + 1.0) * math.log1p(innovation * innovation * certainty / (TAIL * spread))
    )


def _exact_likelihood(moving: Moving, deflection: float) -> float:
    """Return the likelihood of an exact measurement [m], up to a factor that all modes share."""
    spread = moving[4] + 1.0
    innovation = deflection - moving[0]
    return float(
        (innovation * innovation / spread + EXACT * EXACT) ** (-0.5 * (TAIL + 1.0)) / math.sqrt(spread)
    )


def _updated(moving: Moving, deflection: float) -> Moving:
    """Return the motion updated with a measurement [m]."""
    x, v, a, j, p00, p01, p02, p03, p11, p12, p13, p22, p23, p33 = moving
    spread = p00 + 1.0
    k0, k1, k2, k3 = p00 / spread, p01 / spread, p02 / spread, p03 / spread
    innovation = deflection - x
    return (
        x + k0 * innovation,
        v + k1 * innovation,
        a + k2 * innovation,
        j + k3 * innovation,
        k0,
        k1,
        k2,
        k3,
        p11 - k1 * p01,
        p12 - k1 * p02,
        p13 - k1 * p03,
        p22 - k2 * p02,
        p23 - k2 * p03,
        p33 - k3 * p03,
    )
