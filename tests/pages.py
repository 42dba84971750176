"""The commands and the output that the pages show: found, run as a reader would, and compared.

A block ```console holds commands behind `$ ` and what each prints below; a line `...` stands for any text. Two texts
are alike where their words are the same and their numbers differ by at most a twentieth, or three of the last digit
shown; versions, GUIDs, rules and pictures of a terminal, and the width of lines are left out.

A command that takes hours is run with smaller numbers, and the shapes of the two texts are compared: without numbers,
and of a table the first column alone.

`python tests/pages.py PAGE` runs the sessions of a page, as the tests do, and prints what they print today.
"""

from __future__ import annotations

import os
import re
import shutil
import subprocess
import sys
import tempfile
from dataclasses import dataclass
from itertools import accumulate, groupby
from pathlib import Path

import numpy as np
import polars as pl

REPOSITORY = Path(__file__).resolve().parents[1]

PAGES = (
    "README.md",
    "examples/quarter_bicycle/README.md",
    *(f"examples/docs/{p.name}" for p in sorted((REPOSITORY / "examples/docs").glob("*.md"))),
)

CLOSE, LAST_DIGITS = 0.05, 3
"""Shown and printed numbers differ by at most this part, or by so many units of the last digit that is shown."""

LONGEST, LONGEST_SLOW = 560.0, 3600.0
"""A command that takes longer [s] has failed: a diagnosis takes 20 s on an idle machine, a small proof minutes."""

SMALLER = {
    "tirelab prove --kind all --seed 5039128466204531 --trials 60 --out DIR": "--trials 7",
    "tirelab prove --kind none --seed 9218868437227405 --trials 60 --out NONE": "--trials 1",
    "tirelab prove --kind pressure --seed 860221406 --trials 36 --out DIR": "--trials 1",
    "tirelab prove --kind set --seed 20261128 --trials 24 --out DIR": "--trials 1",
    "tirelab prove --kind drift --seed 20261201 --trials 20 --out DIR": "--trials 1",
    "python -m tirelab.validation.calibrate --seed 8346268501 --seed 7778742049 --seed 9192631770 "
    "--trials 200 --out FILE": "--trials 10",
    "python -m tirelab.validation.coverage --seed 6 --draws 200": "--draws 2",
    "python tests/benchmarks/bench_cases.py --seed 11": "nothing_on_a_press",
    "python -m tirelab.validation.form_errors --seed 1": "--draws 12",
    "python -m tirelab.validation.form_errors --seed 1 --draws 400 --only mullins_softening": "--draws 60",
    "python -m tirelab.validation.form_errors --seed 1 --draws 100 --only part_shape": "--draws 3",
    "python -m tirelab.validation.form_errors --seed 1 --kind set --draws 200": "--draws 4",
    "python -m tirelab.validation.form_errors --seed 1 --kind drift --draws 60": "--draws 4",
    "python -m tirelab.validation.plans --seed 20261122 --trials 12 --out FILE": "--trials 1",
    "python tests/sensitivity.py --seed 701408733 --trials 200 --each 6": "--trials 1 --each 1 "
    "--only selection/search.PRIOR_ODDS --out FILE",
}
"""Commands that take hours, and the words behind them, of which the last counts, that make them small."""

SLOW = (
    "tirelab diagnose",
    "tirelab plan --stroke",
    "tirelab plan --rig",
    "tirelab build --from",
    "tirelab build --tire out/",
    "tirelab compare examples/recordings/held_out.csv --fmu corrected/",
    *SMALLER,
)
"""What a command begins with that takes long, or stands on one that does."""

FIVE_MINUTES = "examples/docs/five_minutes.md"

_PROGRAMS = r"(?:tirelab|python3?|pytest|py|pip|sh|rm|cp|\.)"
_NUMBER = re.compile(r"[-+−]?\d+(?:\.\d+)?(?:e[-+]?\d+)?")
_LEFT_OUT = re.compile(r"\{[0-9a-f-]{36}\}|\b\d+\.\d+\.\d+\b|[─-╿]+|[⠀-⣿▁]+")
GAP = "..."


