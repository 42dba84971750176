"""Expressions outside the subset are refused with their place."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import pytest
from tirelab.fmu.native.translation.body import Unsupported
from tirelab.fmu.native.translation.c_types import DOUBLE, ROW
from tirelab.fmu.native.translation.expression import Expression
from tirelab.fmu.native.translation.function import translate
from tirelab.fmu.native.translation.program import Program

# mypy: ignore-errors


def an_unknown_name(x):
    return x + unknown  # noqa: F821


def a_list(x):
    return [x, x][0]


def a_chain(x):
    return 0.0 < x < 1.0


def a_slice_not_known(q, x):
    return sum(q[int(x) : int(x) + 2])


def a_text(x):
    return x + "1"


def a_number_as_a_test(x):
    return 1.0 if x else 0.0


def an_operator_of_bits(x):
    return ~x


def a_remainder(x):
    return x % 2.0


def an_element_of_a_number(x):
    return x[0]


def a_real_place(q, x):
    return q[x]


def an_attribute_of_a_number(x):
    return x.real


def a_module_as_a_value(x):
    return math


def a_place_in_unequal_elements(x):
    return ((x, x > 0.0), x)[int(x)]


@pytest.mark.parametrize(
    ("function", "kinds", "words"),
    [
        (an_unknown_name, [DOUBLE], "an unknown name: unknown"),
        (a_list, [DOUBLE], "an expression outside the subset: \\[x, x\\]"),
        (a_chain, [DOUBLE], "a comparison outside the subset"),
        (a_slice_not_known, [ROW, DOUBLE], "a slice that is not constant"),
        (a_text, [DOUBLE], "no number: '1'"),
        (a_number_as_a_test, [DOUBLE], "a test of other than a truth value"),
        (an_operator_of_bits, [DOUBLE], "an operator outside the subset"),
        (a_remainder, [DOUBLE], "an operator outside the subset"),
        (an_element_of_a_number, [DOUBLE], "no tuple"),
        (a_real_place, [ROW, DOUBLE], "no whole number"),
        (an_attribute_of_a_number, [DOUBLE], "an unknown attribute"),
        (a_module_as_a_value, [DOUBLE], "a name that is no constant"),
        (a_place_in_unequal_elements, [DOUBLE], "a place in a tuple that is not known"),
    ],
)
def test_what_is_refused(function: Callable[..., Any], kinds: list[str], words: str) -> None:
    with pytest.raises(Unsupported, match=words) as raised:
        translate(Program(), function, [Expression(f"a{i}", kind) for i, kind in enumerate(kinds)])
    assert f"{function.__name__}, line " in str(raised.value)
