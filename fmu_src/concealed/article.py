"""The law of the article, transcribed for the rig alone."""

import math

#: Letters of equations 5 and 6, by the side of the flat surface; F in N, deflection and radius in cm.
FLAT_A, FLAT_B = 550.9, 1.422
CONVEX_A, CONVEX_A_DECAY = 337.8, 0.2519
CONVEX_B, CONVEX_B_DECAY = 0.2469, 0.1651
CONCAVE_A, CONCAVE_A_GROWTH = 7822.0, 0.1398
CONCAVE_B, CONCAVE_B_GROWTH = 0.2128, 0.0289

#: Radii of the article's half-rounds [m]: ten convex, the flat, three concave (inches made metric).
ARTICLE_SURFACES = (
    *(inch * 0.0254 for inch in (0.5, 0.75, 1.0, 2.0, 3.0, 5.0, 7.5, 10.0, 15.0, 23.0)),
    math.inf,
    *(inch * 0.0254 for inch in (-15.0, -20.0, -23.0)),
)


def coefficients(radius: float) -> tuple[float, float]:
    """Coefficients A and B of F = A x^B on a half-round.

    A = 550.9 - 337.8 exp(-0.2519 R), B = 1.422 - 0.2469 exp(-0.1651 R)   (convex, R > 0)
    A = 550.9 + 7822 exp(0.1398 R),   B = 1.422 + 0.2128 exp(0.0289 R)    (concave, R < 0)

    Parameters: radius R [m], convex > 0, concave < 0, flat = +-inf.
    Returns A [N/cm^B] and B [1], for a deflection in centimetres.
    Source: Hull, Wang & Moore, Cycling Science, Spring 1996, equations 5a to 6b.
    """
    if math.isinf(radius):
        return FLAT_A, FLAT_B
    cm = 100.0 * radius
    if cm > 0.0:
        return (
            FLAT_A - CONVEX_A * math.exp(-CONVEX_A_DECAY * cm),
            FLAT_B - CONVEX_B * math.exp(-CONVEX_B_DECAY * cm),
        )
    return (
        FLAT_A + CONCAVE_A * math.exp(CONCAVE_A_GROWTH * cm),
        FLAT_B + CONCAVE_B * math.exp(CONCAVE_B_GROWTH * cm),
    )
