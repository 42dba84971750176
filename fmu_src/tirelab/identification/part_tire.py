"""A law of a part as a tire, which a file and an FMU hold: a power law with a gap or with a preload, or a curve."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from radialtire import CATALOGUE, FLAT_RADIUS, ParameterError, PowerLaw, TestedRange, TireModel
from radialtire.part_curve import PartCurve

from ..errors import TirelabError
from ..names import plain
from ..recordings.counting import MOST_MOVED
from ..recordings.pulling import pull_of
from ..recordings.recording import Recording
from ..recordings.sign_convention import mass_alike
from ..recordings.zero import FARTHEST
from .both_ways import common_curve
from .law_fit import LawFit
from .lift_off import lifts_off
from .part_laws import constant_fit, reading_noise
from .power_fit import EXPONENT_BOUNDS

GAPS = ("linear_gap", "power_gap")
"""Laws that a tire file holds as a power law whose deflection is shifted. The gap is a loss of contact, as a tire's in
the air: a stop or a loose spring cannot pull through it, so the tire file is not one of a part held at both ends.
"""

IN_GAP = 0.1
"""Share of the largest force that recordings may have inside the gap, where its law has none: friction and the zero."""

TWO_SIDED = ("constant", "linear", "power", "power_preload")
"""Laws that a tire file holds as a power law of a part that is held at both ends, with its preload; the power alone
only where the recordings show it pull, else it is one that is pressed, and may lift off.
"""

PRESSED = ("power", *GAPS)
"""Laws that a tire file holds of a part that is only pressed."""

CURVE = "piecewise"
"""Law that a tire file holds as a curve of a part that is held at both ends. Every recording has one; it is proposed
only where the force is one of the deflection, in and out alike, and no spring's.
"""

AT_REST, MOSTLY_HELD = 0.02, 0.9
"""A recording is a hold if more than MOSTLY_HELD of its samples lie within AT_REST of its stroke of one deflection."""

LEAST_SPRING = PowerLaw.parameters[0].minimum
"""Least coefficient A [N/cm^B] that a tire file holds: a part without a spring, such as a damper, has this one."""

SURE = 3.0
"""Standard uncertainties by which a spring's constant must be below 0 to be no spring."""


def holds_air(recordings: Sequence[Recording]) -> bool:
    """Return whether a part holds air: only where its pressure was recorded."""
    return any(r.pressure is not None for r in recordings)


def tire_of(fit: LawFit, recordings: Sequence[Recording], name: str) -> TireModel:
    """Return a tire with a fitted law: a power law, and a deflection offset for its gap, or a two-sided part with its
    preload.

    Raises TirelabError where a tire file cannot hold the law, and where there is a force inside a law's gap.
    """
    if fit.name == "power" and not _pulled(recordings):
        law = _power_law(fit, max(fit.value("A"), LEAST_SPRING), recordings)
        if law.coefficient > LEAST_SPRING:
            return _described(TireModel(law=law), recordings, name)
    if fit.name in TWO_SIDED:
        return _described(_two_sided(fit, recordings), recordings, name)
    if fit.name == CURVE and len(fit.at) > 1:
        curve = PartCurve(fit.at, tuple(value for _, value, _, _ in fit.constants))
        return _described(replace(_without_spring(0.0), curve=curve), recordings, name)
    if fit.name not in GAPS:
        known = ", ".join((*TWO_SIDED, *GAPS, CURVE))
        raise TirelabError(f"a tire file cannot hold the law {fit.name}; choose one of {known}")
    _refuse_pull(fit, recordings)
    x0 = 1e-3 * fit.value("x0")
    if abs(x0) > FARTHEST:
        raise TirelabError(
            f"the force begins at {plain(1e3 * x0, 3)} mm, which is rather a gauge's zero than a gap; give what it "
            "reads there, as the file counts: tirelab inspect --part FILE --zero deflection=..."
        )
    symbol, scale = ("k", 10.0) if fit.name == "linear_gap" else ("A", 1.0)  # N/mm to N/cm
    law = _power_law(fit, max(scale * fit.value(symbol), LEAST_SPRING), recordings)
    if law.coefficient == LEAST_SPRING:
        raise TirelabError(
            f"the law {fit.name} has {symbol} = {plain(fit.value(symbol), 3)}; {_other_laws(recordings)}"
        )
    gap = next(effect for effect in CATALOGUE.values() if effect.holds_gap)
    effects = ((gap, (-x0,)),)
    return _described(TireModel(law=law, effects=effects), recordings, name)


