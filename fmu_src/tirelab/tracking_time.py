"""The tracking time and the noise of recorded deflections, by maximum likelihood.

`radialtire.tracking` follows a deflection as a motion of random jerk of intensity q, read with noise of standard
deviation s, with T^5 = s^2 / q. Of all tracking times T the likeliest makes the readings least surprising: with e_i
the surprise of reading i and V_i its variance in units of s^2,

    -2 log L = n log(s^2) + sum(log V_i),   s^2 = sum(e_i^2 / V_i) / n

s is each recording's own. On rides to 8 Hz read at 400 Hz this T comes within 5 % of the least error of the rate.

A slow recording says nothing of fast motions: its likeliest T is long, and would smear a ride. So T is never longer
than the one of a ride's jerk and the noise found.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from radialtire import TireModel
from scipy.optimize import minimize_scalar

from . import compiled
from .held_out import Recorded
from .simulate import Sampled, differentiates, simulate

TRIED = np.geomspace(1e-5, 1.0, 26)
"""Tracking times [s] among which the best is sought first: far below the interval they are all alike."""

RIDE_JERK = 1e3
"""q [m^2/s^5] of the deflections of a ride with content to 8 Hz and 5 mm of standard deviation."""

SHORTEST, SERVING = 0.05, 12
"""Tracking times that are tried for the one that serves: from this part of a ride's, so many."""

AS_GOOD = 1.02
"""Squared errors within this ratio of the least are as good; of such T the longest is taken: a recording that is read
more often needs it."""

SETTLING = 10
"""Readings after which the track has forgotten that it knew nothing of rate and acceleration."""


class Tracking(NamedTuple):
    """tracking_time: T [s]; noise: standard deviation s [m] of each recording's deflection."""

    tracking_time: float
    noise: tuple[float, ...]


def likeliest_tracking(recordings: Sequence[Sampled]) -> Tracking:
    """Return the tracking time that makes the deflections of `recordings` likeliest, or a ride's, and their noise.

    Recordings of SETTLING readings or fewer say nothing and have noise 0; where all are so short, T is 0. Cost: about
    35 passes over the samples.
    """
    loop = compiled.loop("surprise_loop", "surprise")

    def noise_and_surprise(tracking_time: float, recording: Sampled) -> tuple[float, float]:
        count = recording.deflection.size - SETTLING
        if count <= 0:
            return 0.0, 0.0
        squares, logs = loop(recording.time, recording.deflection, tracking_time, SETTLING)
        variance = max(squares / count, np.finfo(float).tiny)
        return math.sqrt(variance), count * math.log(variance) + logs

    def surprise(log_time: float) -> float:
        return sum(noise_and_surprise(math.exp(log_time), recording)[1] for recording in recordings)

    if all(recording.deflection.size <= SETTLING for recording in recordings):
        return Tracking(0.0, (0.0,) * len(recordings))
    logs = np.log(TRIED)
    best = int(np.argmin([surprise(log_time) for log_time in logs]))
    around = (logs[max(best - 1, 0)], logs[min(best + 1, logs.size - 1)])
    found = minimize_scalar(surprise, bounds=around, method="bounded", options={"xatol": 0.02})
    likeliest = math.exp(float(found.x))
    noise = tuple(noise_and_surprise(likeliest, recording)[0] for recording in recordings)
    return Tracking(min(likeliest, of_a_ride(max(noise))), noise)


def of_a_ride(noise: float) -> float:
    """Return the tracking time [s] for the jerk of a ride, read with this standard deviation [m]."""
    return float((noise**2 / RIDE_JERK) ** 0.2)


def serving_tracking(
    tire: TireModel, recordings: Sequence[Recorded], resolved: Sequence[NDArray[np.bool_]], noise: float
) -> float:
    """Return the tracking time [s] with which the forces of `tire` come nearest to those recorded (least squares).

    resolved: for each recording, False where the motion turns within a sample and no T can follow it; noise [m]: of
    the deflections. The likeliest T is right for motions of one kind; the corners of a triangle make it so short that
    all the noise passes. Of those that serve as well the longest, never longer than that of a ride.
    """
    longest = of_a_ride(noise)
    if not differentiates(tire) or longest <= 0.0:
        return tire.tracking_time

    def miss(tracking_time: float) -> float:
        tracked = replace(tire, tracking_time=tracking_time)
        return sum(
            float(np.sum((r.force - simulate(tracked, r))[kept] ** 2))
            for r, kept in zip(recordings, resolved, strict=True)
        )

    tried = np.geomspace(SHORTEST * longest, longest, SERVING)
    missed = np.array([miss(float(T)) for T in tried])
    return float(tried[missed <= AS_GOOD * missed.min()][-1])
