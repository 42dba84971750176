"""The figures of the house, measured from the imports: `python tests/house.py` prints them.

A room is a package or module directly under `fmu_src` or `fmu_src/tirelab`. Its level is one more than that of the
highest room it imports; every import counts, those inside of functions and those for the type checker too. The face of
`tirelab` (`__init__.py`) only names what the rooms offer and is no room.
"""

from __future__ import annotations

import ast
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

SOURCE = Path(__file__).resolve().parents[1] / "fmu_src"

MOST_PARAMETERS = 6

MUTABLE = ("list", "dict", "set", "bytearray", "defaultdict", "deque")


@dataclass(frozen=True)
class House:
    """Rooms with the rooms that each imports, files with the files that each imports, by their dotted names."""

    rooms: dict[str, frozenset[str]]
    files: dict[str, frozenset[str]]

    @property
    def flat(self) -> list[str]:
        """Modules that lie flat in `tirelab`, its face among them."""
        return sorted(p.stem for p in (SOURCE / "tirelab").glob("*.py"))

    def levels(self) -> dict[str, int]:
        """Return the level of every room; raises ValueError where rooms import each other in a circle."""
        if circle := circle_in(self.rooms):
            raise ValueError(f"these rooms import each other: {' -> '.join(circle)}")
        found: dict[str, int] = {}

        def level(room: str) -> int:
            if room not in found:
                found[room] = 1 + max((level(other) for other in self.rooms[room]), default=0)
            return found[room]

        return {room: level(room) for room in self.rooms}


def measure() -> House:
    """Return the house as its imports have it."""
    modules = {_dotted(path): path for path in SOURCE.rglob("*.py") if "egg-info" not in str(path)}
    files = {
        name: frozenset(_imported(name, path, modules.keys())) - {name}
        for name, path in modules.items()
        if name != "tirelab"
    }
    rooms: dict[str, set[str]] = {_room(name): set() for name in files}
    for name, others in files.items():
        rooms[_room(name)] |= {_room(other) for other in others if other != "tirelab"} - {_room(name)}
    return House({room: frozenset(others) for room, others in rooms.items()}, files)


def circle_in(graph: dict[str, frozenset[str]]) -> list[str]:
    """Return one circle of a graph, or nothing."""
    done: set[str] = set()

    def walk(node: str, path: list[str]) -> list[str]:
        if node in path:
            return [*path[path.index(node) :], node]
        if node in done:
            return []
        for other in sorted(graph.get(node, ())):
            if found := walk(other, [*path, node]):
                return found
        done.add(node)
        return []

    return next((found for node in sorted(graph) if (found := walk(node, []))), [])


def long_functions() -> list[str]:
    """Return the functions with more than MOST_PARAMETERS parameters, `self` not counted."""
    found = []
    for where, tree in _trees():
        for node in ast.walk(tree):
            if isinstance(node, (ast.FunctionDef, ast.AsyncFunctionDef, ast.Lambda)):
                a = node.args
                names = [
                    x.arg for x in (*a.posonlyargs, *a.args, *a.kwonlyargs) if x.arg not in ("self", "cls")
                ]
                if len(names) > MOST_PARAMETERS:
                    found.append(f"{where}:{node.lineno} has {len(names)} parameters")
    return found


def mutable_fields() -> list[str]:
    """Return the fields of frozen dataclasses that hold what can be changed."""
    found = []
    for where, tree in _trees():
        for node in ast.walk(tree):
            if isinstance(node, ast.ClassDef) and _is_frozen(node):
                found += [
                    f"{where}:{field.lineno} {node.name}.{ast.unparse(field.target)}: {ast.unparse(field.annotation)}"
                    for field in node.body
                    if isinstance(field, ast.AnnAssign) and _names(field.annotation) & set(MUTABLE)
                ]
    return found


def _is_frozen(node: ast.ClassDef) -> bool:
    return any(
        "dataclass(" in (text := ast.unparse(d)) and "frozen=True" in text for d in node.decorator_list
    )


def _names(node: ast.expr) -> set[str]:
    return {n.id for n in ast.walk(node) if isinstance(n, ast.Name)}


def _trees() -> Iterator[tuple[str, ast.Module]]:
    for path in sorted(SOURCE.rglob("*.py")):
        yield path.relative_to(SOURCE).as_posix(), ast.parse(path.read_text(encoding="utf-8"))


def _dotted(path: Path) -> str:
    parts = path.relative_to(SOURCE).with_suffix("").parts
    return ".".join(parts[:-1] if parts[-1] == "__init__" else parts)


def _room(module: str) -> str:
    parts = module.split(".")
    return ".".join(parts[:2]) if parts[0] == "tirelab" else parts[0]


def _imported(name: str, path: Path, modules: object) -> Iterator[str]:
    package = name if path.name == "__init__.py" else name.rpartition(".")[0]
    for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
        if isinstance(node, ast.Import):
            wanted = [alias.name for alias in node.names]
        elif isinstance(node, ast.ImportFrom):
            parts = package.split(".")
            start = ".".join(parts[: len(parts) - node.level + 1]) if node.level else ""
            base = ".".join(x for x in (start, node.module or "") if x)
            wanted = [f"{base}.{alias.name}" for alias in node.names]
        else:
            continue
        for target in wanted:
            while target and target not in modules:  # type: ignore[operator]
                target = target.rpartition(".")[0]
            if target:
                yield target


def main() -> None:
    """Print the figures."""
    house = measure()
    levels = house.levels()
    for number in range(max(levels.values()), 0, -1):
        print(f"level {number}: {', '.join(sorted(room for room, at in levels.items() if at == number))}")
    print(
        f"{len(house.rooms)} rooms on {max(levels.values())} levels, {len(house.flat)} modules flat in tirelab"
    )
    print(f"circles of files: {' -> '.join(circle_in(house.files)) or 'none'}")
    for title, found in (("too many parameters", long_functions()), ("mutable fields", mutable_fields())):
        print(f"{title}: {len(found)}", *found, sep="\n  ")


if __name__ == "__main__":
    main()
