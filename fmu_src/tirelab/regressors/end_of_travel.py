"""A gauge at the end of its travel: its reading stands still while the tire goes on.

Where the force goes on rising as before and falls again while the reading stands at its largest (or its smallest)
value, by more than the reading's own changes there allow, the gauge did not follow. In a hold the force stops rising.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from ..preprocessing.dataset import Recorded
from ..preprocessing.deflection_noise import deflection_noise
from .noise_floor import white_level

FloatArray = NDArray[np.float64]
BoolArray = NDArray[np.bool_]

BAND = 8.0
"""Noises of the gauge below its largest reading within which it stands still."""

FEWEST = 10
"""Samples of a stay: the peak of a quick cycle has fewer."""

BEYOND = 5.0
"""Rise of the force over what the mean stiffness makes of the reading: a progressive tire is stiffer there."""

MOST = 0.5
"""Part of the samples that may stand still: where more do, the motion is hardly more than its noise. And the part of
its stays in which a gauge at the end of its travel is seen to be there."""

ONWARDS = 0.5
"""Rate of the force in the first fifth of the stay over that before it."""

BROAD = 0.4
"""Part of the stay in which the force is above half of its rise: a ring dies away sooner."""


def beyond_travel(deflection: FloatArray, force: FloatArray) -> BoolArray:
    """Return at which samples (n,) the gauge stands at an end of its travel; deflection [m], force [N]."""
    return _stopped(deflection, force) | _stopped(-deflection, -force)


def said_of(recordings: Sequence[Recorded]) -> str:
    """Return a sentence on each recording whose gauge reached an end of its travel."""
    sentences = []
    for r in recordings:
        lost = beyond_travel(r.deflection, r.force)
        if lost.any():
            place = 1e3 * float(np.median(r.deflection[lost]))
            sentences.append(
                f"In {r.name} the deflection's reading stands still at {place:.4g} mm in {int(lost.sum())} samples "
                "while the force rises and falls: its gauge is at the end of its travel, and these samples were not "
                "compared; record with more travel."
            )
    return " ".join(sentences)


def _stopped(x: FloatArray, force: FloatArray) -> BoolArray:
    """Return where the reading stands at its largest while the force rises and falls."""
    if x.size <= FEWEST or not np.ptp(x) > 0.0:
        return np.zeros(x.size, dtype=bool)
    band = BAND * deflection_noise(x)
    near = x > np.partition(x, -FEWEST)[-FEWEST] - band
    if near.mean() > MOST:
        return np.zeros(x.size, dtype=bool)
    stiffness, noise = float(np.ptp(force)) / float(np.ptp(x)), white_level(force)
    places = np.flatnonzero(near)
    stopped = []
    # A single reading far off does not end a stay.
    for stay in np.split(places, np.flatnonzero(np.diff(places) > FEWEST) + 1):
        begin, end = int(stay[0]), int(stay[-1]) + 1
        own, fifth = force[begin:end], (end - begin) // 5
        if own.size < FEWEST or begin < fifth:
            continue
        ends = float(max(own[0], own[-1]))
        rise = float(own.max()) - ends
        allowed = BEYOND * stiffness * max(band, float(np.ptp(x[begin:end]))) + BAND * noise
        onwards = own[fifth] - own[0] > ONWARDS * (own[0] - force[begin - fifth]) > 0.0
        stopped.append(bool(rise > allowed and onwards and np.mean(own > ends + 0.5 * rise) > BROAD))
    # A gauge stops each time; what else moves the force may do so now and then.
    return near if stopped and np.mean(stopped) >= MOST else np.zeros(x.size, dtype=bool)
