"""The proof as numbers (proof.json) and as a self-contained page (proof.html)."""

from __future__ import annotations

import importlib.resources
import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import jinja2
from markupsafe import Markup, escape

from . import figures
from . import metrics as summary
from .acceptance_criteria import Criterion, criteria
from .calibration import Answers, answers, effect_reliability, reliability, skills
from .metrics import Mean, Point, Rate
from .score import Score
from .wide_kinds import (
    PARTS,
    WIDEST_INTERVAL,
    is_wide,
    kind_criteria,
    right_verdicts,
    sound,
    sound_alternative,
)

PROOF_SCHEMA = 5

LEAST_SKILL = 0.35
"""Brier skill of the confidence that all kinds together have to reach."""

REDRAWN = (
    "A trial is drawn again unless every hidden effect matters: leaving it out has to lose at least 30 in "
    "log-likelihood for any amounts of all other effects in the rig's generous linear regressors, on recordings free "
    "of noise, under the noise's spectrum. An effect outside the catalogue has to leave at least a fifth of its "
    "log-likelihood, and 150 of it, to the best pair of catalogue effects; the family of a foreign form has to explain "
    "at least half of the misfit (root mean square) in the rig's own forms. Two exceptions: in a fifth of the drawn "
    "trials an elastic effect under another tire's law may stay hidden, and a press's first file is never drawn again."
)
"""By which measure trials are drawn again."""

SHARED = (
    "The rig and the tool share the catalogue's list of names and nothing else. Which sets count as right beside the "
    "true one follows from the rig's own simulations: each other set, no larger than the true one, is fitted by least "
    "squares in the rig's own formulation to the hidden forces, and is right where the best possible test between it "
    "and the truth errs in 1 % of cases or more. The kinds none to open keep an older rule of the rig as well, on "
    "which the bytes of their answers depend (every loop is right at one constant rate on one surface): both are "
    "counted."
)
"""What the rig and the tool share, and how alternatives are derived."""


@dataclass(frozen=True)
class Proof:
    """The scores of blind trials, and the seed that draws them again."""

    seed: int
    scores: tuple[Score, ...]
    kind: str | None = None

    @property
    def drawn(self) -> tuple[Score, ...]:
        """The trials of the drawn kinds; those of the wide kinds have figures of their own."""
        return tuple(s for s in self.scores if not is_wide(s))

    @property
    def criteria(self) -> tuple[Criterion, ...]:
        """Every figure with its limit: of the drawn kinds, of the wide kinds, and of all of them together."""
        return (*self.own_criteria, *self.kind_criteria, *self.common_criteria)

    @property
    def own_criteria(self) -> tuple[Criterion, ...]:
        """The figures of the drawn kinds, where there is a trial of them."""
        return criteria(self.drawn) if self.drawn else ()

    @property
    def kind_criteria(self) -> tuple[Criterion, ...]:
        """The figures of the wide kinds that were asked for."""
        return kind_criteria(self.scores)

    @property
    def common_criteria(self) -> tuple[Criterion, ...]:
        """The figures of all kinds together, where a wide kind was asked for."""
        if len(self.drawn) == len(self.scores):
            return ()
        found = skills(self.scores)["confidence of the verdict"]
        return (
            Criterion(
                "Brier skill of the confidence over the constant rate", found, LEAST_SKILL, at_least=True
            ),
        )

    @property
    def answers(self) -> Answers:
        """How many answers the rig accepts."""
        return answers(self.scores)

    @property
    def command(self) -> str:
        """The command that repeats the proof."""
        kind = f" --kind {self.kind}" if self.kind else ""
        return f"tirelab prove --trials {len(self.scores)} --seed {self.seed}{kind} --out DIR"

    @property
    def failures(self) -> tuple[Score, ...]:
        """The trials whose diagnosis failed."""
        return tuple(s for s in self.scores if s.error is not None)


def numbers(proof: Proof) -> dict[str, Any]:
    """Return the content of proof.json; rates as value, hits, trials and 95 % interval."""
    scores = proof.scores
    return {
        "schema": PROOF_SCHEMA,
        "seed": proof.seed,
        "trials": len(scores),
        "failed": len(proof.failures),
        "command": proof.command,
        "criteria": [_criterion(c) for c in proof.criteria],
        "parts_of_foreign": [_criterion(c) for c in kind_criteria(scores, PARTS)],
        "answers": {name: _measured(value) for name, value in vars(proof.answers).items()},
        "brier_skill": {what: _measured(value) for what, value in skills(scores).items()},
        "effect_reliability": [_point(p) for p in effect_reliability(scores)],
        "drawn_again": REDRAWN,
        "shared": SHARED,
        "exact_by_kind": _rates(summary.by_kind(scores, right_verdicts)),
        "wrongly_unknown": _measured(summary.wrongly_unknown(proof.drawn)),
        "names_added": _measured(names_added(proof.drawn)),
        "alternatives_per_verdict": _measured(proof.answers.alternatives),
        "confusion": summary.confusion(scores),
        "naming": {effect: [_point(p) for p in points] for effect, points in summary.naming(scores).items()},
        "reliability": [_point(p) for p in reliability(scores)],
        "regions": [
            {"effect": r.effect, "by": r.by, "median_overlap": r.median, "at_least_half": _measured(r.half)}
            for r in summary.regions(scores)
        ],
        "discriminations": _rates(summary.discriminations(scores)),
        "seconds": _measured(Mean.of(s.seconds for s in scores)),
        "scores": [{**s.to_json(), "right_verdict": sound(s)} for s in scores],
    }


