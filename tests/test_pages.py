"""Every command in the README and the pages is run by a test, and every session prints what is shown."""

from __future__ import annotations

import importlib
import re
import shlex
import shutil
from pathlib import Path
from typing import Any

import click
import pytest
from pages import (
    FIVE_MINUTES,
    LONGEST_SLOW,
    PAGES,
    REPOSITORY,
    SMALLER,
    Step,
    blocks,
    commands,
    copied,
    difference,
    prepare,
    run,
    shape,
    steps,
)
from tirelab.cli import main

INSTALLING = ("python3 -m venv", "python -m pip", "pip install")

PLACEHOLDERS = {"N": "1", "S": "1"}
"""Words of a page that stand for numbers."""

EACH = [pytest.param(page, c, id=f"{Path(page).stem}: {c}") for page in PAGES for c in commands(page)]

MAIN, TESTS = (c for c in commands("README.md") if c.startswith("python3 -m venv"))

ELSEWHERE = {
    MAIN: "tests/test_readme.py::test_the_main_command_from_a_clean_clone",
    ". .venv/bin/activate": "tests/test_readme.py::test_tirelab_is_a_command_before_the_reader_types_it",
    "tirelab open": "tests/tirelab/local_page/test_open.py::test_from_drop_to_download",
    "tirelab open [DIR]": "tests/tirelab/local_page/test_open.py::test_from_drop_to_download",
    "tirelab diagnose press/*.csv --fmu model.fmu": "tests/tirelab/diagnosis/test_simulation_correction_of_fmus.py::"
    "test_what_is_printed_says_what_was_taken_and_that_it_is_native_code",
    "python examples/gallery.py": "tests/examples/test_gallery.py::test_all_pictures_are_the_scripts",
    "python tests/constants.py": "tests/test_constants.py::test_the_page_is_what_the_source_says",
    "mkdir -p dist/openmodelica && cd dist/openmodelica && omc ../../examples/modelica/openmodelica.mos": (
        "tests/tirelab/fmu/test_openmodelica.py::test_the_script_beside_the_blocks"
    ),
    "python -m tirelab.validation.restate DIR": "tests/tirelab/validation/test_restate.py::"
    "test_the_verdicts_of_a_folder_are_restated_and_scored",
    "python -m tirelab.validation.calibrate --proof DIR --out FILE": "tests/tirelab/validation/test_calibrate.py::"
    "test_finished_proofs_are_calibrated_on",
    "python -m tirelab.fmu.native.make": "tests/tirelab/fmu/native/test_make.py::"
    "test_the_other_binaries_are_those_of_the_sources",
    **{
        command: "tests/test_release.py::test_the_pages_words_install_and_uninstall"
        for command in commands(FIVE_MINUTES)
        if command.startswith("python -m pip")
    },
    **{
        command: "tests/test_pages.py::test_the_line_for_a_shell_completes_commands"
        for command in commands("examples/docs/command_line.md")
        if "_TIRELAB_COMPLETE=" in command
    },
}
"""Commands that another test runs, each with its test."""

CLOCKS = {
    "python tests/benchmarks/bench_report.py": "# samples: written in # s, # MB, ready in # ms",
    "pytest -s -n 0 tests/benchmarks/bench_native.py": "bare against the reference: #, the median of # turns",
    "pytest -s -n 0 tests/benchmarks/bench_calls.py -k first_instance": "first instance: # s",
}
"""Commands that measure a time, each with the shape of a line that it prints. Their bars hold on an idle machine."""

NOT_RUN = {
    TESTS: "it runs all tests, this one too",
    "pytest -m slow": "it runs all slow tests, those of the pages too",
    "rm -rf .venv": "it removes what runs the tests",
    "pip install -e '.[formats]'": "it is part of the extra `test`, with which the tests are installed",
    "sh tests/tirelab/fmu/hosts/install.sh": "it installs programs of Debian on the machine",
    "python tests/benchmarks/bench_real.py FOLDER": "its recordings may not be kept here; "
    "tests/examples/test_real_recordings.py runs its parts where they are",
    "python tests/benchmarks/bench_held_out.py DIR": "it diagnoses the trials of a proof for six minutes; "
    "what it measures is tested in tests/tirelab/estimation/test_held_out.py",
    "python tests/benchmarks/bench_identified.py DIR": "it diagnoses the trials of a proof for six minutes; "
    "the five minutes diagnose beside a law of the same recordings too",
    "python tests/benchmarks/bench_few_samples.py --seed 5": "it makes 96 diagnoses in ten minutes; "
    "tests/tirelab/preprocessing/test_motion.py and test_gauge.py test the motions",
    "python tests/benchmarks/bench_ways_of_recording.py": "it makes 306 diagnoses in forty minutes; "
    "tests/tirelab/diagnosis/test_leave_one_out.py hides single effects too",
    "python tests/benchmarks/bench_scales.py DIR --trials 18": "it diagnoses the trials of a proof for half an hour; "
    "tests/tirelab/estimation/test_explanation.py::test_the_scale_of_a_recording_changes_nothing tries two rides",
}
"""Commands that no test can run, each with the reason."""

SESSIONS = [
    pytest.param(page, slow, marks=pytest.mark.slow if slow else (), id=Path(page).stem)
    for page in PAGES
    for slow in sorted({step.slow for step in steps(page)})
]

IN_SESSIONS = {step.command for page in PAGES for step in steps(page)}


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
        assert program in ("cp", "rm", ".", "sh", "mkdir"), f"{page}: nobody knows {program}"


