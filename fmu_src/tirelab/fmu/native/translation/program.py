"""A program in C: the functions translated so far, with the structs and constants that they use."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

from .c_types import DOUBLE, Tuple, Type


@dataclass
class Program:
    """The functions translated so far, with the structs and constants that they use."""

    structs: dict[Tuple, str] = field(default_factory=dict)
    definitions: list[str] = field(default_factory=list)
    constants: dict[str, float] = field(default_factory=dict)
    functions: dict[Any, tuple[str, Type]] = field(default_factory=dict)
    texts: list[tuple[str, str]] = field(default_factory=list)
    """The head and the body of every function."""

    def struct(self, kind: Type) -> str:
        """Return the name of a type in C, defining the struct where it is one."""
        if not isinstance(kind, Tuple):
            return kind
        if kind not in self.structs:
            if not kind.of:
                name, body = "Nothing", "char unused;"
            elif kind.even:
                inner = self.struct(kind.of[0])
                name = f"Vector{len(kind.of)}" if inner == DOUBLE else f"{inner}x{len(kind.of)}"
                body = f"{inner} v[{len(kind.of)}];"
            else:
                members = [f"{self.struct(t)} {kind.member(i)[1:]};" for i, t in enumerate(kind.of)]
                name, body = kind.title or f"Tuple{len(self.structs)}", " ".join(members)
            self.structs[kind] = name
            self.definitions.append(f"typedef struct {{ {body} }} {name};")
        return self.structs[kind]
