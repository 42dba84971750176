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

DRIVER = """
import os, signal, sys, threading
from tirelab.__main__ import main
signal.signal(signal.SIGINT, signal.default_int_handler)
timer = threading.Timer(float(sys.argv.pop(1)), os.kill, (os.getpid(), signal.SIGINT))
timer.daemon = True

class Begin:
    def find_spec(self, name, *_):
        if name == "tirelab.cli":
            timer.start()
            sys.meta_path.remove(self)

sys.meta_path.insert(0, Begin())
main()
"""
"""Presses Ctrl-C so many seconds after the program has begun to load its commands."""

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


@pytest.mark.parametrize("name", COMMANDS)
@pytest.mark.parametrize("seconds", [0.0, 0.2, 0.6])
def test_ctrl_c_at_any_time_has_status_1_and_leaves_nothing(
    name: str, seconds: float, repository: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A fast command may be done before: then its files are whole, which other tests look at."""
    monkeypatch.chdir(repository)
    out = tmp_path / "out"
    done = run(DRIVER, tmp_path, str(seconds), *(word.format(out=out) for word in COMMANDS[name]))
    assert "Traceback" not in done.stderr
    if name == "open" and done.stdout:  # it serves until then
        assert (done.returncode, done.stderr) == (0, "ended\n")
    elif seconds == 0.0 or done.returncode:
        assert done.returncode == 1
        assert done.stderr.endswith("\nAborted!\n")
    if name in CONTINUED:
        for file in out.rglob("*.json"):
            json.loads(file.read_text(encoding="utf-8"))
    elif name == "open" or done.returncode:
        assert [path for path in out.rglob("*") if path.is_file()] == []


def test_no_command_is_left_out() -> None:
    assert set(COMMANDS) == set(known)


def test_no_moment_is_left_at_which_python_ends_by_the_signal(
    repository: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(repository)
    done = run(IN_MADE_CODE, tmp_path)
    assert (done.returncode, done.stderr) == (1, "\nAborted!\n")
