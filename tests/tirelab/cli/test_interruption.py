"""Ctrl-C ends every command alike: the documented status, one line, no half-written file."""

from __future__ import annotations

import json
import subprocess
import sys
from pathlib import Path

import pytest
from tirelab.cli import COMMANDS as known

pytestmark = pytest.mark.skipif(sys.platform == "win32", reason="Ctrl-C is not a signal there")

PRESS = "examples/recordings/press/slow.csv"
COMMANDS = {
    "identify": ["identify", PRESS, "--out", "{out}/tire.json"],
    "diagnose": ["diagnose", PRESS, "--out", "{out}"],
    "compare": ["compare", PRESS, "--out", "{out}"],
    "inspect": ["inspect", PRESS, "--out", "{out}/recording.toml"],
    "plan": ["plan", "--stroke", "20mm", "--speed", "100mm/s", "--out", "{out}"],
    "build": ["build", "--out", "{out}"],
    "ride": ["ride", "--iso-class", "D", "--out", "{out}"],
    "rig": ["rig", "--out", "{out}"],
    "article": ["article", "--out", "{out}"],
    "prove": ["prove", "--trials", "2", "--seed", "1", "--jobs", "1", "--out", "{out}"],
    "open": ["open", "{out}", "--no-browser"],
}
CONTINUED = ("prove",)
"""What these had finished stays, for the same command to go on."""

QUICK = ("identify", "compare", "inspect", "build", "ride", "rig")
"""Those that soon write."""

ONE_OF_QUICK = [name if name == "build" else pytest.param(name, marks=pytest.mark.slow) for name in QUICK]
"""They write by the same functions: one of them with the ordinary tests, each of them with the slow ones."""

WRITTEN = {
    "identify": {"tire.json", "tire.identification.json"},
    "compare": {"slow.compare.png"},
    "inspect": {"recording.toml"},
    "build": {"BicycleTire.fmu"},
    "ride": {"ride.csv", "ride.png"},
}
"""Their files; the rig's are more than one."""

DRIVER = """
import atexit, os, signal, sys, threading
from tirelab.__main__ import main
signal.signal(signal.SIGINT, signal.default_int_handler)
moment, out = sys.argv.pop(1), sys.argv.pop(1)

def press():
    global press
    press = lambda: None
    os.kill(os.getpid(), signal.SIGINT)

MOMENTS = {
    "loading": lambda event, words: event == "import" and words[0] == "tirelab.cli",
    "staging": lambda event, words: event == "tempfile.mkdtemp" and words[0].startswith(out),
    "writing": lambda event, words: event == "open" and words[0].startswith(out) and words[1][0] in "wx",
    "moving": lambda event, words: event == "os.rename" and words[1].startswith(out),
}

if moment in MOMENTS:
    sys.addaudithook(lambda event, words: MOMENTS[moment](event, [str(w) for w in words]) and press())
elif moment == "ending":
    atexit.register(press)
else:
    timer = threading.Timer(float(moment), press)
    timer.daemon = True
    timer.start()
main()
"""
"""Presses Ctrl-C once, at a moment of the program's own course or so many seconds after its start."""

IN_MADE_CODE = """
import signal
import tirelab.cli
from tirelab.__main__ import main

def program():
    exec("import os; os.kill(os.getpid(), signal.SIGINT); [None for _ in range(1000)]", {"signal": signal})

signal.signal(signal.SIGINT, signal.default_int_handler)
tirelab.cli.main = program
main()
"""
"""Is interrupted where Python ends by the signal, had it been a plain KeyboardInterrupt."""

IN_CALLBACK = """
import os, signal, time, weakref
import tirelab.cli
from tirelab.__main__ import main

class Held: ...

def press(_):
    os.kill(os.getpid(), signal.SIGINT)
    [None for _ in range(1000)]

def program():
    held = Held()
    seen = weakref.ref(held, press)
    del held
    time.sleep(3)
    print("never interrupted")

signal.signal(signal.SIGINT, signal.default_int_handler)
tirelab.cli.main = program
main()
"""
"""Is interrupted in a callback, as one of the import system: Python prints such an error and goes on."""

SLOW_THREADS = """
import threading, time
start = threading.Thread.start

def slowly(thread):
    start(thread)
    time.sleep(0.2)

threading.Thread.start = slowly
"""
"""A busy machine."""


def run(program: str, folder: Path, *words: str) -> subprocess.CompletedProcess[str]:
    """Run a program of Python as a module, in whose code no interrupt is looked at."""
    (folder / "driven.py").write_text(program, encoding="utf-8")
    return subprocess.run(
        [sys.executable, "-m", "driven", *words],
        env={"PYTHONPATH": f"{folder}:fmu_src", "PATH": "", "HOME": str(folder)},
        capture_output=True,
        text=True,
        timeout=300,
    )


