"""A tire on a press: slow triangles, with and without a hold."""

from __future__ import annotations

import numpy as np
from radialtire import TireModel

from .case import Bench, Drawn, case
from .materials import FloatArray, believed, decaying, friction, law
from .motion import Motion, ramp, triangle

PRESS = triangle(0.02, 0.004, 2, 0.02)
HELD = triangle(0.018, 0.02, 2, 0.02, hold=20.0)


def one(bench: Bench, motion: Motion, force: FloatArray) -> Drawn:
    """One recording beside the tire's own law."""
    return Drawn([bench.record("press", motion, force)], believed())


@case("")
def nothing_on_a_press(bench: Bench) -> Drawn:
    """The tire as it is believed."""
    return one(bench, PRESS, law(PRESS.deflection))


@case("rate_independent_hysteresis")
def friction_on_a_press(bench: Bench) -> Drawn:
    """A loop of 12 % of the force."""
    x = PRESS.deflection
    return one(bench, PRESS, law(x) * (1.0 + 0.06 * friction(x, 6e-4)))


@case("rate_independent_hysteresis")
def friction_at_two_speeds(bench: Bench) -> Drawn:
    """The same loop at 3 and 30 mm/s."""
    motions = {"slow": triangle(0.02, 0.003, 2, 0.02), "fast": triangle(0.02, 0.03, 2, 0.002)}
    return Drawn(
        [
            bench.record(name, m, law(m.deflection) * (1.0 + 0.06 * friction(m.deflection, 6e-4)))
            for name, m in motions.items()
        ],
        believed(),
    )


@case("viscoelastic_relaxation")
def relaxation_in_holds(bench: Bench) -> Drawn:
    """One time constant of 4 s, two holds of 20 s; the ground does not pull."""
    force = law(HELD.deflection)
    return one(bench, HELD, np.maximum(force + 0.08 * decaying(force, HELD.step, 4.0), 0.0))


@case("viscoelastic_relaxation")
def relaxation_over_decades(bench: Bench) -> Drawn:
    """Four time constants from 0.3 to 70 s, one hold of 100 s."""
    motion = triangle(0.018, 0.02, 1, 0.05, hold=100.0)
    force = law(motion.deflection)
    more = sum(decaying(force, motion.step, tau) for tau in (0.3, 2.0, 12.0, 70.0))
    return one(bench, motion, np.maximum(force + 0.03 * more, 0.0))


@case("deflection_offset")
def zero_of_the_gauge(bench: Bench) -> Drawn:
    """The gauge reads 0.6 mm too much."""
    return one(bench, PRESS, law(PRESS.deflection - 6e-4))


@case("force_offset")
def zero_of_the_load_cell(bench: Bench) -> Drawn:
    """The load cell reads 14 N too much, in the air too."""
    return one(bench, PRESS, law(PRESS.deflection) + 14.0)


@case("series_compliance")
def soft_frame_on_two_surfaces(bench: Bench) -> Drawn:
    """A frame of 250 N/mm in series with the article's tire, on the flat and on 10 cm."""
    recordings = []
    for radius in (np.inf, 0.1):
        a, b = TireModel().law.coefficients(radius)
        at = np.linspace(0.0, law(PRESS.deflection, a, b).max(), 4000)
        force = np.interp(PRESS.deflection, (at / a) ** (1.0 / b) / 100.0 + 4e-6 * at, at)
        recordings.append(bench.record(f"radius {radius:g}", PRESS, force, noise=2.0, radius=radius))
    return Drawn(recordings, TireModel(tested_range=None))


@case("saturation")
def ceiling_of_the_amplifier(bench: Bench) -> Drawn:
    """No reading above 860 N."""
    return one(bench, PRESS, np.minimum(law(PRESS.deflection), 860.0))


@case("force_drift")
def drifting_load_cell(bench: Bench) -> Drawn:
    """0.7 N/s, in the air too."""
    motion = triangle(0.02, 0.008, 8, 0.02)
    return one(bench, motion, law(motion.deflection) + 0.7 * motion.time)


@case("pressure_leak")
def leaking_tire(bench: Bench) -> Drawn:
    """The force falls by 1 part in 400 each second."""
    motion = triangle(0.02, 0.008, 12, 0.02)
    return one(bench, motion, law(motion.deflection) * np.exp(-motion.time / 400.0))


@case("mullins_softening")
def softening_at_the_first_press(bench: Bench) -> Drawn:
    """Up to 10 % less force where it was pressed further before."""
    motion = triangle(0.02, 0.008, 5, 0.02)
    x = motion.deflection
    reached = np.maximum(np.maximum.accumulate(x), 1e-9)
    return one(bench, motion, law(x) * (1.0 - 0.1 * (1.0 - x / reached)))


@case("bottoming")
def rim_at_16_mm(bench: Bench) -> Drawn:
    """300 N/mm more from 16 mm on."""
    x = PRESS.deflection
    return one(bench, PRESS, law(x) + 3e5 * np.maximum(x - 0.016, 0.0))


@case("recalibration")
def another_straight_law(bench: Bench) -> Drawn:
    """55 N/mm."""
    return one(bench, PRESS, 55e3 * PRESS.deflection)


@case("recalibration")
def another_curved_law(bench: Bench) -> Drawn:
    """A polynomial of the second degree, which no power law is."""
    x = PRESS.deflection
    return one(bench, PRESS, 30e3 * x + 1.1e6 * x**2)


@case("recalibration")
def another_law_on_the_way_in(bench: Bench) -> Drawn:
    """8 % more force, and no way back."""
    motion = ramp(0.02, 0.004, 0.02)
    return one(bench, motion, 1.08 * law(motion.deflection))


@case("recalibration")
def another_law_on_one_of_three_surfaces(bench: Bench) -> Drawn:
    """12 % more force on 10 cm, none on the flat and in a hollow of 20 cm."""
    recordings = []
    for radius in (np.inf, 0.1, -0.2):
        a, b = TireModel().law.coefficients(radius)
        force = law(PRESS.deflection, 1.12 * a if radius == 0.1 else a, b)
        recordings.append(bench.record(f"radius {radius:g}", PRESS, force, noise=3.0, radius=radius))
    return Drawn(recordings, TireModel(tested_range=None))


@case("inflation_pressure")
def three_pressures(bench: Bench) -> Drawn:
    """The air carries 80 % of the force, and a channel tells the pressure."""
    motion, held_at = triangle(0.02, 0.004, 2, 0.02), 3.447e5
    return Drawn(
        [
            bench.record(f"{p:g} Pa", motion, law(motion.deflection) * (0.2 + 0.8 * p / held_at), pressure=p)
            for p in (2.5e5, held_at, 4.2e5)
        ],
        believed(),
    )
