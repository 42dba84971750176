"""What the instruments and the rig add: hum, steps of a coarse scale, play in the load path.

Hum is no physics of the tire: nothing is right, and so is something unknown.
A play between gauge and tire makes a loop that runs backwards and is as wide at every speed. No effect of the catalogue
does that (friction runs forwards, a lag is wider at a higher speed), so something unknown is right.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from .case import Bench, Drawn, case
from .materials import believed, friction, law, played
from .motion import triangle
from .presses import PRESS, one


@case("", "unknown")
def hum_of_the_mains(bench: Bench) -> Drawn:
    """6 N at 50.3 Hz, 200 samples a second."""
    motion = triangle(0.02, 0.004, 2, 0.005)
    return one(bench, motion, law(motion.deflection) + 6.0 * np.sin(2.0 * np.pi * 50.3 * motion.time))


@case("unknown")
def slow_hum(bench: Bench) -> Drawn:
    """6 N at 0.7 Hz beside a triangle of 0.1 Hz."""
    return one(bench, PRESS, law(PRESS.deflection) + 6.0 * np.sin(2.0 * np.pi * 0.7 * PRESS.time))


@case("rate_independent_hysteresis")
def steps_of_the_gauge(bench: Bench) -> Drawn:
    """A loop of 12 %, and a gauge that shows tenths of a millimetre."""
    x = PRESS.deflection
    stepped = replace(PRESS, deflection=1e-4 * np.round(x / 1e-4))
    force = law(x) * (1.0 + 0.06 * friction(x, 6e-4))
    return Drawn([bench.record("press", stepped, force, reading=0.0)], believed())


@case("rate_independent_hysteresis")
def steps_of_the_load_cell(bench: Bench) -> Drawn:
    """A loop of 12 %, and a display in steps of 5 N, without any other noise."""
    x = PRESS.deflection
    shown = 5.0 * np.round(law(x) * (1.0 + 0.06 * friction(x, 6e-4)) / 5.0)
    return Drawn([bench.record("press", PRESS, shown, noise=0.0, reading=0.0)], believed())


@case("unknown")
def play_in_the_fixture(bench: Bench) -> Drawn:
    """0.6 mm between the gauge and the tire."""
    motion = triangle(0.02, 0.004, 3, 0.02)
    return one(bench, motion, law(played(motion.deflection, 3e-4)))


@case("unknown")
def play_in_the_fixture_at_two_speeds(bench: Bench) -> Drawn:
    """The same at 3 and 30 mm/s."""
    motions = {"slow": triangle(0.02, 0.003, 3, 0.02), "fast": triangle(0.02, 0.03, 3, 0.002)}
    return Drawn(
        [bench.record(name, m, law(played(m.deflection, 3e-4))) for name, m in motions.items()], believed()
    )
