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
    "written_files.py",
)
"""Modules of these rooms whose numbers cannot change a verdict."""

BESIDE = (
    "diagnosis/alternatives.FASTER",
    "diagnosis/alternatives.HOLD_DEPTH",
    "diagnosis/alternatives.LONG_ENOUGH",
    "diagnosis/alternatives.USUAL_SPEED",
    "diagnosis/between_recordings",
    "diagnosis/binning",
    "diagnosis/contradiction",
    "diagnosis/residual_model",
    "diagnosis/discriminating_test",
    "diagnosis/localization",
    "diagnosis/simulation_correction.FORCE_FROM",
    "preprocessing/samples.ROWS",
)
"""Modules or numbers of these rooms that make what is shown beside a verdict: places, the next test, reasons."""

NOT_ZERO = 1e-6
"""What only keeps a division or a logarithm from zero, or a sum from its rounding."""

OF_UNITS = (100.0, 1000.0)
"""Centimetres and millimetres in a metre, and percent."""

SENSITIVITY = Path(__file__).parent / "sensitivity.json"

KINDS: dict[str, str] = {
    "derived": "from a definition, a theorem, a cited source, other numbers or the numbers' own precision",
    "prior": "spread of a refitted law's parameters, as the effects' files declare theirs; recordings find its scale",
    "effort": "bounds time or memory, or says where and how finely a search looks: one number, scaled all together",
    "chosen": "set by hand and tried on drawn cases",
}

DERIVED = (
    "diagnosis/simulation_correction.FAR_OFF",
    "estimation/fit.BARE_MENTION",
    "preprocessing/data_checks.BY_CHANCE",
    "preprocessing/data_checks.FEWEST_BESIDE",
    "preprocessing/data_checks.FEWEST_SAMPLES",
    "preprocessing/data_checks.FEWEST_STEPS",
    "preprocessing/data_checks.FEWEST_A_CYCLE",
    "preprocessing/data_checks.FOLLOWED",
    "preprocessing/data_checks.LEAST_TOLD",
    "preprocessing/data_checks.MAJORITY",
    "preprocessing/data_checks.ONWARDS",
    "preprocessing/gauge.FIFTH",
    "preprocessing/gauge.HALF",
    "preprocessing/gauge.HIGHEST",
    "preprocessing/gauge.STOPPED",
    "preprocessing/gauge.ON_GRID",
    "preprocessing/levels.FEWEST_READINGS",
    "selection/search.FEWEST_EACH",
    "estimation/problem.FARTHEST",
    "estimation/minimise.DAMPED",
    "regressors/dataset.LARGEST",
    "diagnosis/confidence.MOST_TRANSFER",
    "preprocessing/data_checks.SETTLING",
    "preprocessing/gauge.FINEST_STEP",
    "preprocessing/gauge.GRID_TOLERANCE",
    "preprocessing/gauge.LEAST_LEVELS",
    "preprocessing/gauge.LEAST_NOISE",
    "preprocessing/gauge.SMALL",
    "preprocessing/hum.DEVIATION",
    "preprocessing/hum.MAINS",
    "preprocessing/driven.KINDS",
    "preprocessing/levels.FEWEST",
    "preprocessing/levels.OF_THIRD",
    "preprocessing/levels.STAYS",
    "preprocessing/motion.ARC",
    "preprocessing/motion.CORNER",
    "preprocessing/motion.CORNER_SAMPLES",
    "preprocessing/motion.FADED",
    "preprocessing/motion.FORGOTTEN",
    "preprocessing/motion.PADDING",
    "preprocessing/motion.SAME",
    "preprocessing/motion.SHORTEST",
    "preprocessing/motion.UNUSED",
    "preprocessing/motion.WEIGHT_ROUNDS",
    "preprocessing/motion.WINDOW",
    "preprocessing/levels.FEWEST_IN_STATE",
    "preprocessing/noise.LONGEST_PHASE",
    "preprocessing/noise_floor.SHARE_OF_STEP",
    "preprocessing/levels.STATE_LAGS",
    "preprocessing/spread.MEDIAN_TO_SIGMA",
    "preprocessing/spread.TRIMMED",
    "regressors/experiment.COUNTED",
    "regressors/excitation.COURSE_DRAWS",
    "regressors/excitation.UNDER_WAY",
    "regressors/signature.FEWEST",
    "regressors/draws.LEAST_MASS",
    "regressors/signature.LEAST_RATIO",
    "regressors/signature.SILENT",
    "selection/search.BEAM",
    "selection/search.GRID",
    "selection/search.LIKE_NOISE",
    "estimation/findings.DETERMINED",
    "estimation/findings.SENSITIVITY_STEP",
    "diagnosis/moved_simulation.TRIED",
    "estimation/minimise.DAMPING",
    "estimation/first_sets.LEAST_LEFT",
    "estimation/evidence.DRIFT_SCALES",
    "estimation/evidence.FORM_SCALES",
    "estimation/evidence.LAW_SCALES",
    "estimation/forms.DEFLECTION_HATS",
    "estimation/forms.SIGNED_HATS",
    "estimation/minimise.STEP",
    "estimation/problem.COMMON",
    "estimation/problem.KINKS",
    "estimation/problem.MOST_OF_FACTOR",
    "estimation/problem.MOST_UNUSUAL",
    "estimation/ranking.MOST_EFFECTS",
    "estimation/ranking.SWAPPED",
    "diagnosis/acceptance.LIKELY",
    "diagnosis/alternatives.CREDIBLE",
    "diagnosis/confidence.EITHER",
    "diagnosis/confidence.MOST_LOG_ODDS",
    "diagnosis/confidence.LEAST_SHARE",
    "diagnosis/discriminating_test.DECISIVE",
    "diagnosis/localization.LOCATED",
)

