"""Translates the plain subset of Python, in which the physics is written, to readable C99.

The subset: floats, ints, bools, tuples of fixed length, rows of floats that are indexed (pointers in C), `math`, calls
of functions of the subset by their names or on constants, if, while, for over a range. A name has one type. A function
is translated for the types of its arguments. Arguments that are not numbers (a SignalPath, its stages) and whole
numbers are constants of a translation: a loop over a constant tuple is unrolled, and a function is translated anew for
each constant. Anything else raises Unsupported with its place: nothing is guessed.

A tuple becomes a struct: of equal elements with an array v, else with members a, b, c, or the names of a NamedTuple.
"""

from __future__ import annotations

import ast
import inspect
import math
import re
import textwrap
from collections.abc import Callable
from dataclasses import dataclass, field
from types import FunctionType, ModuleType
from typing import Any

DOUBLE, INT, BOOL, ROW, OUT = "double", "int", "bool", "const double *", "double *"
"""The types that are no tuple; ROW is read, OUT is written."""

_FUNCTIONS = """exp expm1 log log1p sqrt sin cos tan asin acos atan sinh cosh tanh asinh acosh atanh fabs hypot atan2
copysign floor ceil"""

FUNCTIONS = frozenset(_FUNCTIONS.split())
"""Functions of `math` that C has under the same name."""

_RESERVED = """auto break case char const continue default do double else enum extern float for goto if inline int long
register restrict return short signed sizeof static struct switch typedef union unsigned void volatile while"""

RESERVED = frozenset(_RESERVED.split())

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
ATOM, UNARY, EQUAL, AND, OR, CHOICE = 16, 14, 10, 5, 4, 3
"""How tightly C binds."""

WIDTH = 116

PLACE = re.compile(r"^(.+)\[(\d+)\]$")
"""A number at a constant place of a row or of an array."""

LONG = 4
"""So many neighbours are copied at once."""


def run_of(texts: list[str]) -> int:
    """Return how many texts from the first on name neighbours: x[3], x[4], x[5]."""
    found = [PLACE.match(text) for text in texts]
    count = 1
    while count < len(texts):
        a, b = found[count - 1], found[count]
        if a is None or b is None or a[1] != b[1] or int(b[2]) != int(a[2]) + 1:
            break
        count += 1
    return count


class Unsupported(Exception):
    """Something outside the subset; the sentence says where."""


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


def _plain(kind: Type) -> Type:
    return DOUBLE if kind == INT else kind


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

    def function(
        self,
        function: Callable[..., Any],
        arguments: list[Expression],
        *,
        name: str = "",
        public: bool = False,
    ) -> tuple[str, Type]:
        """Return the name and the result's type of `function` for `arguments`, translating it the first time."""
        assert isinstance(function, FunctionType)
        kinds = tuple(("constant", id(a.constant)) if _fixed(a) else a.type for a in arguments)
        key = (function, kinds)
        if key not in self.functions:
            one = _Function(self, function, arguments, name or _name_of(function, arguments))
            head, body = one.translated(public)
            self.functions[key] = (one.name, one.result)
            self.texts.append((head, body))
        return self.functions[key]


def _fixed(argument: Expression) -> bool:
    """Whether the function called is translated for the very value."""
    return argument.constant is not None and (argument.type == "object" or argument.type == INT)


def _name_of(function: FunctionType, arguments: list[Expression]) -> str:
    module = function.__module__.rsplit(".", 1)[-1]
    suffixes = [a.text for a in arguments if _fixed(a) and a.text.isidentifier() and a.text != "path"]
    words = [*([] if module == "flat_step" else [module]), function.__name__.strip("_"), *suffixes]
    return "_".join(words)


