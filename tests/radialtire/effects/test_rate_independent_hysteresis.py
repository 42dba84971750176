"""Friction: the area of its loop, its memory, its load, and its indifference to speed and noise."""

from __future__ import annotations

import math

import numpy as np
import pytest
from driving import LINEAR, STIFFNESS, drive, loop_area, only, sine
from radialtire import TireModel

NAME = "rate_independent_hysteresis"
CYCLE = 2000


def steady_loop(amplitude: float, **changed: float) -> tuple[np.ndarray, np.ndarray]:
    """Deflection and friction force over the last of three cycles."""
    time, x = sine(1.0, amplitude, 0.015, 3.0, CYCLE)
    force = drive(only(NAME, law=LINEAR, **changed), time, x) - STIFFNESS * x
    last = slice(-CYCLE - 1, None)
    return x[last], force[last]


@pytest.mark.parametrize("reach", [1e-4, 1e-3, 5e-3])
def test_dahls_loop_has_its_area(reach: float) -> None:
    # between -a and a the closed loop runs from -tanh(a/d) to tanh(a/d): area S (4 a - 4 d tanh(a/d))
    a, S = 0.01, 50.0
    x, force = steady_loop(a, slip_force=S, reach=reach)
    area = S * 4.0 * (a - reach * math.tanh(a / reach))
    # trapezes over arcs bent by 1/d: less than (2 pi a / 2000)^2 / (12 d a) of the area
    assert loop_area(x, force) == pytest.approx(area, rel=2e-3)
    assert force.max() == pytest.approx(S * math.tanh(a / reach), rel=1e-6)


def test_one_elastic_plastic_elements_loop_is_a_parallelogram() -> None:
    # slips at r = 4/3 d: height 2 S, base 2 a - 2 r
    a, S, d = 0.01, 50.0, 1.5e-3
    x, force = steady_loop(a, slip_force=S, reach=d, memory=1.0, spread=0.0)
    assert loop_area(x, force) == pytest.approx(4.0 * S * (a - 4.0 / 3.0 * d), rel=2e-3)


def test_spread_elements_slip_one_after_the_other() -> None:
    # loops of four elements of S/4 with reaches r (1 -+ 3/4 c), r (1 -+ 1/4 c): the mean reach counts
    a, S, d = 0.01, 50.0, 1.5e-3
    x, force = steady_loop(a, slip_force=S, reach=d, memory=1.0, spread=0.8)
    assert loop_area(x, force) == pytest.approx(4.0 * S * (a - 4.0 / 3.0 * d), rel=2e-3)
    slopes = {round(float(s) / (S / 4.0), 3) for s in np.diff(force) / np.diff(x) if abs(s) > 1e-6 * S}
    assert len(slopes) >= 4


@pytest.mark.parametrize("memory", [0.0, 0.5, 1.0])
def test_the_speed_plays_no_part(memory: float) -> None:
    _, x = sine(1.0, 0.01, 0.012, 2.0, 500)
    tire = only(NAME, slip_force=40.0, load_share=0.02, memory=memory)
    slow = drive(tire, np.arange(x.size) * 1.0, x)
    fast = drive(tire, np.arange(x.size) * 1e-4, x)
    uneven = drive(tire, np.cumsum(np.linspace(0.1, 3.0, x.size)), x)
    assert np.array_equal(slow, fast)
    assert np.array_equal(slow, uneven)


def test_friction_by_load_is_a_share_of_the_elastic_force() -> None:
    # fully slipping: 1 + mu of the elastic force up, 1 - mu down
    x = np.concatenate([np.linspace(0.0, 0.02, 500), np.linspace(0.02, 0.005, 500)])
    force = drive(only(NAME, law=LINEAR, load_share=0.05, reach=1e-4), np.arange(1000.0), x)
    assert force[499] / (STIFFNESS * x[499]) == pytest.approx(1.05, rel=1e-9)
    assert force[-1] / (STIFFNESS * x[-1]) == pytest.approx(0.95, rel=1e-9)


@pytest.mark.parametrize("memory", [0.0, 1.0])
def test_the_way_back_slips_at_a_share_of_its_own(memory: float) -> None:
    # fully slipping: S up, -u S down; without memory and slipping at once, the area is (1 + u) S times the base
    x = np.concatenate([np.linspace(0.0, 0.02, 500), np.linspace(0.02, 0.005, 500)])
    tire = only(NAME, law=LINEAR, slip_force=50.0, reach=1e-4, memory=memory, rebound=0.4)
    force = drive(tire, np.arange(1000.0), x) - STIFFNESS * x
    assert force[499] == pytest.approx(50.0, rel=1e-9)
    assert force[-1] == pytest.approx(-20.0, rel=1e-9)


def excursion(memory: float) -> tuple[float, float]:
    """Force on the way up before and after a closed excursion downwards by 1 mm."""
    path = [np.linspace(0.0, 0.0135, 200), np.linspace(0.0135, 0.0125, 50), np.linspace(0.0125, 0.0135, 50)]
    x = np.concatenate(path)
    force = drive(only(NAME, law=LINEAR, slip_force=50.0, reach=3e-3, memory=memory), np.arange(300.0), x)
    return float(force[199]), float(force[-1])


def test_elastic_plastic_elements_remember_where_they_turned() -> None:
    before, after = excursion(1.0)
    assert after == pytest.approx(before, rel=1e-12)