def interrupted(name: str, moment: str, folder: Path) -> tuple[subprocess.CompletedProcess[str], list[str]]:
    """Run a command to that moment; return how it ended, and the files that stand in `folder`/out."""
    out = folder / "out"
    done = run(DRIVER, folder, moment, str(out), *(word.format(out=out) for word in COMMANDS[name]))
    assert "Traceback" not in done.stderr
    if done.returncode:
        assert done.returncode == 1
        assert done.stderr.endswith("\nAborted!\n")
    return done, [path.relative_to(out).as_posix() for path in out.rglob("*") if path.is_file()]


@pytest.mark.parametrize("name", COMMANDS)
def test_ctrl_c_while_the_commands_are_loaded_has_status_1_and_leaves_nothing(
    name: str, repository: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(repository)
    done, files = interrupted(name, "loading", tmp_path)
    assert (done.returncode, files) == (1, [])


@pytest.mark.parametrize("name", ONE_OF_QUICK[:-1])  # the rig's files are not opened by Python
@pytest.mark.parametrize("moment", ["staging", "writing"])
def test_ctrl_c_while_the_files_are_written_leaves_none(
    name: str, moment: str, repository: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(repository)
    done, files = interrupted(name, moment, tmp_path)
    assert (done.returncode, files) == (1, [])


@pytest.mark.parametrize("name", ONE_OF_QUICK)
def test_ctrl_c_as_the_files_are_moved_into_their_folder_waits_for_all_of_them(
    name: str, repository: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(repository)
    done, files = interrupted(name, "moving", tmp_path)
    assert done.returncode == 1
    if name in WRITTEN:
        assert set(files) == WRITTEN[name]
    else:
        assert len(files) > 1


def test_ctrl_c_after_the_work_changes_nothing(
    repository: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(repository)
    done, files = interrupted("inspect", "ending", tmp_path)
    assert (done.returncode, done.stderr) == (0, "reading slow.csv\n")
    assert set(files) == WRITTEN["inspect"]


@pytest.mark.parametrize("name", COMMANDS)
@pytest.mark.parametrize("seconds", ["0.2", "0.8"])
def test_ctrl_c_at_any_time_leaves_no_half_of_the_files(
    name: str, seconds: str, repository: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """How far a command is at that time depends on the machine: it may even have written all of its files."""
    monkeypatch.chdir(repository)
    done, files = interrupted(name, seconds, tmp_path)
    if name == "open" and done.stdout:  # it serves until then
        assert (done.returncode, done.stderr) == (0, "ended\n")
        assert files == []
    elif name in CONTINUED:
        for file in files:
            assert _whole(tmp_path / "out" / file), file
    elif files and name in WRITTEN:
        assert set(files) == WRITTEN[name]
    assert not [file for file in files if ".tirelab-" in file]


def _whole(file: Path) -> bool:
    """Whether a file of a proof was written to its end, as its format shows it."""
    held = file.read_bytes()
    if file.suffix == ".json":
        return bool(json.loads(held))
    return held.rstrip().endswith(b"</html>") if file.suffix == ".html" else len(held) > 0


def test_no_command_is_left_out() -> None:
    assert set(COMMANDS) == set(known)


def test_no_moment_is_left_at_which_python_ends_by_the_signal(
    repository: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(repository)
    done = run(IN_MADE_CODE, tmp_path)
    assert (done.returncode, done.stderr) == (1, "\nAborted!\n")


def test_an_interrupt_that_a_callback_swallows_comes_again(
    repository: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(repository)
    done = run(IN_CALLBACK, tmp_path)
    assert (done.returncode, done.stdout, done.stderr) == (1, "", "\nAborted!\n")


def test_it_comes_again_where_a_thread_takes_long_to_start(
    repository: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(repository)
    done = run(SLOW_THREADS + IN_CALLBACK, tmp_path)
    assert (done.returncode, done.stdout, done.stderr) == (1, "", "\nAborted!\n")


def test_other_errors_in_a_callback_are_told_as_ever(
    repository: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(repository)
    done = run(IN_CALLBACK.replace("    os.kill(os.getpid(), signal.SIGINT)\n", "    1 / 0\n"), tmp_path)
    assert "ZeroDivisionError" in done.stderr
    assert done.stdout == "never interrupted\n"


def test_ctrl_c_while_a_class_is_made_is_no_other_error() -> None:
    """Python 3.10 and 3.11 tell it as the cause of a RuntimeError of `__set_name__`; another one stays an error."""
    program = """
import sys, types, tirelab.__main__ as program
class Cut:
    def __set_name__(self, owner, name):
        raise {error}
def main():
    type("Made", (), {{"name": Cut()}})
sys.modules["tirelab.cli"] = types.SimpleNamespace(main=main)
program.main()
"""
    for error, said in (("KeyboardInterrupt", "Aborted!"), ("ValueError", "Traceback")):
        words = [sys.executable, "-c", program.format(error=error)]
        done = subprocess.run(words, capture_output=True, text=True, timeout=60, check=False)
        assert done.returncode == 1
        assert said in done.stderr
        assert ("Traceback" in done.stderr) == (said == "Traceback")
