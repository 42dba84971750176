"""Rate and acceleration from readings: exact without noise, as good as noise allows, and their noise floor."""

import numpy as np
import pytest
from concealed.bench import Bench
from concealed.effects.damping import LinearDashpot
from concealed.effects.machine import MovingMass
from concealed.measurement import Instrument
from concealed.motion import Motion
from concealed.reading import derivatives, estimated, nearest
from concealed.tires import PowerTire, Surface
from concealed.trial import recorded


def sine(frequency: float, stride: int = 4) -> Motion:
    """Some 4 mm of a sine at 200 readings a second."""
    time = np.arange(0.0, 20.0, 0.005 / stride)
    deflection = 0.012 + 0.004 * np.sin(2.0 * np.pi * frequency * time)
    return Motion("sine", time, deflection, np.full_like(time, np.inf), stride)


@pytest.mark.parametrize(("order", "expected"), [(1, [0.3, -0.8, 3.6]), (2, [-0.8, 7.2])])
def test_polynomials_of_its_degree_differentiate_a_cubic_exactly(order: int, expected: list[float]) -> None:
    time = np.arange(0.0, 1.0, 0.01)
    shown = 0.01 + 0.3 * time - 0.4 * time**2 + 1.2 * time**3
    true = np.polynomial.Polynomial(expected)(time)
    best = min(float(np.max(np.abs(s - true)[60:])) for s in derivatives(shown, 0.01, order))
    assert best < 1e-9


def test_the_slope_of_a_line_passes_the_noise_that_it_must() -> None:
    # slope of m readings of spacing d: variance 12 s^2 / (d^2 m (m^2 - 1)); 50 000 readings give a percent
    noise = 1e-5 * np.random.default_rng(0).standard_normal(50_000)
    slopes = next(s for i, s in enumerate(derivatives(noise, 0.01, 1)) if i == 5)
    m = 7
    expected = 1e-5 / 0.01 * np.sqrt(12.0 / (m * (m**2 - 1.0)))
    assert float(np.std(slopes)) == pytest.approx(expected, rel=0.03)


def test_the_nearest_is_the_one_with_the_least_error() -> None:
    true = np.array([1.0, 2.0])
    assert nearest([np.array([1.0, 3.0]), np.array([1.1, 2.1]), np.array([9.0, 2.0])], true).tolist() == [
        1.1,
        2.1,
    ]


def test_without_noise_a_slow_motion_is_estimated_closely() -> None:
    motion = sine(0.5)
    found = estimated(motion, motion.recorded(motion.deflection))
    for true, estimate in ((motion.rate, found.rate), (motion.acceleration, found.acceleration)):
        assert np.std((estimate - true)[400:]) < 1e-3 * np.std(true)
    np.testing.assert_array_equal(found.deflection, motion.deflection)


def noise_floors(
    effect: MovingMass | LinearDashpot | None, gauge: float, frequency: float = 0.5
) -> tuple[float, float]:
    bench = Bench(PowerTire((Surface(np.inf, 600.0, 1.4),)), () if effect is None else (effect,))
    instrument = Instrument(white=5.0, gauge=gauge)
    return recorded(bench, instrument, sine(frequency), "r", np.random.default_rng(1))[1]


def test_without_an_effect_of_the_rate_both_noise_floors_are_equal() -> None:
    floor, read_floor = noise_floors(None, 1e-5)
    assert read_floor == floor


@pytest.mark.parametrize("effect", [MovingMass(10.0), LinearDashpot(2000.0)])
def test_a_finer_gauge_brings_the_noise_floors_together(effect: MovingMass | LinearDashpot) -> None:
    coarse, fine = (noise_floors(effect, gauge, 3.0) for gauge in (1.5e-5, 1.5e-7))
    assert coarse[1] > 1.02 * coarse[0]
    assert fine[1] == pytest.approx(fine[0], rel=0.02)


def test_the_reading_noise_floor_is_below_that_of_plain_differences() -> None:
    # differences of two readings add c sqrt(2) s / d: 2000 * 1.4 * 1.5e-5 / 0.005 = 8.5 N to the floor
    floor, read_floor = noise_floors(LinearDashpot(2000.0), 1.5e-5)
    assert read_floor < np.hypot(floor, 0.5 * 8.5)