PRIOR = tuple(f"regressors/signature.{n}" for n in ("FACTOR", "EXPONENT", "BEND", "TWIST", "KINK", "PRELOAD"))

EFFORT = (
    "preprocessing/gauge.CANDIDATES",
    "preprocessing/levels.LOADS",
    "diagnosis/moved_simulation.MOST_REPLAYS",
    "diagnosis/moved_simulation.SETTLED",
    "preprocessing/motion.CUTOFFS",
    "preprocessing/motion.LEVERAGE",
    "preprocessing/motion.KEPT",
    "preprocessing/motion.KEPT_LONG",
    "preprocessing/motion.LONG",
    "preprocessing/motion.MOST_PIECES",
    "preprocessing/driven.FEWEST_LAGS",
    "preprocessing/hum.FEWEST_BINS",
    "preprocessing/hum.PADDED",
    "preprocessing/samples.ROWS",
    "preprocessing/spread.FIRST_QUANTILE",
    "regressors/experiment.FEWEST_BLOCKS",
    "regressors/dataset.MOST_BLOCKS",
    "regressors/dataset.BLOCKS",
    "regressors/experiment.SECANTS",
    "regressors/experiment.RESOLVED",
    "regressors/experiment.PROGRESSION",
    "regressors/excitation.CELLS",
    "regressors/excitation.COURSES",
    "regressors/signature.COLUMNS",
    "regressors/signature.DRAWS",
    "regressors/signature.ENERGY",
    "preprocessing/samples.MOST_SURFACES",
    "regressors/signature.BLOCKS_OF_PART",
    "regressors/signature.PARTS",
    "regressors/signature.PROBED",
    "regressors/draws.LEAST_DRAWN",
    "regressors/draws.MOST_OF_LOAD",
    "regressors/draws.SIZED",
    "regressors/draws.OVERSIZED",
    "preprocessing/data_checks.PARTS_OF_STAY",
    "selection/search.STARTS",
    "estimation/additions.PREDICTED_SIZES",
    "estimation/additions.LEAST_START",
    "estimation/fit.SETTLED",
    "selection/search.LOST",
    "selection/search.MOST_CANDIDATES",
    "selection/search.LEAST_SIZE",
    "selection/search.POLISHED",
    "selection/search.ITERATIONS",
    "selection/search.SIZES",
    "selection/search.MOST_SIZE",
    "estimation/findings.REMAINDER_BINS",
    "estimation/fit.LEAST_GAIN",
    "estimation/fit.LAW_LOOSE",
    "estimation/minimise.LONGEST",
    "estimation/fit.OPTIONAL_GAIN",
    "estimation/evidence.PASSES",
    "estimation/fit.REWEIGHTINGS",
    "estimation/fit.ROUNDS",
    "estimation/minimise.TRIES",
    "estimation/minimise.TRUSTED",
    "estimation/problem.START_OFFSET",
    "estimation/first_sets.BEGUN",
    "estimation/ranking.CORRECTIONS",
    "estimation/ranking.EVALUATION",
    "estimation/explanation.FIRST_PART",
    "estimation/ranking.USUAL_MOVED",
    "estimation/ranking.GAIN_ERROR",
    "estimation/ranking.MOST_FITS",
    "estimation/ranking.MOST_WORK",
    "estimation/ranking.PROMISING",
    "estimation/ranking.REPEATS",
    "diagnosis/states_of_motion.DEPTHS",
    "diagnosis/states_of_motion.SPEEDS_PER_OCTAVE",
    "diagnosis/contradiction.ANEW",
    "diagnosis/contradiction.SUSPECTED",
    "diagnosis/between_recordings.ROUNDS",
    "diagnosis/between_recordings.SETTLED",
    "diagnosis/between_recordings.STEP",
    "diagnosis/acceptance.CONSIDERED",
    "diagnosis/binning.BINS",
    "diagnosis/binning.NARROWEST",
    "diagnosis/alternatives.MOST_LISTED",
    "diagnosis/discriminating_test.MOST_TESTED",
    "diagnosis/localization.DEPTHS",
    "diagnosis/localization.MOST_SPANS",
    "diagnosis/residual_model.FOLDS",
    "diagnosis/residual_model.KNOTS",
    "diagnosis/residual_model.SAMPLES_PER_KNOT",
)

