"""Numbers in sentences are written as people write them."""

from __future__ import annotations

import math

import pytest
from tirelab.names import in_seconds, plain, power_of_ten, with_power


@pytest.mark.parametrize(
    ("value", "digits", "said"),
    [
        (5.0, 2, "5"),
        (5.25, 2, "5.2"),
        (240.4, 2, "240"),
        (-240.4, 2, "-240"),
        (30_000.0, 3, "30000"),
        (1_730_000_000.5, 6, "1730000000"),
        (99.96, 3, "100"),
        (0.0, 3, "0"),
        (2.5e-7, 2, "2.5·10⁻⁷"),
        (4e20, 2, "4·10²⁰"),
        (math.inf, 2, "inf"),
        (math.nan, 2, "nan"),
    ],
)
def test_a_number_in_a_sentence(value: float, digits: int, said: str) -> None:
    assert plain(value, digits) == said


def test_times_of_a_list_add_up() -> None:
    assert [in_seconds(t) for t in (7.5, 8.0, 18.75, 100.0, 104.4999, 0.0)] == [
        "7.5",
        "8",
        "18.75",
        "100",
        "104.5",
        "0",
    ]


def test_powers_of_ten() -> None:
    assert power_of_ten(-5) == "·10⁻⁵"
    assert with_power("9.60e-05") == "9.60·10⁻⁵"
    assert with_power("9.6") == "9.6"