@dataclass(frozen=True)
class Step:
    """A command of a page and what the page shows below it; None where it shows nothing."""

    page: str
    command: str
    shown: str | None

    @property
    def slow(self) -> bool:
        """Whether it is run with the tests marked slow only."""
        return self.command.startswith(SLOW)

    def run(self, clone: Path, home: Path) -> subprocess.CompletedProcess[str]:
        """Run it in a copy of the clone, a long one with smaller numbers."""
        words = SMALLER.get(self.command)
        command = self.command if words is None else f"{self.command} {words}"
        return run(command, clone, home, LONGEST_SLOW if self.slow else LONGEST)

    def fault(self, printed: str) -> str:
        """Return where what it printed is not what is shown, as a sentence; empty where it is."""
        if self.shown is None:
            return ""
        seen = shape if self.command in SMALLER else str
        return difference(seen(self.shown), seen(printed))


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
            found.append(Step(page, command, shown if shown.strip() else None))
    return found


def commands(page: str) -> list[str]:
    """Return every command that a page names: in blocks for a shell, in console blocks, and within its lines."""
    text = (REPOSITORY / page).read_text(encoding="utf-8")
    lines = [line for block in blocks(page, "sh") for line in block.splitlines() if line.strip()]
    lines += [step.command for step in steps(page)]
    prose = re.sub(r"^```.*?^```", "", text, flags=re.MULTILINE | re.DOTALL).replace("\n", " ")
    within = [span for span in re.findall(r"`([^`]+)`", prose) if re.match(rf"{_PROGRAMS} \S", span)]
    return list(dict.fromkeys([*lines, *within]))


def run(command: str, folder: Path, home: Path, longest: float = LONGEST) -> subprocess.CompletedProcess[str]:
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
        timeout=longest,
        check=False,
    )


def copied(folder: Path) -> Path:
    """Copy what a reader's commands may use of the repository, and nothing that they wrote."""
    clone = folder / "clone"
    for name in ("examples", "fmu_src", "tests"):
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


def shape(text: str) -> str:
    """Return what of a text does not depend on how many trials there were."""
    cells = (re.split(r"[│┃]", line) for line in text.splitlines())
    return _NUMBER.sub("#", "\n".join(cell[1] if len(cell) > 1 else cell[0] for cell in cells))


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


def prepare(clone: Path) -> None:
    """Write the files that the pages speak of: three recordings, a damper's FMU, the limits of a rig."""
    from foreign_models import damper

    ride = pl.read_csv(clone / "examples" / "recordings" / "held_out.csv").filter(
        pl.col("radius [cm]").is_infinite()
    )
    law = 540.0 * pl.col("deflection [cm]").clip(0.0) ** 1.4
    ride.with_columns(law.alias("F model [N]")).drop("radius [cm]").write_csv(clone / "ride.csv")

    time = np.arange(0.0, 20.0, 0.05)
    depth = 10.0 * (1.0 - np.cos(0.4 * np.pi * time))
    tared = {"deflection [mm]": 150.0 + depth, "force [N]": 200.0 + 540.0 * (0.1 * depth) ** 1.4}
    pl.DataFrame({"time [s]": time, **tared}).write_csv(clone / "press.csv", float_precision=3)

    time = np.arange(0.0, 40.0, 0.01)
    stroke = 0.01 * np.sin(2.0 * np.pi * np.cumsum(np.repeat([0.2, 1.0], 2000)) * 0.01)
    change = np.append(0.0, np.diff(stroke))
    slip = np.fromiter(
        accumulate(change, lambda y, dx: min(max(y + dx / 4e-4, -1.0), 1.0), initial=0.0), float
    )[1:]
    force = 1500.0 * change / 0.01 + 60.0 * slip + 3.0 * np.random.default_rng(1).normal(size=time.size)
    moved = {"stroke [mm]": 1e3 * stroke, "force [N]": force}
    pl.DataFrame({"time [s]": time, **moved}).write_csv(clone / "damper.csv", float_precision=4)
    damper(clone)
    (clone / "rig.toml").write_text(blocks("examples/docs/plan.md", "toml")[0], encoding="utf-8")


def main() -> None:
    """Run the sessions of a page and print them as they are today."""
    sys.path.insert(0, str(REPOSITORY / "tests" / "tirelab" / "fmu"))
    with tempfile.TemporaryDirectory() as name:
        clone = copied(Path(name))
        prepare(clone)
        for step in steps(sys.argv[1]):
            print(f"$ {step.command}\n{step.run(clone, Path(name)).stdout}", end="")


if __name__ == "__main__":
    main()
