"""What else it could be: the sets of effects that the recordings cannot rule out, and what they lack for it."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from ..names import UNKNOWN
from ..preprocessing.kinematics import FloatArray
from .findings import Alternative
from .judge import FORM_ERROR
from .naming import named
from .scene import Scene
from .search import Settled

DECIDABLE = 10.0
"""Sets within this log evidence of the best one are rivals: odds of 1000 to 1, as FORM_DOUBT counts them."""

SPEAKS = 4.0
"""The same for a set with one effect more: without any sample that speaks for it an effect costs five."""

UNSEEN = 6.0
"""Log odds against each effect that a free law may hide: chosen, as the price of one that gains nothing."""

DOUBTED = 1.5
"""Least log odds against what is smaller than the others' own error of form, and most against what one rate tells from
the best by the form of its loop alone: the evidence may be that error's."""

MOST_RIVALS = 10
"""So many are stated, likeliest first, beside those that one rate cannot tell at all."""

FORM_DOUBT = 0.7
"""Power to which odds between sets are taken: the forms of two sets err independently, each as allowed for."""

SUREST = 0.96
"""No verdict is surer than this: of 169 that no rival came within 4 of, on trials of the independent rig, 163 were
right (its seeds 7000 to 7220)."""

STATIC = frozenset(
    {"deflection_offset", "series_compliance", "gas_compression", "recalibration", "bottoming", "saturation"}
)


def rivals_of(settled: Sequence[Settled], scene: Scene) -> tuple[Alternative, ...]:
    """Return the sets of other names within DECIDABLE of the first one, and those that one rate cannot rule out."""
    best = settled[0]
    found: dict[tuple[str, ...], float] = {}
    for s in settled[1:]:
        names = named(s)
        if names == named(best):
            continue
        gap, nearest = best.log_evidence - s.log_evidence, DECIDABLE
        if not np.isfinite(gap) and UNKNOWN not in names and _speaks(s, settled):
            # Part of it is too small to be believed, but it may be there.
            gap = max(best.log_evidence - s.likely, DOUBTED)
        if set(names) > set(named(best)):
            nearest = SPEAKS
        elif UNKNOWN in named(best) and UNKNOWN not in names:
            nearest = SHAPE_DOUBT
        if gap < nearest:
            found[names] = min(gap, found.get(names, np.inf))
    for names, gap in static_rivals(settled):
        found.setdefault(names, gap)
    gaps = {named(s): best.log_evidence - s.log_evidence for s in reversed(settled)}
    same = [(names, min(gaps.get(names, 0.0), DOUBTED)) for names in one_rate_rivals(named(best), scene)]
    others = [item for item in sorted(found.items(), key=lambda item: item[1]) if item[0] not in dict(same)]
    order = [*same, *others[:MOST_RIVALS]]
    return tuple(Alternative(names, gap, reason_of(named(best), names, scene)) for names, gap in order)


def _speaks(one: Settled, settled: Sequence[Settled]) -> bool:
    """Return whether something speaks for all of a set: none of the smaller ones is as likely but for the price."""
    smaller = [s.log_evidence for s in settled if set(s.names) < set(one.names)]
    return one.likely > max(smaller, default=-np.inf) - SPEAKS


HIDING = ("series_compliance", "gas_compression", "bottoming", "deflection_offset")
"""What a law that is free on every surface can stand for, at one pressure and on one rig: of each less than a tenth is
left beside such a law."""

SHAPE_DOUBT = 30.0
"""Sets that differ in functions of deflection and surface alone are rivals within this log evidence: each has a form of
its own for what the law's shape, itself wrong by up to 13.5 %, may be. So is a set of known effects beside something
unknown, whose form is anybody's."""


def static_rivals(settled: Sequence[Settled]) -> list[tuple[tuple[str, ...], float]]:
    """Return the sets with another function of deflection and surface in the place of the first one's, and their gap.

    Beside a free law one of HIDING can always be there, unseen, or in the place of another that is hardly seen.
    """
    best = settled[0]
    names = named(best)
    statics = {"recalibration", *HIDING} & set(names)
    if not statics or UNKNOWN in names:
        return []
    rest = set(names) - statics
    found = []
    for s in settled[1:]:
        gap = best.log_evidence - s.log_evidence
        others = set(named(s))
        if np.isfinite(gap) and "recalibration" in set(names) - others and _is_error_of_form(s, best):
            gap = min(gap, UNSEEN)
        if gap < SHAPE_DOUBT and others != set(names) and others - {"recalibration", *HIDING} == rest:
            found.append((named(s), gap))
    if "recalibration" in names:
        less = [set(other) for other, _ in found if set(other) < set(names) and "recalibration" in other]
        seen = set.intersection(set(names), *less)
        bases = [seen, set(names)] if seen < set(names) else [seen]
        found += [(tuple(sorted({*base, h})), UNSEEN) for base in bases for h in HIDING if h not in names]
    return found


