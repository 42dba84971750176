"""Expressions as operands, and numbers as C writes them."""

from __future__ import annotations

import math

import pytest
from tirelab.fmu.native.translation.c_types import BOOL, DOUBLE, INT
from tirelab.fmu.native.translation.expression import ATOM, UNARY, Expression, is_fixed, number


def test_an_operand_that_binds_less_is_put_in_parentheses() -> None:
    total = Expression("a + b", DOUBLE, 12)
    assert [total.within(12), total.within(13)] == ["a + b", "(a + b)"]


@pytest.mark.parametrize(
    ("value", "text", "kind", "binds"),
    [
        (True, "true", BOOL, ATOM),
        (3, "3", INT, ATOM),
        (-3, "-3", INT, UNARY),
        (0.1, "0.1", DOUBLE, ATOM),
        (-1e-300, "-1e-300", DOUBLE, UNARY),
        (math.inf, "INFINITY", DOUBLE, UNARY),
        (-math.inf, "-INFINITY", DOUBLE, UNARY),
    ],
)
def test_numbers(value: float, text: str, kind: str, binds: int) -> None:
    found = number(value)
    assert (found.text, found.type, found.binds) == (text, kind, binds)


def test_a_function_is_translated_anew_for_whole_numbers_and_objects_alone() -> None:
    assert is_fixed(number(3))
    assert is_fixed(Expression("path", "object", constant=object()))
    assert not is_fixed(number(3.0))
    assert not is_fixed(Expression("x", INT))
