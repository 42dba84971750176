"""A function as a whole: what the C computes is what the Python computes, and what it cannot translate it refuses."""

from __future__ import annotations

import ctypes
import math
import subprocess

import pytest
from hypothesis import given
from hypothesis import strategies as st
from tirelab.fmu.loader import Compiler
from tirelab.fmu.native.translation.body import Unsupported
from tirelab.fmu.native.translation.c_types import DOUBLE
from tirelab.fmu.native.translation.expression import Expression
from tirelab.fmu.native.translation.function import translate
from tirelab.fmu.native.translation.program import Program

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
    translate(
        program, branching, [Expression("x", DOUBLE), Expression("y", DOUBLE)], name="branching", public=True
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


def unrolled(x: float) -> float:
    """Call one function on two whole numbers and twice on a variable."""
    return power(x, 2) + power(x, 3) + halved(x) + halved(2.0 * x)


def power(x: float, n: int) -> float:
    """Return x^n, n at least 1."""
    total = x
    for _ in range(n - 1):
        total *= x
    return total


def halved(x: float) -> float:
    """Return the half."""
    return 0.5 * x


def test_a_function_is_translated_once_for_its_types_and_anew_for_each_constant() -> None:
    program = Program()
    translate(program, unrolled, [Expression("x", DOUBLE)], name="unrolled", public=True)
    heads = [head for head, _ in program.texts]
    assert [head.split("(")[0].replace("_", " ").split()[-1] for head in heads] == [
        "power",
        "power",
        "halved",
        "unrolled",
    ]
    assert [head.startswith("static ") for head in heads] == [True, True, True, False]


def of_two_types(x: float) -> float:
    """Give a name two types."""
    y: object = (x, x)
    y = x
    return y if y else x  # type: ignore[return-value]


def test_what_is_outside_the_subset_is_refused_with_its_place() -> None:
    """The place is that in the file: the line of `y = x` above."""
    line = of_two_types.__code__.co_firstlineno + 3
    with pytest.raises(Unsupported, match=rf"of_two_types, line {line}: .*in place of"):
        translate(Program(), of_two_types, [Expression("x", DOUBLE)])
