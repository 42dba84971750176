"""Calls outside the subset are refused with their place."""

from __future__ import annotations

import math
from collections.abc import Callable
from fractions import Fraction
from typing import Any

import pytest
from tirelab.fmu.native.translation.body import Unsupported
from tirelab.fmu.native.translation.c_types import DOUBLE
from tirelab.fmu.native.translation.expression import Expression
from tirelab.fmu.native.translation.function import translate
from tirelab.fmu.native.translation.program import Program

# mypy: ignore-errors


def one(x, y):
    return x + y


def a_named_argument(x):
    return one(x, y=x)


def another_function_of_math(x):
    return math.gamma(x)


def a_function_that_is_not_there(x):
    return rounded(x)  # noqa: F821


def a_method(x):
    return x.hex()


def a_class(x):
    return Fraction(x)


def an_int_of_a_test(x):
    return int(x > 0.0)


def two_for_one(x):
    return abs(x, x)


def a_call_of_a_call(x):
    return one(x, x)(x)


@pytest.mark.parametrize(
    ("function", "kinds", "words"),
    [
        (a_named_argument, [DOUBLE], "named arguments"),
        (another_function_of_math, [DOUBLE], "a function of math outside the subset"),
        (a_function_that_is_not_there, [DOUBLE], "a call outside the subset"),
        (a_method, [DOUBLE], "a call outside the subset"),
        (a_class, [DOUBLE], "a call outside the subset"),
        (an_int_of_a_test, [DOUBLE], "a call outside the subset"),
        (two_for_one, [DOUBLE], "a call outside the subset"),
        (a_call_of_a_call, [DOUBLE], "a call outside the subset"),
    ],
)
def test_what_is_refused(function: Callable[..., Any], kinds: list[str], words: str) -> None:
    with pytest.raises(Unsupported, match=words) as raised:
        translate(Program(), function, [Expression(f"a{i}", kind) for i, kind in enumerate(kinds)])
    assert f"{function.__name__}, line " in str(raised.value)
