"""What the law and plain arithmetic give for the claims of Hull, Wang & Moore (1996), each beside what was printed.

A number is reproduced if what the law gives rounds to the digits printed. Two kinds of claim allow more, each with its
reason: what was measured may differ from the law by the errors that the article states for it (13.5 % on convex, 4.2 %
on concave surfaces), and a percentage of a force may be taken of the law's force or of the measured one.

Reference: M. L. Hull, E. L. Wang, D. F. Moore, "An empirical model for determining the radial force-deflection
behavior of off-road bicycle tires", Cycling Science, Spring 1996.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from itertools import pairwise

import numpy as np
from radialtire import CATALOGUE, Hull1996, PowerLaw, TireModel, power_law

from ..identification.identify import identify
from ..recordings.recording import Recording
from . import press as rig

NEWTON_PER_POUND = 4.4482216152605
"""1 lbf [N], exact by definition."""

PASCAL_PER_PSI = 6894.757293168
"""1 psi [Pa]."""

CM_PER_INCH = 2.54

CONVEX_ERROR = 0.135
"""Largest relative error of the law on convex surfaces, as stated."""

WHEEL_STIFFNESS = 2e6
"""Stiffness of the wheel [N/m] (Hopkins & Principe 1990, quoted in the article)."""

EDGE = 1e-9
"""Radius [m] of a knife's edge."""

WANG_HULL = PowerLaw(718.5, 1.4)
"""Wang & Hull's tires, as quoted in the article."""


@dataclass(frozen=True)
class Finding:
    """What a law says of a claim: the number, the sentence around it, and whether it agrees with the print."""

    value: float
    text: str
    agrees: bool


Check = Callable[[Hull1996], Finding]
"""What a claim is checked by: it gets the law and says what that gives."""


def force(law: Hull1996 | PowerLaw, radius: float, deflection: float) -> float:
    """Return the force [N] on a surface of `radius` [cm] at `deflection` [cm]."""
    return power_law.force(deflection / 100.0, *law.coefficients(radius / 100.0))


def deflection_at(law: Hull1996 | PowerLaw, radius: float, load: float) -> float:
    """Return the deflection [cm] at which the force on a surface of `radius` [cm] is `load` [N]."""
    A, B = law.coefficients(radius / 100.0)
    return float((load / A) ** (1.0 / B))


def rounds_to(value: float, printed: str, unit: str) -> Finding:
    """Return whether `value` rounds to the digits of `printed`."""
    mantissa, _, exponent = printed.partition("e")
    places = len(mantissa.partition(".")[2])
    half = 0.5 * 10.0 ** (int(exponent or 0) - places)
    agrees = abs(value - float(printed)) <= half * (1.0 + 1e-9)
    return Finding(value, f"{value:.{places}f} {unit}".strip(), agrees)


def converted(printed: str, value: float, unit: str) -> Check:
    """Return the check of a conversion, the same for every law."""
    return lambda law: rounds_to(value, printed, unit)


def constants_convex(law: Hull1996) -> Finding:
    """Return how many constants the force on convex ground depends on."""
    base = law.coefficients(0.02)
    count = 0
    for p in law.parameters:
        values = {q.name: getattr(law, q.name) * (1.01 if q is p else 1.0) for q in law.parameters}
        count += Hull1996(**values).coefficients(0.02) != base
    return Finding(count, f"{count} constants act on convex ground", count == 6)


def flat_limit(law: Hull1996) -> Finding:
    """Return A and B on flat ground, reached from both sides."""
    convex, concave = law.coefficients(1e4), law.coefficients(-1e4)
    same = max(abs(a - b) for a, b in zip(convex, concave, strict=True)) < 1e-9
    agrees = same and round(convex[0], 1) == 550.9 and round(convex[1], 3) == 1.422
    return Finding(convex[0], f"A = {convex[0]:.1f} N/cm^B, B = {convex[1]:.3f} from both sides", agrees)


def printed_decay(law: Hull1996) -> Finding:
    """Return A on the sharpest bump with E0 = 2519 /cm, as printed in 5a."""
    A = law.flat_coefficient - law.convex_coefficient_drop * math.exp(-2519.0 * 1.27)
    return Finding(A, f"A = {A:.1f} on the sharpest bump, as on flat ground", law.flat_coefficient > A)


