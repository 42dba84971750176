"""Types in C: what is an array, what has named members, what a variable of a whole number is kept as."""

from __future__ import annotations

from tirelab.fmu.native.translation.c_types import BOOL, DOUBLE, INT, Tuple, plain


def test_equal_elements_are_an_array() -> None:
    pair = Tuple((DOUBLE, DOUBLE))
    assert pair.even
    assert [pair.member(i) for i in range(2)] == [".v[0]", ".v[1]"]


def test_other_tuples_have_members() -> None:
    mixed, named = Tuple((DOUBLE, BOOL)), Tuple((DOUBLE, DOUBLE), ("force", "rate"), "Answer")
    assert not mixed.even
    assert not named.even
    assert not Tuple(()).even
    assert [mixed.member(1), named.member(1)] == [".b", ".rate"]


def test_a_whole_number_is_kept_as_a_real_one() -> None:
    assert [plain(INT), plain(BOOL), plain(Tuple((INT,)))] == [DOUBLE, BOOL, Tuple((INT,))]
