"""Assignments: to names, to several at once, to places of a row."""

from __future__ import annotations

import ast

from .c_types import DOUBLE, OUT, Tuple, Type
from .calls import Calls
from .expression import Expression
from .expressions import OPERATORS
from .neighbours import LONG, PLACE, run_of


class Assignments(Calls):
    """What gives a name or a place its value; a name first met in a branch is declared at the function's top."""

    late: dict[str, Type]
    unrolled: bool

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
        """Give several names their values at once, each read before it is overwritten."""
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
        """Give one target its value, whatever kind of target it is."""
        if isinstance(target, ast.Tuple):
            self.unpack(target, found)
        elif isinstance(target, ast.Subscript):
            self.write(target, found)
        elif isinstance(target, ast.Name):
            self.declare(target, found)
        else:
            raise self.fail(target, "an assignment outside the subset")

    def unpack(self, target: ast.Tuple, found: Expression) -> None:
        """Give the elements of a tuple to names."""
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
        """Give a name its value; the first time it is declared with the value's type."""
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
