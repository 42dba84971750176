"""Statements: branches, loops and what a function returns; a loop over a constant is unrolled."""

from __future__ import annotations

import ast

from .assignments import Assignments
from .c_types import INT, Type, plain
from .expression import Expression, number


class Statements(Assignments):
    """What a function does; a method for each kind of statement of the subset."""

    result: Type

    def block(self, body: list[ast.stmt]) -> None:
        """Write statements; refuse one of another kind."""
        for node in body:
            method = getattr(self, f"do_{type(node).__name__.lower()}", None)
            if method is None:
                raise self.fail(node, "a statement outside the subset")
            method(node)

    def nested(self, body: list[ast.stmt]) -> None:
        """Write statements one level further in."""
        self.indent += 1
        self.block(body)
        self.indent -= 1

    def do_expr(self, node: ast.Expr) -> None:
        if isinstance(node.value, ast.Constant):
            return
        called = self.of(node.value)
        self.put(f"{called.text};")

    def do_break(self, node: ast.Break) -> None:
        self.put("break;")

    def do_if(self, node: ast.If) -> None:
        if self.never(node.test):
            self.block(node.orelse)
            return
        self.put(f"if ({self.truth(node.test).text}) {{")
        self.nested(node.body)
        other = node.orelse
        while len(other) == 1 and isinstance(other[0], ast.If):
            branch = other[0]
            before = len(self.lines)
            test = self.truth(branch.test).text
            if len(self.lines) != before:
                raise self.fail(branch, "a test that needs a variable of its own")
            self.put(f"}} else if ({test}) {{")
            self.nested(branch.body)
            other = branch.orelse
        if other:
            self.put("} else {")
            self.nested(other)
        self.put("}")

    def never(self, test: ast.expr) -> bool:
        """Whether a test, or the first one of several that must all hold, is false of constants."""
        if isinstance(test, ast.BoolOp) and isinstance(test.op, ast.And):
            return self.never(test.values[0])
        if not isinstance(test, ast.Compare) or not isinstance(test.left, ast.Attribute):
            return False
        a, b = self.of(test.left), self.of(test.comparators[0])
        known = a.constant is not None and b.constant is not None and isinstance(test.ops[0], ast.Eq)
        return known and bool(a.constant != b.constant)

    def do_while(self, node: ast.While) -> None:
        before = len(self.lines)
        test = self.truth(node.test).text
        if len(self.lines) != before or node.orelse:
            raise self.fail(node, "a loop outside the subset")
        self.put(f"while ({test}) {{")
        self.nested(node.body)
        self.put("}")

    def do_for(self, node: ast.For) -> None:
        if node.orelse or not isinstance(node.target, ast.Name):
            raise self.fail(node, "a loop outside the subset")
        if (
            isinstance(node.iter, ast.Call)
            and isinstance(node.iter.func, ast.Name)
            and node.iter.func.id == "range"
        ):
            self.count(node, node.iter, node.target.id)
            return
        over = self.of(node.iter)
        if not isinstance(over.constant, tuple):
            raise self.fail(node, "a loop over other than a range or a constant")
        for item in over.constant:
            self.fixed[node.target.id] = Expression("item", "object", constant=item)
            before, self.unrolled = (dict(self.types), dict(self.fixed)), True
            self.block(node.body)
            (self.types, self.fixed), self.unrolled = before, False

    def count(self, node: ast.For, call: ast.Call, target: str) -> None:
        """Write a loop over a range."""
        bounds = [self.of(argument) for argument in call.args]
        if any(bound.type != INT for bound in bounds):
            raise self.fail(node, "a range of other than whole numbers")
        if len(bounds) == 1:
            bounds.insert(0, number(0))
        step = bounds[2].constant if len(bounds) == 3 else 1
        name = self.temporary() if target == "_" else self.safe(target)
        self.types[target] = INT
        onward = {1: f"{name}++", -1: f"{name}--"}.get(step, f"{name} += {step}")
        sign = "<" if step > 0 else ">"
        self.put(f"for (int {name} = {bounds[0].text}; {name} {sign} {bounds[1].text}; {onward}) {{")
        self.nested(node.body)
        self.put("}")

    def do_return(self, node: ast.Return) -> None:
        if node.value is None:
            self.put("return;")
            return
        found = self.of(node.value)
        if not self.result:
            self.result = plain(found.type)
        self.put(f"return {self.fit(found, self.result, node)};")
