"""The translator: what the C computes is what the Python computes, and what it cannot translate it refuses."""

from __future__ import annotations

import ctypes
import math
import subprocess
from collections.abc import Callable
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st
from tirelab.fmu.loader import Compiler
from tirelab.fmu.native.translate import DOUBLE, ROW, Expression, Program, Unsupported

LIMIT = 3.0
STEPS = 5


def branching(x: float, y: float) -> float:
    """Return a number that every statement of the subset has a part in."""
    total, last = 0.0, x
    pair = (x, y)
    for i in range(STEPS):
        if i == 2 and x > 0.0:
            continue_at = last
        elif not x > y or i == 4:
            continue_at = -last
        else:
            continue_at = min(max(x, y, LIMIT), 1e3)
        total += continue_at * pair[0] - 2.0 * pair[1]
        last, total = total / (1.0 + abs(total)), last
    while total > LIMIT:
        total /= 2.0
    a, b = swapped((total, last))
    return a - (b if a > b else -b) ** 2


def swapped(pair: tuple[float, float]) -> tuple[float, float]:
    """Return the two the other way round, the first one with a root."""
    a, b = pair
    a, b = b, a
    return math.sqrt(abs(a)), b


@pytest.fixture(scope="module")
def in_c(compiler: Compiler, tmp_path_factory: pytest.TempPathFactory) -> ctypes.CDLL:
    program = Program()
    program.function(
        branching, [Expression("x", DOUBLE), Expression("y", DOUBLE)], name="branching", public=True
    )
    lines = ["#include <math.h>", "#include <stdbool.h>"]
    lines += [f"static const double {name} = {value!r};" for name, value in program.constants.items()]
    lines += [*program.definitions, "static double lesser(double a, double b) { return b < a ? b : a; }"]
    lines += ["static double greater(double a, double b) { return b > a ? b : a; }"]
    lines += [text for _, text in program.texts]
    folder = tmp_path_factory.mktemp("translated")
    (folder / "one.c").write_text("\n".join(lines))
    flags = ["-std=c99", "-O2", "-ffp-contract=off", "-Wall", "-Werror", "-fPIC", "-shared"]
    library = folder / "one.so"
    subprocess.run([*compiler.command, *flags, "-o", library, folder / "one.c", "-lm"], check=True)
    loaded = ctypes.CDLL(str(library))
    loaded.branching.restype = ctypes.c_double
    loaded.branching.argtypes = [ctypes.c_double, ctypes.c_double]
    return loaded


@given(x=st.floats(-1e6, 1e6), y=st.floats(-1e6, 1e6))
def test_every_statement_gives_the_same_bits(in_c: ctypes.CDLL, x: float, y: float) -> None:
    assert in_c.branching(x, y) == branching(x, y)


def of_names(x: float) -> float:
    """Use a name that nobody knows."""
    return x + unknown  # noqa: F821


def of_lists(x: float) -> float:
    """Use a list."""
    return [x, x][0]


def of_two_types(x: float) -> float:
    """Give a name two types."""
    y: object = (x, x)
    y = x
    return y if y else x  # type: ignore[return-value]


def of_a_place_not_known(q: tuple[float, ...], x: float) -> float:
    """Cut a row where nobody knows."""
    at = int(x)
    return sum(q[at : at + 2])


def of_a_chain(x: float) -> bool:
    """Compare three."""
    return 0.0 < x < 1.0


@pytest.mark.parametrize(
    ("function", "arguments", "words"),
    [
        (of_names, [DOUBLE], "of_names.*unknown name: unknown"),
        (of_lists, [DOUBLE], r"of_lists.*outside the subset: \[x, x\]"),
        (of_two_types, [DOUBLE], "of_two_types.*in place of"),
        (of_a_place_not_known, [ROW, DOUBLE], "of_a_place_not_known.*a slice that is not constant"),
        (of_a_chain, [DOUBLE], "of_a_chain.*comparison outside the subset"),
    ],
)
def test_what_is_outside_the_subset_is_refused_with_its_place(
    function: Callable[..., Any], arguments: list[str], words: str
) -> None:
    with pytest.raises(Unsupported, match=words) as raised:
        Program().function(function, [Expression(f"a{i}", kind) for i, kind in enumerate(arguments)])
    assert f"{function.__name__}, line " in str(raised.value)
