"""Every claim of Hull, Wang & Moore (1996) with a number, or about a limit, in the order of the text.

Reference: M. L. Hull, E. L. Wang, D. F. Moore, "An empirical model for determining the radial force-deflection
behavior of off-road bicycle tires", Cycling Science, Spring 1996.
"""

from __future__ import annotations

from dataclasses import dataclass

from . import checks
from . import press as rig
from .checks import CM_PER_INCH, NEWTON_PER_POUND, PASCAL_PER_PSI, Check, converted

POUND = "a pound-force is 4.448 N; the article reckons with 4.48"


@dataclass(frozen=True)
class Claim:
    """One claim.

    name: short; section: of the article; printed: the claim, in few words, with its number as printed
    check: what a law says of it, None where neither the law nor arithmetic can speak
    remark: the likely reason where it is not reproduced or not computable, or what a reader should know
    """

    name: str
    section: str
    printed: str
    check: Check | None
    remark: str = ""


CLAIMS = (
    Claim(
        "pressure",
        "Abstract, Methods",
        "34.7 kPa (50 psi)",
        converted("34.7", 50.0 * PASCAL_PER_PSI / 1e3, "kPa"),
        "misprint: the digit 4 of 344.7 was lost",
    ),
    Claim(
        "largest radius",
        "Methods",
        "58.4 cm (23 in.)",
        converted("58.4", 23.0 * CM_PER_INCH, "cm"),
    ),
    Claim("wheel", "Methods", "66 cm (26 in.)", converted("66", 26.0 * CM_PER_INCH, "cm")),
    Claim("tire width", "Methods", "4.953 cm (1.95 in.)", converted("4.953", 1.95 * CM_PER_INCH, "cm")),
    Claim(
        "least largest deflection", "Methods", "1.27 cm (0.5 in.)", converted("1.27", 0.5 * CM_PER_INCH, "cm")
    ),
    Claim(
        "largest deflection", "Methods", "3.175 cm (1.25 in.)", converted("3.175", 1.25 * CM_PER_INCH, "cm")
    ),
    Claim("tightest dip", "Discussion", "-38.1 cm (-15 in.)", converted("-38.1", -15.0 * CM_PER_INCH, "cm")),
    Claim(
        "rating", "Methods", "4480 N (1000 lbs)", converted("448e1", 1000.0 * NEWTON_PER_POUND, "N"), POUND
    ),
    Claim(
        "largest force",
        "Methods",
        "2240 N (500 lbs)",
        converted("224e1", 500.0 * NEWTON_PER_POUND, "N"),
        POUND,
    ),
    Claim(
        "hysteresis in pounds",
        "Discussion",
        "100 N (22.32 lbs)",
        converted("22.32", 100.0 / NEWTON_PER_POUND, "lbf"),
        POUND,
    ),
    Claim(
        "number of coefficients",
        "Abstract",
        "a power equation with six coefficients",
        checks.constants_convex,
        "six on either side of flat ground; ten in all, since the flat limits are shared",
    ),
    Claim(
        "number of surfaces",
        "Methods",
        "fourteen: 10 convex, a flat one, three concave",
        converted("14", float(len(rig.CONVEX_RADII) + 1 + len(rig.CONCAVE_RADII)), "surfaces"),
    ),
    Claim(
        "deflection kept small for the force",
        "Methods",
        "largest deflection down to 1.27 cm to keep the force below 2240 N",
        checks.least_deflection,
        "the force did not require it: the law stays below 2240 N to 2.4 cm and more on all fourteen surfaces",
    ),
    Claim(
        "deflection allowed by the force",
        "Methods",
        "largest deflection up to 3.175 cm with the force below 2240 N",
        checks.greatest_deflection,
    ),
    Claim(
        "rates",
        "Methods",
        "rate has no effect: none was found from 3.2 to 63.5 mm/s",
        checks.rate,
        "the rig was slower than any rate at which none was found, so that finding does not cover it",
    ),
    Claim(
        "flat law",
        "Results",
        "550.9 in 5a and 5b, 1.422 in 6a and 6b",
        checks.flat_limit,
    ),
    Claim(
        "decay E0",
        "Results",
        "A = 550.9 - 337.8 e(-2519 Rb)",
        checks.printed_decay,
        "misprint: with it no bump would be felt, against Figure 1; a decimal point was lost, as in 6a",
    ),
    Claim(
        "quality of the fits",
        "Results",
        "best for A, worst for B on concave surfaces",
        None,
        "needs the A and B of Table 1, which the text does not give",
    ),
    Claim(
        "error on convex surfaces",
        "Results",
        "193 N on the 25.4 cm bump at 2.53 cm, bounded by 13.5 %",
        checks.error_part(25.4, 2.53, 193.0, 13.5),
        "speaks for E0 = 0.02519 /cm: with 0.2519 /cm that force is half as large again",
    ),
    Claim(
        "error on concave surfaces",
        "Results",
        "116 N in the -50.8 cm dip at 1.9 cm, at most 4.2 %",
        checks.error_part(-50.8, 1.9, 116.0, 4.2),
        "the article contradicts itself: 116 N are 4.2 % of 2762 N, above the 2240 N never exceeded (the sentence "
        "also calls this dip convex)",
    ),
    Claim(
        "errors of all surfaces",
        "Abstract, Results",
        "at most 4.2 % concave, 13.5 % convex",
        None,
        "needs the measured forces, or Table 1",
    ),
    Claim(
        "loads on concave surfaces",
        "Results",
        "concave errors are smaller in percent because the loads are higher",
        checks.loads,
        "the loads account for part of the factor of 3.2 between 13.5 % and 4.2 % only",
    ),
    Claim(
        "contact patch",
        "Discussion",
        "no contact patch below a radius of 3.175 cm",
        None,
        "an observation; the law does not know the contact patch",
    ),
    Claim(
        "hysteresis",
        "Discussion",
        "100 N between loading and unloading, about 6.5 % of the force at worst",
        checks.hysteresis_peak,
        "possible: the peak it needs lies inside the tested range",
    ),
    Claim(
        "hysteresis averaged",
        "Discussion",
        "weighting both branches alike halves the error by hysteresis",
        checks.hysteresis_averaged,
        "computed from the rig's flat recording of the law with 100 N between the branches",
    ),
    Claim(
        "least of the largest stiffnesses",
        "Discussion",
        "2.3e4 N/m on the 1.27 cm bump, force over deflection at the largest deflection",
        checks.softest,
        "measured, so the law may differ by its 13.5 %; speaks for E0 = 0.02519 /cm",
    ),
    Claim(
        "greatest of the largest stiffnesses",
        "Discussion",
        "1.7e5 N/m in the -38.1 cm dip",
        checks.stiffest,
        "below 2240 N neither force over deflection nor the tangent comes near, nor does a 4.2 % error bridge it",
    ),
    Claim(
        "wheel in series",
        "Discussion",
        "a wheel of 2e6 N/m lowers it by up to 8.8 %",
        checks.series,
        "no rounding of 1.7e5 N/m gives 8.8 %; 1000 lbf/in, 1.751e5 N/m, of the tire's own stiffness would",
    ),
    Claim("force over bumps", "Discussion", "falls as a bump's radius falls", checks.convex_force),
    Claim("force in dips", "Discussion", "rises as a dip's radius nears the wheel's", checks.concave_force),
    Claim("exponent over bumps", "Discussion", "B falls as a bump's radius falls", checks.convex_exponent),
    Claim(
        "edge",
        "Discussion",
        "on a knife edge the force hardly varies with the deflection",
        checks.edge,
        "the law has B above 1 even on an edge; it is softer there, not insensitive",
    ),
    Claim(
        "dip of the wheel's radius",
        "Discussion",
        "the force approaches infinity, or at least some very large number",
        checks.wheel_limit,
        "the law's exponentials stay small at the wheel's radius: it has no such limit",
    ),
    Claim(
        "road tire",
        "Introduction",
        "150000 N/m at 688 kPa",
        None,
        "another tire, measured by Wang & Hull",
    ),
    Claim(
        "constant of Wang & Hull",
        "Discussion",
        "A = 718.5 in similar units",
        None,
        "their A in N/m^1.4, from which it was converted, is not given",
    ),
    Claim(
        "exponents",
        "Discussion",
        "relatively good agreement of the exponents, 1.4 and 1.422",
        checks.exponents,
    ),
    Claim(
        "shift by 1 mm",
        "Discussion",
        "the flat curve shifted by 1 mm is within about 5 % of Wang & Hull's",
        checks.shifted,
        "nearest is the refitted exponent, which the shift moves away from 1.4; A would need 1.6 mm for 5 %",
    ),
    Claim(
        "preload",
        "Discussion",
        "22 N of preload account for an offset of 1 mm",
        checks.preload,
        "with the deflection in cm; in metres, as in equation 1, 22 N would be 0.10 m",
    ),
)
