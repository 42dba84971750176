"""The numbers that can change a verdict, in one table: python tests/constants.py > examples/docs/constants.md

Read from the source of the rooms between a recording and its verdict: every upper-case number there, its value and its
own words. Where it comes from stands in KINDS below; tests/test_constants.py holds that none is missing and that the
page is what this prints. What happens to verdicts when a number is halved or doubled is in sensitivity.json, which
tests/sensitivity.py wrote.
"""

from __future__ import annotations

import ast
import json
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from functools import cache
from pathlib import Path

SOURCE = Path(__file__).parents[1] / "fmu_src" / "tirelab"
ROOMS = ("preprocessing", "regressors", "selection", "estimation", "diagnosis")
WORDS_ONLY = (
    "diagnosis_file.py",
    "diagnosis_run.py",
    "effect_figures.py",
    "outcome.py",
    "summary.py",
    "verdict.py",
)
"""Modules of these rooms whose numbers cannot change a verdict."""

BESIDE = (
    "diagnosis/confidence.FASTER",
    "diagnosis/confidence.LONG_ENOUGH",
    "diagnosis/confidence.REACHED",
    "diagnosis/binning",
    "diagnosis/residual_model",
    "diagnosis/diagnose",
    "diagnosis/discriminating_test",
    "diagnosis/localization",
    "preprocessing/samples",
)
"""Modules or numbers of these rooms that make what is shown beside a verdict: places, the next test, reasons."""

SENSITIVITY = Path(__file__).parent / "sensitivity.json"

KINDS: dict[str, str] = {
    "derived": "from a definition, a theorem, a cited source or the numbers' own precision",
    "calibrated": "measured by a command on declared seeds",
    "budget": "bounds time or memory, or says where a search begins; more changes a verdict where one was cut short",
    "chosen": "set by hand and tried on drawn cases",
}

DERIVED = (
    "preprocessing/data_checks.FEWEST_SAMPLES",
    "preprocessing/data_checks.FEWEST_STEPS",
    "preprocessing/noise.LEAST_NOISE",
    "preprocessing/noise.FINEST_STEP",
    "preprocessing/noise.SMALL",
    "preprocessing/noise.LEAST_LEVELS",
    "preprocessing/noise.GRID_TOLERANCE",
    "preprocessing/noise.MEDIAN_TO_SIGMA",
    "preprocessing/noise.SPIKE_LIMIT",
    "preprocessing/noise.TRIMMED",
    "preprocessing/noise.OF_THIRD",
    "regressors/dataset.BY_CHANCE",
    "preprocessing/noise.SHARE_OF_STEP",
    "preprocessing/noise.STAYS",
    "preprocessing/noise.LONGEST_PHASE",
    "preprocessing/motion.SAME",
    "estimation/findings.SHAPE_INDICES",
    "diagnosis/acceptance.LIKELY",
    "preprocessing/motion.PADDING",
    "preprocessing/motion.WEIGHT_ROUNDS",
    "preprocessing/motion.CORNER_SAMPLES",
    "regressors/signature.LEAST_MASS",
    "regressors/signature.REFERENCE",
    "regressors/signature.LEAST_RATIO",
    "regressors/signature.SILENT",
    "regressors/signature.FEWEST",
    "selection/search.GRID",
    "selection/search.LIKE_NOISE",
    "estimation/findings.STEP",
    "estimation/fit.STEP",
    "estimation/fit.DAMPING",
    "estimation/problem.COMMON",
    "estimation/fit.LAW_SCALES",
    "estimation/fit.FORM_SCALES",
    "estimation/findings.DETERMINED",
    "diagnosis/localization.LOCATED",
    "diagnosis/discriminating_test.DECISIVE",
    "diagnosis/confidence.FURTHEST",
    "diagnosis/confidence.SMALLEST",
    "diagnosis/confidence.CREDIBLE",
)

CALIBRATED: dict[str, str] = {}

