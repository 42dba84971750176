"""The proof as numbers (proof.json) and as a self-contained page (proof.html)."""

from __future__ import annotations

import importlib.resources
import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import jinja2
from markupsafe import Markup

from . import figures
from . import metrics as summary
from .acceptance_criteria import Criterion, criteria
from .metrics import Mean, Point, Rate
from .score import Score

PROOF_SCHEMA = 4


@dataclass(frozen=True)
class Proof:
    """The scores of blind trials, and the seed that draws them again."""

    seed: int
    scores: tuple[Score, ...]

    @property
    def criteria(self) -> tuple[Criterion, ...]:
        """Every figure with its limit."""
        return criteria(self.scores)

    @property
    def command(self) -> str:
        """The command that repeats the proof."""
        return f"tirelab prove --trials {len(self.scores)} --seed {self.seed} --out DIR"

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
        "criteria": [
            {
                "figure": criterion.figure,
                **_measured(criterion.measured),
                "limit": criterion.limit,
                "direction": "at least" if criterion.at_least else "at most",
                "passes": criterion.passes,
            }
            for criterion in proof.criteria
        ],
        "exact_by_kind": _rates(summary.by_kind(scores, summary.exact)),
        "wrongly_unknown": _measured(summary.wrongly_unknown(scores)),
        "names_added": _measured(names_added(scores)),
        "alternatives_per_verdict": _measured(alternatives_named(scores)),
        "confusion": summary.confusion(scores),
        "naming": {effect: [_point(p) for p in points] for effect, points in summary.naming(scores).items()},
        "reliability": [_point(p) for p in summary.reliability(scores)],
        "regions": [
            {"effect": r.effect, "by": r.by, "median_overlap": r.median, "at_least_half": _measured(r.half)}
            for r in summary.regions(scores)
        ],
        "discriminations": _rates(summary.discriminations(scores)),
        "seconds": _measured(Mean.of(s.seconds for s in scores)),
        "scores": [s.to_json() for s in scores],
    }


def names_added(scores: Sequence[Score]) -> Rate:
    """How often the verdict holds a name that belongs to no set that counts as right, over all trials."""
    return Rate.of(bool(s.added) for s in scores)


def alternatives_named(scores: Sequence[Score]) -> Mean:
    """How many alternatives a verdict states: with many of them the truth is easily among them."""
    return Mean.of(float(len(s.alternatives)) for s in scores if s.verdict is not None)


def page(proof: Proof) -> str:
    """Return proof.html: one self-contained file, all text escaped."""
    scores = proof.scores
    source = importlib.resources.files(__package__).joinpath("proof.html.jinja").read_text(encoding="utf-8")
    environment = jinja2.Environment(autoescape=True, undefined=jinja2.StrictUndefined, trim_blocks=True)
    environment.filters |= {"interval": interval, "value": value_text, "names": names_text, "words": _words}
    return environment.from_string(source).render(
        proof=proof,
        kinds=summary.by_kind(scores, summary.exact),
        wrongly_unknown=summary.wrongly_unknown(scores),
        added=names_added(scores),
        alternatives=alternatives_named(scores),
        regions=summary.regions(scores),
        discriminations=summary.discriminations(scores),
        pictures={
            "confusion": _picture(figures.confusion_matrix(summary.confusion(scores)), "confusion"),
            "naming": _picture(figures.naming_curves(summary.naming(scores)), "naming"),
            "reliability": _picture(figures.reliability_diagram(summary.reliability(scores)), "reliability"),
            "held_out": _picture(figures.held_out_errors(scores), "held_out"),
        },
    )


def value_text(measured: Rate | Mean) -> str:
    """A rate in percent with its counts, a mean with three digits."""
    if math.isnan(measured.value):
        return "no trial"
    if isinstance(measured, Rate):
        return f"{100.0 * measured.value:.1f} % ({measured.hits} of {measured.trials})"
    return f"{measured.value:.3g}"


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


def _picture(figure: Any, name: str) -> Markup:
    # the text in a figure is names of effects, and matplotlib escapes it
    return Markup(figures.svg(figure, name))


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


def _rates(rates: dict[str, Rate]) -> dict[str, Any]:
    return {name: _measured(rate) for name, rate in rates.items()}


def _point(point: Point) -> dict[str, Any]:
    return {
        "from": point.low,
        "to": point.high if math.isfinite(point.high) else None,
        "at": point.at,
        **_measured(point.rate),
    }