def grows(what: str, values: list[float]) -> Finding:
    """Return whether `values` rise throughout."""
    rising = all(b > a for a, b in pairwise(values))
    return Finding(values[-1] / values[0], f"{what}: from {values[0]:.4g} to {values[-1]:.4g}", rising)


def convex_force(law: Hull1996) -> Finding:
    """Return whether the force at 2 cm rises with the radius of a bump, over the rig's bumps."""
    return grows("F at 2 cm over the bumps [N]", [force(law, 100.0 * r, 2.0) for r in rig.CONVEX_RADII])


def concave_force(law: Hull1996) -> Finding:
    """Return whether the force at 2 cm rises as a dip comes nearer to the wheel's radius of 33 cm."""
    radii = (*sorted(100.0 * r for r in rig.CONCAVE_RADII), -33.0)
    return grows("F at 2 cm to -33 cm [N]", [force(law, r, 2.0) for r in radii])


def convex_exponent(law: Hull1996) -> Finding:
    """Return whether B rises with the radius of a bump."""
    return grows("B over the bumps", [law.coefficients(r)[1] for r in rig.CONVEX_RADII])


def edge(law: Hull1996) -> Finding:
    """Return by how much the force on a knife's edge grows when the deflection doubles."""
    A, B = law.coefficients(EDGE)
    growth = 2.0**B
    return Finding(
        growth, f"A = {A:.1f}, B = {B:.3f}: twice the deflection, {growth:.2f} times the force", growth < 1.5
    )


def wheel_limit(law: Hull1996) -> Finding:
    """Return the force in a dip of the wheel's own radius, against flat ground, at 2.54 cm."""
    ratio = force(law, -33.0, 2.54) / force(law, math.inf, 2.54)
    return Finding(ratio, f"at -33 cm {ratio:.2f} times flat ground, at 2.54 cm", ratio > 10.0)


def least_deflection(law: Hull1996) -> Finding:
    """Return the least deflection at which the law reaches 2240 N on any of the surfaces."""
    least = min(deflection_at(law, 100.0 * r, 2240.0) for r in rig.SURFACES)
    return Finding(
        least, f"2240 N at {least:.2f} cm or more on every surface", least < 1.27 + CM_PER_INCH / 8.0
    )


def greatest_deflection(law: Hull1996) -> Finding:
    """Return the force at 3.175 cm on the sharpest bump."""
    load = force(law, 1.27, 3.175)
    return Finding(load, f"{load:.0f} N at 3.175 cm on the sharpest bump", load < 2240.0)


def rate(law: Hull1996) -> Finding:
    """Return the rig's own speeds."""
    slow, fast = (10.0 * 2.0 * x / rig.PERIOD for x in (1.27, 3.175))
    return Finding(fast, f"the rig's own rates: {slow:.2f} to {fast:.2f} mm/s", slow >= 3.2)


def error_part(radius: float, deflection: float, error: float, printed: float) -> Check:
    """Return the check of an error as a percentage of the force, the law's or the measured one, of either sign."""

    def compute(law: Hull1996) -> Finding:
        load = force(law, radius, deflection)
        part, least, most = (100.0 * error / f for f in (load, load + error, load - error))
        text = f"{part:.1f} % of the law's {load:.0f} N ({least:.1f} to {most:.1f} % of the measured force)"
        return Finding(part, text, least - 0.05 <= printed <= most + 0.05)

    return compute


def loads(law: Hull1996) -> Finding:
    """Return the force in the dip of the largest error against that on the bump, at the same deflection."""
    ratio = force(law, -50.8, 1.9) / force(law, 25.4, 1.9)
    return Finding(ratio, f"{ratio:.2f} times the force on the 25.4 cm bump, at 1.9 cm", ratio > 1.0)


def hysteresis_peak(law: Hull1996) -> Finding:
    """Return where on flat ground 100 N is 6.5 % of the force, and whether the rig goes there."""
    peak = 100.0 / 0.065
    at = deflection_at(law, math.inf, peak)
    return Finding(
        peak, f"a peak of {peak:.0f} N, on flat ground at {at:.2f} cm", 1.27 <= at <= 3.175 and peak < 2240.0
    )


