"""Calls: of functions of the subset, of `math`, of what is built in, and of NamedTuples."""

from __future__ import annotations

import ast
import math
from abc import abstractmethod
from types import FunctionType, ModuleType
from typing import Any

from .c_types import DOUBLE, INT, Tuple, Type, plain
from .expression import UNARY, Expression, is_fixed
from .expressions import Expressions

_FUNCTIONS = """exp expm1 log log1p sqrt sin cos tan asin acos atan sinh cosh tanh asinh acosh atanh fabs hypot atan2
copysign floor ceil"""

FUNCTIONS = frozenset(_FUNCTIONS.split())
"""Functions of `math` that C has under the same name."""


class Calls(Expressions):
    """What calls something."""

    @abstractmethod
    def callee(self, function: FunctionType, arguments: list[Expression]) -> tuple[str, Type]:
        """Return the name in C and the result's type of a function of the subset, translating it the first time."""

    def of_call(self, node: ast.Call) -> Expression:
        if node.keywords:
            raise self.fail(node, "named arguments")
        arguments = [self.of(argument) for argument in node.args]
        called, word = self.called(node.func)
        if called is None:
            return self.built_in(word, arguments, node)
        if isinstance(called, ModuleType):
            if word not in FUNCTIONS:
                raise self.fail(node, "a function of math outside the subset")
            return Expression(f"{word}({', '.join(self.real(a, node) for a in arguments)})", DOUBLE)
        if isinstance(called, type) and issubclass(called, tuple) and hasattr(called, "_fields"):
            names = tuple(self.safe(name) for name in called._fields)
            kinds = tuple(plain(a.type) for a in arguments)
            return Expression("", Tuple(kinds, names, called.__name__), parts=tuple(arguments))
        if not isinstance(called, FunctionType):
            raise self.fail(node, "a call outside the subset")
        name, result = self.callee(called, arguments)
        passed = [self.fit(a, a.type, node) for a in arguments if not is_fixed(a)]
        return Expression(f"{name}({', '.join(passed)})", result or "void")

    def called(self, node: ast.expr) -> tuple[Any, str]:
        """Return the object that is called, and its word; None for one that is built in."""
        if isinstance(node, ast.Name):
            return self.scope.get(node.id), node.id
        if not isinstance(node, ast.Attribute) or not isinstance(node.value, ast.Name):
            raise self.fail(node, "a call outside the subset")
        owner = self.scope.get(node.value.id)
        if owner is math:
            return math, node.attr
        if isinstance(owner, ModuleType):
            return getattr(owner, node.attr), node.attr
        if node.value.id in self.fixed:
            return getattr(self.fixed[node.value.id].constant, node.attr), node.attr
        raise self.fail(node, "a call outside the subset")

    def built_in(self, word: str, arguments: list[Expression], node: ast.Call) -> Expression:
        """Return a call of what Python has without an import; min and max are those of the kernel's head."""
        if word in ("min", "max"):
            text = self.real(arguments[0], node)
            for argument in arguments[1:]:
                text = f"{'lesser' if word == 'min' else 'greater'}({text}, {self.real(argument, node)})"
            return Expression(text, DOUBLE)
        if len(arguments) != 1:
            raise self.fail(node, "a call outside the subset")
        (argument,) = arguments
        if word == "tuple" and isinstance(argument.type, Tuple):
            return argument
        if word == "abs":
            return Expression(f"fabs({self.real(argument, node)})", DOUBLE)
        if word == "float":
            return Expression(self.real(argument, node), DOUBLE, argument.binds)
        if word == "int" and argument.type == DOUBLE:
            return Expression(f"(int){argument.within(UNARY)}", INT, UNARY)
        raise self.fail(node, "a call outside the subset")
