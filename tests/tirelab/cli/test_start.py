"""The program starts without what it does not need, and `tirelab` shows its public names only."""

from __future__ import annotations

import importlib.metadata
import json
import subprocess
import sys

import click
import pytest
import tirelab
from click.testing import CliRunner
from tirelab.cli import COMMANDS, main

HEAVY = {"fmpy", "joblib", "matplotlib", "numba", "numpy", "pint", "polars", "pythonfmu", "rich", "scipy"}

PROGRAM = """
import json, sys
import tirelab
from tirelab.cli import main
try:
    main(json.loads(sys.argv[1]), prog_name="tirelab")
except SystemExit as end:
    print(json.dumps([end.code, sorted(sys.modules)]))
"""


@pytest.mark.parametrize(
    ("arguments", "status"),
    [
        (["--version"], 0),
        (["--help"], 0),
        (["diagnose", "nosuch.csv"], 2),
        *(([name, "--help"], 0) for name in COMMANDS),
    ],
)
def test_an_answer_without_work_loads_no_heavy_library(arguments: list[str], status: int) -> None:
    done = subprocess.run(
        [sys.executable, "-c", PROGRAM, json.dumps(arguments)], capture_output=True, text=True, check=True
    )
    code, modules = json.loads(done.stdout.splitlines()[-1])
    assert code == status
    assert HEAVY.isdisjoint(modules)


def test_a_file_that_is_not_there_is_said_so() -> None:
    result = CliRunner().invoke(main, ["diagnose", "nosuch.csv"])
    assert result.exit_code == 2
    assert result.stderr == "Error: nosuch.csv: there is no such file; check the path\n"


def test_a_held_out_file_that_is_not_there_is_said_so() -> None:
    result = CliRunner().invoke(main, ["diagnose", __file__, "--held-out", "none.csv"])
    assert result.exit_code == 2
    assert result.stderr == "Error: none.csv: there is no such file; check the path\n"


def test_every_command_listed_is_there_and_says_what_it_does() -> None:
    context = click.Context(main)
    listed = CliRunner().invoke(main, ["--help"]).stdout
    for name, sentence in COMMANDS.items():
        command = main.get_command(context, name)
        assert command is not None
        assert command.name == name
        assert command.help
        assert " ".join(sentence.split()) in " ".join(listed.split())
    # in the order of the work: what to record, recordings, tire, FMU, comparison, what is missing; the article and
    # the proof last
    assert main.list_commands(context) == list(COMMANDS)
    assert list(COMMANDS)[:7] == ["open", "plan", "inspect", "identify", "build", "compare", "diagnose"]
    assert list(COMMANDS)[-2:] == ["article", "prove"]


def test_the_list_of_commands_tells_the_exit_statuses_and_the_completion() -> None:
    told = CliRunner().invoke(main, ["--help"]).stdout
    assert "Exit status: 0 done, 1 interrupted (Ctrl-C), 2 bad input" in told
    for shell in ("bash", "zsh", "fish"):
        assert f"_TIRELAB_COMPLETE={shell}_source tirelab" in told


@pytest.mark.parametrize("shell", ["bash", "zsh", "fish"])
def test_the_shell_completes_commands_and_options(shell: str, monkeypatch: pytest.MonkeyPatch) -> None:
    result = CliRunner().invoke(main, [], prog_name="tirelab", env={"_TIRELAB_COMPLETE": f"{shell}_source"})
    if shell == "bash" and "is not supported" in result.output:
        pytest.skip("bash is too old or missing")
    assert "_TIRELAB_COMPLETE" in result.output
    words = {"COMP_WORDS": "tirelab diagnose --he", "COMP_CWORD": "--he" if shell == "fish" else "2"}
    found = CliRunner().invoke(
        main, [], prog_name="tirelab", env={"_TIRELAB_COMPLETE": f"{shell}_complete", **words}
    )
    assert "--held-out" in found.output


@pytest.mark.parametrize(
    ("typed", "said"),
    [
        ("diagnsoe", "(Did you mean 'diagnose'?)"),
        ("identfy", "(Did you mean 'identify'?)"),
        ("xyz", "'xyz'."),
    ],
)
def test_a_command_that_was_mistyped_is_told_the_one_that_is_spelled_alike(typed: str, said: str) -> None:
    result = CliRunner().invoke(main, [typed, "a.csv"])
    assert result.exit_code == 2
    assert f"No such command '{typed}'." in result.stderr
    assert result.stderr.rstrip().endswith(said)


def test_a_command_that_does_not_exist_is_refused() -> None:
    result = CliRunner().invoke(main, ["diagnosis"])
    assert result.exit_code == 2
    assert "No such command 'diagnosis'" in result.stderr


def test_the_package_runs_as_a_module() -> None:
    done = subprocess.run(
        [sys.executable, "-m", "tirelab", "--version"], capture_output=True, text=True, check=True
    )
    assert done.stdout.split()[-1] == importlib.metadata.version("tirelab")


def test_dir_shows_the_public_names_and_nothing_else() -> None:
    import tirelab.diagnosis.diagnose
    import tirelab.identification.identify
    import tirelab.terrain.ride

    names = {
        "Recording",
        "read_recording",
        "identify",
        "diagnose",
        "Limits",
        "build_fmu",
        "replay",
        "compare",
    }
    assert set(dir(tirelab)) == names | {"ride", "__version__"}
    assert tirelab.__version__ == importlib.metadata.version("tirelab")


@pytest.mark.parametrize("name", ["identify", "diagnose", "build_fmu", "replay", "compare", "ride"])
def test_a_verb_is_the_function_whatever_was_imported_before(name: str) -> None:
    for module in ("diagnosis.diagnose", "identification.identify", "fmu.replay", "terrain.ride"):
        importlib.import_module(f"tirelab.{module}")
    function = getattr(tirelab, name)
    assert callable(function)
    assert function.__name__ == name


def test_annotations_and_except_find_their_classes() -> None:
    from tirelab import TirelabError, Verdict

    assert issubclass(TirelabError, ValueError)
    assert Verdict.__name__ == "Verdict"
    with pytest.raises(AttributeError, match="module 'tirelab' has no attribute 'magic'"):
        tirelab.magic  # noqa: B018
