"""What is thinned for drawing still shows what there was; rates and branches are those of the motion."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
from tirelab.report.course import loading, rate_of
from tirelab.report.thinning import envelope, occupancy, trail


def test_an_envelope_keeps_the_extremes_of_every_column() -> None:
    rng = np.random.default_rng(1)
    x = np.sort(rng.uniform(0.0, 10.0, 50_000))
    y = rng.normal(size=x.size)
    y[31_234] = 40.0
    thin_x, thin_y = envelope(x, y, 100)
    assert thin_x.size <= 2 * 101
    assert np.all(np.diff(thin_x) >= 0.0)
    edges = x[0] + (x[-1] - x[0]) / 100 * np.arange(101)
    for low, high in pairwise(edges):
        inside, thin = (x >= low) & (x < high), (thin_x >= low) & (thin_x < high)
        assert y[inside].max() == thin_y[thin].max()
        assert y[inside].min() == thin_y[thin].min()


def test_a_short_line_is_left_alone() -> None:
    x, y = np.arange(10.0), np.arange(10.0) ** 2
    assert np.array_equal(envelope(x, y)[1], y)


def test_a_loop_that_comes_by_again_is_drawn_once() -> None:
    turn = np.linspace(0.0, 2.0 * np.pi, 2000, endpoint=False)
    once = trail(np.cos(turn), np.sin(turn), (-1.1, 1.1), (-1.1, 1.1))
    often = trail(np.cos(np.tile(turn, 50)), np.sin(np.tile(turn, 50)), (-1.1, 1.1), (-1.1, 1.1))
    assert abs(often[0].size - once[0].size) < 10
    assert np.nanmax(np.abs(np.hypot(*once) - 1.0)) < 1e-12


def test_a_trail_lifts_the_pen_between_pieces_that_are_apart() -> None:
    """Right, back, and right again on the same line, then up: the line is drawn once, and up starts at its end."""
    x = np.concatenate([np.linspace(0, 1, 50), np.linspace(1, 0, 50), np.linspace(0, 1, 50), np.ones(50)])
    y = np.concatenate([np.zeros(150), np.linspace(0.0, 1.0, 50)])
    path_x, path_y = trail(x, y, (-0.1, 1.1), (-0.1, 1.1))
    drawn = np.isfinite(path_x[1:]) & np.isfinite(path_x[:-1])
    lengths = np.hypot(np.diff(path_x), np.diff(path_y))[drawn]
    assert abs(float(lengths.sum()) - 2.0) < 0.05
    assert lengths.max() < 0.06


def test_occupancy_marks_the_pixels_of_the_points() -> None:
    many = 30_000
    x, y = np.full(many, 0.25), np.full(many, 0.75)
    picture = occupancy(x, y, (0.0, 1.0), (0.0, 1.0), (40, 60))
    assert np.argwhere(picture).tolist() == [[30, 15]]
    assert not occupancy(x + 9.0, y, (0.0, 1.0), (0.0, 1.0), (40, 60)).any()


def test_few_points_are_larger_dots() -> None:
    picture = occupancy(np.array([0.5]), np.array([0.5]), (0.0, 1.0), (0.0, 1.0), (41, 41))
    assert int(np.count_nonzero(picture)) == 25


def test_the_rate_is_that_of_the_motion_within_a_tenth_of_its_size() -> None:
    """0.1 of the root mean square is the noise that is allowed; the sine adds its own curvature, below that."""
    rng = np.random.default_rng(2)
    time = np.arange(20_000) * 1e-3
    deflection = 0.01 * np.sin(2.0 * time) + rng.normal(0.0, 1e-5, time.size)
    rate, true = rate_of(time, deflection), 0.02 * np.cos(2.0 * time)
    size = float(np.sqrt(np.mean(true**2)))
    assert float(np.sqrt(np.mean((rate - true)[50:-50] ** 2))) < 0.12 * size
    clear = np.abs(true) > 0.5 * size
    assert np.mean((loading(rate) == (true > 0.0))[clear]) > 0.999


def test_a_hold_belongs_to_the_branch_before_it() -> None:
    rate = np.concatenate([np.zeros(5), np.ones(10), np.zeros(10), -np.ones(10), np.zeros(5)])
    assert loading(rate).tolist() == [True] * 25 + [False] * 15
    assert loading(np.zeros(4)).all()
