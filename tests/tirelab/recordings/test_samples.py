"""What a sample may be: the limits from both sides, and the first sample that breaks them."""

import numpy as np
import pytest
from tirelab.recordings.samples import (
    GAP,
    HALF_DAY,
    LARGEST_PLAUSIBLE,
    SampleFault,
    check_time,
    check_values,
    checked_radius,
    descends,
    find_gaps,
    gap_notes,
    over_midnight,
    over_the_top,
)


def fault(check: object, *arguments: object) -> SampleFault:
    with pytest.raises(SampleFault) as caught:
        check(*arguments)  # type: ignore[operator]
    return caught.value


class TestValues:
    @pytest.mark.parametrize("name", LARGEST_PLAUSIBLE)
    def test_the_limit_itself_is_allowed_and_the_next_number_is_not(self, name: str) -> None:
        most = LARGEST_PLAUSIBLE[name]
        check_values(name, np.array([0.0, most]))
        found = fault(check_values, name, np.array([0.0, 1.0, np.nextafter(most, np.inf)]))
        assert (found.index, found.channel) == (2, name)
        assert "cannot be; correct the value or its unit" in found.what

    def test_a_temperature_is_not_below_absolute_zero(self) -> None:
        check_values("temperature", np.array([0.0]))
        assert fault(check_values, "temperature", np.array([300.0, -1e-9])).index == 1

    @pytest.mark.parametrize("value", [np.nan, np.inf, -np.inf])
    def test_the_first_value_that_is_not_finite_is_named(self, value: float) -> None:
        found = fault(check_values, "force", np.array([1.0, value, value]))
        assert str(found) == f"sample 2, force: {value} is no force; correct the value, or delete the row"


class TestTime:
    def test_time_that_increases(self) -> None:
        check_time(np.array([-1.0, 0.0, 1e-9]))

    @pytest.mark.parametrize(
        ("time", "index", "what"),
        [
            ([0.0, 1.0, 1.0, 0.0], 2, "time repeats 1 s"),
            (
                [5.0] * 3,
                1,
                "time repeats 5 s, as do 1 others: the clock is coarser than the samples; if these are "
                "evenly spaced, give their rate: --sampling RATE",
            ),
            ([0.0, 1.0, 0.5, 0.2], 2, "time goes back from 1 s to 0.5 s"),
        ],
    )
    def test_the_first_step_that_does_not_is_named(self, time: list[float], index: int, what: str) -> None:
        found = fault(check_time, np.array(time))
        assert (found.index, found.channel) == (index, "time")
        assert found.what.startswith(what)


class TestRadius:
    def test_flat_is_inf_from_either_side_and_cannot_be_written_to(self) -> None:
        radius = checked_radius(np.array([np.inf, -np.inf, 0.3, -0.3]))
        np.testing.assert_array_equal(radius, [np.inf, np.inf, 0.3, -0.3])
        with pytest.raises(ValueError, match="read-only"):
            radius[0] = 1.0

    @pytest.mark.parametrize("value", [0.0, -0.0, np.nan])
    def test_what_is_no_radius(self, value: float) -> None:
        found = fault(checked_radius, np.array([0.3, -0.3, value]))
        assert (found.index, found.channel) == (2, "radius")

    def test_radii_of_both_signs_go_through_zero_without_being_it(self) -> None:
        np.testing.assert_array_equal(checked_radius(np.array([-0.1, 0.1])), [-0.1, 0.1])


class TestGaps:
    def test_steps_up_to_the_limit_are_no_gap(self) -> None:
        assert len(find_gaps(np.array([1.0, GAP, 1.0, 1.0]))) == 0
        np.testing.assert_array_equal(find_gaps(np.array([1.0, GAP + 1e-9, 1.0, 1.0])), [1])

    def test_a_step_that_is_short_makes_no_gap_of_the_others(self) -> None:
        assert len(find_gaps(np.array([1.0, 0.1, 1.0, 1.0]))) == 0

    @pytest.mark.parametrize(
        ("steps", "note"),
        [
            ([1.0] * 30, []),
            ([1.0] * 15 + [5.0] + [1.0] * 15, ["1 gap in time, not filled: 5 s after 15 s"]),
            (
                [1.0] * 15 + [5.0] + [1.0] * 15 + [7.0],
                ["2 gaps in time, not filled, the longest 7 s after 35 s"],
            ),
            ([1.0, 5.0, 1.0, 1.0], ["time is sampled irregularly: steps from 1 to 5 s"]),
        ],
    )
    def test_what_is_said_of_them(self, steps: list[float], note: list[str]) -> None:
        assert gap_notes(np.concatenate([[0.0], np.cumsum(steps)])) == note


class TestClock:
    def test_a_day_is_added_after_midnight(self) -> None:
        time, first = over_midnight(np.array([86_398.0, 86_399.0, 0.0, 1.0]))
        np.testing.assert_array_equal(time, [86_398.0, 86_399.0, 86_400.0, 86_401.0])
        assert first == 2

    def test_half_a_day_is_added_after_twelve(self) -> None:
        time, first = over_midnight(np.array([43_198.0, 43_199.0, 0.0, 1.0]), HALF_DAY)
        np.testing.assert_array_equal(time, [43_198.0, 43_199.0, 43_200.0, 43_201.0])
        assert first == 2

    @pytest.mark.parametrize(
        "time", [[0.0, 1.0, 0.0, 1.0], [86_399.0, 0.0, 86_399.0, 0.0], [2e5, 3e4, 3e4 + 1.0]]
    )
    def test_another_jump_back_is_none_of_a_day(self, time: list[float]) -> None:
        assert over_midnight(np.array(time))[1] is None

    @pytest.mark.parametrize(
        ("time", "falls"), [([3.0, 2.0, 1.0], True), ([3.0, 3.0, 1.0], False), ([1.0], False)]
    )
    def test_time_that_falls_throughout(self, time: list[float], falls: bool) -> None:
        assert descends(np.array(time)) is falls


class TestCounters:
    @pytest.mark.parametrize("low", [0.0, -(2.0**15)])
    def test_one_of_16_bits_goes_on(self, low: float) -> None:
        true = 500.0 * np.arange(400)
        time, first = over_the_top(1e-3 * ((true % 2**16) + low), 1e-3)
        np.testing.assert_allclose(time, 1e-3 * (true + low), rtol=1e-12)
        assert first == 132  # 131 steps of 500 are 65,500

    def test_one_of_32_bits_goes_on(self) -> None:
        true = 4_294_967_296.0 - 2e7 + 1e5 * np.arange(400)
        time, first = over_the_top(1e-6 * (true % 2**32), 1e-6)
        np.testing.assert_allclose(time, 1e-6 * true, rtol=1e-12)
        assert first == 200

    @pytest.mark.parametrize(
        "counts",
        [
            500.0 * np.arange(100),
            500.0 * (np.arange(100) % 50),  # begins anew with a reset
            np.concatenate([[65_000.0], 500.0 * np.arange(3.0, 40.0)]),  # 2036 later, four steps
            0.5 + 500.0 * np.arange(200) % 2**16,
        ],
        ids=["rises", "reset", "a pause", "no whole numbers"],
    )
    def test_what_is_no_full_counter_stays(self, counts: np.ndarray) -> None:
        time, first = over_the_top(1e-3 * counts, 1e-3)
        assert first is None
        np.testing.assert_array_equal(time, 1e-3 * counts)