def best_writable(fits: Sequence[LawFit], recordings: Sequence[Recording]) -> str:
    """Return the first of the laws that a tire file holds, "" where it holds none.

    One whose spring is none is left to the constant. The curve is taken where it is proposed (`curve_advice`). Where
    what presses the part lifts off it, it is not held at both ends.
    """
    pressed = lifts_off(recordings)
    for fit in fits:
        if fit.name == CURVE or (pressed and fit.name not in PRESSED):
            continue
        try:
            tire = tire_of(fit, recordings, "")
        except TirelabError:
            continue
        if fit.name == "constant" or tire.law != PowerLaw(LEAST_SPRING, 1.0):
            return CURVE if not pressed and curve_advice(tire, recordings) else fit.name
    return ""


def curve_advice(tire: TireModel, recordings: Sequence[Recording]) -> str:
    """Return the reason to take the curve instead of the law of `tire`, "" where there is none.

    A diagnosis refits the law by a factor and ten forces, so it cannot follow what rises and falls between them. What a
    mass may do, which moves between the part and the load cell, is left to the diagnosis.
    """
    if not tire.two_sided or tire.curve is not None:
        return ""
    if all(r.timed and mass_alike(r.time, r.deflection, r.force) < MOST_MOVED for r in recordings):
        return ""
    common, spring = common_curve(recordings, tire)
    if not (common > spring and common > reading_noise(recordings)):
        return ""
    return (
        f"the force rises and falls with the deflection in and out alike, by {plain(common, 2)} N, and the spring "
        f"of this law by {plain(spring, 2)} N, as with detents or a snap-through"
    )


def _pulled(recordings: Sequence[Recording]) -> bool:
    """Return whether a recording shows the force of a part that pulls, or deflections of one.

    What sticks to a press pulls before it lifts off, and is pressed all the same.
    """
    stroke = stroke_of(recordings)
    pulls = (pull_of(r.force) < 0.0 or float(r.deflection.min()) < -AT_REST * stroke for r in recordings)
    return not lifts_off(recordings) and any(pulls)


def _two_sided(fit: LawFit, recordings: Sequence[Recording]) -> TireModel:
    if fit.name == "constant":
        return _without_spring(fit.value("F0"))
    symbol, scale = ("k", 10.0) if fit.name == "linear" else ("A", 1.0)  # N/mm to N/cm
    value, deviation = next((v, d) for s, v, d, _ in fit.constants if s == symbol)
    if value + SURE * deviation < 0.0:
        raise TirelabError(
            f"the law {fit.name} has {symbol} = {plain(value, 3)}, a force that falls as the deflection grows, "
            "which a tire file does not hold as a power; check the signs of force and deflection; "
            f"{_other_laws(recordings)}"
        )
    if scale * value <= LEAST_SPRING:
        return _without_spring(constant_fit(recordings).value("F0"))
    law = _power_law(fit, scale * value, recordings)
    preload = 0.0 if fit.name == "power" else fit.value("F0")
    return TireModel(law=law, two_sided=True, preload=preload)


def _power_law(fit: LawFit, coefficient: float, recordings: Sequence[Recording]) -> PowerLaw:
    """Return the law of a coefficient [N/cm^B]; raises TirelabError where a tire file holds none like it."""
    exponent = _exponent(fit, recordings)
    try:
        return PowerLaw(coefficient, exponent)
    except ParameterError as error:
        raise TirelabError(f"the law {fit.name}: {error}; take another one, as --part piecewise") from None


def _exponent(fit: LawFit, recordings: Sequence[Recording]) -> float:
    """Return the exponent B of a law; raises TirelabError where a tire file holds none like it."""
    if fit.name in ("linear", "linear_gap"):
        return 1.0
    exponent = fit.value("B")
    least, most = EXPONENT_BOUNDS
    if not least <= exponent <= most:
        levels_off = "for a force that levels off, as of a metal that yields, --part piecewise; "
        raise TirelabError(
            f"the law {fit.name} has B = {plain(exponent, 3)}, and a tire file holds {least:g} to {most:g}; "
            f"{levels_off if 0.0 < exponent < least else ''}{_other_laws(recordings)}"
        )
    return exponent


def _other_laws(recordings: Sequence[Recording]) -> str:
    """Return the advice where a spring's law does not hold what was recorded."""
    return (
        f"{_ramp_advice(recordings)}for a part without a spring, such as a damper, give --part constant; for a force "
        "that falls as the deflection grows, as between magnets, --part piecewise"
    )


def springless(fit: LawFit, tire: TireModel) -> str:
    """Return a sentence where a law was asked for that has a spring, and the tire file has none; "" else."""
    if fit.name in ("constant", CURVE) or tire.law != PowerLaw(LEAST_SPRING, 1.0):
        return ""
    symbol, value, deviation, unit = next(c for c in fit.constants if c[0] in ("k", "A"))
    return (
        f"{symbol} = {plain(value, 3)} ± {plain(deviation, 2)} {unit} is no spring that a tire file holds: the file "
        f"has the preload alone, {plain(tire.preload, 4)} N, as of --part constant"
    )