def hysteresis_averaged(law: Hull1996) -> Finding:
    """Return the worst branch's RMSE of a fit to loading alone against that of a fit to both branches."""
    friction = CATALOGUE["rate_independent_hysteresis"]
    values = {"slip_force": 50.0, "reach": 1e-4}
    tire = TireModel(
        law=law, effects=((friction, tuple(values.get(p.name, p.start) for p in friction.parameters)),)
    )
    recorded = rig.record(tire, math.inf)
    top = int(recorded.deflection.argmax())
    worst = []
    for part in (slice(0, top + 1), slice(None)):
        A, B = identify([_part(recorded, part)]).tire.law.coefficients(math.inf)
        error = recorded.force - A * (100.0 * recorded.deflection) ** B
        worst.append(max(float(np.sqrt(np.mean(e**2))) for e in (error[: top + 1], error[top:])))
    ratio = worst[0] / worst[1]
    return Finding(
        ratio, f"{worst[0]:.0f} N fitted to loading alone, {worst[1]:.0f} N to both", 1.5 <= ratio <= 2.5
    )


def _part(recorded: Recording, part: slice) -> Recording:
    return Recording(
        recorded.name,
        recorded.time[part],
        recorded.deflection[part],
        recorded.surface_radius[part],
        recorded.force[part],
    )


def _powers(value: float) -> str:
    return f"{value:.2e}".replace("e+0", "e")


def softest(law: Hull1996) -> Finding:
    """Return force over deflection on the 1.27 cm bump, from the least to the greatest of the largest deflections."""
    low, high = (100.0 * force(law, 1.27, x) / x for x in (1.27, 3.175))
    agrees = low * (1.0 - CONVEX_ERROR) <= 2.35e4 and high * (1.0 + CONVEX_ERROR) >= 2.25e4
    return Finding(low, f"{_powers(low)} N/m at 1.27 cm to {_powers(high)} N/m at 3.175 cm", agrees)


def stiffest(law: Hull1996) -> Finding:
    """Return force over deflection, and the tangent, where the law reaches 2240 N in the -38.1 cm dip."""
    at = deflection_at(law, -38.1, 2240.0)
    secant = 100.0 * 2240.0 / at
    tangent = secant * law.coefficients(-0.381)[1]
    return Finding(
        secant, f"{_powers(secant)} N/m at 2240 N, tangent {_powers(tangent)} N/m", tangent >= 1.65e5
    )


def series(law: Hull1996) -> Finding:
    """Return by how much the wheel in series lowers a stiffness of 1.7e5 N/m."""
    of_tire, of_both = (100.0 * 1.7e5 / k for k in (WHEEL_STIFFNESS, WHEEL_STIFFNESS - 1.7e5))
    agrees = any(abs(part - 8.8) <= 0.05 for part in (of_tire, of_both))
    return Finding(
        of_tire, f"{of_tire:.1f} % of the tire's own stiffness, {of_both:.1f} % of the measured", agrees
    )


def shifted(law: Hull1996) -> Finding:
    """Return the flat law shifted by 1 mm against Wang & Hull's, as forces and as refitted constants."""
    recorded = rig.record(TireModel(law=law), math.inf)
    later = int(np.searchsorted(recorded.deflection[: recorded.deflection.argmax()], 1e-3, side="right"))
    kept = _part(recorded, slice(later, recorded.time.size - later))
    moved = replace(kept, deflection=kept.deflection - 1e-3)
    A, B = identify([moved]).tire.law.coefficients(math.inf)
    ratios = [force(law, math.inf, x + 0.1) / force(WANG_HULL, math.inf, x) - 1.0 for x in (1.0, 2.4)]
    text = (
        f"force {100.0 * ratios[0]:.0f} % at 1 cm, {100.0 * ratios[1]:.0f} % at 2.4 cm; refitted A = {A:.0f} "
        f"({100.0 * (A / 718.5 - 1.0):.1f} %), B = {B:.3f} ({100.0 * (B / 1.4 - 1.0):.1f} %)"
    )
    return Finding(100.0 * ratios[0], text, all(0.045 <= abs(ratio) <= 0.055 for ratio in ratios))


def exponents(law: Hull1996) -> Finding:
    """Return the exponent on flat ground beside Wang & Hull's 1.4."""
    return rounds_to(law.flat_exponent, "1.4", "")


def preload(law: Hull1996) -> Finding:
    """Return the deflection on flat ground at 22 N."""
    at = 10.0 * deflection_at(law, math.inf, 22.0)
    by_theirs = 10.0 * deflection_at(WANG_HULL, math.inf, 22.0)
    return Finding(at, f"{at:.2f} mm ({by_theirs:.2f} mm by Wang & Hull's law)", 0.5 <= at < 1.5)
