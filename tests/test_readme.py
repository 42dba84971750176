"""The README's promises that a machine can check."""

from __future__ import annotations

import re
import shutil
import subprocess
from pathlib import Path

import pytest


def commands(repository: Path) -> tuple[str, str]:
    found = re.findall(r"^python3 -m venv .*$", (repository / "README.md").read_text(), flags=re.MULTILINE)
    assert len(found) == 2
    return found[0], found[1]


def test_sections_stand_in_their_order(repository: Path) -> None:
    headings = re.findall(r"^## (.*)$", (repository / "README.md").read_text(), flags=re.MULTILINE)
    assert headings == [
        "Two commands",
        "What comes out",
        "How far it can be trusted",
        "The FMU's interface",
        "The Python API",
        "What it cannot do",
        "Where is what",
        "Contributing",
    ]


def test_links_lead_to_files(repository: Path) -> None:
    for target in re.findall(r"\]\(([^)#]+)\)", (repository / "README.md").read_text()):
        assert target.startswith("https://") or (repository / target).exists(), target


def test_the_api_example_runs(repository: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (code,) = re.findall(r"```python\n(.*?)```", (repository / "README.md").read_text(), flags=re.DOTALL)
    shutil.copytree(repository / "examples", tmp_path / "examples")
    monkeypatch.chdir(tmp_path)
    exec(compile(code, "README.md", "exec"), {})


@pytest.mark.slow
def test_the_main_command_from_a_clean_clone(repository: Path, tmp_path: Path) -> None:
    """Needs a package registry; everything it writes is inside the clone, its home stays empty."""
    clone, home = tmp_path / "clone", tmp_path / "home"
    home.mkdir()
    subprocess.run(["git", "clone", "-q", repository, clone], check=True)
    environment = {"PATH": "/usr/local/bin:/usr/bin:/bin", "HOME": str(home)}
    python = shutil.which("python3")
    assert python is not None
    environment["PATH"] = f"{Path(python).parent}:{environment['PATH']}"
    main, _ = commands(repository)
    done = subprocess.run(
        ["bash", "-c", main], cwd=clone, env=environment, capture_output=True, text=True, check=False
    )
    assert done.returncode == 0, done.stderr
    assert "Left out: rate-independent hysteresis" in done.stdout
    assert (clone / "dist" / "BicycleTire.fmu").is_file()
    assert list(home.iterdir()) == []
