"""The README's promises that a machine can check."""

from __future__ import annotations

import re
import shutil
import subprocess
import venv
from pathlib import Path

import pytest
from radialtire import CATALOGUE
from tirelab.report.titles import full_title


def commands(repository: Path) -> tuple[str, str]:
    found = re.findall(r"^python3 -m venv .*$", (repository / "README.md").read_text(), flags=re.MULTILINE)
    assert len(found) == 2
    return found[0], found[1]


def test_sections_stand_in_their_order(repository: Path) -> None:
    headings = re.findall(r"^## (.*)$", (repository / "README.md").read_text(), flags=re.MULTILINE)
    assert headings == [
        "Two commands",
        "Your own tire in five minutes",
        "The effects it can name",
        "Which FMU",
        "Python in ten lines",
        "How far it can be trusted",
        "Where the rest stands",
        "Contributing",
    ]


def test_the_readme_is_short(repository: Path) -> None:
    assert len((repository / "README.md").read_text().splitlines()) <= 150


@pytest.mark.parametrize(
    ("page", "begins"),
    [
        ("README.md", "## Your own tire in five minutes\n\n"),
        ("examples/docs/five_minutes.md", "# Your own tire in five minutes\n\n"),
    ],
)
def test_tirelab_is_a_command_before_the_reader_types_it(
    repository: Path, tmp_path: Path, page: str, begins: str
) -> None:
    task = (repository / page).read_text(encoding="utf-8").partition(begins)[2]
    (line, *again) = re.findall(r"\. \.venv/bin/activate", task)
    assert again == []
    assert task.index(line) < min(m.start() for m in re.finditer(r"`tirelab \w|\$ tirelab ", task))
    venv.create(tmp_path / ".venv", with_pip=False)
    program = tmp_path / ".venv" / "bin" / "tirelab"
    program.write_text("#!/bin/sh\necho it runs\n")
    program.chmod(0o755)
    for before, status in (("", 127), (f"{line} && ", 0)):
        done = subprocess.run(
            ["bash", "-c", f"{before}tirelab"], cwd=tmp_path, env={"PATH": "/usr/bin:/bin"}, check=False
        )
        assert done.returncode == status


def test_every_effect_is_in_the_table_of_effects(repository: Path) -> None:
    text = (repository / "README.md").read_text().lower()
    names = [name for name, effect in CATALOGUE.items() if "law" not in effect.traits]
    assert [n for n in names if f"| {full_title(n).lower()} |" not in text] == []


def test_pages_lead_to_files(repository: Path) -> None:
    pages = (repository / "examples" / "docs").glob("*.md")
    links = [(p, t) for p in pages for t in re.findall(r"\]\(([^)#]+)\)", p.read_text())]
    assert [
        (p.name, t) for p, t in links if not t.startswith("https://") and not (p.parent / t).exists()
    ] == []


def test_a_file_is_shown_as_it_is(repository: Path) -> None:
    (sample,) = re.findall(
        r"^```\n(time .*?)```", (repository / "README.md").read_text(), re.MULTILINE | re.DOTALL
    )
    press = (repository / "examples" / "recordings" / "press" / "fast.csv").read_text()
    assert len(sample.splitlines()) == 3
    assert press.startswith(sample)


def test_the_time_of_a_diagnosis_is_told_alike(repository: Path) -> None:
    (told,) = re.findall(r"the missing physics, in (.*) s \|", (repository / "README.md").read_text())
    page = (repository / "examples" / "docs" / "five_minutes.md").read_text()
    assert f"| `diagnose` | {told};" in page


def test_links_lead_to_files(repository: Path) -> None:
    for target in re.findall(r"\]\(([^)#]+)\)", (repository / "README.md").read_text()):
        assert target.startswith("https://") or (repository / target).exists(), target


def test_the_api_example_runs(repository: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (code,) = re.findall(r"```python\n(.*?)```", (repository / "README.md").read_text(), flags=re.DOTALL)
    assert len([line for line in code.splitlines() if line.strip()]) == 10
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
    assert "Left out: friction loop (rate-independent hysteresis)" in done.stdout
    assert (clone / "dist" / "BicycleTire.fmu").is_file()
    assert list(home.iterdir()) == []
