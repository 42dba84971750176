"""The proof as numbers (proof.json) and as a page (proof.html) that needs nothing from elsewhere."""

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
from .acceptance_criteria import Line, against_the_bar
from .metrics import Mean, Point, Rate
from .score import Score

SCHEMA = 3


@dataclass(frozen=True)
class Proof:
    """The scores of a series of trials, and the seed that makes them again."""

    seed: int
    scores: tuple[Score, ...]

    @property
    def lines(self) -> tuple[Line, ...]:
        """Every figure beside its bar."""
        return against_the_bar(self.scores)

    @property
    def command(self) -> str:
        """The command that makes the proof again."""
        return f"tirelab prove --trials {len(self.scores)} --seed {self.seed} --out DIR"

    @property
    def failures(self) -> tuple[Score, ...]:
        """The trials whose diagnosis failed."""
        return tuple(s for s in self.scores if s.error is not None)


def numbers(proof: Proof) -> dict[str, Any]:
    """Return the content of proof.json; rates as value, hits, trials and 95 % interval."""
    scores = proof.scores
    return {
        "schema": SCHEMA,
        "seed": proof.seed,
        "trials": len(scores),
        "failed": len(proof.failures),
        "command": proof.command,
        "bar": [
            {
                "figure": line.figure,
                **_measured(line.measured),
                "bar": line.bar,
                "direction": "at least" if line.at_least else "at most",
                "passes": line.passes,
            }
            for line in proof.lines
        ],
        "exact_by_kind": _rates(summary.by_kind(scores, summary.exact)),
        "wrongly_unknown": _measured(summary.wrongly_unknown(scores)),
        "names_added": _measured(names_added(scores)),
        "rivals_per_verdict": _measured(rivals_named(scores)),
        "confusion": summary.confusion(scores),
        "naming": {effect: [_point(p) for p in points] for effect, points in summary.naming(scores).items()},
        "reliability": [_point(p) for p in summary.reliability(scores)],
        "places": [
            {"effect": p.effect, "by": p.by, "median_overlap": p.median, "at_least_half": _measured(p.half)}
            for p in summary.places(scores)
        ],
        "separations": _rates(summary.separations(scores)),
        "seconds": _measured(Mean.of(s.seconds for s in scores)),
        "scores": [s.to_json() for s in scores],
    }


def names_added(scores: Sequence[Score]) -> Rate:
    """How often the verdict holds a name that belongs to no set that counts as right, over all trials."""
    return Rate.of(bool(s.added) for s in scores)


def rivals_named(scores: Sequence[Score]) -> Mean:
    """How many rivals a verdict names: with many of them the truth is among them for nothing."""
    return Mean.of(float(len(s.alternatives)) for s in scores if s.verdict is not None)


def page(proof: Proof) -> str:
    """Return proof.html: one file, everything in it, all text escaped."""
    scores = proof.scores
    source = importlib.resources.files(__package__).joinpath("proof.html.jinja").read_text(encoding="utf-8")
    environment = jinja2.Environment(autoescape=True, undefined=jinja2.StrictUndefined, trim_blocks=True)
    environment.filters |= {"interval": interval, "value": told_value, "names": told_names, "words": _words}
    return environment.from_string(source).render(
        proof=proof,
        lines=proof.lines,
        kinds=summary.by_kind(scores, summary.exact),
        wrongly_unknown=summary.wrongly_unknown(scores),
        added=names_added(scores),
        rivals=rivals_named(scores),
        places=summary.places(scores),
        separations=summary.separations(scores),
        pictures={
            "confusion": _picture(figures.confusion_matrix(summary.confusion(scores)), "confusion"),
            "naming": _picture(figures.naming_curves(summary.naming(scores)), "naming"),
            "reliability": _picture(figures.reliability_diagram(summary.reliability(scores)), "reliability"),
            "held_out": _picture(figures.held_out_errors(scores), "held_out"),
        },
    )


def told_value(measured: Rate | Mean) -> str:
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


def told_names(names: frozenset[str] | None) -> str:
    """A set of names in words."""
    if names is None:
        return "failed"
    return " + ".join(_words(name) for name in sorted(names))


def _words(name: str) -> str:
    return name.replace("_", " ")


def _picture(figure: Any, name: str) -> Markup:
    # what stands in a figure comes from names of effects, and matplotlib escapes it
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
