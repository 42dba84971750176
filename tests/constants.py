"""The numbers that can change a verdict, in one table: python tests/constants.py > examples/docs/constants.md

Read from the source of the rooms between a recording and its verdict: every upper-case number there, its value and its
own words. Where it comes from stands in `constant_kinds`; tests/test_constants.py holds that none is missing and that
the page is what this prints. What happens to verdicts when a number is halved or doubled is in sensitivity.json, which
tests/sensitivity.py wrote.
"""

from __future__ import annotations

import ast
import json
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from functools import cache
from pathlib import Path

from constant_kinds import ARITHMETIC, BESIDE, DERIVED, EFFORT, KINDS, NOT_ZERO, OF_UNITS, PRIOR, WORDS_ONLY

SOURCE = Path(__file__).parents[1] / "fmu_src" / "tirelab"
ROOMS = ("preprocessing", "regressors", "selection", "estimation", "diagnosis")
SENSITIVITY = Path(__file__).parent / "sensitivity.json"

TOGETHER = "effort"
"""Under this name they stand in the file of the sensitivities."""


@dataclass(frozen=True)
class Constant:
    """One number: its place ("room/module.NAME"), its value as written, and what its source says of it."""

    place: str
    value: str
    words: str

    @property
    def kind(self) -> str:
        """One of KINDS."""
        if self.place in DERIVED:
            return "derived"
        if self.place in PRIOR:
            return "prior"
        return "effort" if self.place in EFFORT else "chosen"

    @property
    def beside(self) -> bool:
        """Whether it makes what is shown beside a verdict, and no verdict."""
        return any(self.place == b or self.place.startswith(b + ".") for b in BESIDE)

    @property
    def tried(self) -> Mapping[str, tuple[int, int]]:
        """Of the factors 0.5 and 2.0: verdicts that became others, and trials; empty where it was not tried."""
        return _sensitivity().get(self.place, {})


@cache
def _sensitivity() -> Mapping[str, Mapping[str, tuple[int, int]]]:
    if not SENSITIVITY.exists():
        return {}
    found: dict[str, dict[str, tuple[int, int]]] = {}
    for row in json.loads(SENSITIVITY.read_text(encoding="utf-8"))["numbers"]:
        found.setdefault(row["number"], {})[str(row["factor"])] = (row["other"], row["trials"])
    return found


def constants() -> list[Constant]:
    """Return all numbers of the rooms, in their order."""
    found: list[Constant] = []
    for room in ROOMS:
        for path in sorted((SOURCE / room).glob("*.py")):
            if path.name not in WORDS_ONLY:
                found += _of_module(f"{room}/{path.stem}", path)
    return found


def within_functions() -> dict[str, str]:
    """Return the lines of the numbers that stand within functions, by their place and value (see ARITHMETIC)."""
    found: dict[str, str] = {}
    for room in ROOMS:
        for path in sorted((SOURCE / room).glob("*.py")):
            module, source = f"{room}/{path.stem}", path.read_text(encoding="utf-8")
            if path.name in WORDS_ONLY or module in BESIDE:
                continue
            lines = source.splitlines()
            for function in (f for f in ast.walk(ast.parse(source)) if isinstance(f, ast.FunctionDef)):
                for n in _numbers_in(function):
                    found[f"{module}.{function.name} {n.value}"] = lines[n.lineno - 1].strip()
    return found


def _numbers_in(function: ast.FunctionDef) -> Iterator[ast.Constant]:
    """Yield the numbers that a function decides with; those in its sentences are of a reader."""
    told = {id(n) for text in ast.walk(function) if isinstance(text, ast.JoinedStr) for n in ast.walk(text)}
    for n in ast.walk(function):
        if isinstance(n, ast.Constant) and type(n.value) in (int, float) and id(n) not in told:
            plain = n.value in (0.5, 1.0, 2.0, *OF_UNITS) or abs(n.value) <= NOT_ZERO
            if not plain and not (isinstance(n.value, int) and n.value <= 4):
                yield n


def _of_module(module: str, path: Path) -> Iterator[Constant]:
    body = ast.parse(path.read_text(encoding="utf-8")).body
    for number, statement in enumerate(body):
        if not isinstance(statement, ast.Assign):
            continue
        for name, value in _named(statement):
            if name.isupper() and _is_number(value):
                yield Constant(f"{module}.{name}", ast.unparse(value), _words(body, number))


def _named(statement: ast.Assign) -> list[tuple[str, ast.expr]]:
    target, value = statement.targets[0], statement.value
    if isinstance(target, ast.Tuple) and isinstance(value, ast.Tuple):
        return [(t.id, v) for t, v in zip(target.elts, value.elts, strict=True) if isinstance(t, ast.Name)]
    return [(target.id, value)] if isinstance(target, ast.Name) else []


