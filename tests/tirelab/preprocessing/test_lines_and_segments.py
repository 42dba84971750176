"""What stands out of a residual: lines, segments of time, and of noise alone nothing."""

import numpy as np
import pytest
from scipy.signal import lfilter
from tirelab.preprocessing.lines_and_segments import detect_lines_and_segments

COUNT = 4000
TIME = np.arange(COUNT) * 0.01
FORCE = 1000.0 * np.sin(1.3 * TIME) ** 2


def overlap(found: tuple[int, int], planted: tuple[int, int]) -> float:
    """Return what both have over what either has."""
    both = min(found[1], planted[1]) - max(found[0], planted[0])
    return max(both, 0) / (max(found[1], planted[1]) - min(found[0], planted[0]))


@pytest.mark.parametrize("slow", [0.0, 0.4])
def test_of_noise_alone_hardly_anything_stands_out(slow: float) -> None:
    # Asked for is one in a hundred; 4 of 40 happen by chance once in a thousand. Slow noise is less regular.
    segments = lines = 0
    for seed in range(40):
        rng = np.random.default_rng(seed)
        drift = lfilter([np.sqrt(1.0 - 0.99**2)], [1.0, -0.99], rng.standard_normal(COUNT))
        found = detect_lines_and_segments(
            TIME, np.sqrt(1.0 - slow) * rng.standard_normal(COUNT) + np.sqrt(slow) * drift, FORCE
        )
        segments += bool(found.segments)
        lines += bool(found.lines)
    assert segments <= (3 if slow == 0.0 else 8)
    assert lines <= 3


@pytest.mark.parametrize(
    ("first", "last", "height"), [(1000, 1012, 6.0), (3000, 3130, 2.5), (200, 1100, 1.5)]
)
def test_a_jump_that_comes_back_is_found(first: int, last: int, height: float) -> None:
    noise = np.random.default_rng(11).standard_normal(COUNT)
    noise[first:last] += height
    assert (
        max(overlap(s, (first, last)) for s in detect_lines_and_segments(TIME, noise, FORCE).segments) > 0.8
    )


def test_a_channel_that_hangs_is_found() -> None:
    # It holds its last value while the force goes on: what is missing is all of the force's change.
    noise = np.random.default_rng(12).standard_normal(COUNT)
    noise[2000:2030] += 0.02 * (FORCE[2000] - FORCE[2000:2030]) - 0.5 * np.arange(30)
    assert max(overlap(s, (2000, 2030)) for s in detect_lines_and_segments(TIME, noise, FORCE).segments) > 0.7


@pytest.mark.parametrize("modulation", [0.0, 0.5])
def test_a_line_is_found_steady_or_modulation(modulation: float) -> None:
    rng = np.random.default_rng(13)
    loud = 3.0 * (1.0 + modulation * np.sin(2.0 * np.pi * 3.0 * TIME / TIME[-1]))
    found = detect_lines_and_segments(
        TIME, rng.standard_normal(COUNT) + loud * np.sin(2.0 * np.pi * 7.3 * TIME), FORCE
    )
    assert found.lines[0] == pytest.approx(7.3, abs=0.05)
    assert not found.segments


@pytest.mark.parametrize("turns", [8.7, 10.0])
def test_a_line_of_few_turns_is_found(turns: float) -> None:
    # What makes fewer than eight turns is followed by the courses of time, of sixteen half turns.
    rng = np.random.default_rng(16)
    wave = 2.0 * np.sin(2.0 * np.pi * turns * TIME / TIME[-1])
    found = detect_lines_and_segments(TIME, rng.standard_normal(COUNT) + wave, FORCE)
    assert found.lines[0] * TIME[-1] == pytest.approx(turns, abs=0.3)


def test_a_hum_is_noise() -> None:
    rng = np.random.default_rng(14)
    assert not detect_lines_and_segments(
        TIME, rng.standard_normal(COUNT) + 0.4 * np.sin(2.0 * np.pi * 20.0 * TIME), FORCE
    ).lines


def test_spikes_are_noise() -> None:
    rng = np.random.default_rng(15)
    noise = rng.standard_normal(COUNT)
    noise[rng.integers(0, COUNT, 5)] += 15.0
    assert not detect_lines_and_segments(TIME, noise, FORCE).segments
