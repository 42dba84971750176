"""Recordings of one tire that should agree: in one of them something else was pressed, or the gauge was moved."""

from __future__ import annotations

import numpy as np
from tirelab.recordings.recording import Recording

from .case import Bench, Drawn, case
from .materials import believed, friction, law
from .motion import triangle

A, B = 900.0, 1.35


def pressed(
    bench: Bench,
    name: str,
    *,
    coefficient: float = A,
    exponent: float = B,
    zero: float = 0.0,
    speed: float = 0.005,
    loop: float = 0.0,
) -> Recording:
    """Two cycles to 20 mm; zero [m]: what the gauge reads too much, loop: the friction as a part of the force."""
    motion = triangle(0.02, speed, 2, 0.02)
    x = motion.deflection - zero
    force = law(x, coefficient, exponent)
    if loop:
        force = force * (1.0 + loop * friction(np.maximum(x, 0.0), 6e-4))
    return bench.record(name, motion, force, noise=2.0, reading=2e-6)


def with_one_more(bench: Bench, other: Recording, loop: float = 0.0) -> Drawn:
    """The first recording, another one, and a faster one like the first."""
    first, fast = pressed(bench, "first", loop=loop), pressed(bench, "fast", speed=0.02, loop=loop)
    return Drawn([first, other, fast], believed(A, B))


@case("rate_independent_hysteresis")
def three_that_agree(bench: Bench) -> Drawn:
    """A loop of 10 % in all three."""
    return with_one_more(bench, pressed(bench, "second", loop=0.05), 0.05)


@case(odd="second")
def zero_moved_in_one_of_two(bench: Bench) -> Drawn:
    """The gauge reads 1 mm too much in one."""
    return Drawn([pressed(bench, "first"), pressed(bench, "second", zero=1e-3)], believed(A, B))


@case(odd="second")
def zero_moved_in_one_of_three(bench: Bench) -> Drawn:
    """The same beside two that agree."""
    return with_one_more(bench, pressed(bench, "second", zero=1e-3))


@case(odd="second")
def zero_moved_in_one_of_three_beside_friction(bench: Bench) -> Drawn:
    """The same, and a loop of 10 % in all."""
    return with_one_more(bench, pressed(bench, "second", zero=1e-3, loop=0.05), 0.05)


@case(odd="second")
def another_pressure_in_one_of_two(bench: Bench) -> Drawn:
    """10 % more force in one."""
    return Drawn([pressed(bench, "first"), pressed(bench, "second", coefficient=1.1 * A)], believed(A, B))


@case(odd="second")
def another_pressure_in_one_of_three(bench: Bench) -> Drawn:
    """The same beside two that agree."""
    return with_one_more(bench, pressed(bench, "second", coefficient=1.1 * A))


@case(odd="second")
def another_pressure_in_one_of_three_beside_friction(bench: Bench) -> Drawn:
    """The same, and a loop of 10 % in all."""
    return with_one_more(bench, pressed(bench, "second", coefficient=1.1 * A, loop=0.05), 0.05)


@case(odd="second")
def another_tire_in_one_of_three(bench: Bench) -> Drawn:
    """An exponent of 1.45 in place of 1.35."""
    return with_one_more(bench, pressed(bench, "second", exponent=B + 0.1))
