"""The commands and the output that the pages show: found, run as a reader would, and compared.

A block ```console holds commands behind `$ ` and what each prints below; a line `...` stands for any text. Two texts
are alike where their words are the same and their numbers differ by at most a twentieth, or three of the last digit
shown; versions, GUIDs, rules and pictures of a terminal, and the width of lines are left out.

`python tests/pages.py PAGE` runs the sessions of a page and prints what they print today.
"""

from __future__ import annotations

import os
import re
import shutil
import subprocess
import sys
import tempfile
from dataclasses import dataclass
from itertools import groupby
from pathlib import Path

REPOSITORY = Path(__file__).resolve().parents[1]

PAGES = (
    "README.md",
    *(f"examples/docs/{p.name}" for p in sorted((REPOSITORY / "examples/docs").glob("*.md"))),
)

CLOSE, LAST_DIGITS = 0.05, 3
"""Shown and printed numbers differ by at most this part, or by so many units of the last digit that is shown."""

LONGEST = 560.0
"""A command that takes longer [s] has failed: the slowest is a diagnosis, 20 s on an idle machine."""

_PROGRAMS = r"(?:tirelab|python3?|pytest|py)\b"
_NUMBER = re.compile(r"[-+−]?\d+(?:\.\d+)?(?:e[-+]?\d+)?")
_LEFT_OUT = re.compile(r"\{[0-9a-f-]{36}\}|\b\d+\.\d+\.\d+\b|[─│┌┐└┘]+|[⠀-⣿▁]+")
GAP = "..."


@dataclass(frozen=True)
class Step:
    """A command of a page and what the page shows below it; None where it shows nothing."""

    command: str
    shown: str | None


def blocks(page: str, language: str) -> list[str]:
    """Return the fenced blocks of a page in one language."""
    text = (REPOSITORY / page).read_text(encoding="utf-8")
    return re.findall(rf"^```{language}\n(.*?)^```", text, flags=re.MULTILINE | re.DOTALL)


def steps(page: str) -> list[Step]:
    """Return the steps of all console blocks of a page, in their order."""
    found = []
    for block in blocks(page, "console"):
        for part in re.split(r"^\$ ", block, flags=re.MULTILINE)[1:]:
            command, _, shown = part.partition("\n")
            found.append(Step(command, shown if shown.strip() else None))
    return found


def commands(page: str) -> list[str]:
    """Return every command that a page names: in blocks for a shell, in console blocks, and within its lines."""
    text = (REPOSITORY / page).read_text(encoding="utf-8")
    lines = [line for block in blocks(page, "sh") for line in block.splitlines() if line.strip()]
    lines += [step.command for step in steps(page)]
    prose = re.sub(r"^```.*?^```", "", text, flags=re.MULTILINE | re.DOTALL).replace("\n", " ")
    within = re.findall(rf"`({_PROGRAMS} [^`]+)`", prose)
    return list(dict.fromkeys([*lines, *within]))


def run(command: str, folder: Path, home: Path) -> subprocess.CompletedProcess[str]:
    """Run a command in a shell in a folder, with this Python's programs first, and no settings from outside."""
    keep = {k: v for k, v in os.environ.items() if k in ("LANG", "LC_ALL", "TMPDIR", "MPLCONFIGDIR")}
    path = f"{Path(sys.executable).parent}{os.pathsep}{os.environ['PATH']}"
    environment = {**keep, "PATH": path, "HOME": str(home), "PYTHONUTF8": "1"}
    return subprocess.run(
        ["bash", "-c", command],
        cwd=folder,
        env=environment,
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,  # as a terminal shows both
        text=True,
        encoding="utf-8",
        timeout=LONGEST,
        check=False,
    )


def copied(folder: Path) -> Path:
    """Copy what a reader's commands may use of the repository, and nothing that they wrote."""
    clone = folder / "clone"
    for name in ("examples", "fmu_src"):
        ignored = shutil.ignore_patterns("__pycache__", "recording.toml", "*.egg-info")
        shutil.copytree(REPOSITORY / name, clone / name, ignore=ignored)
    for name in ("build_fmu.py", "pyproject.toml", "README.md"):
        shutil.copy(REPOSITORY / name, clone / name)
    return clone


def difference(shown: str, printed: str) -> str:
    """Return where two texts differ, as a sentence; empty where they are alike."""
    have = _words(printed)
    parts = [list(part) for gap, part in groupby(_words(shown), GAP.__eq__) if not gap]
    open_start = shown.lstrip().startswith(GAP)
    open_end = shown.rstrip().endswith(GAP)
    at = 0
    for number, part in enumerate(parts):
        floating = number > 0 or open_start
        last = number == len(parts) - 1 and not open_end
        starts = range(at, len(have) - len(part) + 1) if floating else [at]
        starts = [len(have) - len(part)] if last and floating else starts
        found = next((s for s in starts if s >= at and _alike(part, have[s : s + len(part)])), None)
        if found is None:
            return _first_difference(part, have[at:])
        at = found + len(part)
    if parts and not open_end and at < len(have):
        return f"more is printed: {' '.join(have[at : at + 12])}"
    return ""


def _words(text: str) -> list[str]:
    return _LEFT_OUT.sub(" ", text).split()


def _alike(shown: list[str], printed: list[str]) -> bool:
    return len(shown) == len(printed) and all(map(_same, shown, printed))


def _same(shown: str, printed: str) -> bool:
    if _NUMBER.sub("#", shown) != _NUMBER.sub("#", printed):
        return False
    return all(map(_close, _NUMBER.findall(shown), _NUMBER.findall(printed)))


def _close(shown: str, printed: str) -> bool:
    one, other = (float(text.replace("−", "-")) for text in (shown, printed))
    mantissa, _, power = shown.partition("e")
    digit = 10.0 ** (int(power or 0) - len(mantissa.partition(".")[2]))
    return abs(one - other) <= max(CLOSE * abs(one), LAST_DIGITS * digit) * (1.0 + 1e-9)


def _first_difference(shown: list[str], printed: list[str]) -> str:
    same = next((i for i, (a, b) in enumerate(zip(shown, printed, strict=False)) if not _same(a, b)), None)
    at = min(len(shown), len(printed)) if same is None else same
    around = slice(max(at - 6, 0), at + 6)
    return f"shown {' '.join(shown[around])!r}, printed {' '.join(printed[around])!r}"


def main() -> None:
    """Run the sessions of a page and print them as they are today."""
    with tempfile.TemporaryDirectory() as name:
        clone = copied(Path(name))
        for step in steps(sys.argv[1]):
            done = run(step.command, clone, Path(name))
            print(f"$ {step.command}\n{done.stdout}", end="")


if __name__ == "__main__":
    main()