class _Function:
    """One function in translation."""

    def __init__(
        self, program: Program, function: FunctionType, arguments: list[Expression], name: str
    ) -> None:
        self.program, self.function, self.name = program, function, name
        (tree,) = ast.parse(textwrap.dedent(inspect.getsource(function))).body
        assert isinstance(tree, ast.FunctionDef)
        self.tree = tree
        self.scope: dict[str, Any] = function.__globals__
        self.types: dict[str, Type] = {}
        self.fixed: dict[str, Expression] = {}
        self.result: Type = ""
        self.lines: list[str] = []
        self.late: dict[str, Type] = {}
        self.indent = 1
        self.unrolled = False
        self.temporaries = 0
        self.parameters: list[str] = []
        for argument, parameter in zip(arguments, tree.args.args, strict=True):
            if _fixed(argument):
                self.fixed[parameter.arg] = argument
            else:
                self.types[parameter.arg] = argument.type
                self.parameters.append(parameter.arg)

    def translated(self, public: bool) -> tuple[str, str]:
        """Return head and whole text of the function."""
        note = ast.get_docstring(self.tree)
        self.block(self.tree.body[1:] if note else self.tree.body)
        parameters = [self.declared(self.types[p], self.safe(p)) for p in self.parameters]
        result = self.program.struct(self.result) if self.result else "void"
        head = f"{'' if public else 'static '}{result} {self.name}({', '.join(parameters)})"
        late = [f"    {self.declared(kind, self.safe(n))};" for n, kind in self.late.items()]
        module = self.function.__module__.rpartition("radialtire.")[2]
        comment = (note or self.function.__name__).splitlines()[0].replace("*/", "* /")
        wrapped = textwrap.wrap(
            f"/* {module}.py: {comment} */", WIDTH, subsequent_indent="   ", break_long_words=False
        )
        wrapped_head = textwrap.wrap(head, WIDTH, subsequent_indent="    ", break_long_words=False)
        return head, "\n".join([*wrapped, *wrapped_head, "{", *late, *self.lines, "}", ""])

    def declared(self, kind: Type, name: str) -> str:
        word = self.program.struct(kind)
        return f"{word}{name}" if word.endswith("*") else f"{word} {name}"

    @staticmethod
    def safe(name: str) -> str:
        return name + "_" if name in RESERVED else name

    def fail(self, node: ast.AST, why: str) -> Unsupported:
        line = getattr(node, "lineno", 0) + self.function.__code__.co_firstlineno - 1
        return Unsupported(
            f"{self.function.__module__}.{self.function.__name__}, line {line}: {why}: {ast.unparse(node)[:90]}"
        )

    def put(self, line: str) -> None:
        space = "    "
        self.lines += textwrap.wrap(
            line,
            WIDTH,
            initial_indent=space * self.indent,
            subsequent_indent=space * (self.indent + 1),
            break_long_words=False,
            break_on_hyphens=False,
        )

    # Statements.

    def block(self, body: list[ast.stmt]) -> None:
        for node in body:
            method = getattr(self, f"do_{type(node).__name__.lower()}", None)
            if method is None:
                raise self.fail(node, "a statement outside the subset")
            method(node)

    def nested(self, body: list[ast.stmt]) -> None:
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
            self.result = _plain(found.type)
        self.put(f"return {self.fit(found, self.result, node)};")

    def do_annassign(self, node: ast.AnnAssign) -> None:
        assert node.value is not None
        self.assign(node.target, self.of(node.value))

    def do_augassign(self, node: ast.AugAssign) -> None:
        assert isinstance(node.target, ast.Name)
        right = self.of(node.value)
        if type(node.op) not in OPERATORS:
            raise self.fail(node, "an operator outside the subset")
        kind = self.types[node.target.id]
        self.put(f"{self.safe(node.target.id)} {OPERATORS[type(node.op)][0]}= {self.fit(right, kind, node)};")

    def do_assign(self, node: ast.Assign) -> None:
        target = node.targets[0]
        if len(node.targets) == 1 and isinstance(node.value, ast.Tuple) and isinstance(target, ast.Tuple):
            self.together(target.elts, node.value.elts, node)
            return
        found = self.of(node.value)
        if len(node.targets) > 1 and not isinstance(found.type, Tuple) and found.constant is None:
            found = self.kept(found)
        for other in reversed(node.targets):
            self.assign(other, found)

    def together(self, targets: list[ast.expr], values: list[ast.expr], node: ast.Assign) -> None:
        if len(targets) != len(values):
            raise self.fail(node, "sides of different length")
        names = [t.id if isinstance(t, ast.Name) else "" for t in targets]
        uses = [{n.id for n in ast.walk(v) if isinstance(n, ast.Name)} for v in values]
        crossing = any(names[k] in use for k in range(len(names)) for use in uses[k + 1 :])
        found = [self.of(v) for v in values]
        if crossing:
            found = [self.kept(x) for x in found]
        for target, one in zip(targets, found, strict=True):
            self.assign(target, one)

    def assign(self, target: ast.expr, found: Expression) -> None:
        if isinstance(target, ast.Tuple):
            self.unpack(target, found)
        elif isinstance(target, ast.Subscript):
            self.write(target, found)
        elif isinstance(target, ast.Name):
            self.declare(target, found)
        else:
            raise self.fail(target, "an assignment outside the subset")

    def unpack(self, target: ast.Tuple, found: Expression) -> None:
        if not isinstance(found.type, Tuple) or len(found.type.of) != len(target.elts):
            raise self.fail(target, "a tuple of another length")
        parts = self.parts(self.stored(found))
        todo = [
            (t, p)
            for t, p in zip(target.elts, parts, strict=True)
            if not (isinstance(t, ast.Name) and t.id == "_")
        ]
        names = [t.id for t, _ in todo if isinstance(t, ast.Name)]
        new = self.indent == 1 and len(names) == len(todo) and not any(n in self.types for n in names)
        if new and all(p.type == DOUBLE for _, p in todo):
            self.types |= dict.fromkeys(names, DOUBLE)
            self.put(
                f"double {', '.join(f'{self.safe(n)} = {p.text}' for n, (_, p) in zip(names, todo, strict=True))};"
            )
            return
        for t, p in todo:
            self.assign(t, p)

    def write(self, target: ast.Subscript, found: Expression) -> None:
        """Write into a row: one number, or a tuple into a slice of its length."""
        row = self.of(target.value)
        if row.type != OUT:
            raise self.fail(target, "what is written to is no row")
        if not isinstance(target.slice, ast.Slice):
            self.put(f"{row.text}[{self.of(target.slice).text}] = {self.fit(found, DOUBLE, target)};")
            return
        first, last = self.bounds(target.slice)
        if not isinstance(found.type, Tuple) or len(found.type.of) != last - first:
            raise self.fail(target, "a slice of another length")
        parts = self.parts(self.stored(found)) if last > first else []
        texts = [self.fit(part, DOUBLE, target) for part in parts]
        while texts:
            count = run_of(texts)
            if count >= LONG:
                source, at = PLACE.findall(texts[0])[0]
                moved = f"i + {at}" if at != "0" else "i"
                self.put(f"for (int i = 0; i < {count}; i++)")
                self.put(f"    {row.text}[{first} + i] = {source}[{moved}];")
            else:
                count = 1
                self.put(f"{row.text}[{first}] = {texts[0]};")
            first, texts = first + count, texts[count:]

    def declare(self, target: ast.Name, found: Expression) -> None:
        if found.type == "object":
            raise self.fail(target, "a constant object in a variable")
        if found.type == Tuple(()) and target.id not in self.types:
            self.fixed[target.id] = Expression("", Tuple(()), parts=())
            return
        if target.id not in self.types:
            kind = found.type
            self.types[target.id] = kind
            if self.indent == 1 or self.unrolled:
                self.put(f"{self.declared(kind, self.safe(target.id))} = {self.fit(found, kind, target)};")
                return
            self.late[target.id] = kind
        self.put(f"{self.safe(target.id)} = {self.fit(found, self.types[target.id], target)};")

    # Expressions.

    def temporary(self) -> str:
        self.temporaries += 1
        return f"t{self.temporaries}"

    def kept(self, found: Expression) -> Expression:
        """Return the expression in a variable of its own."""
        name = self.temporary()
        kind = _plain(found.type)
        self.put(f"const {self.program.struct(kind)} {name} = {self.fit(found, kind, self.tree)};")
        return Expression(name, kind)

    def stored(self, found: Expression) -> Expression:
        """Return the expression as something whose elements can be named."""
        simple = found.parts is not None or found.constant is not None
        return found if simple or found.text.translate(_SIMPLE).isalnum() else self.kept(found)

    def parts(self, found: Expression) -> list[Expression]:
        assert isinstance(found.type, Tuple)
        if found.parts is not None:
            return list(found.parts)
        return [Expression(f"{found.text}{found.type.member(i)}", t) for i, t in enumerate(found.type.of)]

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
        if isinstance(found.type, Tuple) or found.type not in (DOUBLE, INT, BOOL):
            raise self.fail(node, "no number")
        if found.type == DOUBLE:
            return found.within(level)
        return Expression(self.fit(found, DOUBLE, node), DOUBLE, UNARY).within(level)

    def truth(self, node: ast.expr) -> Expression:
        found = self.of(node)
        if found.type != BOOL:
            raise self.fail(node, "a test of other than a truth value")
        return found

    def of(self, node: ast.expr) -> Expression:
        method = getattr(self, f"of_{type(node).__name__.lower()}", None)
        if method is None:
            raise self.fail(node, "an expression outside the subset")
        found = method(node)
        assert isinstance(found, Expression)
        return found

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

    def tupled(self, parts: list[Expression]) -> Expression:
        return Expression("", Tuple(tuple(_plain(p.type) for p in parts)), parts=tuple(parts))

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

    def whole(self, node: ast.expr) -> Expression:
        found = self.of(node)
        if found.type != INT:
            raise self.fail(node, "no whole number")
        return found if found.constant is None else number(int(found.constant))

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
        kind = _plain(a.type)
        text = f"{test.within(OR)} ? {self.fit(a, kind, node)} : {self.fit(b, kind, node)}"
        return Expression(text, kind, CHOICE)

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
            kinds = tuple(_plain(a.type) for a in arguments)
            return Expression("", Tuple(kinds, names, called.__name__), parts=tuple(arguments))
        if not isinstance(called, FunctionType):
            raise self.fail(node, "a call outside the subset")
        name, result = self.program.function(called, arguments)
        passed = [self.fit(a, a.type, node) for a in arguments if not _fixed(a)]
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


_SIMPLE = str.maketrans(dict.fromkeys("_.[]", "a"))