BOUNDS = (
    "regressors/experiment.FEWEST_BLOCKS",
    "regressors/dataset.MOST_BLOCKS",
    "regressors/dataset.BLOCKS",
    "regressors/excitation.COURSES",
    "regressors/signature.COLUMNS",
    "regressors/signature.DRAWS",
    "selection/search.LOST",
    "selection/search.MOST_CANDIDATES",
    "selection/search.POLISHED",
    "selection/search.ITERATIONS",
    "estimation/evidence.PASSES",
    "estimation/fit.REWEIGHTINGS",
    "estimation/fit.ROUNDS",
    "estimation/minimise.TRIES",
    "estimation/first_sets.BEGUN",
    "estimation/ranking.CORRECTIONS",
    "estimation/ranking.GAIN_ERROR",
    "estimation/ranking.MOST_FITS",
    "estimation/ranking.MOST_WORK",
    "estimation/ranking.PROMISING",
    "estimation/ranking.REPEATS",
    "diagnosis/acceptance.CONSIDERED",
)
"""Those of the effort of which more is better: what is halved and doubled together."""

ARITHMETIC: dict[str, str] = {
    "preprocessing/data_checks.check_recordings 0.001": "deflections a thousandth of the span apart are distinct",
    "preprocessing/data_checks.spikes 1.5": "variance of the mean of a sample's two differences, over its own",
    "preprocessing/gauge.deflection_noise 1.5": "between one step and two: second differences of a rounded motion",
    "preprocessing/gauge._random_noise 5": "order of the differences that white noise is told by",
    "preprocessing/gauge.deflection_noise 12.0": "variance of a rounding error: step^2 / 12",
    "preprocessing/gauge._random_noise 252.0": "variance of fifth differences of white noise",
    "preprocessing/gauge.read_again 12.0": "variance of a rounding error: step^2 / 12",
    "preprocessing/levels._third_differences 3.0": "weights of third differences",
    "preprocessing/motion._motion 12.0": "variance of a rounding error: step^2 / 12",
    "preprocessing/motion._smoothed 0.001": "intervals that differ by less are a clock's rounding",
    "preprocessing/motion._resolved 3.0": "five samples, from -2 to 2",
    "preprocessing/motion._resolved 5": "five samples: one more than a cubic has coefficients",
    "preprocessing/motion.smoothed 4.0": "norm of the square of a Gaussian window",
    "preprocessing/motion._spline 4.0": "an arc at each end, each within a quarter",
    "preprocessing/motion._spline 6": "the filter of a spline of third differences",
    "preprocessing/motion._ends 2.5": "second derivative of the arc",
    "preprocessing/motion._weights_of_end 6": "the filter of a spline of third differences",
    "preprocessing/motion._third_differences_squared 3.0": "weights of third differences",
    "preprocessing/turns._at_rest 5": "a reading, two before it and two after it",
    "regressors/signature._spline 3.0": "degree of a cubic spline",
    "selection/search.profile 4.0": "solution of a quadratic equation",
    "selection/search.evidence_of 4.0": "the first V of a search is a quarter of the highest",
    "selection/search.evidence_of 0.0001": "below the least size that is searched",
    "estimation/problem.parameters_of_law 5": "number of a group of parameters",
    "estimation/problem.parameters_of_law 6": "number of a group of parameters",
    "estimation/problem.parameters_of_law 7": "number of a group of parameters",
    "estimation/problem.parameters_of_law 8": "number of a group of parameters",
    "estimation/problem.parameters_of_law 9": "number of a group of parameters",
    "diagnosis/alternatives._is_held 0.25": "a turn goes a quarter as far as the speed at its ends would",
    "estimation/problem.residual 1000000.0": "a force that is no number is far from every reading",
}
"""Numbers that stand within a function, other than a half, whole ones up to four, units of length and percent in words,
and what keeps a division from zero: where, and what they are."""

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
