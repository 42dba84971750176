"""The types of C that the plain subset has: numbers, truth values, rows, and tuples as structs."""

from __future__ import annotations

from dataclasses import dataclass

DOUBLE, INT, BOOL, ROW, OUT = "double", "int", "bool", "const double *", "double *"
"""The types that are no tuple; ROW is read, OUT is written."""


@dataclass(frozen=True)
class Tuple:
    """The type of a tuple: those of its elements; the names of its members and its own, where it has some."""

    of: tuple[Type, ...]
    names: tuple[str, ...] = ()
    title: str = ""

    @property
    def even(self) -> bool:
        """Whether it is an array in C."""
        return not self.names and len(self.of) > 0 and len(set(self.of)) == 1

    def member(self, i: int) -> str:
        """How C names the element `i`."""
        if self.even:
            return f".v[{i}]"
        return "." + (self.names[i] if self.names else "abcdefghijklmnopqrstuvwxyz"[i])


Type = str | Tuple


def plain(kind: Type) -> Type:
    """Return the type that a variable has: a whole number is kept as a real one."""
    return DOUBLE if kind == INT else kind
