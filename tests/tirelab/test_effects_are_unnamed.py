"""The engine knows no effect by its name: what it needs, an effect declares or shows by its response."""

from __future__ import annotations

import ast
from pathlib import Path

import pytest
from radialtire import CATALOGUE
from tirelab.names import REFITTED_LAW

ROOMS = ("preprocessing", "regressors", "selection", "estimation", "diagnosis")


def strings(path: Path) -> set[str]:
    """The texts in a module's code, without its docstrings and those beside constants."""
    tree = ast.parse(path.read_text(encoding="utf-8"))
    prose = {id(n.value) for n in ast.walk(tree) if isinstance(n, ast.Expr)}
    return {
        n.value
        for n in ast.walk(tree)
        if isinstance(n, ast.Constant) and isinstance(n.value, str) and id(n) not in prose
    }


@pytest.mark.parametrize("room", ROOMS)
def test_no_effect_is_named_in_the_code(repository: Path, room: str) -> None:
    modules = list((repository / "fmu_src" / "tirelab" / room).rglob("*.py"))
    assert len(modules) > 1
    for path in modules:
        assert not strings(path) & {*CATALOGUE, REFITTED_LAW}, path


def test_a_name_would_be_found(tmp_path: Path) -> None:
    module = tmp_path / "module.py"
    module.write_text('"""inertia"""\nif name == "inertia":\n    pass\n')
    assert strings(module) == {"inertia"}
