"""One parameter: what it takes, and the sentence with which it refuses."""

from __future__ import annotations

import math

import pytest
from radialtire import Parameter, ParameterError

LENGTH = Parameter("length", "l", "m", 1.0, 0.0, 2.0, "of something")
COUNT = Parameter("count", "n", "1", 1.0, 0.0, math.inf, "of something", neutral=0.0, nominal=3.0)


@pytest.mark.parametrize("value", [0, 0.0, 2.0, 1])
def test_the_bounds_belong_to_what_is_allowed(value: float) -> None:
    checked = LENGTH.checked(value)
    assert checked == value
    assert type(checked) is float


@pytest.mark.parametrize(
    ("value", "said"),
    [
        (-1e-300, "length = -1.0000000000000000e-300 is not allowed; it must lie between 0 and 2 m"),
        (2.5, "length = 2.5 is not allowed; it must lie between 0 and 2 m"),
        (math.nan, "length = nan is not allowed; it must lie between 0 and 2 m"),
        (math.inf, "length = inf is not allowed; it must lie between 0 and 2 m"),
        (True, "length = True is not a number; it must lie between 0 and 2 m"),
        ("1", "length = '1' is not a number; it must lie between 0 and 2 m"),
        (None, "length = None is not a number; it must lie between 0 and 2 m"),
    ],
)
def test_what_is_not_allowed_is_said_with_what_is(value: float, said: str) -> None:
    with pytest.raises(ParameterError) as refusal:
        LENGTH.checked(value)
    assert str(refusal.value) == said.replace("1.0000000000000000e-300", "1e-300")


def test_an_open_end_is_said_as_such() -> None:
    assert COUNT.allowed() == "it must be at least 0"
    assert COUNT.checked(1e300) == 1e300


def test_an_everyday_value_is_the_start_where_none_is_typical() -> None:
    assert LENGTH.nominal_value == 1.0
    assert COUNT.nominal_value == 3.0