def test_dahls_element_forgets_where_it_turned() -> None:
    # down by u and up again: z -> 1 - (2 - (1 + z) e) e with e = exp(-u/d)
    before, after = excursion(0.0)
    z = 1.0 - math.exp(-0.0135 / 3e-3)
    e = math.exp(-1.0 / 3.0)
    assert after - before == pytest.approx(50.0 * (1.0 - (2.0 - (1.0 + z) * e) * e - z), rel=1e-9)
    assert before - after > 1.0


def test_four_elements_follow_iwans_continuum() -> None:
    # a second formulation: 400 elements of one stiffness that slip at reaches evenly from 0 to 2 mm; documented 3 %
    random = np.random.default_rng(6)
    time = np.arange(0.0, 20.0, 0.005)
    w = 2.0 * math.pi * np.linspace(0.3, 4.0, 15)[:, None]
    x = 0.015 + 5e-3 * math.sqrt(2.0 / 15.0) * np.sum(
        np.sin(w * time + random.uniform(0.0, 6.3, (15, 1))), axis=0
    )
    x = np.maximum(x, 2e-3)
    reaches = (np.arange(400) + 0.5) / 400.0 * 2e-3
    y = np.zeros(400)
    iwan = np.zeros_like(x)
    for i in range(1, x.size):
        y = np.clip(y + (x[i] - x[i - 1]) / reaches, -1.0, 1.0)
        iwan[i] = float(reaches @ y) / float(reaches.sum())
    force = drive(only(NAME, law=LINEAR, slip_force=1.0, reach=1.01e-3, memory=1.0, spread=0.64), time, x)
    assert np.sqrt(np.mean((force - STIFFNESS * x - iwan) ** 2)) < 0.03


def test_in_the_air_nothing_slips_and_nothing_is_forgotten() -> None:
    tire = only(NAME, law=LINEAR, slip_force=50.0, reach=1e-3)
    down = np.linspace(0.02, 0.0, 100)
    up = np.linspace(1e-4, 0.02, 100)
    straight = drive(tire, np.arange(200.0), np.concatenate([down, up]))
    jump = np.array([-0.01, -0.3, -0.02])
    through_air = drive(tire, np.arange(203.0), np.concatenate([down, jump, up]))
    assert np.array_equal(straight[100:], through_air[103:])
    assert np.all(through_air[100:103] == 0.0)


def held_with_noise(play: float, memory: float) -> float:
    """Friction over S at the end of a hold of 10 s read at 400 Hz with 8e-6 m of noise, after loading."""
    random = np.random.default_rng(5)
    x = np.concatenate([np.linspace(0.0, 0.01, 100), np.full(4000, 0.01)])
    read = x + 8e-6 * random.standard_normal(x.size)
    force = drive(
        only(NAME, law=LINEAR, slip_force=50.0, play=play, memory=memory), np.arange(x.size) * 2.5e-3, read
    )
    return float(force[-1] - STIFFNESS * read[-1]) / 50.0


def test_noise_makes_dahls_element_forget_unless_it_has_play() -> None:
    # exp(-10 mm / 1 mm) from full slip before; documented: all forgotten without play, 3 % with four times the noise
    assert abs(held_with_noise(0.0, 0.0)) < 0.1
    assert held_with_noise(3.2e-5, 0.0) > 0.95
    assert held_with_noise(0.0, 1.0) > 0.95


def test_play_costs_little_where_there_is_no_noise() -> None:
    # a way back of w counts as w / 2: on the slope 2 S / d after a turn that is S w / d, and past 2 w it is nothing
    w = 3.2e-5
    time, x = sine(1.0, 0.008, 0.012, 2.0, 1000)
    exact = drive(only(NAME, law=LINEAR, slip_force=50.0), time, x)
    off = np.abs(drive(only(NAME, law=LINEAR, slip_force=50.0, play=w), time, x) - exact)
    assert np.max(off) < 1.05 * 50.0 * w / 1e-3
    assert np.sqrt(np.mean(off**2)) < 0.01 * 50.0


def test_the_articles_hysteresis_can_be_had() -> None:
    # 100 N between loading and unloading, 6.5 % of the peak
    time, x = sine(1.0, 0.01, 0.011, 2.0, 2000)
    force = drive(only(NAME, slip_force=50.0), time, x)
    middle = np.abs(x - 0.011) < 2e-5
    up, down = force[middle & (np.gradient(x) > 0.0)], force[middle & (np.gradient(x) < 0.0)]
    assert up[-1] - down[-1] == pytest.approx(100.0, rel=0.02)
    assert 100.0 / force.max() == pytest.approx(0.065, abs=0.005)


@pytest.mark.parametrize("memory", [0.0, 0.5, 1.0])
def test_a_tire_that_is_deflected_at_the_first_moment_was_pressed_there(memory: float) -> None:
    tire = only("rate_independent_hysteresis", slip_force=40.0, reach=2e-3, memory=memory)
    there = drive(tire, [0.0], [0.003])
    pressed = drive(tire, [0.0, 1.0], [0.0, 0.003])
    assert there[0] == pytest.approx(pressed[1], rel=1e-14)
    bare = drive(TireModel(), [0.0], [0.003])[0]
    assert there[0] > bare + 20.0
    half = only("rate_independent_hysteresis", slip_force=40.0, reach=2e-3, memory=memory, seat=-0.5)
    assert drive(half, [0.0], [0.003])[0] - bare == pytest.approx(-0.5 * (there[0] - bare), rel=1e-12)