def _is_number(value: ast.expr) -> bool:
    numbers = [n for n in ast.walk(value) if isinstance(n, ast.Constant)]
    return bool(numbers) and all(isinstance(n.value, (int, float)) for n in numbers)


def _words(body: list[ast.stmt], number: int) -> str:
    """Return the text after a statement, also where more statements stand between."""
    for statement in body[number + 1 :]:
        if isinstance(statement, ast.Expr) and isinstance(statement.value, ast.Constant):
            return " ".join(str(statement.value.value).split())
        if not isinstance(statement, ast.Assign):
            break
    return ""


def page() -> str:
    """Return the page."""
    every = constants()
    own = [c for c in every if not c.beside]
    counts = {kind: sum(c.kind == kind for c in own) for kind in KINDS}
    lines = [
        "# The numbers that can change a verdict",
        "",
        "For the colleague who asks why a verdict fell as it did, or who wants to change a number. Written by",
        "`python tests/constants.py`; a test checks that every number of the packages between a recording and its",
        "verdict is here. What stands within a function and decides nothing (a half, a weight of third differences)",
        "is in the last table.",
        "",
        *(f"- **{kind}** ({counts[kind]}): {text}" for kind, text in KINDS.items() if counts[kind]),
        "",
        *_told(counts["chosen"]),
        "Beside these, `fmu_src/tirelab/diagnosis/calibration.json` holds the weights of the confidence with the",
        "command that made them, and each effect's file its priors and its form error.",
        "",
        "| number | value | kind | halved | doubled | what it is |",
        "|---|---|---|---|---|---|",
    ]
    order = list(KINDS)[::-1]
    for c in sorted(own, key=lambda c: (order.index(c.kind), -sum(o for o, _ in c.tried.values()))):
        halved, doubled = (_counted(c.tried, factor) for factor in ("0.5", "2.0"))
        lines.append(f"| `{c.place}` | {c.value} | {c.kind} | {halved} | {doubled} | {_plain(c)} |")
    lines += [
        "",
        "## Numbers that make what is shown beside a verdict",
        "",
        "Places of the misfit, the next test, reasons and regressions of a remainder; no verdict depends on them.",
        "",
        "| number | value | kind | what it is |",
        "|---|---|---|---|",
        *(f"| `{c.place}` | {c.value} | {c.kind} | {_plain(c)} |" for c in every if c.beside),
        "",
        "## Numbers within functions",
        "",
        "Coefficients of equations and orders of differences. A half, whole numbers up to four, millimetres, percent",
        "and what keeps a division from zero are not listed.",
        "",
        "| function | number | what it is |",
        "|---|---|---|",
        *(f"| `{place}` | {value} | {what} |" for (place, value), what in _arithmetic()),
    ]
    return "\n".join(lines) + "\n"


def _arithmetic() -> list[tuple[tuple[str, str], str]]:
    return [((key.split()[0], key.split()[1]), what) for key, what in ARITHMETIC.items()]


def _told(chosen: int) -> list[str]:
    lines = [
        f"So {chosen + 1} are not derived: the {chosen} that are set by hand, and the effort. The priors of a refitted",
        "law stand here because no effect's file holds them.",
        "",
    ]
    if not SENSITIVITY.exists():
        return lines
    run = json.loads(SENSITIVITY.read_text(encoding="utf-8"))
    effort = _sensitivity().get(TOGETHER, {})
    ways = (("halved", "0.5"), ("doubled", "2.0"))
    changed = [f"{way}, {count}" for way, factor in ways if (count := _counted(effort, factor))]
    only = "".join(f" --only {name}" for name in run["only"])
    return [
        *lines,
        f"Each of the {chosen} was halved and doubled, and {run['each']} of {run['trials']} blind trials were",
        "diagnosed again each time, other ones for each number: the columns tell how many verdicts became others. The",
        "bounds of the effort were changed all together: "
        + " and ".join(changed)
        + " verdicts became others.",
        "They were taken before what can win was fitted to the samples. The command:",
        "",
        "```sh",
        f"python tests/sensitivity.py --seed {run['seed']} --trials {run['trials']} --each {run['each']}{only}",
        "```",
        "",
    ]


def _counted(tried: Mapping[str, tuple[int, int]], factor: str) -> str:
    if factor not in tried:
        return ""
    other, trials = tried[factor]
    return f"{other} of {trials}"


def _plain(c: Constant) -> str:
    return c.words.replace("|", "\\|")


if __name__ == "__main__":
    print(page(), end="")
