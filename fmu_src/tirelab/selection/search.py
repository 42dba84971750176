"""Search over sets of candidates by the marginal likelihood of their signatures: a beam, one candidate at a time."""

from __future__ import annotations

from dataclasses import dataclass

from .discrepancy import Discrepancy
from .marginal_likelihood import Evidence, NormalEquations, evidence_of

PRIOR_ODDS = 5.0
"""What a candidate must gain in log likelihood before it is as likely as not: one of a dozen candidates is there, or
none; and it is worth naming."""

BEAM, POLISHED, MOST = 4, 8, 5
"""Sets kept from one size to the next, sets polished among a size's candidates, candidates of a set."""

LOST = 10.0
"""A size of sets whose best is this far behind ends the search."""


@dataclass(frozen=True)
class Selection:
    """Sets by their posterior (log, not normalised), the likeliest first."""

    ranked: tuple[Evidence, ...]

    def starts(self, best: int) -> tuple[Evidence, ...]:
        """Return the `best` sets, then the best one of each size: a fit may find what the signatures miss."""
        sizes = {len(e.names): e for e in reversed(self.ranked)}
        return tuple(dict.fromkeys((*self.ranked[:best], *(sizes[k] for k in sorted(sizes)))))

    def posterior(self, evidence: Evidence) -> float:
        """Return the log posterior of a set."""
        return evidence.log_likelihood - PRIOR_ODDS * len(evidence.names)


def search(equations: NormalEquations, discrepancy: Discrepancy) -> Selection:
    """Return the sets that were visited."""
    order = {name: i for i, name in enumerate(equations.places)}
    found: dict[tuple[str, ...], Evidence] = {(): evidence_of((), equations, discrepancy)}
    frontier: list[tuple[str, ...]] = [()]

    def posterior(names: tuple[str, ...]) -> float:
        return found[names].log_likelihood - PRIOR_ODDS * len(names)

    def polished(names: tuple[str, ...], start: Evidence) -> None:
        found[names] = evidence_of(names, equations, discrepancy, start)

    for size in range(1, MOST + 1):
        rough: dict[tuple[str, ...], Evidence] = {}
        for base in frontier:
            for name in order:
                names = tuple(sorted({*base, name}, key=order.__getitem__))
                if name not in base and names not in rough:
                    rough[names] = evidence_of(names, equations, discrepancy, found[base], polish=False)
        if not rough:
            break
        best = sorted(rough, key=lambda n: -rough[n].log_likelihood)[:POLISHED]
        for names in best:
            polished(names, rough[names])
        frontier = sorted(best, key=lambda n: -posterior(n))[:BEAM]
        if size > 2:  # a candidate that came first may have been made needless since
            for names in frontier[:2]:
                for out in names:
                    less = tuple(n for n in names if n != out)
                    if less not in found:
                        polished(less, found[names])
        top = max(posterior(n) for n in found)
        if size > 2 and posterior(frontier[0]) < top - LOST:
            break
    ranked = sorted(found.values(), key=lambda e: -(e.log_likelihood - PRIOR_ODDS * len(e.names)))
    return Selection(tuple(ranked))
