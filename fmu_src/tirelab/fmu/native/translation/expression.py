"""An expression in C, with what its translation has to know of it."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

from .c_types import BOOL, DOUBLE, INT, Type

ATOM, UNARY, EQUAL, AND, OR, CHOICE = 16, 14, 10, 5, 4, 3
"""How tightly C binds."""


@dataclass(frozen=True)
class Expression:
    """An expression in C: its text, its type, how tightly it binds.

    constant: the object or number that it is at the time of translation; parts: the elements of a tuple not stored
    """

    text: str
    type: Type
    binds: int = ATOM
    constant: Any = None
    parts: tuple[Expression, ...] | None = None

    def within(self, level: int) -> str:
        """Return the text as an operand of something that binds as tightly as `level`."""
        return self.text if self.binds >= level else f"({self.text})"


def number(value: float) -> Expression:
    """Return a number as an expression."""
    if isinstance(value, bool):
        return Expression("true" if value else "false", BOOL, constant=value)
    if isinstance(value, int):
        return Expression(str(value), INT, ATOM if value >= 0 else UNARY, value)
    if math.isinf(value):
        return Expression("INFINITY" if value > 0 else "-INFINITY", DOUBLE, UNARY)
    return Expression(repr(value), DOUBLE, ATOM if value >= 0 else UNARY, value)


def is_fixed(argument: Expression) -> bool:
    """Whether the function called is translated for the very value."""
    return argument.constant is not None and (argument.type == "object" or argument.type == INT)
