"""Where a motion turns, against the motion driven."""

import numpy as np
import pytest
from tirelab.preprocessing.turns import branches

SIDE, STEP = 500, 2e-5


def triangle(strokes: int) -> np.ndarray:
    """A deflection [m] that goes up and down, SIDE samples of STEP [m] each way."""
    samples = np.arange(strokes * SIDE + 1)
    return STEP * (SIDE - np.abs(samples % (2 * SIDE) - SIDE))


def test_a_recording_that_begins_deep_begins_with_unloading() -> None:
    """No loading came before it, not even of a sample: it would be a second visit of where the recording ends."""
    pressed = triangle(4)[SIDE:]
    direction, cycle = branches(pressed, 0.0)
    middle = np.arange(SIDE // 2, pressed.size, SIDE)
    np.testing.assert_array_equal(direction[middle], [-1, 1, -1])
    np.testing.assert_array_equal(cycle[middle], [0, 1, 1])
    assert direction[0] == -1.0
    # Neither the noise of the gauge is a loading.
    trembling, _ = branches(pressed + 2e-5 * np.random.default_rng(1).standard_normal(pressed.size), 2e-5)
    assert np.all(trembling[: SIDE // 2] == -1.0)


def test_single_false_readings_in_a_hold_are_no_strokes() -> None:
    """A ramp of 10 mm, a hold with readings 0.15 mm above and below it, a fiftieth of the stroke being 0.2 mm."""
    held = np.full(4000, SIDE * STEP)
    held[500::1000] += 1.5e-4
    held[1000::1000] -= 1.5e-4
    motion = np.concatenate([triangle(1), held, triangle(2)[SIDE:]])
    direction, cycle = branches(motion, 1e-6)
    assert np.count_nonzero(np.diff(direction)) == 1
    assert cycle.max() == 0.0


@pytest.mark.parametrize("samples", [2, 3, 10])
def test_strokes_of_few_samples_are_counted(samples: int) -> None:
    """A lone sample at a turn of a motion is no false reading."""
    motion = 1e-2 * np.interp(np.arange(8 * samples + 1) / samples % 2.0, [0.0, 1.0, 2.0], [0.0, 1.0, 0.0])
    direction, cycle = branches(motion, 0.0)
    assert np.count_nonzero(np.diff(direction)) == 7
    assert cycle.max() == 3.0
