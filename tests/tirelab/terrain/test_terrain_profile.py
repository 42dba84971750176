"""Profiles that no ground can have are refused in a sentence with the place."""

import numpy as np
import pytest
from tirelab.errors import TirelabError
from tirelab.terrain import Profile, flat, from_function, sine

LEVEL = np.arange(6.0)


@pytest.mark.parametrize(
    ("s", "z", "sentence"),
    [
        ([0.0], [1.0], r"trail, point 1: the profile has 1 point in all; give at least 5"),
        ([], [], r"0 points in all"),
        ([0.0, 1.0, 2.0, 1.5, 3.0], [0.0] * 5, r"point 4: the profile folds back, s falls from 2 m to 1.5 m"),
        ([0.0, 1.0, 2.0, 3.0, 4.0], [0.0, 0.0, np.nan, 0.0, 0.0], r"point 3: z is nan"),
        ([0.0, np.inf, 2.0, 3.0, 4.0], [0.0] * 5, r"point 2: s is inf"),
        ([0.0, 1.0, 2.0, 3.0, 1e300], [0.0] * 5, r"point 5: s is 1e\+300 m, farther than around the Earth"),
        ([0.0, 1.0, 2.0, 3.0, 4.0], [0.0, -1e9, 0.0, 0.0, 0.0], r"point 2: z is -1e\+09 m"),
        (
            [0.0, 1.0, 1.0, 2.0, 3.0],
            [0.0, 0.0, 0.1, 0.1, 0.1],
            r"point 3: the profile steps from z = 0 m to 0.1 m at s = 1",
        ),
        (
            [0.0, 1.0, 1.01, 2.0, 3.0],
            [0.0, 0.0, 0.2, 0.2, 0.2],
            r"point 3: the profile steps .* s = 1.01 m.*kerb",
        ),
        ([0.0, 1.0, 1.0, 2.0, 3.0], [0.0] * 5, r"point 3: the point at s = 1 m is there twice"),
    ],
)
def test_impossible_ground(s: list[float], z: list[float], sentence: str) -> None:
    with pytest.raises(TirelabError, match=sentence) as caught:
        Profile(np.array(s), np.array(z), "trail")
    assert "\n" not in str(caught.value)


def test_columns_of_two_lengths() -> None:
    with pytest.raises(TirelabError, match="one length"):
        Profile(LEVEL, LEVEL[:-1])


def test_first_fault_is_told_when_there_are_several() -> None:
    with pytest.raises(TirelabError, match="point 3: the profile steps"):
        Profile(np.array([0.0, 1.0, 1.0, 0.5, 3.0]), np.array([0.0, 0.0, 0.1, 0.1, 0.1]))


def test_profile_keeps_its_own_copy() -> None:
    heights = np.zeros(6)
    profile = Profile(LEVEL, heights)
    heights[2] = 1.0
    assert profile.z[2] == 0.0
    with pytest.raises(ValueError, match="read-only"):
        profile.z[0] = 1.0


def test_functions_end_where_they_should() -> None:
    assert flat(3.0, 0.01).s.size == 301
    assert flat(3.0, 0.011).s[-1] == 3.0
    ramp = from_function(lambda s: 0.1 * s, 2.0)
    assert ramp.z[-1] == pytest.approx(0.2)
    assert ramp.length == pytest.approx(2.0)


def test_sum_of_sines() -> None:
    profile = sine(4.0, (0.1, 2.0), (0.01, 0.5))
    expected = 0.1 * np.sin(np.pi * profile.s) + 0.01 * np.sin(4.0 * np.pi * profile.s)
    np.testing.assert_allclose(profile.z, expected, atol=1e-15)


@pytest.mark.parametrize(
    "call", [lambda: flat(0.0), lambda: flat(np.nan), lambda: flat(1.0, 0.0), lambda: sine(1.0, (1.0, 0.0))]
)
def test_bad_sizes(call: "object") -> None:
    with pytest.raises(TirelabError):
        call()  # type: ignore[operator]


def test_bad_smoothing_length() -> None:
    with pytest.raises(TirelabError, match="smoothing length"):
        Profile(LEVEL, LEVEL, smoothing_length=-1.0)
