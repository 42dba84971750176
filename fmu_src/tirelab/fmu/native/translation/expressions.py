"""Expressions: names, constants, tuples and their elements, operators, comparisons, choices."""

from __future__ import annotations

import ast
from types import ModuleType
from typing import Any

from .body import Body
from .c_types import BOOL, DOUBLE, INT, OUT, ROW, Tuple, plain
from .expression import AND, ATOM, CHOICE, EQUAL, OR, UNARY, Expression, number

OPERATORS: dict[type, tuple[str, int]] = {
    ast.Add: ("+", 12),
    ast.Sub: ("-", 12),
    ast.Mult: ("*", 13),
    ast.Div: ("/", 13),
}
COMPARISONS: dict[type, str] = {
    ast.Lt: "<",
    ast.LtE: "<=",
    ast.Gt: ">",
    ast.GtE: ">=",
    ast.Eq: "==",
    ast.NotEq: "!=",
}


class Expressions(Body):
    """What computes a value; a method for each kind of expression of the subset."""

    def of(self, node: ast.expr) -> Expression:
        """Return any expression; refuse one of another kind."""
        method = getattr(self, f"of_{type(node).__name__.lower()}", None)
        if method is None:
            raise self.fail(node, "an expression outside the subset")
        found = method(node)
        assert isinstance(found, Expression)
        return found

    def truth(self, node: ast.expr) -> Expression:
        """Return a test."""
        found = self.of(node)
        if found.type != BOOL:
            raise self.fail(node, "a test of other than a truth value")
        return found

    def whole(self, node: ast.expr) -> Expression:
        """Return a whole number."""
        found = self.of(node)
        if found.type != INT:
            raise self.fail(node, "no whole number")
        return found if found.constant is None else number(int(found.constant))

    def of_constant(self, node: ast.Constant) -> Expression:
        if not isinstance(node.value, (bool, int, float)):
            raise self.fail(node, "no number")
        return number(node.value)

    def of_name(self, node: ast.Name) -> Expression:
        if node.id in self.fixed:
            return self.fixed[node.id]
        if node.id in self.types:
            return Expression(self.safe(node.id), self.types[node.id])
        if node.id not in self.scope:
            raise self.fail(node, "an unknown name")
        return self.known(node.id, self.scope[node.id], node)

    def known(self, name: str, value: Any, node: ast.AST) -> Expression:
        """Return a constant of a module."""
        if isinstance(value, (bool, int)):
            return number(value)
        if isinstance(value, float):
            module = self.function.__module__.rsplit(".", 1)[-1].upper()
            known = self.program.constants
            if known.setdefault(name, value) != value:
                name = f"{module}_{name}"
                known.setdefault(name, value)
            return Expression(name, DOUBLE)
        if isinstance(value, tuple):
            return Expression(name, "object", constant=value)
        raise self.fail(node, "a name that is no constant")

    def of_attribute(self, node: ast.Attribute) -> Expression:
        if isinstance(node.value, ast.Name) and isinstance(self.scope.get(node.value.id), ModuleType):
            return self.known(node.attr, getattr(self.scope[node.value.id], node.attr), node)
        owner = self.of(node.value)
        if owner.type == "object":
            value = getattr(owner.constant, node.attr)
            if isinstance(value, int):
                return Expression(node.attr if owner.text == "path" else str(value), INT, constant=value)
            return Expression(node.attr, "object", constant=value)
        if not isinstance(owner.type, Tuple) or self.safe(node.attr) not in owner.type.names:
            raise self.fail(node, "an unknown attribute")
        return self.parts(self.stored(owner))[owner.type.names.index(self.safe(node.attr))]

    def of_tuple(self, node: ast.Tuple) -> Expression:
        return self.tupled([self.of(element) for element in node.elts])

    def of_subscript(self, node: ast.Subscript) -> Expression:
        owner = self.of(node.value)
        if owner.type in (ROW, OUT):
            if not isinstance(node.slice, ast.Slice):
                return Expression(f"{owner.text}[{self.whole(node.slice).text}]", DOUBLE)
            first, last = self.bounds(node.slice)
            return self.tupled([Expression(f"{owner.text}[{i}]", DOUBLE) for i in range(first, last)])
        if not isinstance(owner.type, Tuple):
            raise self.fail(node, "no tuple")
        owner = self.stored(owner)
        if isinstance(node.slice, ast.Slice):
            first, last = self.bounds(node.slice, len(owner.type.of) if isinstance(owner.type, Tuple) else 0)
            return self.tupled(self.parts(owner)[first:last])
        index = self.whole(node.slice)
        if index.constant is not None:
            element: Expression = self.parts(owner)[index.constant]
            return element
        kind = owner.type
        if not isinstance(kind, Tuple) or not kind.even:
            raise self.fail(node, "a place in a tuple that is not known")
        if owner.parts is not None:
            owner = self.kept(owner)
        return Expression(f"{owner.text}.v[{index.text}]", kind.of[0])

    def bounds(self, node: ast.Slice, length: int = 0) -> tuple[int, int]:
        """Return the bounds of a slice, which must be constant."""
        first = 0 if node.lower is None else self.whole(node.lower).constant
        last = length if node.upper is None else self.whole(node.upper).constant
        if first is None or last is None or node.step is not None:
            raise self.fail(node, "a slice that is not constant")
        return first, last

    def of_unaryop(self, node: ast.UnaryOp) -> Expression:
        if isinstance(node.op, ast.Not):
            return Expression(f"!{self.truth(node.operand).within(UNARY)}", BOOL, UNARY)
        found = self.of(node.operand)
        if not isinstance(node.op, ast.USub) or found.type not in (DOUBLE, INT):
            raise self.fail(node, "an operator outside the subset")
        if found.constant is not None:
            return number(-found.constant)
        return Expression(f"-{found.within(ATOM)}", found.type, UNARY)

    def of_binop(self, node: ast.BinOp) -> Expression:
        a, b = self.of(node.left), self.of(node.right)
        if isinstance(a.type, Tuple) and isinstance(b.type, Tuple) and isinstance(node.op, ast.Add):
            return self.tupled([*self.parts(self.stored(a)), *self.parts(self.stored(b))])
        if a.type not in (DOUBLE, INT) or b.type not in (DOUBLE, INT):
            raise self.fail(node, "an operator outside the subset")
        if isinstance(node.op, ast.Pow):
            return Expression(f"pow({self.real(a, node)}, {self.real(b, node)})", DOUBLE)
        if type(node.op) not in OPERATORS:
            raise self.fail(node, "an operator outside the subset")
        sign, level = OPERATORS[type(node.op)]
        if a.type == b.type == INT and sign != "/":
            if a.constant is not None and b.constant is not None:
                known = {"+": a.constant + b.constant, "-": a.constant - b.constant}
                return number(known.get(sign, a.constant * b.constant))
            return Expression(f"{a.within(level)} {sign} {b.within(level + 1)}", INT, level)
        return Expression(
            f"{self.real(a, node, level)} {sign} {self.real(b, node, level + 1)}", DOUBLE, level
        )

    def of_boolop(self, node: ast.BoolOp) -> Expression:
        sign, level = ("&&", AND) if isinstance(node.op, ast.And) else ("||", OR)
        tests = [self.truth(value) for value in node.values]
        needed = [test for test in tests if sign == "||" or test.constant is not True] or tests[:1]
        return Expression(f" {sign} ".join(test.within(EQUAL) for test in needed), BOOL, level)

    def of_compare(self, node: ast.Compare) -> Expression:
        if len(node.ops) != 1 or type(node.ops[0]) not in COMPARISONS:
            raise self.fail(node, "a comparison outside the subset")
        a, b = self.of(node.left), self.of(node.comparators[0])
        sign = COMPARISONS[type(node.ops[0])]
        if a.type == b.type == INT:
            same = a.constant is not None and sign == "==" and a.constant == b.constant
            return Expression(f"{a.text} {sign} {b.text}", BOOL, EQUAL, True if same else None)
        return Expression(f"{self.real(a, node, 11)} {sign} {self.real(b, node, 11)}", BOOL, EQUAL)

    def of_ifexp(self, node: ast.IfExp) -> Expression:
        test, a, b = self.truth(node.test), self.of(node.body), self.of(node.orelse)
        kind = plain(a.type)
        text = f"{test.within(OR)} ? {self.fit(a, kind, node)} : {self.fit(b, kind, node)}"
        return Expression(text, kind, CHOICE)
