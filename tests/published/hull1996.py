"""Figures printed in M. L. Hull, E. L. Wang, D. F. Moore, Cycling Science, Spring 1996, each with where it stands.

SI units, except for what is fitted to x in cm.
"""

FLAT_COEFFICIENT = 550.9
"""A on flat ground [N/cm^B]: the constant of equations 5a and 5b."""

FLAT_EXPONENT = 1.422
"""B on flat ground: the constant of equations 6a and 6b."""

CONVEX_DROP = (337.8, 0.2469)
"""What A and B lose on the sharpest edge: 5a and 6a."""

CONCAVE_RISE = (7822.0, 0.2128)
"""What A and B gain extrapolated to a radius of zero: 5b and 6b."""

CONVEX_DECAY = (0.2519, 0.1651)
"""Digits of the decays of A and B on convex ground [1/cm]: 5a ("-2519") and 6a ("-01651")."""

CONCAVE_DECAY = (0.1398, 0.0289)
"""Decays of A and B on concave ground [1/cm]: 5b ("0.l398") and 6b."""

OFFSET = 1e-3
"""Offset [m] by which the flat surface's curve would meet that of Wang and Hull: Discussion."""

PRELOAD = 22.0
"""Preload [N] "enough to account for the offset": Discussion."""

SMALLEST_RADIUS = 0.0127
"""Radius [m] of the sharpest bump: Discussion."""

LARGEST_RADIUS = 0.584
"""Radius [m] of the bluntest convex and the shallowest concave surface: Abstract."""

SHARPEST_STIFFNESS = 2.3e4
"""Force over deflection at maximum deflection [N/m] on the sharpest bump: Discussion."""

LEAST_DEFLECTION, GREATEST_DEFLECTION = 0.0127, 0.03175
"""Range of the maximum deflection [m]: Methods."""

GREATEST_FORCE = 2240.0
"""Force [N] below which the tests were kept: Methods."""

GREATEST_CONVEX_ERROR = (0.254, 0.0253, 193.0, 0.135)
"""Radius [m], deflection [m], error [N] of the worst convex case and the bound of its share: Results, Abstract."""

GREATEST_CONCAVE_ERROR = (-0.508, 0.019, 116.0, 0.042)
"""Radius [m], deflection [m], error [N] of the worst concave case and the bound of its share: Results, Abstract."""

WHEEL_STIFFNESS = 2e6
"""Of a 3-cross, 32-spoke wheel [N/m], quoted from Hopkins and Principle: Discussion."""

GREATEST_STIFFNESS = 1.7e5
"""Largest stiffness of wheel and tire [N/m], on a radius of -38.1 cm: Discussion."""

GREATEST_UNDERESTIMATE = 0.088
"""Share by which the wheel makes the tire seem softer, at most: Discussion."""

HYSTERESIS = (100.0, 0.065)
"""Loading above unloading [N], and its share of the peak, worst case: Discussion."""

OTHER_TIRE = (718.5, 1.4)
"""A [N/cm^B] and B of Wang and Hull's tire: Discussion."""
