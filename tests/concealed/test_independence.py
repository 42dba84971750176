"""The rig may share nothing with what it is there to prove."""

import ast
import subprocess
import sys
from pathlib import Path

import pytest

PROVED = {"radialtire", "tirelab", "bicycle_tire_fmu", "fmu_description"}
#: The rig stands on these alone; numba is not among them.
ALLOWED = {"concealed", "numpy", "scipy", "click"} | set(sys.stdlib_module_names)


def sources(repository: Path) -> list[Path]:
    return sorted((repository / "fmu_src" / "concealed").rglob("*.py"))


def imported(source: Path) -> set[str]:
    """Top-level packages that a module imports; a relative import leads to its own package."""
    package = source.parts[source.parts.index("fmu_src") + 1 : -1]
    names: set[str] = set()
    for node in ast.walk(ast.parse(source.read_text(encoding="utf-8"))):
        if isinstance(node, ast.Import):
            names |= {alias.name for alias in node.names}
        elif isinstance(node, ast.ImportFrom):
            assert node.level <= len(package), f"{source}: a relative import leaves the rig"
            names.add(package[0] if node.level else node.module or "")
    return {name.partition(".")[0] for name in names}


def test_no_module_imports_the_model_or_the_tool(repository: Path) -> None:
    found = {source.name: imported(source) & PROVED for source in sources(repository)}
    assert len(found) > 15
    assert not any(found.values()), found


def test_inside_the_rig_imports_are_relative(repository: Path) -> None:
    for source in sources(repository):
        tree = ast.parse(source.read_text(encoding="utf-8"))
        absolute = [n.module for n in ast.walk(tree) if isinstance(n, ast.ImportFrom) and not n.level]
        assert not [module for module in absolute if (module or "").startswith("concealed")], source


def test_only_numpy_scipy_and_click_are_needed(repository: Path) -> None:
    for source in sources(repository):
        assert imported(source) <= ALLOWED, source


@pytest.mark.parametrize("word", ["importlib", "__import__", "exec(", "eval("])
def test_nothing_is_imported_by_the_back_door(repository: Path, word: str) -> None:
    for source in sources(repository):
        assert word not in source.read_text(encoding="utf-8"), source


def test_it_draws_in_an_interpreter_that_cannot_import_them(repository: Path) -> None:
    program = f"""
import sys
class Blocked:
    def find_spec(self, name, path=None, target=None):
        if name.partition(".")[0] in {sorted(PROVED | {"numba"})!r}:
            raise ImportError(name + " is blocked")
sys.meta_path.insert(0, Blocked())
sys.path.insert(0, {str(repository / "fmu_src")!r})
import concealed
print(len(concealed.draw(5).train))
"""
    done = subprocess.run([sys.executable, "-I", "-c", program], capture_output=True, text=True, timeout=120)
    assert done.returncode == 0, done.stderr
    assert int(done.stdout) >= 1