def _is_error_of_form(other: Settled, best: Settled) -> bool:
    """Return whether a set leaves no more power than its largest effect's form may miss, which a free law takes up."""
    more = other.candidate.explained.chi_square - best.candidate.explained.chi_square
    return more < (FORM_ERROR * max(other.candidate.explained.size, default=0.0)) ** 2


def confidence_of(rivals: Sequence[Alternative]) -> float:
    """Return the probability of a verdict beside its `rivals`, by their log odds."""
    return SUREST / (1.0 + sum(float(np.exp(-FORM_DOUBT * r.log_odds)) for r in rivals))


LOOPS = ("rate_independent_hysteresis", "viscous_damping", "viscoelastic_relaxation", "force_lag")
"""What makes a loop; at one constant rate on one surface any one of them can be the cause."""

SAME_RATE = 0.1
"""Rates within this part of their median count as one."""

AT_CORNERS = 0.15
"""Part of the samples that may stand at the corners of a triangle, where the rate is on its way."""

NOTICED = 0.03
"""Rates are taken over this part of the largest deflection, that the noise of the reading does not make them many."""


def one_constant_rate(scene: Scene) -> bool:
    """Return whether all recordings run at one rate up and at one rate down, on one surface.

    Two rates will not do where one of them is always up: the law takes up what loading and unloading have in common.
    """
    if len(scene.radii) > 1:
        return False
    # Steps of the smoothed deflection: its derivative rings around corners.
    rates = np.concatenate([_rates(r.time, r.motion.deflection, scene.deepest) for r in scene.records])
    return all(_is_one(rates[way * rates > 0.0]) for way in (1.0, -1.0))


def _rates(time: FloatArray, deflection: FloatArray, deepest: float) -> FloatArray:
    """Return the rates [m/s] over as many samples as it takes to move a noticed part of the largest deflection [m]."""
    travel = float(np.median(np.abs(np.diff(deflection))))
    apart = min(max(int(np.ceil(NOTICED * deepest / max(travel, 1e-12))), 1), max(time.size // 20, 1))
    return np.asarray((deflection[apart:] - deflection[:-apart]) / (time[apart:] - time[:-apart]))


def _is_one(rates: FloatArray) -> bool:
    if rates.size == 0:
        return True
    middle = float(np.median(rates))
    return float(np.mean(np.abs(rates / middle - 1.0) > SAME_RATE)) < AT_CORNERS


def one_rate_rivals(names: tuple[str, ...], scene: Scene) -> list[tuple[str, ...]]:
    """Return the sets in which one loop takes the place of all there are, where one rate cannot tell."""
    loops = {n for n in names if n in LOOPS}
    if not loops or not one_constant_rate(scene):
        return []
    return [tuple(sorted({*names, other} - (loops - {other}))) for other in LOOPS if {other} != loops]


def poverty(scene: Scene) -> list[str]:
    """Return what the recordings lack that tells effects apart."""
    lacks = []
    if one_constant_rate(scene):
        lacks.append("one constant rate only: drive a second rate")
    if len(scene.radii) == 1:
        lacks.append("one surface only: press on a second surface")
    rates = [np.abs(r.motion.rate) for r in scene.records]
    typical = max(float(np.sqrt(np.mean(r**2))) for r in rates)
    held = max(_longest_rest(r.time, np.abs(r.motion.rate) < 0.02 * typical) for r in scene.records)
    if held < 1.0:
        lacks.append(f"no hold: hold 10 s at {650.0 * scene.deepest:.0f} mm")
    if max(float(r.motion.cycle.max()) for r in scene.records) < 1.0:
        lacks.append("no repeated cycle: drive each cycle twice")
    return lacks


def _longest_rest(time: FloatArray, still: np.ndarray) -> float:
    ends = np.flatnonzero(np.diff(np.concatenate([[0], still.astype(int), [0]])))
    return max(
        (float(time[b - 1] - time[a]) for a, b in zip(ends[::2], ends[1::2], strict=True)), default=0.0
    )


SLOW = frozenset({"pressure_leak", "warm_up", "mullins_softening", "force_drift"})


def reason_of(names: tuple[str, ...], other: tuple[str, ...], scene: Scene) -> str:
    """Return why the recordings cannot tell two sets apart, in a clause."""
    apart = set(names) ^ set(other)
    lacks = poverty(scene)
    if apart <= STATIC:
        return "they depend on deflection and surface only: record at a second pressure or on a stiffer rig"
    if apart <= set(LOOPS):
        told = [x for x in lacks if "surface" not in x]
        return (
            "; ".join(told)
            if told
            else "their loops are alike at the recorded rates: drive slower and faster"
        )
    if apart <= SLOW:
        return "they all change slowly with time: repeat the first cycle after a rest"
    if UNKNOWN in apart:
        return "a smooth curve fits the residual as well as a known effect does"
    return "; ".join(lacks) if lacks else "the difference is smaller than these recordings can show"
