"""Assignments outside the subset are refused with their place."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import pytest
from tirelab.fmu.native.translation.body import Unsupported
from tirelab.fmu.native.translation.c_types import DOUBLE, OUT, ROW
from tirelab.fmu.native.translation.expression import Expression
from tirelab.fmu.native.translation.function import translate
from tirelab.fmu.native.translation.program import Program

# mypy: ignore-errors


def to_an_attribute(x):
    x.y = 1.0
    return x


def of_another_length(x):
    pair = (x, x)
    a, _, _ = pair
    return a


def of_sides_of_another_length(x):
    a, _ = x, x, x
    return a


def to_a_row_that_is_read(q, x):
    q[0] = x
    return x


def to_a_slice_of_another_length(n, x):
    n[0:3] = (x, x)
    return x


def of_a_constant_object(x):
    table = TABLE  # noqa: F841
    return x


def of_a_remainder(x):
    x %= 2.0
    return x


TABLE = (1.0, 2.0)


@pytest.mark.parametrize(
    ("function", "kinds", "words"),
    [
        (to_an_attribute, [DOUBLE], "an assignment outside the subset"),
        (of_another_length, [DOUBLE], "a tuple of another length"),
        (of_sides_of_another_length, [DOUBLE], "sides of different length"),
        (to_a_row_that_is_read, [ROW, DOUBLE], "what is written to is no row"),
        (to_a_slice_of_another_length, [OUT, DOUBLE], "a slice of another length"),
        (of_a_constant_object, [DOUBLE], "a constant object in a variable"),
        (of_a_remainder, [DOUBLE], "an operator outside the subset"),
    ],
)
def test_what_is_refused(function: Callable[..., Any], kinds: list[str], words: str) -> None:
    with pytest.raises(Unsupported, match=words) as raised:
        translate(Program(), function, [Expression(f"a{i}", kind) for i, kind in enumerate(kinds)])
    assert f"{function.__name__}, line " in str(raised.value)
