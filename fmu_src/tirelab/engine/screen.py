"""The screening: thousands of sets of explanations compared on one matrix of products, around one point."""

from __future__ import annotations

from .columns import Layout
from .evidence import Products
from .families import STATIC
from .judge import Candidate, SetName, judge, law_whole

BEAM = 6
DEEPEST_SET = 6

MOST_BEYOND = 2
"""Coordinates beyond the catalogue in one set: the verdict is then something unknown, whatever else it depends on."""

CLOSE = 30.0
"""Sets within this log evidence of the best one in the screening are settled."""

BESIDE = 5.0
"""Sets with one effect more are settled within this log evidence, even if that effect is too small to be believed."""

UNDOING = ("force_lag", "viscoelastic_relaxation")
"""What one of them adds to a quick change the other takes away: where both act neither fits alone."""

OF_RATE = ("viscous_damping", "viscoelastic_relaxation", "inertia")
"""What a large lag hides: around no lag at all the sets with both do not stand out."""


class Screen:
    """Candidates compared around one point, each judged once."""

    def __init__(self, products: Products, layout: Layout, zeta: float) -> None:
        self.products, self.layout, self.zeta = products, layout, zeta
        self.seen: dict[SetName, Candidate] = {}

    def judged(self, names: SetName) -> Candidate:
        """Return the candidate of `names`, judged now or before."""
        key = law_whole(names)
        if key not in self.seen:
            self.seen[key] = judge(self.products, self.layout, key, self.zeta)
        return self.seen[key]

    def allowed(self, names: SetName, name: str) -> bool:
        """Return whether `name` may be added: not twice, nothing unknown beyond MOST_BEYOND, no shape by itself."""
        if name in names or name == "shape":
            return False
        beyond = sum(self.layout.families[n].agnostic for n in names)
        return not self.layout.families[name].agnostic or beyond < MOST_BEYOND

    def beam(self) -> None:
        """Grow sets one family at a time, keeping the best of each size."""
        level: list[SetName] = [()]
        best = self.judged(()).log_evidence
        for _ in range(DEEPEST_SET):
            # In order, not a set: among equals the first is kept, in every process the same.
            grown = dict.fromkeys(
                self.judged((*s, n)).names for s in level for n in self.layout.families if self.allowed(s, n)
            )
            level = sorted(grown, key=self._order)[:BEAM]
            top = self.judged(level[0]).log_evidence
            if top < best - 3.0:
                return
            best = max(best, top)

    def _order(self, names: SetName) -> tuple[float, float]:
        found = self.judged(names)
        return -found.log_evidence, -found.likely

    def neighbours(self, names: SetName) -> None:
        """Judge every set that differs from `names` by one family more, less or other, and by a free law."""
        law = ["recalibration"] if "recalibration" in self.layout.families else []
        for gone in ("", *names):
            left = tuple(n for n in names if n not in (gone, "shape"))
            self.judged(left)
            for n in self.layout.families:
                if self.allowed(left, n):
                    self.judged((*left, n))
                    self.judged((*left, n, *law))
            if all(n in self.layout.families for n in UNDOING):
                self.judged((*left, *(n for n in UNDOING if n not in left)))
                self.judged((*left, *(n for n in UNDOING if n not in left), *law))
        for free in self.freed(names):
            self.judged(free)

    def freed(self, names: SetName) -> list[SetName]:
        """Return the set with a free law in place of the effects that are like one, if the law may be another's."""
        if "recalibration" not in self.layout.families:
            return []
        return [law_whole((*(n for n in names if n not in STATIC), "recalibration"))]

    def seeds(self) -> list[SetName]:
        """Return every family of the catalogue alone, then a lag with each of OF_RATE, all also beside a free law."""
        known = [
            n
            for n, f in self.layout.families.items()
            if not f.agnostic and n not in ("shape", "recalibration")
        ]
        alone: list[SetName] = [(n,) for n in known]
        alone += [("force_lag", n) for n in OF_RATE if n in known and "force_lag" in known]
        beside = [law_whole((*s, "recalibration")) for s in alone if "recalibration" in self.layout.families]
        return [*alone, *beside]

    def instead_of_unknown(self, names: SetName) -> list[SetName]:
        """Return, for what is beyond the catalogue in a set, the three effects that do best in its place."""
        found: list[SetName] = []
        for gone in (n for n in names if self.layout.families[n].agnostic):
            left = tuple(n for n in names if n != gone)
            known = [n for n, f in self.layout.families.items() if not f.agnostic and self.allowed(left, n)]
            found += sorted(
                (law_whole((*left, n)) for n in known), key=lambda s: -self.judged(s).log_evidence
            )[:3]
        if any(self.layout.families[n].agnostic for n in names) or any(n in STATIC for n in names):
            found += self.freed(names)
        return found

    def beside(self, names: SetName, count: int) -> list[SetName]:
        """Return the set with each of the `count` likeliest effects more, material or not, that may be there."""
        known = [n for n, f in self.layout.families.items() if not f.agnostic and self.allowed(names, n)]
        more = [law_whole((*names, n)) for n in known]
        more = [n for n in more if self.judged(n).likely > self.judged(names).likely - BESIDE]
        return sorted(more, key=lambda s: -self.judged(s).likely)[:count]

    def best(self, count: int) -> list[Candidate]:
        """Return the `count` best candidates within CLOSE of the best."""
        order = sorted(self.seen.values(), key=lambda c: -c.log_evidence)
        return [c for c in order[:count] if c.log_evidence > order[0].log_evidence - CLOSE]
