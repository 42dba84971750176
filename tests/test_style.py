"""The code as a reader meets it: linted, formatted, type-checked, and free of what does not belong."""

from __future__ import annotations

import ast
import importlib
import subprocess
import sys
from pathlib import Path

import pytest


@pytest.mark.parametrize(
    "tool",
    [
        ["ruff", "check", "."],
        ["ruff", "format", "--check", "."],
        pytest.param(
            ["mypy"],
            marks=pytest.mark.skipif(
                sys.version_info < (3, 11),
                reason="numpy 2.2, the last for Python 3.10, states its types otherwise; any Python checks for 3.10",
            ),
        ),
    ],
)
def test_tools_find_nothing(repository: Path, tool: list[str]) -> None:
    pytest.importorskip(tool[0])
    done = subprocess.run(
        [sys.executable, "-m", *tool], cwd=repository, capture_output=True, text=True, check=False
    )
    assert done.returncode == 0, done.stdout + done.stderr


def test_the_embedded_package_needs_the_standard_library_only(repository: Path) -> None:
    code = f"import sys; sys.path.insert(0, {str(repository / 'fmu_src')!r}); import radialtire"
    subprocess.run([sys.executable, "-I", "-S", "-c", code], check=True)


def test_the_licence_in_the_fmu_is_the_repositorys(repository: Path) -> None:
    packed = repository / "fmu_src" / "tirelab" / "fmu" / "license.txt"
    assert packed.read_text() == (repository / "LICENSE").read_text()


def test_no_helper_of_the_tests_hides_a_module_of_an_example(repository: Path) -> None:
    helpers = {p.name for p in (repository / "tests").rglob("*.py") if not p.name.startswith("test_")}
    assert not helpers & {p.name for p in (repository / "examples").rglob("*.py")}


def test_what_the_benchmarks_import_is_there(repository: Path) -> None:
    """No test runs them, so a name that moved would show only when somebody needs a figure."""
    for path in sorted((repository / "tests" / "benchmarks").glob("*.py")):
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
            if isinstance(node, ast.ImportFrom) and (node.module or "").split(".")[0] in (
                "tirelab",
                "concealed",
            ):
                module = importlib.import_module(str(node.module))
                assert all(hasattr(module, alias.name) for alias in node.names), (path.name, node.module)
