"""No module of the diagnosis may know the rig."""

from __future__ import annotations

import ast
from pathlib import Path


def imported(source: Path) -> set[str]:
    names: set[str] = set()
    for node in ast.walk(ast.parse(source.read_text(encoding="utf-8"))):
        if isinstance(node, ast.Import):
            names |= {alias.name for alias in node.names}
        elif isinstance(node, ast.ImportFrom) and node.module and node.level == 0:
            names.add(node.module)
    return names


def importers(root: Path) -> set[str]:
    return {
        source.relative_to(root).as_posix()
        for source in root.rglob("*.py")
        if any(name.partition(".")[0] == "concealed" for name in imported(source))
    }


def test_only_the_blind_trials_import_the_rig(repository: Path) -> None:
    root = repository / "fmu_src"
    found = {name for name in importers(root) if not name.startswith("concealed/")}
    assert found
    assert all(name.startswith("tirelab/validation/") for name in found), found


def test_only_their_command_imports_the_blind_trials(repository: Path) -> None:
    root = repository / "fmu_src" / "tirelab"
    found = set()
    for source in root.rglob("*.py"):
        tree = ast.parse(source.read_text(encoding="utf-8"))
        for node in ast.walk(tree):
            module = node.module or "" if isinstance(node, ast.ImportFrom) else ""
            if module.split(".")[0] == "validation" or module.startswith("tirelab.validation"):
                found.add(source.relative_to(root).as_posix())
    assert found == {"cli/prove.py"}


def test_no_diagnosing_module_names_the_rig_at_all(repository: Path) -> None:
    root = repository / "fmu_src" / "tirelab"
    for source in root.rglob("*.py"):
        if "validation" not in source.relative_to(root).as_posix():
            assert "concealed" not in source.read_text(encoding="utf-8"), source
