"""Dampers, bushings and springs, which work both ways, beside the straight line of their spring."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np

from .case import Bench, Drawn, case
from .materials import FloatArray, decaying, friction, spring
from .motion import Motion, sine


def driven(
    bench: Bench,
    stiffness: float,
    drives: Sequence[tuple[float, float]],
    force: Callable[[Motion], FloatArray],
    cycles: int = 8,
) -> Drawn:
    """Sines about 0, each of an amplitude [m] and a frequency [Hz]; force [N] beside that of the spring."""
    recordings = []
    for amplitude, frequency in drives:
        motion = sine(0.0, amplitude, frequency, cycles, 0.01 / frequency)
        recordings.append(
            bench.record(
                f"{1e3 * amplitude:g} mm at {frequency:g} Hz",
                motion,
                stiffness * motion.deflection + force(motion),
            )
        )
    return Drawn(recordings, spring(stiffness))


def alike(amplitude: float, *frequencies: float) -> list[tuple[float, float]]:
    """One amplitude [m] at several frequencies [Hz]."""
    return [(amplitude, frequency) for frequency in frequencies]


@case("viscous_damping")
def linear_damper(bench: Bench) -> Drawn:
    """800 N s/m beside 2 N/mm."""
    return driven(bench, 2e3, alike(0.02, 0.5, 2.0, 6.0), lambda m: 800.0 * m.rate)


@case("viscous_damping")
def damper_of_a_vehicle(bench: Bench) -> Drawn:
    """Digressive above 0.15 m/s, and 2.2 times as stiff one way as the other."""

    def force(motion: Motion) -> FloatArray:
        v = motion.rate
        return np.where(v > 0.0, 1.0, 2.2) * (600.0 * v / np.sqrt(1.0 + (v / 0.15) ** 2) + 200.0 * v)

    return driven(bench, 2e3, alike(0.02, 0.5, 2.0, 6.0), force)


@case("viscous_damping", "rate_independent_hysteresis + viscous_damping")
def magnetorheological_damper(bench: Bench) -> Drawn:
    """650 N s/m and 45 N that turn over within 6 mm/s: a dashpot that thins, or one beside friction."""
    return driven(
        bench,
        1500.0,
        alike(0.012, 0.5, 1.0, 3.0),
        lambda m: 650.0 * m.rate + 45.0 * np.tanh((m.rate + 0.4 * m.deflection) / 0.006),
    )


@case("rate_independent_hysteresis + viscoelastic_relaxation")
def bushing_at_three_frequencies(bench: Bench) -> Drawn:
    """A loop of 40 N, and 15 % of the force that decays with 0.1 s."""
    return driven(
        bench,
        2e5,
        alike(0.004, 0.1, 1.0, 5.0),
        lambda m: 0.15 * decaying(2e5 * m.deflection, m.step, 0.1) + 40.0 * friction(m.deflection, 3e-4),
    )


@case("rate_independent_hysteresis")
def bushing_at_three_amplitudes(bench: Bench) -> Drawn:
    """A loop of 60 N that turns over in 0.3 mm, driven by 0.5, 2 and 6 mm."""
    return driven(
        bench, 2e5, [(a, 1.0) for a in (5e-4, 2e-3, 6e-3)], lambda m: 60.0 * friction(m.deflection, 3e-4), 6
    )


@case("recalibration")
def cubic_spring(bench: Bench) -> Drawn:
    """40 % more than the straight line at 20 mm."""
    return driven(bench, 2e3, alike(0.02, 0.5), lambda m: 2e6 * m.deflection**3, 6)


@case("recalibration + rate_independent_hysteresis", "force_offset + rate_independent_hysteresis")
def preloaded_spring_with_friction(bench: Bench) -> Drawn:
    """35 N at no deflection, and a loop of 12 N: a part of the spring's law, or a load cell that is off."""
    return driven(bench, 2e3, alike(0.02, 0.5), lambda m: 35.0 + 12.0 * friction(m.deflection, 5e-4), 6)
