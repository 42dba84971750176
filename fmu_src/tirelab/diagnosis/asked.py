"""What is asked of a diagnosis, and what is known before it of a simulation of others."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np
from radialtire import TireModel
from scipy.special import expit

from ..estimation.findings import NamedEffect, Remainder
from ..planning.waveforms import Limits
from ..preprocessing.samples import Recorded
from ..report.titles import listed, newtons, short_title
from ..selection.search import EFFECTIVE, PRIOR_ODDS
from .alternatives import Alternative
from .localization import Span
from .verdict import FitErrors


@dataclass(frozen=True)
class Before:
    """Effects before a simulation that were found with it (see `moved_simulation`), none by default. The recordings
    that are diagnosed have the deflection after them.

    effects: named, the one that was found last at the end; values: of all parameters of each; without: errors [N] of
    the likeliest verdict without the last one; errors: of the recordings as they are; where: places of their misfit;
    recordings, held_out: as they are; tried: whether such effects are tried with the simulation
    """

    effects: tuple[NamedEffect, ...] = ()
    values: tuple[tuple[str, tuple[float, ...]], ...] = ()
    without: FitErrors | None = None
    errors: FitErrors | None = None
    where: tuple[Span, ...] = ()
    recordings: tuple[Recorded, ...] = ()
    held_out: tuple[Recorded, ...] = ()
    tried: bool = False

    @property
    def probability(self) -> float:
        """Probability that all of them are there."""
        return float(np.prod([e.probability for e in self.effects]))

    def judged(self, fit: FitErrors) -> Before:
        """Return the same with the probability of the last effect, from the errors [N] that are left with it."""
        if self.without is None:
            return self
        odds = log_odds(self.without.after, fit.after)
        if self.held_out:
            odds = min(odds, log_odds(self.without.held_out_after, fit.held_out_after))
        last = replace(self.effects[-1], probability=float(expit(odds)))
        return replace(self, effects=(*self.effects[:-1], last))

    def told(self, fit: FitErrors) -> list[str]:
        """Return the sentence on what was found; fit: what is left."""
        if self.without is None:
            return []
        names = listed([short_title(e.name) for e in self.effects], "and")
        return [
            f"The simulation itself was given the deflection after the {names}: this leaves {newtons(fit.after)}, "
            f"where {newtons(self.without.after)} are left without it."
        ]

    def of_the_whole(self, remainder: Remainder, noise: float) -> Remainder:
        """Return a remainder with its share of the misfit of the recordings as they are; noise [N]: of theirs."""
        if self.errors is None:
            return remainder
        missed = max(self.errors.before**2 - noise**2, 1e-300)
        return replace(remainder, share=min(remainder.force**2 / missed, 1.0))

    def beside(
        self, effects: Sequence[NamedEffect], alternatives: Sequence[Alternative], fit: FitErrors
    ) -> tuple[tuple[NamedEffect, ...], tuple[Alternative, ...], FitErrors]:
        """Return what was found in the recordings with the deflection after these effects, with these effects."""
        if self.errors is None:
            return tuple(effects), tuple(alternatives), fit
        names, chance = [e.name for e in self.effects], self.probability
        return (
            (*self.effects, *effects),
            tuple(
                replace(a, names=(*names, *a.names), probability=chance * a.probability) for a in alternatives
            ),
            replace(fit, before=self.errors.before, held_out_before=self.errors.held_out_before),
        )


def log_odds(without: float, left: float) -> float:
    """Return the log odds of an effect before a simulation that leaves so much [N] of what is left without it: the
    evidence of two discrepancies with EFFECTIVE samples, and the prior of an effect.
    """
    return EFFECTIVE * math.log(max(without, 1e-300) / max(left, 1e-300)) - PRIOR_ODDS


@dataclass(frozen=True)
class Asked:
    """What is asked of a diagnosis (see `diagnose`); before: what is known before it."""

    recordings: Sequence[Recorded]
    baseline: TireModel
    held_out: Sequence[Recorded] = ()
    catalogue: Sequence[str] | None = None
    limits: Limits | None = None
    progress: Callable[[str], None] | None = None
    before: Before = Before()
