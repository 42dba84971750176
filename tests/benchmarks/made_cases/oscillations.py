"""A tire on a shaker: sines of one or several frequencies."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np

from .case import Bench, Drawn, case
from .materials import FloatArray, believed, decaying, delayed, friction, law
from .motion import Motion, rough_ground, sine

THREE = (0.5, 2.0, 6.0)
"""Frequencies [Hz] a decade apart."""


def sines(
    bench: Bench,
    frequencies: Sequence[float],
    force: Callable[[Motion], FloatArray],
    *,
    amplitude: float = 0.006,
    cycles: int = 8,
    samples: int = 100,
) -> Drawn:
    """Sines about 12 mm, `samples` of each cycle, beside the tire's own law."""
    motions = {f"{f:g} Hz": sine(0.012, amplitude, f, cycles, 1.0 / (samples * f)) for f in frequencies}
    return Drawn([bench.record(name, m, force(m)) for name, m in motions.items()], believed())


@case("")
def nothing_on_a_shaker(bench: Bench) -> Drawn:
    """The tire as it is believed, at 2 Hz."""
    return sines(bench, (2.0,), lambda m: law(m.deflection), samples=125)


@case("rate_independent_hysteresis")
def constant_friction(bench: Bench) -> Drawn:
    """15 N at 1 Hz alone, whatever the deflection."""
    return sines(
        bench,
        (1.0,),
        lambda m: law(m.deflection) + 15.0 * friction(m.deflection, 3e-4),
        cycles=6,
        samples=200,
    )


@case("viscous_damping")
def linear_damping(bench: Bench) -> Drawn:
    """250 N s/m."""
    return sines(bench, THREE, lambda m: law(m.deflection) + 250.0 * m.rate)


@case("viscous_damping")
def damping_by_the_root_of_the_rate(bench: Bench) -> Drawn:
    """60 N at 1 m/s, half as much at a quarter of it."""
    return sines(bench, THREE, lambda m: law(m.deflection) + 60.0 * np.sign(m.rate) * np.sqrt(np.abs(m.rate)))


@case("viscous_damping")
def damping_at_a_kilohertz_of_samples(bench: Bench) -> Drawn:
    """250 N s/m at 3 Hz alone, 10000 samples."""
    return sines(bench, (3.0,), lambda m: law(m.deflection) + 250.0 * m.rate, cycles=30, samples=333)


@case("inertia")
def mass_at_one_frequency(bench: Bench) -> Drawn:
    """1.2 kg at 12 Hz, where the acceleration is a straight line of the deflection."""
    return sines(
        bench,
        (12.0,),
        lambda m: law(m.deflection) + 1.2 * m.acceleration,
        amplitude=0.005,
        cycles=30,
        samples=42,
    )


@case("inertia")
def mass_at_two_frequencies(bench: Bench) -> Drawn:
    """2 kg at 2 and 12 Hz."""
    return sines(
        bench,
        (2.0, 12.0),
        lambda m: law(m.deflection) + 2.0 * m.acceleration,
        amplitude=0.005,
        cycles=12,
        samples=50,
    )


@case("force_lag")
def slow_amplifier(bench: Bench) -> Drawn:
    """A low pass of 12 ms behind the load cell, 250 samples a second."""
    recordings = []
    for frequency in (0.5, 5.0):
        fine = sine(0.012, 0.006, frequency, 8, 0.0002)
        force = delayed(law(fine.deflection), fine.step, 0.012)[::20]
        recordings.append(bench.record(f"{frequency:g} Hz", fine.thinned(20), force))
    return Drawn(recordings, believed())


@case("force_lag")
def force_three_samples_late(bench: Bench) -> Drawn:
    """Two loggers: the force comes 12 ms behind the deflection."""
    recordings = []
    for frequency in (0.5, 5.0):
        motion = sine(0.012, 0.006, frequency, 8, 0.004)
        then = 0.012 - 0.006 * np.cos(2.0 * np.pi * frequency * (motion.time - 0.012))
        recordings.append(bench.record(f"{frequency:g} Hz", motion, law(then)))
    return Drawn(recordings, believed())


@case("viscoelastic_relaxation")
def stiffening_with_the_frequency(bench: Bench) -> Drawn:
    """Two time constants, 0.02 and 0.2 s, at 0.2, 2 and 10 Hz."""

    def force(motion: Motion) -> FloatArray:
        own = law(motion.deflection)
        return own + 0.06 * (decaying(own, motion.step, 0.02) + decaying(own, motion.step, 0.2))

    return sines(bench, (0.2, 2.0, 10.0), force, cycles=10)


@case("pressure_leak")
def cooling_tire(bench: Bench) -> Drawn:
    """6 % less force after the heat of the pump is gone, with 40 s: the part of the air that is lost."""
    return sines(
        bench,
        (2.0,),
        lambda m: law(m.deflection) * (0.94 + 0.06 * np.exp(-m.time / 40.0)),
        cycles=240,
        samples=25,
    )


@case("rate_independent_hysteresis + viscous_damping")
def friction_and_damping_on_rough_ground(bench: Bench) -> Drawn:
    """A loop of 12 % and 120 N s/m, 20 s of a ride."""
    motion = rough_ground(0.012, 0.004, 20.0, 0.005, bench.rng)
    x = motion.deflection
    force = law(x) * (1.0 + 0.06 * friction(x, 6e-4)) + 120.0 * motion.rate
    return Drawn([bench.record("ride", motion, force)], believed())
