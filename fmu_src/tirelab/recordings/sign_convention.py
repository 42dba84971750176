"""Which way a rig counts: compression and compressive force positive, or negative."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

CLEAR = 0.5
"""How strong a piece of evidence (-1 to 1) must be to count: far above noise, far below what a load gives."""

ROUNDING = 1e-11
"""A spread below this share of the sum of squares is what roundings leave of a constant, and no evidence."""


PASSED = 0.1
"""A passage of the middle counts where the deflection goes on beyond it by this part of its stroke."""


@dataclass(frozen=True)
class Signs:
    """The factors, 1 or -1, that make deflection and force positive in compression, and why they are in doubt.

    In doubt they are the likely ones: a tire pushes, and more the more it is pressed.
    falls: whether the force falls where the deflection rises, up to the largest one where the whole does not tell
    negative: whether both are negative under load
    """

    deflection: int = 1
    force: int = 1
    doubt: str = ""
    falls: bool = False
    negative: bool = False


def compressive_signs(deflection: NDArray[np.float64], force: NDArray[np.float64]) -> Signs:
    """The signs of a rig, from three pieces of evidence, each from -1 to 1.

    together     correlation of x and F: positive when both count the same way; up to the largest |F| where that shows
                 the contrary of the whole, as of a specimen that fails and is pulled on
    pushing      sum F|F| / sum F^2: 1 when the force is positive wherever it is large
    compressed   sum x F^2 / sum |x| F^2: 1 when the deflection is positive wherever the force is large

    A tire pushes and never pulls, so the last two show the sign of either channel, and the first must agree
    with their product. Evidence below `CLEAR` counts for nothing: force that follows no deflection, as in the
    air, leaves the signs as they are. Parameters: `deflection`, `force`, of shape (samples,), in any units.
    """
    # Numbers too large to be squared are refused elsewhere; here they are no evidence.
    with np.errstate(all="ignore"):
        evidence = _evidence(deflection, force)
        before = _together_before_the_peak(deflection, force)
        if before * evidence[0] < 0.0:
            evidence = (before, *evidence[1:])
    together, pushing, compressed = (0 if not abs(e) >= CLEAR else (1 if e > 0.0 else -1) for e in evidence)
    if together and pushing and compressed and compressed * pushing == together:
        return Signs(compressed, pushing)
    negative = together < 0 or pushing < 0 or compressed < 0
    unloaded = together == 0 and pushing == 0
    if not negative or unloaded:
        return Signs()
    at_first = together == 0 and before < 0.0
    falls = {1: "rises with", 0: "does not follow", -1: "falls with"}[together]
    follows = "falls, up to the largest one, with" if at_first else falls
    side = {1: "positive", 0: "of both signs", -1: "negative"}
    force_sign = pushing or 1
    return Signs(
        together * force_sign if together else compressed or 1,
        force_sign,
        doubt=f"force {follows} deflection; under load force is {side[pushing]}, deflection {side[compressed]}",
        falls=together < 0 or at_first,
        negative=pushing < 0 and compressed < 0,
    )


def _evidence(deflection: NDArray[np.float64], force: NDArray[np.float64]) -> tuple[float, float, float]:
    # Sums of products rather than centred copies: a long recording is large enough as it is.
    samples = len(force)
    x, f = float(deflection.mean()), float(force.mean())
    xx, ff = float(np.dot(deflection, deflection)), float(np.dot(force, force))
    covariance = float(np.dot(deflection, force)) - samples * x * f
    spread_x, spread_f = xx - samples * x * x, ff - samples * f * f
    varied = spread_x > ROUNDING * xx and spread_f > ROUNDING * ff
    size = np.abs(force)
    pushing = float(np.dot(force, size))
    size *= size
    compressed = float(np.dot(deflection, size))
    reached = float(np.dot(np.abs(deflection), size))
    return (
        covariance / float(np.sqrt(spread_x * spread_f)) if varied else 0.0,
        pushing / ff if ff > 0.0 else 0.0,
        compressed / reached if reached > 0.0 else 0.0,
    )


def _together_before_the_peak(deflection: NDArray[np.float64], force: NDArray[np.float64]) -> float:
    """Return the correlation up to the largest |force|; 0 where it is not clear, or that is no loading (`_loads`)."""
    first = slice(0, int(np.argmax(np.abs(force))) + 1)
    if not _loads(deflection, force, first):
        return 0.0
    together = _evidence(deflection[first], force[first])[0]
    return together if abs(together) >= CLEAR else 0.0


def _loads(deflection: NDArray[np.float64], force: NDArray[np.float64], first: slice) -> bool:
    """Return whether what is driven up to the largest |force| is long enough to be a loading.

    It is where it is more than `PASSED` of the stroke. A specimen that yields early is pulled on by far more: where the
    force gains most of its largest, it is enough that a step of the gauge, or its noise, is below `PASSED` of the way.
    """
    x = deflection[first]
    way = float(np.ptp(x))
    if way > PASSED * np.ptp(deflection):
        return True
    steps = np.diff(x)
    steps = steps[steps != 0.0]
    gains = abs(force[first][-1] - force[0]) > CLEAR * np.max(np.abs(force))
    return bool(gains and steps.size and np.sqrt(np.mean(steps**2)) < PASSED * way)


def work_share(deflection: NDArray[np.float64], force: NDArray[np.float64]) -> float:
    """Return the work that whole cycles bring into a part over the largest that they could, -1 to 1.

        sum F dx / sum |F - mean F| |dx|,    from the first to the last passage of the middle inwards

    The middle is that of the stroke: a median is where a part rests for long. A passage counts once, where the
    deflection has gone on beyond it by `PASSED`: the noise of a gauge passes the middle many times in one slow stroke.
    1 of friction or a damper alone, 0 of a spring; nothing passive is below 0 but for a force that is read late: by
    phi of a cycle, a spring has -pi/2 sin phi. NaN where no cycle is whole. `deflection`, `force`: (samples,).
    """
    above = deflection > _middle(deflection)
    far, passages = _passages(deflection)
    inwards = [
        int(before + np.flatnonzero(above[before + 1 : after + 1] & ~above[before:after])[-1])
        for before, after in zip(far[passages], far[passages + 1], strict=True)
        if above[after]
    ]
    if len(inwards) < 2:
        return float("nan")
    whole = slice(inwards[0], inwards[-1] + 1)
    way, middle = _steps(deflection[whole], force[whole])
    with np.errstate(all="ignore"):
        return float((middle @ way) / (np.abs(middle - middle.mean()) @ np.abs(way)))


def loading_share(deflection: NDArray[np.float64], force: NDArray[np.float64]) -> float:
    """Return the work of what the force gains up to its largest, over the largest that it could be, -1 to 1.

        sum (F - F_1) dx / sum |F - F_1| |dx|,    from the first sample to the largest |F|

    1 of a spring that is loaded, whatever its preload or the zero of its load cell; a snap-through has its barrier in
    it. NaN where the force gains less than `CLEAR` of its largest, as friction alone, or the way is short (`_loads`).
    """
    first = slice(0, int(np.argmax(np.abs(force))) + 1)
    gained = force[first] - force[0]
    if not _loads(deflection, force, first) or not abs(gained[-1]) > CLEAR * np.max(np.abs(force)):
        return float("nan")
    way, middle = _steps(deflection[first], gained)
    with np.errstate(all="ignore"):
        return float((middle @ way) / (np.abs(middle) @ np.abs(way)))


def _steps(
    deflection: NDArray[np.float64], force: NDArray[np.float64]
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Return the way of each step from sample to sample and the mean force on it (n - 1,): their product is work."""
    return np.diff(deflection), 0.5 * (force[1:] + force[:-1])


