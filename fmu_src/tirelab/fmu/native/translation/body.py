"""The body of a function in translation: its lines, its names with their types, and values made to fit a type."""

from __future__ import annotations

import ast
import inspect
import textwrap
from types import FunctionType
from typing import Any

from .c_types import BOOL, DOUBLE, INT, OUT, ROW, Tuple, Type, plain
from .expression import UNARY, Expression, number
from .neighbours import LONG, PLACE, run_of
from .program import Program

_RESERVED = """auto break case char const continue default do double else enum extern float for goto if inline int long
register restrict return short signed sizeof static struct switch typedef union unsigned void volatile while"""

RESERVED = frozenset(_RESERVED.split())

WIDTH = 116

_SIMPLE = str.maketrans(dict.fromkeys("_.[]", "a"))


class Unsupported(Exception):
    """Something outside the subset; the sentence says where."""


class Body:
    """What is written of one function.

    types: of its variables; fixed: names that are constants of this translation
    """

    def __init__(self, program: Program, function: FunctionType) -> None:
        self.program, self.function = program, function
        (tree,) = ast.parse(textwrap.dedent(inspect.getsource(function))).body
        assert isinstance(tree, ast.FunctionDef)
        self.tree = tree
        self.scope: dict[str, Any] = function.__globals__
        self.types: dict[str, Type] = {}
        self.fixed: dict[str, Expression] = {}
        self.lines: list[str] = []
        self.indent = 1
        self.temporaries = 0

    def fail(self, node: ast.AST, why: str) -> Unsupported:
        """Return the exception that says what is outside the subset, and where."""
        line = getattr(node, "lineno", 0) + self.function.__code__.co_firstlineno - 1
        return Unsupported(
            f"{self.function.__module__}.{self.function.__name__}, line {line}: {why}: {ast.unparse(node)[:90]}"
        )

    def put(self, line: str) -> None:
        """Write a line, wrapped."""
        space = "    "
        self.lines += textwrap.wrap(
            line,
            WIDTH,
            initial_indent=space * self.indent,
            subsequent_indent=space * (self.indent + 1),
            break_long_words=False,
            break_on_hyphens=False,
        )

    def declared(self, kind: Type, name: str) -> str:
        """Return a variable with its type, as C declares it."""
        word = self.program.struct(kind)
        return f"{word}{name}" if word.endswith("*") else f"{word} {name}"

    @staticmethod
    def safe(name: str) -> str:
        """Return a name that C has not reserved."""
        return name + "_" if name in RESERVED else name

    def temporary(self) -> str:
        """Return the name of a new variable."""
        self.temporaries += 1
        return f"t{self.temporaries}"

    def kept(self, found: Expression) -> Expression:
        """Return the expression in a variable of its own."""
        name = self.temporary()
        kind = plain(found.type)
        self.put(f"const {self.program.struct(kind)} {name} = {self.fit(found, kind, self.tree)};")
        return Expression(name, kind)

    def stored(self, found: Expression) -> Expression:
        """Return the expression as something whose elements can be named."""
        simple = found.parts is not None or found.constant is not None
        return found if simple or found.text.translate(_SIMPLE).isalnum() else self.kept(found)

    def parts(self, found: Expression) -> list[Expression]:
        """Return the elements of a tuple."""
        assert isinstance(found.type, Tuple)
        if found.parts is not None:
            return list(found.parts)
        return [Expression(f"{found.text}{found.type.member(i)}", t) for i, t in enumerate(found.type.of)]

    def tupled(self, parts: list[Expression]) -> Expression:
        """Return a tuple that is stored nowhere yet."""
        return Expression("", Tuple(tuple(plain(p.type) for p in parts)), parts=tuple(parts))

    def fit(self, found: Expression, wanted: Type, node: ast.AST) -> str:
        """Return the text of the expression as a value of a type."""
        if isinstance(wanted, Tuple):
            if not isinstance(found.type, Tuple) or len(found.type.of) != len(wanted.of):
                raise self.fail(node, f"{found.type} in place of {wanted}")
            if found.parts is None:
                if found.type != wanted:
                    raise self.fail(node, f"{found.type} in place of {wanted}")
                return found.text
            name = self.program.struct(wanted)
            inner = ", ".join(self.fit(p, t, node) for p, t in zip(found.parts, wanted.of, strict=True))
            if not wanted.of:
                return f"({name}){{0}}"
            texts = [p.text for p in found.parts]
            if wanted.even and wanted.of[0] == DOUBLE and LONG <= run_of(texts) == len(texts):
                row, at = PLACE.findall(texts[0])[0]
                if (
                    row.isidentifier()
                ):  # a struct of numbers may be read where numbers are: C99, 6.5 paragraph 7
                    return f"*(const {name} *)({row} + {at})"
            return f"({name}){{{{{inner}}}}}" if wanted.even else f"({name}){{{inner}}}"
        if found.type == wanted or (wanted == ROW and found.type == OUT):
            return found.text
        if wanted == DOUBLE and found.type in (INT, BOOL):
            if found.constant is not None:
                return number(float(found.constant)).text
            return f"(double){found.within(UNARY)}"
        raise self.fail(node, f"{found.type} in place of {wanted}")

    def real(self, found: Expression, node: ast.AST, level: int = 0) -> str:
        """Return the text of a number as a double, as an operand of something that binds as tightly as `level`."""
        if isinstance(found.type, Tuple) or found.type not in (DOUBLE, INT, BOOL):
            raise self.fail(node, "no number")
        if found.type == DOUBLE:
            return found.within(level)
        return Expression(self.fit(found, DOUBLE, node), DOUBLE, UNARY).within(level)