def is_run(command: str) -> bool:
    """Whether a test runs a command of a page: in a session, perhaps with more options, or as a register says."""
    in_session = any(shown == command or shown.startswith(f"{command} ") for shown in IN_SESSIONS)
    if command.startswith("pytest ") and command not in (*CLOCKS, *NOT_RUN):  # part of these tests
        *_, path = command.split()
        tests = [path] if path.endswith(".py") else sorted(map(str, (REPOSITORY / path).glob("test_*.py")))
        return any("-m slow" not in command or "mark.slow" in (REPOSITORY / t).read_text() for t in tests)
    return in_session or command in (*SMALLER, *ELSEWHERE, *CLOCKS, *NOT_RUN)


@pytest.mark.parametrize(("page", "command"), EACH)
def test_every_command_is_run(page: str, command: str) -> None:
    assert is_run(command), f"show what {command!r} prints in a block ```console, or say which test runs it"


def test_a_command_that_nobody_runs_is_seen() -> None:
    for command in (
        "tirelab compare other.csv",
        "pytest tests/nowhere",
        "python -m tirelab.validation.score",
    ):
        assert not is_run(command)


def test_commands_stand_in_blocks_that_are_looked_through() -> None:
    """Not under another name of a shell, nor in a block without a name."""
    for page in PAGES:
        text = (REPOSITORY / page).read_text(encoding="utf-8")
        named = set(re.findall(r"^```(\w+)", text, flags=re.MULTILINE))
        assert named <= {"console", "sh", "powershell", "python", "toml", "mermaid"}, page
        bare = re.findall(r"^```(\w*)\n(.*?)^```$", text, flags=re.MULTILINE | re.DOTALL)
        assert [
            b for name, b in bare if not name and re.match(r"(\$ )?(tirelab|python|pytest|pip) ", b)
        ] == [], page


def test_the_registers_speak_of_commands_and_tests_that_are_there() -> None:
    there = {command for page in PAGES for command in commands(page)}
    assert {*SMALLER, *ELSEWHERE, *CLOCKS, *NOT_RUN} - there == set()
    for place in ELSEWHERE.values():
        file, _, name = place.partition("::")
        assert re.search(rf"^def {name}\(", (REPOSITORY / file).read_text(encoding="utf-8"), re.MULTILINE), (
            place
        )


@pytest.mark.parametrize(("page", "slow"), SESSIONS)
def test_a_session_prints_what_is_shown(page: str, slow: bool, tmp_path: Path) -> None:
    """In a copy of the clone, from the first command of the page to the last; the slow ones with the slow tests."""
    clone = copied(tmp_path)
    prepare(clone)
    wrong = []
    for step in steps(page):
        if step.slow and not slow:
            continue
        done = step.run(clone, tmp_path)
        assert done.returncode == 0, f"{step.command}\n{done.stdout}"
        if fault := step.fault(done.stdout):
            wrong.append(f"{step.command}: {fault}")
    assert wrong == []


@pytest.mark.slow
@pytest.mark.parametrize("command", sorted(set(SMALLER) - IN_SESSIONS))
def test_a_long_command_runs_with_smaller_numbers(command: str, tmp_path: Path) -> None:
    done = Step("", command, None).run(copied(tmp_path), tmp_path)
    assert done.returncode == 0, done.stdout
    assert done.stdout.strip()
    assert "failed" not in done.stdout


@pytest.mark.slow
@pytest.mark.parametrize("command", CLOCKS)
def test_a_clock_prints_its_line(command: str, tmp_path: Path) -> None:
    if "bench_report" in command and not shutil.which("chromium"):
        pytest.skip("no chromium on this machine")
    printed = run(command, copied(tmp_path), tmp_path, LONGEST_SLOW).stdout
    assert CLOCKS[command] in shape(printed), printed


@pytest.mark.parametrize("shell", ["bash", "zsh", "fish"])
def test_the_line_for_a_shell_completes_commands(shell: str, tmp_path: Path) -> None:
    if not shutil.which(shell):
        pytest.skip(f"no {shell} on this machine")
    (line,) = (c for c in commands("examples/docs/command_line.md") if f"={shell}_source" in c)
    asked = {
        "bash": "COMP_WORDS=(tirelab comp) COMP_CWORD=1; _tirelab_completion tirelab; echo ${COMPREPLY[@]}",
        "zsh": "whence -f _tirelab_completion",
        "fish": 'complete -C "tirelab comp"',
    }[shell]
    begin = "autoload -Uz compinit; compinit -u; " if shell == "zsh" else ""
    script = tmp_path / "script"
    script.write_text(f"{begin}{line}\n{asked}\n", encoding="utf-8")
    printed = run(f"{shell} {script}", tmp_path, tmp_path).stdout
    assert ("_TIRELAB_COMPLETE=zsh_complete" if shell == "zsh" else "compare") in printed


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


@pytest.mark.parametrize(
    ("shown", "printed", "alike"),
    [
        ("200 trials", "5 trials", True),
        ("200 trials", "5 draws", False),
        ("│ exact set │ 80.0 % │", "│ exact set │ no trial │", True),
        ("│ exact set │ 80.0 % │", "│ a set │ 80.0 % │", False),
        ("│ the noise │ 80.0 % │\n│ floor     │        │", "│ the noise floor │ 60 % │", True),
    ],
)
def test_another_shape_is_seen_and_other_numbers_are_not(shown: str, printed: str, alike: bool) -> None:
    assert (difference(shape(shown), shape(printed)) == "") is alike