def mass_alike(
    time: NDArray[np.float64], deflection: NDArray[np.float64], force: NDArray[np.float64]
) -> float:
    """Return the mass [kg] that has a force fall with the deflection as this one does, driven as this one is.

        m = -k / w^2,    k the slope of the force over the deflection, w from the usual time between two passages of
                         the middle

    Infinite where the force does not fall, the part is not driven to and fro, or the clock stands or begins anew.
    `time` [s], `deflection` [m], `force` [N], of shape (samples,).
    """
    far, found = _passages(deflection)
    passages = time[far[found + 1]]
    x = deflection - deflection.mean()
    fall = -float(x @ (force - force.mean()))
    usual = float(np.median(np.diff(passages))) if passages.size > 1 else 0.0
    if usual <= 0.0 or fall <= 0.0:
        return float("inf")
    return fall / float(x @ x) / (np.pi / usual) ** 2


def _middle(deflection: NDArray[np.float64]) -> float:
    with np.errstate(all="ignore"):
        return 0.5 * float(deflection.min()) + 0.5 * float(deflection.max())


def _passages(deflection: NDArray[np.float64]) -> tuple[NDArray[np.intp], NDArray[np.intp]]:
    """Return the samples that are beyond the middle by `PASSED` of the stroke, and those of them after which the next
    one is on the other side."""
    beyond = (deflection - _middle(deflection)) / max(float(np.ptp(deflection)), np.finfo(float).tiny)
    far = np.flatnonzero(np.abs(beyond) > PASSED)
    return far, np.flatnonzero(np.diff(np.sign(beyond[far])) != 0.0)