BUDGET = (
    "preprocessing/samples.ROWS",
    "regressors/dataset.ROWS",
    "regressors/dataset.MOST_ROWS",
    "preprocessing/noise.FEWEST_LAGS",
    "regressors/dataset.FEWEST_ROWS",
    "regressors/signature.DRAWS",
    "regressors/signature.COLUMNS",
    "regressors/signature.ENERGY",
    "selection/search.ROUNDS",
    "selection/search.BEAM",
    "selection/search.POLISHED",
    "selection/search.MOST",
    "selection/search.LOST",
    "estimation/fit.REWEIGHTED",
    "estimation/fit.OPTIONAL_GAIN",
    "estimation/fit.ROUNDS",
    "estimation/fit.ENOUGH",
    "estimation/fit.PASSES",
    "estimation/fit.TRIES",
    "estimation/fit.TRUSTED",
    "estimation/fit.LONGEST",
    "regressors/signature.MOST_SURFACES",
    "preprocessing/motion.MOST_PIECES",
    "estimation/ranking.BEGUN",
    "estimation/ranking.REACH",
    "estimation/ranking.MOST_FITS",
    "estimation/ranking.REPEATS",
    "estimation/ranking.MOST_EFFECTS",
    "estimation/ranking.PROMISING",
    "estimation/ranking.SWAPPED",
    "estimation/ranking.HOPE",
    "preprocessing/noise.FIRST_QUANTILE",
    "regressors/excitation.COURSES",
    "regressors/excitation.DRAWS",
    "estimation/fit.LAW_LOOSE",
    "estimation/problem.AWAKE",
    "diagnosis/acceptance.CONSIDERED",
    "diagnosis/confidence.MOST",
    "diagnosis/localization.MOST_SPANS",
    "diagnosis/binning.BINS",
    "diagnosis/binning.NARROWEST",
    "diagnosis/residual_model.KNOTS",
    "diagnosis/residual_model.SAMPLES_PER_KNOT",
    "diagnosis/residual_model.FOLDS",
    "diagnosis/diagnose.MOST_TESTED",
    "regressors/signature.HEIGHTS",
    "regressors/dataset.SECANTS",
    "selection/search.SIZES",
    "selection/search.NARROWEST",
    "selection/search.WIDEST",
    "diagnosis/localization.DEPTHS",
    "estimation/problem.DEPTHS",
    "estimation/problem.WAYS",
)


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
        if self.place in CALIBRATED:
            return "calibrated"
        return "budget" if self.place in BUDGET else "chosen"

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
    open_ones = [c for c in own if c.kind != "derived"]
    moved = [c for c in open_ones if any(other for other, _ in c.tried.values())]
    lines = [
        "# The numbers that can change a verdict",
        "",
        "For the colleague who asks why a verdict fell as it did, or who wants to change a number. Written by",
        "`python tests/constants.py`; a test holds that it is complete.",
        "",
        *(f"- **{kind}** ({counts[kind]}): {text}" for kind, text in KINDS.items() if counts[kind]),
        "",
        *_told(len(open_ones), moved),
        "Beside these, `fmu_src/tirelab/diagnosis/calibration.json` holds the weights of the confidence with the",
        "command that made them, and each effect's file its priors and its form error.",
        "",
        "| number | value | kind | halved | doubled | what it is |",
        "|---|---|---|---|---|---|",
    ]
    for c in sorted(own, key=lambda c: (list(KINDS).index(c.kind), -sum(o for o, _ in c.tried.values()))):
        made = f" (`{CALIBRATED[c.place]}`)" if c.place in CALIBRATED else ""
        halved, doubled = (_counted(c, factor) for factor in ("0.5", "2.0"))
        lines.append(f"| `{c.place}` | {c.value} | {c.kind}{made} | {halved} | {doubled} | {_plain(c)} |")
    lines += [
        "",
        "## Numbers that make what is shown beside a verdict",
        "",
        "Places of the misfit, the next test, reasons and regressions of a remainder; no verdict depends on them.",
        "",
        "| number | value | kind | what it is |",
        "|---|---|---|---|",
        *(f"| `{c.place}` | {c.value} | {c.kind} | {_plain(c)} |" for c in every if c.beside),
    ]
    return "\n".join(lines) + "\n"


def _told(count: int, moved: list[Constant]) -> list[str]:
    if not SENSITIVITY.exists():
        return []
    run = json.loads(SENSITIVITY.read_text(encoding="utf-8"))
    tried = len({row["number"] for row in run["numbers"]})
    only = "".join(f" --only {name}" for name in run["only"])
    only += f" --kind {run['kind']}" if run.get("kind") else ""
    return [
        f"Of the {count} that are not derived, {tried} were halved and doubled, and {run['each']} of {run['trials']}",
        f"blind trials were diagnosed again each time: {len(moved)} of the numbers changed a verdict at all. The",
        "columns tell how many. The others are not tried yet. The command:",
        "",
        "```sh",
        f"python tests/sensitivity.py --seed {run['seed']} --trials {run['trials']} --each {run['each']}{only}",
        "```",
        "",
    ]


def _counted(c: Constant, factor: str) -> str:
    if factor not in c.tried:
        return ""
    other, trials = c.tried[factor]
    return f"{other} of {trials}"


def _plain(c: Constant) -> str:
    return c.words.replace("|", "\\|")


if __name__ == "__main__":
    print(page(), end="")
