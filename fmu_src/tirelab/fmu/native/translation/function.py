"""Functions: each is translated once for the types of its arguments, and anew for each constant."""

from __future__ import annotations

import ast
import textwrap
from collections.abc import Callable
from types import FunctionType
from typing import Any

from .body import WIDTH
from .c_types import Type
from .expression import Expression, is_fixed
from .program import Program
from .statements import Statements


def translate(
    program: Program,
    function: Callable[..., Any],
    arguments: list[Expression],
    *,
    name: str = "",
    public: bool = False,
) -> tuple[str, Type]:
    """Return the name and the result's type of `function` for `arguments`, translating it the first time.

    Raises Unsupported, with the place, where something is outside the subset.
    """
    assert isinstance(function, FunctionType)
    kinds = tuple(("constant", id(a.constant)) if is_fixed(a) else a.type for a in arguments)
    key = (function, kinds)
    if key not in program.functions:
        one = _Function(program, function, arguments, name or _name_of(function, arguments))
        head, body = one.translated(public)
        program.functions[key] = (one.name, one.result)
        program.texts.append((head, body))
    return program.functions[key]


def _name_of(function: FunctionType, arguments: list[Expression]) -> str:
    module = function.__module__.rsplit(".", 1)[-1]
    suffixes = [a.text for a in arguments if is_fixed(a) and a.text.isidentifier() and a.text != "path"]
    words = [*([] if module == "flat_step" else [module]), function.__name__.strip("_"), *suffixes]
    return "_".join(words)


class _Function(Statements):
    """One function in translation."""

    def __init__(
        self, program: Program, function: FunctionType, arguments: list[Expression], name: str
    ) -> None:
        super().__init__(program, function)
        self.name = name
        self.result: Type = ""
        self.late: dict[str, Type] = {}
        self.unrolled = False
        self.parameters: list[str] = []
        for argument, parameter in zip(arguments, self.tree.args.args, strict=True):
            if is_fixed(argument):
                self.fixed[parameter.arg] = argument
            else:
                self.types[parameter.arg] = argument.type
                self.parameters.append(parameter.arg)

    def callee(self, function: FunctionType, arguments: list[Expression]) -> tuple[str, Type]:
        """Return what another function is called in this program."""
        return translate(self.program, function, arguments)

    def translated(self, public: bool) -> tuple[str, str]:
        """Return head and whole text of the function."""
        note = ast.get_docstring(self.tree)
        self.block(self.tree.body[1:] if note else self.tree.body)
        parameters = [self.declared(self.types[p], self.safe(p)) for p in self.parameters]
        result = self.program.struct(self.result) if self.result else "void"
        head = f"{'' if public else 'static inline '}{result} {self.name}({', '.join(parameters)})"
        late = [f"    {self.declared(kind, self.safe(n))};" for n, kind in self.late.items()]
        module = self.function.__module__.rpartition("radialtire.")[2]
        comment = (note or self.function.__name__).splitlines()[0].replace("*/", "* /")
        wrapped = textwrap.wrap(
            f"/* {module}.py: {comment} */", WIDTH, subsequent_indent="   ", break_long_words=False
        )
        wrapped_head = textwrap.wrap(head, WIDTH, subsequent_indent="    ", break_long_words=False)
        return head, "\n".join([*wrapped, *wrapped_head, "{", *late, *self.lines, "}", ""])
