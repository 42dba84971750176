"""Structs of a program: each is defined once, after those that it holds."""

from __future__ import annotations

from tirelab.fmu.native.translation.c_types import BOOL, DOUBLE, ROW, Tuple
from tirelab.fmu.native.translation.program import Program


def test_structs_are_defined_once_and_from_the_inside() -> None:
    program = Program()
    pair = Tuple((DOUBLE, DOUBLE))
    assert program.struct(ROW) == ROW
    assert program.struct(Tuple((pair, pair, pair))) == "Vector2x3"
    assert program.struct(pair) == "Vector2"
    assert program.struct(Tuple((DOUBLE, BOOL), ("force", "known"), "Answer")) == "Answer"
    assert program.definitions == [
        "typedef struct { double v[2]; } Vector2;",
        "typedef struct { Vector2 v[3]; } Vector2x3;",
        "typedef struct { double force; BOOL known; } Answer;".replace("BOOL", BOOL),
    ]