def names_added(scores: Sequence[Score]) -> Rate:
    """How often the verdict holds a name that belongs to no set that counts as right, over all trials."""
    return Rate.of(bool(s.added) for s in scores)


def page(proof: Proof) -> str:
    """Return proof.html: one self-contained file, all text escaped."""
    scores = proof.scores
    source = importlib.resources.files(__package__).joinpath("proof.html.jinja").read_text(encoding="utf-8")
    environment = jinja2.Environment(autoescape=True, undefined=jinja2.StrictUndefined, trim_blocks=True)
    environment.filters |= {"interval": interval, "value": value_text, "names": names_text, "words": _words}
    environment.filters |= {"judged": judged, "too_few": too_few}
    style = importlib.resources.files("tirelab.report").joinpath("report.css").read_text(encoding="utf-8")
    return environment.from_string(source).render(
        style=Markup(style),
        proof=proof,
        kinds=summary.by_kind(scores, right_verdicts),
        wrongly_unknown=summary.wrongly_unknown(proof.drawn),
        added=names_added(proof.drawn),
        parts=kind_criteria(scores, PARTS),
        skills=skills(scores),
        redrawn=REDRAWN,
        shared=SHARED,
        right=sound,
        among=sound_alternative,
        regions=summary.regions(scores),
        discriminations=summary.discriminations(scores),
        pictures={
            "confusion": _picture(
                figures.confusion_matrix(summary.confusion(scores)),
                "confusion",
                "Matrix of hidden effects and the names that their verdicts gave them.",
            ),
            "naming": _picture(
                figures.naming_curves(summary.naming(scores)),
                "naming",
                "For each effect, how often it was named over its size in noises, with 95 % intervals.",
            ),
            "reliability": _picture(
                figures.reliability_diagram(reliability(scores)),
                "reliability",
                "How often verdicts were right over their stated confidence, with 95 % intervals.",
            ),
            "effects": _picture(
                figures.effect_reliability_diagram(effect_reliability(scores)),
                "effects",
                "How often named effects were there over their stated probability, with 95 % intervals.",
            ),
            "held_out": _picture(
                figures.held_out_errors(scores),
                "held_out",
                "Held-out error of the corrected tire over that of the baseline, one point for each trial.",
            ),
        },
    )


def value_text(measured: Rate | Mean) -> str:
    """A rate in percent with its counts, a mean with three digits."""
    if math.isnan(measured.value):
        return "not defined" if measured.trials else "no trial"
    if isinstance(measured, Rate):
        return f"{100.0 * measured.value:.1f} % ({measured.hits} of {measured.trials})"
    return f"{measured.value:.3g}"


def too_few(measured: Rate | Mean) -> bool:
    """Whether a rate's interval is too wide to judge by."""
    low, high = measured.interval
    return isinstance(measured, Rate) and not math.isnan(measured.value) and high - low > WIDEST_INTERVAL


def judged(criterion: Criterion) -> str:
    """What came out of a criterion, in words; "too few trials" wherever the interval is too wide to judge by."""
    low, high = criterion.measured.interval
    measured = not math.isnan(criterion.measured.value)
    around = measured and low < criterion.limit < high and high - low > WIDEST_INTERVAL
    return "too few trials" if around or too_few(criterion.measured) else criterion.result


def interval(measured: Rate | Mean) -> str:
    """The 95 % interval in the unit of the value."""
    low, high = measured.interval
    if math.isnan(measured.value):
        return "-"
    if isinstance(measured, Rate):
        return f"{100.0 * low:.1f} to {100.0 * high:.1f} %"
    return f"{low:.3g} to {high:.3g}"


def names_text(names: frozenset[str] | None) -> str:
    """A set of names as text."""
    if names is None:
        return "failed"
    return " + ".join(_words(name) for name in sorted(names))


def _words(name: str) -> str:
    return name.replace("_", " ")


def _picture(figure: Any, name: str, title: str) -> Markup:
    # the text in a figure is names of effects, and matplotlib escapes it
    drawn = figures.svg(figure, name)
    return Markup(drawn.replace("<svg", f'<svg role="img" aria-label="{escape(title)}"', 1))


def _measured(measured: Rate | Mean) -> dict[str, Any]:
    value, (low, high) = measured.value, measured.interval
    known = not math.isnan(value)
    counts = {"hits": measured.hits} if isinstance(measured, Rate) else {}
    return {
        "value": value if known else None,
        "interval": [low, high] if known else None,
        **counts,
        "of": measured.trials,
    }


def _criterion(criterion: Criterion) -> dict[str, Any]:
    return {
        "figure": criterion.figure,
        **_measured(criterion.measured),
        "limit": criterion.limit,
        "direction": "at least" if criterion.at_least else "at most",
        "passes": criterion.passes,
        "result": criterion.result,
    }


def _rates(rates: dict[str, Rate]) -> dict[str, Any]:
    return {name: _measured(rate) for name, rate in rates.items()}


def _point(point: Point) -> dict[str, Any]:
    return {
        "from": point.low,
        "to": point.high if math.isfinite(point.high) else None,
        "at": point.at,
        **_measured(point.rate),
    }
