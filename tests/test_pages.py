"""Every command in the README and the pages is understood, and every session prints what is shown."""

from __future__ import annotations

import importlib
import re
import shlex
from pathlib import Path
from typing import Any

import click
import polars as pl
import pytest
from pages import PAGES, REPOSITORY, blocks, commands, copied, difference, run, steps
from tirelab.cli import main

FIVE_MINUTES = "examples/docs/five_minutes.md"

INSTALLING = ("python3 -m venv", "python -m pip")
"""The README's two commands begin with the first: test_readme.py runs one from a clean clone; the other runs us. Lines
for pip are run by test_release.py."""

PLACEHOLDERS = {"N": "1", "S": "1"}
"""Words of a page that stand for numbers."""

EACH = [pytest.param(page, c, id=f"{Path(page).stem}: {c}") for page in PAGES for c in commands(page)]

SLOW = {"examples/docs/recordings.md"}
"""Pages whose sessions diagnose more than once."""

SESSIONS = [
    pytest.param(page, marks=pytest.mark.slow if page in SLOW else (), id=Path(page).stem)
    for page in PAGES
    if steps(page)
]


def understood(command: click.Command, words: list[str], program: str) -> None:
    """Parse words as the command would, without running it; click's error names the option that is not true."""
    if words in (["--help"], ["--version"]):
        return
    name, *rest = words if isinstance(command, click.Group) else (program, *words)
    if isinstance(command, click.Group):
        inner = command.get_command(click.Context(command), name)
        assert inner is not None, f"{program} has no command {name}"
        if name == "COMMAND" or rest == ["--help"]:
            return
        command = inner
    with command.make_context(name, rest):
        pass


def words_of(command: str) -> list[str]:
    """Return the words of one command of a page, with numbers for its placeholders and without a trailing remark."""
    bare = command.replace("[DIR]", "DIR").partition("  #")[0]
    return [PLACEHOLDERS.get(word, word) for word in shlex.split(bare)]


def python_words(words: list[str]) -> None:
    """Check the words behind `python`: the module or file is there, and understands its options."""
    if words[0] == "-m":
        module = importlib.import_module(words[1])
        command: Any = getattr(module, "main", None)
        if isinstance(command, click.Command):
            understood(command, words[2:], words[1])
        else:
            assert len(words) == 2, f"{words[1]} takes options that nobody checks"
        return
    assert (REPOSITORY / words[0]).is_file(), words[0]
    if words[0] == "build_fmu.py":
        understood(main, ["build", *words[1:]], "tirelab")


@pytest.mark.parametrize(("page", "command"), EACH)
def test_every_command_is_understood(page: str, command: str) -> None:
    if command.startswith(INSTALLING):
        for part in command.split("&&"):
            if part.strip().startswith(".venv/bin/tirelab"):
                understood(main, shlex.split(part)[1:], "tirelab")
        return
    if "_TIRELAB_COMPLETE=" in command:  # completion of a shell
        assert re.search(r"_TIRELAB_COMPLETE=(bash|zsh|fish)_source tirelab", command)
        return
    if command.endswith("COMMAND --help"):
        return
    program, *words = words_of(command.partition(" > ")[0])
    if program == "tirelab":
        understood(main, words, program)
    elif program == "pytest":
        paths = [word for word in words if "/" in word]
        assert paths or words[:1] == ["-m"], command
        assert all((REPOSITORY / path).exists() for path in paths)
    elif program.startswith("python"):
        python_words(words)
    else:
        assert program in ("cp", "rm", "."), f"{page}: nobody knows {program}"


def prepare(clone: Path) -> None:
    """Write the file that the page on recordings speaks of: a ride with the force of a simulation beside it."""
    ride = pl.read_csv(clone / "examples" / "recordings" / "held_out.csv").filter(
        pl.col("radius [cm]").is_infinite()
    )
    law = 540.0 * pl.col("deflection [cm]").clip(0.0) ** 1.4
    ride.with_columns(law.alias("F model [N]")).drop("radius [cm]").write_csv(clone / "ride.csv")


@pytest.mark.parametrize("page", SESSIONS)
def test_a_session_prints_what_is_shown(page: str, tmp_path: Path) -> None:
    """In a copy of the clone, from the first command of the page to the last."""
    clone = copied(tmp_path)
    prepare(clone)
    before = {path.relative_to(clone) for path in clone.rglob("*")}
    wrong = []
    for step in steps(page):
        done = run(step.command, clone, tmp_path)
        assert done.returncode == 0, f"{step.command}\n{done.stdout}"
        if step.shown is not None and (fault := difference(step.shown, done.stdout)):
            wrong.append(f"{step.command}: {fault}")
    assert wrong == []
    # a session shows files being made: those that its pages name are there
    made = {path.relative_to(clone) for path in clone.rglob("*") if path.is_file()} - before
    assert made


def test_the_five_minutes_of_the_readme_are_those_of_their_page(repository: Path) -> None:
    table = (
        (repository / "README.md")
        .read_text(encoding="utf-8")
        .partition("| you type |")[2]
        .partition("\n\n")[0]
    )
    typed = re.findall(r"^\| `([^`]+)`", table, flags=re.MULTILINE)
    shown = {step.command for step in steps(FIVE_MINUTES)}
    assert len(typed) >= 6
    assert [
        c for c in typed if c not in shown and c != "tirelab open"
    ] == []  # open: tests/tirelab/local_page


def test_lines_for_powershell_are_powershell_and_the_same_commands() -> None:
    """Its own parser cannot be had everywhere: a grammar of it stands in."""
    tree_sitter = pytest.importorskip("tree_sitter")
    grammar = pytest.importorskip("tree_sitter_powershell")
    parser = tree_sitter.Parser(tree_sitter.Language(grammar.language()))
    assert parser.parse(b"py -m venv .venv && ( 'open").root_node.has_error  # it can fail
    found = [(page, block) for page in PAGES for block in blocks(page, "powershell")]
    assert found
    for page, block in found:
        assert not parser.parse(block.encode()).root_node.has_error, (page, block)
        assert "&&" not in block  # not in Windows PowerShell 5.1
        for line in re.split(r"[;\n]\s*", block):
            program, *words = line.split() or [""]
            if program == r".venv\Scripts\tirelab":
                understood(main, words, "tirelab")
            elif program == r".venv\Scripts\python":
                python_words(words)
            else:
                assert program in ("py", r".venv\Scripts\pip", "Copy-Item", ""), line


@pytest.mark.parametrize(
    ("shown", "printed", "alike"),
    [
        ("RMSE 9.86 N", "RMSE 9.87 N", True),
        ("RMSE 9.86 N", "RMSE 19.86 N", False),
        ("RMSE 9.86 N", "RMSE 9.86 kN", False),
        ("7 %", "9 %", True),
        ("7 %", "11 %", False),
        ("ziglang 0.17.1, for", "ziglang 0.13.0, for", True),
        ("a\n...\nz", "a b c\nd z", True),
        ("a\n...\nz", "a b c\nd", False),
        ("a\n...", "b c", False),
        ("...\nz", "a z", True),
        ("...\nz", "a z b", False),
        ("a b", "a\n  b", True),
        ("a b", "a b c", False),
        ("a b c", "a b", False),
        ("−66.0 N", "66.0 N", False),
    ],
)
def test_a_difference_is_seen_and_a_tolerated_one_is_not(shown: str, printed: str, alike: bool) -> None:
    assert (difference(shown, printed) == "") is alike