def held_though_pressed(tire: TireModel, recordings: Sequence[Recording]) -> str:
    """Return a sentence where a law of a part that is held at both ends was asked for, and the press lifts off; ""
    else.
    """
    if not tire.two_sided or not lifts_off(recordings):
        return ""
    return (
        "the force rests on a way back where the part was loaded before: what presses it lifts off, and this file is "
        f"of a part that is held at both ends; --part {', '.join(PRESSED)} cannot pull"
    )


def falling(fit: LawFit, linear: LawFit) -> str:
    """Return a sentence for a curve of a force that falls as the deflection grows, "" where it does not.

    linear: the straight line through the same readings, which is refused as a spring where it falls
    """
    k, deviation = next(
        (value, deviation) for symbol, value, deviation, _ in linear.constants if symbol == "k"
    )
    if fit.name != CURVE or not k + SURE * deviation < 0.0:
        return ""
    return (
        f"the force falls as the deflection grows, by {plain(-k, 3)} N/mm on the whole, as between magnets; if this "
        "is a spring, check the signs of force and deflection"
    )


def ramp_before_hold(recording: Recording, stroke: float) -> tuple[float, float] | None:
    """Return the times [s] of the ramp after which a recording is a hold, equal where it begins with that; None where
    it is not nearly all a hold.

    In a hold the force relaxes at one deflection: a law that is fitted to it says nothing of a spring.
    stroke [m]: of all recordings
    """
    deflection = recording.deflection
    near = np.abs(deflection - np.median(deflection)) < AT_REST * stroke
    begun = float(recording.time[int(np.argmax(near))])
    held = recording.timed and float(np.mean(near)) > MOSTLY_HELD
    return (float(recording.time[0]), begun) if held else None


def stroke_of(recordings: Sequence[Recording]) -> float:
    """Return the stroke [m] of all recordings together."""
    return float(np.ptp([bound for r in recordings for bound in (r.deflection.min(), r.deflection.max())]))


def _ramp_advice(recordings: Sequence[Recording]) -> str:
    """Return the advice to identify the law from the ramp before the first hold; "" where no recording is a hold."""
    for recording in recordings:
        ramp = ramp_before_hold(recording, stroke_of(recordings))
        if ramp is not None and ramp[0] < ramp[1]:
            name = recording.name if recording.source is None else recording.source.name
            return (
                f"nearly all of {name} is a hold, so identify the law from the way there, "
                f"{name}@{ramp[0]:.4g}s:{ramp[1]:.4g}s, and diagnose the whole with it; "
            )
    return ""


def _without_spring(preload: float) -> TireModel:
    return TireModel(law=PowerLaw(LEAST_SPRING, 1.0), two_sided=True, preload=preload)


def _refuse_pull(fit: LawFit, recordings: Sequence[Recording]) -> None:
    """Refuse a law with a gap for recordings that have a force where it has none: a part that is held at both ends."""
    x0 = 1e-3 * fit.value("x0")
    loose = [r for r in recordings if np.any(r.deflection < x0)]
    if not loose:
        return
    squares = [r.force[r.deflection < x0] ** 2 for r in loose]
    noise = reading_noise(loose)
    left = float(np.sqrt(max(np.mean(np.concatenate(squares)) - (0.0 if np.isnan(noise) else noise**2), 0.0)))
    if left > IN_GAP * max(float(np.abs(r.force).max()) for r in recordings):
        first = loose[0]
        if float(first.deflection.max()) <= x0 and float(first.force.max()) > -float(first.force.min()):
            low, high = (1e3 * float(end) for end in (first.deflection.min(), first.deflection.max()))
            raise TirelabError(
                f"the deflection of {first.name} is {plain(low, 3)} to {plain(high, 3)} mm, where the law "
                f"{fit.name} has no force; give what the gauge reads where the part begins to be loaded, as the "
                "file counts: tirelab inspect --part FILE --zero deflection=..."
            )
        raise TirelabError(
            f"the law {fit.name} has no force below {plain(1e3 * x0, 3)} mm, and the recordings have "
            f"{plain(left, 3)} N there beyond the noise (root mean square); choose one of {', '.join(TWO_SIDED)} "
            "for a part that pulls too"
        )


def _described(tire: TireModel, recordings: Sequence[Recording], name: str) -> TireModel:
    """Return the tire with its name, its source and the range of the recordings.

    A part holds no air unless its pressure was recorded.
    """
    recorded = ", ".join(dict.fromkeys(r.name for r in recordings))
    flat = 1.0 / FLAT_RADIUS
    curvature = 1.0 / float(recordings[0].surface_radius[0])
    return replace(
        tire,
        tested_range=TestedRange(
            curvature_min=curvature - flat,
            curvature_max=curvature + flat,
            deflection_max=max(float(r.deflection.max()) for r in recordings),
            force_max=max(float(r.force.max()) for r in recordings),
        ),
        inflated=holds_air(recordings),
        name=name or f"part identified from {recorded}",
        source=f"identified by tirelab from the recordings {recorded}",
    )
