"""Rate and acceleration of a deflection that is read with noise at moments of any spacing.

A Kalman filter, without look-ahead, of a motion whose jerk is white noise of intensity q, read with white noise of
standard deviation s. Only their ratio matters, as the tracking time T:

    q / s^2 = T^-5

T is the memory of the filter: readings much older than T hardly count. T = 0 is right for readings free of noise: the
errors then fall with d^2 (rate) and d (acceleration). The likelihood of a recorded deflection tells its T. On a ride
to 8 Hz and 5 mm, read at 400 Hz with 8e-6 m of noise, the likeliest T is 2.3 ms and leaves errors of 4 mm/s and
1.3 m/s^2; plain differences leave 9 mm/s, most of it their delay of half an interval, and 3.2 m/s^2.

Lengths of time are scaled by the last interval d: the filter holds x, d x', d^2 x''/2 and their covariance over s^2.

Reference: P. R. Belanger, P. Dobrovolny, A. Helmy, X. Zhang, "Estimation of angular velocity and acceleration from
shaft-encoder measurements", Int. J. Robotics Research 17 (1998) 1225-1233.
"""

from __future__ import annotations

Track = tuple[float, float, float, float, float, float, float, float, float, float]
"""x, d x', d^2 x''/2, their covariance P00 P01 P02 P11 P12 P22 over s^2, and the last interval d [s]."""

UNTRACKED: Track = (0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0)
"""The track before the first reading."""

UNKNOWN = 1e4
"""Variance over s^2 of the scaled acceleration at the second reading: large beside 1, so the third one decides."""

JERK_MAX = 32.0
"""Largest (d/T)^5: a T below d/2 counts as d/2. Shorter, it would overshoot at kinks and gain little elsewhere."""


def begin(deflection: float) -> Track:
    """Return the track after the first reading [m]."""
    return (deflection, *UNTRACKED[1:])


def follow(track: Track, interval: float, deflection: float, tracking_time: float) -> Track:
    """Return the track after a reading `deflection` [m], `interval` > 0 [s] after the last one.

    tracking_time: T >= 0 [s].
    """
    x, v, a, p00, p01, p02, p11, p12, p22, last = track
    if last <= 0.0:  # the second reading: the difference, taken as free of acceleration until the third
        return (deflection, deflection - x, 0.0, 1.0, 1.0, 0.0, 2.0 + UNKNOWN, UNKNOWN, UNKNOWN, interval)
    if interval != last:
        r = interval / last
        rr = r * r
        v, a = v * r, a * rr
        p01, p02 = p01 * r, p02 * rr
        p11, p12, p22 = p11 * rr, p12 * rr * r, p22 * rr * rr
    # one interval on: x + v + a, v + 2 a, a
    x += v + a
    v += 2.0 * a
    p00 += 2.0 * (p01 + p02 + p12) + p11 + p22
    p01 += p11 + 2.0 * p02 + 3.0 * p12 + 2.0 * p22
    p02 += p12 + p22
    p11 += 4.0 * (p12 + p22)
    p12 += 2.0 * p22
    jerk = JERK_MAX
    if tracking_time > 0.0:
        ratio = interval / tracking_time
        jerk = min(ratio * ratio * ratio * ratio * ratio, JERK_MAX)
    p00 += jerk / 20.0
    p01 += jerk / 8.0
    p02 += jerk / 12.0
    p11 += jerk / 3.0
    p12 += jerk / 4.0
    p22 += jerk / 4.0
    # the reading
    spread = p00 + 1.0
    k0, k1, k2 = p00 / spread, p01 / spread, p02 / spread
    surprise = deflection - x
    return (
        x + k0 * surprise,
        v + k1 * surprise,
        a + k2 * surprise,
        k0,
        k1,
        k2,
        p11 - k1 * p01,
        p12 - k1 * p02,
        p22 - k2 * p02,
        interval,
    )


def rate(track: Track) -> float:
    """Return the rate [m/s] of the deflection at the last reading, 0 before the second one."""
    return track[1] / track[9] if track[9] > 0.0 else 0.0


def acceleration(track: Track) -> float:
    """Return the acceleration [m/s^2] of the deflection at the last reading, 0 before the second one."""
    return 2.0 * track[2] / (track[9] * track[9]) if track[9] > 0.0 else 0.0
