"""Rate and acceleration: exact on what they should be, and against the same estimator written with matrices."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from radialtire import tracking


def follow(time: np.ndarray, deflection: np.ndarray, noise: float) -> tuple[np.ndarray, np.ndarray]:
    track = tracking.begin(float(deflection[0]))
    found = [(tracking.rate(track), tracking.acceleration(track))]
    for d, x in zip(np.diff(time), deflection[1:], strict=True):
        track = tracking.follow(track, float(d), float(x), noise)
        found.append((tracking.rate(track), tracking.acceleration(track)))
    rate, acceleration = np.array(found).T
    return rate, acceleration


def test_before_the_second_reading_nothing_moves() -> None:
    assert tracking.rate(tracking.begin(0.02)) == 0.0
    assert tracking.acceleration(tracking.begin(0.02)) == 0.0
    assert tracking.rate(tracking.begin(0.01)) == 0.0


def test_the_second_reading_gives_the_difference() -> None:
    track = tracking.follow(tracking.begin(0.01), 0.005, 0.011, 2e-3)
    assert tracking.rate(track) == pytest.approx(0.2, rel=1e-12)
    assert tracking.acceleration(track) == 0.0


@given(st.sampled_from([0.0, 2e-6, 1e-5]), st.lists(st.floats(1e-3, 1e-2), min_size=150, max_size=150))
def test_constant_acceleration_is_followed_exactly_at_any_spacing(noise: float, steps: list[float]) -> None:
    # a Kalman filter has no bias on the motion of its own model; what it starts from fades
    time = np.concatenate([[0.0], np.cumsum(steps)])
    rate, acceleration = follow(time, 0.01 + 0.1 * time - 2.0 * time**2, noise)
    assert rate[-1] == pytest.approx(0.1 - 4.0 * time[-1], abs=2e-3)
    assert acceleration[-1] == pytest.approx(-4.0, abs=0.2)


def estimator(time: np.ndarray, deflection: np.ndarray, noise: float) -> tuple[np.ndarray, np.ndarray]:
    """A second formulation: matrices in SI units, the process noise by quadrature, the mixing over all pairs."""
    nodes, weights = np.polynomial.legendre.leggauss(8)
    smaller = min(noise / tracking.FINEST, 1.0) ** 2
    slow, quick = (smaller * tracking.PRESS, smaller * tracking.SMOOTH), (tracking.RIDE, tracking.SHARP)
    kinds = [(3, slow[0]), (3, quick[0]), (4, slow[1]), (4, quick[1])]
    largest = {3: tracking.JERK_MAX, 4: tracking.SNAP_MAX}
    factorial = np.array([math.factorial(k) for k in range(4)])
    switch = np.where(np.eye(4) > 0.0, 1.0 - tracking.SWITCH, tracking.SWITCH / 3.0)
    n, s2, u = tracking.TAIL, noise**2, tracking.UNKNOWN

    d = scale = time[1] - time[0]
    size = factorial / d ** np.arange(4)
    four = np.array([[1, 1, 0, 0], [1, 2 + 2 * u, u, -u], [0, u, u, 0], [0, -u, 0, u]], dtype=float)
    three = np.array([[1, 1, 0, 0], [1, 2 + u, u, 0], [0, u, u, 0], [0, 0, 0, 0]], dtype=float)
    means = [np.array([deflection[1], (deflection[1] - deflection[0]) / d, 0.0, 0.0]) for _ in kinds]
    spreads = [s2 * (four if order == 4 else three) * np.outer(size, size) for order, _ in kinds]
    likely = np.full(4, 0.25)
    rate, acceleration = [0.0, means[0][1]], [0.0, 0.0]
    for i in range(2, time.size):
        d = time[i] - time[i - 1]
        scale = max(d, tracking.FADES * scale)
        before = likely @ switch
        share = switch * likely[:, None] / before
        mixed = share.T @ np.array(means)
        about = [
            np.einsum("k,kab->ab", share[:, j], spreads)
            + np.einsum("k,ka,kb->ab", share[:, j], means - mixed[j], means - mixed[j])
            for j in range(4)
        ]
        move = np.array(
            [[d ** (c - r) / factorial[c - r] if c >= r else 0.0 for c in range(4)] for r in range(4)]
        )
        for j, (order, q) in enumerate(kinds):
            kicked = np.zeros((4, 4))
            for node, weight in zip(nodes, weights, strict=True):
                left = d * (1.0 - node) / 2.0
                kick = np.zeros(4)
                kick[:order] = [left**k / factorial[k] for k in reversed(range(order))]
                kicked += weight * d / 2.0 * np.outer(kick, kick)
            known = np.diag([1.0, 1.0, 1.0, float(order == 4)])
            mean = known @ move @ mixed[j]
            most = largest[order] * s2 / scale ** (2 * order - 1)
            spread = known @ move @ about[j] @ move.T @ known + min(q, most) * kicked
            read = spread[0, 0] + s2
            off = deflection[i] - mean[0]
            gain = spread[:, 0] / read
            means[j], spreads[j] = mean + gain * off, spread - np.outer(gain, spread[0])
            likely[j] = before[j] * (read / s2) ** -0.5 * (1.0 + off**2 / (n * read)) ** (-(n + 1.0) / 2.0)
        likely = likely / likely.sum()
        rate.append(likely @ np.array(means)[:, 1])
        acceleration.append(likely @ np.array(means)[:, 2])
    return np.array(rate), np.array(acceleration)


def test_it_is_the_estimator_of_the_definition() -> None:
    random = np.random.default_rng(3)
    time = np.cumsum(random.uniform(1e-3, 6e-3, 120))
    # a press and a ride with a corner between them
    deflection = np.where(time < 0.2, 0.01 + 0.02 * time, 0.014 + 0.005 * np.sin(30.0 * (time - 0.2)))
    deflection = deflection + 1e-5 * random.standard_normal(120)
    rate, acceleration = follow(time, deflection, 1e-5)
    expected_rate, expected_acceleration = estimator(time, deflection, 1e-5)
    np.testing.assert_allclose(rate, expected_rate, rtol=1e-6, atol=1e-7)
    np.testing.assert_allclose(acceleration, expected_acceleration, rtol=1e-6, atol=1e-4)


@pytest.mark.parametrize("noise", [5e-7, 2e-6, 1e-5])
def test_it_is_the_estimator_of_the_definition_with_readings_soon_after_others(noise: float) -> None:
    random = np.random.default_rng(4)
    time = np.cumsum(10.0 ** random.uniform(-3.5, -2.6, 120))
    deflection = 0.014 + 0.005 * np.sin(30.0 * time) + noise * random.standard_normal(120)
    assert np.any(np.diff(time)[1:] < tracking.FADES**2 * np.diff(time)[:-1])
    expected_rate, expected_acceleration = estimator(time, deflection, noise)
    rate, acceleration = follow(time, deflection, noise)
    np.testing.assert_allclose(rate, expected_rate, rtol=1e-6, atol=1e-6)
    np.testing.assert_allclose(acceleration, expected_acceleration, rtol=1e-6, atol=1e-3)


@pytest.mark.parametrize("noise", [0.0, 1e-5])
@pytest.mark.parametrize("soon", [1e-12, 1e-7, 1e-4, 3e-4])
def test_a_reading_soon_after_another_one_changes_next_to_nothing(noise: float, soon: float) -> None:
    # A second reading of the same moment halves the variance of one reading, so that errors can only become smaller.
    time = np.arange(0.0, 4.0, 5e-3)
    twice = np.sort(np.concatenate([time, time[50::50] + soon]))

    def largest_errors(at: np.ndarray) -> np.ndarray:
        read = 0.01 + 0.004 * np.sin(20.0 * at) + noise * np.random.default_rng(1).standard_normal(at.size)
        rate, acceleration = follow(at, read, noise)
        off = np.array([rate - 0.08 * np.cos(20.0 * at), acceleration + 1.6 * np.sin(20.0 * at)])
        return np.abs(off[:, at > 0.4]).max(axis=1)

    assert np.all(largest_errors(twice) < 1.2 * largest_errors(time))


def test_finer_samples_are_followed_after_a_few_of_them() -> None:
    coarse, fine = np.arange(0.0, 1.0, 1e-2), 1.0 + np.arange(1e-4, 0.1, 1e-4)
    time = np.concatenate([coarse, fine])
    deflection = np.where(time < 1.0, 0.01, 0.01 + 0.5 * (time - 1.0))
    rate, _ = follow(time, deflection, 0.0)
    halvings = math.ceil(math.log2(1e-2 / 1e-4))
    np.testing.assert_allclose(rate[coarse.size + 3 * halvings :], 0.5, rtol=1e-3)


def test_noise_that_no_number_of_metres_holds_is_none() -> None:
    time = np.linspace(0.0, 0.2, 60)
    deflection = 0.01 + 0.004 * np.sin(40.0 * time)
    exact, finer = (follow(time, deflection, noise) for noise in (0.0, 0.9e-12))
    np.testing.assert_array_equal(exact, finer)


@pytest.mark.parametrize("size", [1e-2, 1e-4])
def test_a_small_part_is_followed_as_a_tire_is_whose_gauge_is_as_much_coarser(size: float) -> None:
    """A part of 0.2 mm whose gauge reads to 0.1 um, as good as a tire of 20 mm and 10 um; and one of 2 um."""
    random = np.random.default_rng(8)
    time = np.arange(0.0, 20.0, 5e-3)
    noise, w = size * 1e-5, 4.0
    motion, rate = size * 0.02 * np.sin(w * time), size * 0.02 * w * np.cos(w * time)
    acceleration = -w * w * motion
    read = motion + noise * random.standard_normal(time.size)
    found = follow(time, read, noise) - np.array([rate, acceleration])
    plain = np.array([math.sqrt(2.0) * noise / 5e-3, math.sqrt(6.0) * noise / 5e-3**2])
    as_exact = follow(time, read, 0.0) - np.array([rate, acceleration])
    left = np.sqrt(np.mean(found[:, 400:] ** 2, axis=1))
    # Taken as exact, the noise is magnified as by plain differences; a tire's sine leaves less than half of that.
    assert np.all(left < 0.5 * plain)
    assert np.all(np.sqrt(np.mean(as_exact[:, 400:] ** 2, axis=1)) > plain)


def test_it_finds_by_itself_whether_it_is_a_press_or_a_ride() -> None:
    # A press whose rate holds for long allows far more averaging than a sine whose rate turns within a quarter second.
    random = np.random.default_rng(5)
    noise, d = 1e-5, 5e-3
    time = np.arange(0.0, 20.0, d)
    read = 0.01 + noise * random.standard_normal(time.size)
    settled = slice(400, None)

    def errors(motion: np.ndarray, true_rate: np.ndarray, true_acceleration: np.ndarray) -> np.ndarray:
        off = follow(time, read + motion, noise) - np.array([true_rate, true_acceleration])
        return np.sqrt(np.mean(off[:, settled] ** 2, axis=1))

    w, size = 12.0, 2e-3
    press = errors(1e-4 * time, np.full_like(time, 1e-4), np.zeros_like(time))
    sine = errors(size * np.sin(w * time), size * w * np.cos(w * time), -size * w * w * np.sin(w * time))
    differences = np.array([math.sqrt(2.0) * noise / d, math.sqrt(6.0) * noise / d**2])
    assert np.all(press < 0.25 * differences)
    assert np.all(sine < 0.5 * differences)
    assert np.all(press < 0.7 * sine)


def test_a_corner_is_followed_within_three_readings() -> None:
    time = np.arange(0.0, 2.0, 0.01)
    read = 0.02 * np.abs(time - 1.0) + 1e-5 * np.random.default_rng(6).standard_normal(time.size)
    rate, _ = follow(time, read, 1e-5)
    # a difference over one interval tells the rate to s sqrt(2)/d = 1.4e-3 m/s: thrice that
    assert abs(rate[99] + 0.02) < 4.2e-3
    assert abs(rate[103] - 0.02) < 4.2e-3


def test_without_noise_the_error_of_the_rate_falls_with_the_cube_of_the_interval() -> None:
    def errors(count: int) -> tuple[float, float]:
        time = np.linspace(0.0, 1.0, count + 1)
        rate, acceleration = follow(time, 0.01 * np.sin(20.0 * time), 0.0)
        half = slice(count // 2, None)
        off = np.abs(rate - 0.2 * np.cos(20.0 * time))[half].max()
        off2 = np.abs(acceleration + 4.0 * np.sin(20.0 * time))[half].max()
        return float(off), float(off2)

    coarse, fine = errors(500), errors(1000)
    assert math.log2(coarse[0] / fine[0]) == pytest.approx(3.0, abs=0.3)
    assert math.log2(coarse[1] / fine[1]) == pytest.approx(2.0, abs=0.3)


def test_on_a_noisy_ride_it_beats_plain_differences() -> None:
    # 30 sines of random phase to 8 Hz, 5 mm in all, read at 400 Hz with 8e-6 m of noise: the documented figures
    random = np.random.default_rng(1)
    time = np.arange(0.0, 20.0, 2.5e-3)
    w = 2.0 * math.pi * np.linspace(0.3, 8.0, 30)[:, None]
    phase = random.uniform(0.0, 2.0 * math.pi, (30, 1))
    size = 5e-3 * math.sqrt(2.0 / 30.0)
    clean = size * np.sum(np.sin(w * time + phase), axis=0)
    true_rate = size * np.sum(w * np.cos(w * time + phase), axis=0)
    true_acceleration = -size * np.sum(w * w * np.sin(w * time + phase), axis=0)
    read = clean + 8e-6 * random.standard_normal(time.size)
    settled = slice(20, None)

    def rms(off: np.ndarray) -> float:
        return float(np.sqrt(np.mean(off[settled] ** 2)))

    rate, acceleration = follow(time, read, 8e-6)
    difference = np.diff(read, prepend=read[0]) / 2.5e-3
    second = np.diff(difference, prepend=0.0) / 2.5e-3
    assert rms(rate - true_rate) == pytest.approx(3.0e-3, rel=0.1)
    assert rms(acceleration - true_acceleration) == pytest.approx(0.8, rel=0.1)
    assert rms(difference - true_rate) == pytest.approx(9e-3, rel=0.1)
    assert rms(second - true_acceleration) == pytest.approx(3.2, rel=0.1)


@pytest.mark.parametrize("noise", [0.0, 1e-11, 1e-8, 1.1e-6, 1e-5, 1e-3])
def test_whatever_is_read_at_whatever_moments_stays_a_number(noise: float) -> None:
    # steps of 20 mm at intervals from microseconds to minutes: none of the kinds of motion, and hard on the rounding
    random = np.random.default_rng(9)
    for shortest in (1e-6, 1e-3, 1.0):
        time = np.cumsum(shortest * 10.0 ** random.uniform(0.0, 2.0, 400))
        steps = 0.02 * random.integers(0, 2, 400)
        for at in (time, np.cumsum(np.full(400, shortest))):
            rate, acceleration = follow(at, steps, noise)
            assert np.all(np.isfinite(rate))
            assert np.all(np.isfinite(acceleration))
