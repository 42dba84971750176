"""Statements outside the subset are refused with their place."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import pytest
from tirelab.fmu.native.translation.body import Unsupported
from tirelab.fmu.native.translation.c_types import DOUBLE
from tirelab.fmu.native.translation.expression import Expression
from tirelab.fmu.native.translation.function import translate
from tirelab.fmu.native.translation.program import Program

# mypy: ignore-errors


def a_try(x):
    try:
        return x
    finally:
        pass


def a_loop_over_a_variable(x):
    for i in (x, x):
        x += i
    return x


def a_range_of_reals(x):
    for _ in range(x):
        x += 1.0
    return x


def an_else_of_a_loop(x):
    for _ in range(3):
        x += 1.0
    else:
        x = 0.0
    return x


def an_else_of_a_while(x):
    while x > 0.0:
        x -= 1.0
    else:
        x = 0.0
    return x


def two_results(x):
    if x > 0.0:
        return x
    return (x, x)


@pytest.mark.parametrize(
    ("function", "kinds", "words"),
    [
        (a_try, [DOUBLE], "a statement outside the subset"),
        (a_loop_over_a_variable, [DOUBLE], "a loop over other than a range or a constant"),
        (a_range_of_reals, [DOUBLE], "a range of other than whole numbers"),
        (an_else_of_a_loop, [DOUBLE], "a loop outside the subset"),
        (an_else_of_a_while, [DOUBLE], "a loop outside the subset"),
        (two_results, [DOUBLE], "in place of"),
    ],
)
def test_what_is_refused(function: Callable[..., Any], kinds: list[str], words: str) -> None:
    with pytest.raises(Unsupported, match=words) as raised:
        translate(Program(), function, [Expression(f"a{i}", kind) for i, kind in enumerate(kinds)])
    assert f"{function.__name__}, line " in str(raised.value)
