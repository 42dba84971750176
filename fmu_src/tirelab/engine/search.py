"""The search for the set of explanations with the most evidence.

A screening compares thousands of sets on one matrix of products, linear around the believed law or around the best set
so far. The sets at its top are settled: the law's shape, offset, compliance and lag, in which the force is not linear,
are carried along until they stand still. Screening around the best settled set goes on until no neighbour beats it.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np

from ..preprocessing.kinematics import IndexArray
from ..preprocessing.noise_model import Noise
from .columns import Layout, beside_at, build, layout_of, lifted_at, lifted_from_force, measure, moved
from .evidence import Products
from .families import STATIC, Family
from .judge import CONFINED, Candidate, SetName, beside_all, judge, law_whole, material
from .place import Point
from .scene import Scene
from .screen import UNDOING, Screen

POOR = 1.15
"""Where no settled set comes nearer to the noise than this chi square per sample, every effect is settled beside a free
law too."""

TURNS = 9
"""Steps in which a set settles, at most."""

AGAIN = 3
"""So many of the best sets are settled once more from the believed law."""

LAG_STAGES = (0, 1, 2)

LAG_STARTS = (2e-3, 8e-3, 32e-3)
"""Lags [s] from which both are settled: without any lag the relaxation takes its place."""


@dataclass(frozen=True)
class Settled:
    """A candidate with the point carried along until it stands still."""

    candidate: Candidate
    point: Point
    products: Products
    layout: Layout

    @property
    def log_evidence(self) -> float:
        """Log evidence of the set at its own point."""
        return self.candidate.log_evidence

    @property
    def likely(self) -> float:
        """The same, whether or not all of the set is material."""
        return self.candidate.likely

    @property
    def names(self) -> SetName:
        """The families of the set."""
        return self.candidate.names


def settle(
    scene: Scene,
    noises: Sequence[Noise],
    families: dict[str, Family],
    names: SetName,
    zeta: float,
    start: Point,
) -> Settled:
    """Return the set `names` at the point where it stands still."""
    # Once a lag has been found its kind is known too, and stays.
    stages = LAG_STAGES if "force_lag" in names and start.lag <= 0.0 else (start.stages,)
    found = [_settle(scene, noises, families, names, zeta, replace(start, stages=s)) for s in stages]
    if len(stages) > 1 and set(UNDOING) <= set(names):
        found += [
            _settle(scene, noises, families, names, zeta, replace(start, stages=1, lag=lag))
            for lag in LAG_STARTS
        ]
    return max(found, key=lambda s: (s.log_evidence, s.likely))


def _settle(
    scene: Scene,
    noises: Sequence[Noise],
    families: dict[str, Family],
    names: SetName,
    zeta: float,
    start: Point,
) -> Settled:
    chosen = [families[n] for n in names]
    point = _only(start, names)
    best: Settled | None = None
    for turn in range(TURNS):
        built = build(scene, point, chosen)
        layout = layout_of(built, chosen)
        p = measure(built, noises, chosen, point)
        candidate = judge(p, layout, names, zeta)
        settled = Settled(candidate, point, p, layout)
        gained = candidate.log_evidence - best.log_evidence if best else np.inf
        # The first guess of lift-off follows the noise and flatters: the model's own replaces it at once.
        if best is None or turn == 1 or gained > 0.0:
            best = settled
        starts = np.cumsum([0, *(layout.count[n] for n in names)])
        own = [g - start for g, start in zip(candidate.groups, starts, strict=False)]
        lifted = lifted_at(built, point, chosen, candidate.explained.coefficients, own)
        beside = beside_at(built, point, chosen, candidate.explained.coefficients, own)
        following = replace(point, lifted=lifted, beside=beside)
        for name, values, group in zip(names, candidate.explained.coefficients, own, strict=True):
            following = moved(following, name, values, group)
        if _same(point, following) or (turn > 1 and abs(gained) < 0.05):
            break
        if turn == 1 and point.lag > 0.0:
            # What is read late costs a filter for each column: the variants that were not chosen stay behind.
            chosen = [_narrowed(f, group) for f, group in zip(chosen, own, strict=True)]
        point = following
    assert best is not None
    return best


def _narrowed(family: Family, group: IndexArray) -> Family:
    """Return the family with the columns of one variant alone; those that a point holds keep all of theirs."""
    if len(group) == 0 or family.name in KEEP_COLUMNS:
        return family
    return replace(family, build=lambda p: family.build(p)[:, group], variants=lambda n: [list(range(n))])


KEEP_COLUMNS = ("recalibration", "shape", "deflection_offset", "series_compliance", "force_lag")


def _only(point: Point, names: SetName) -> Point:
    shape = point.shape.copy()
    if "recalibration" not in names:
        shape[:, :2] = 0.0
    if "shape" not in names:
        shape[:, 2:] = 0.0
    return Point(
        shape,
        point.offset if "deflection_offset" in names else 0.0,
        point.compliance if "series_compliance" in names else 0.0,
        point.lag if "force_lag" in names else 0.0,
        point.stages,
        point.lifted,
        point.beside,
    )


def _same(a: Point, b: Point) -> bool:
    return (
        _same_ground(a, b)
        and np.allclose(a.shape, b.shape, atol=1e-4)
        and abs(a.offset - b.offset) < 1e-7
        and abs(a.compliance - b.compliance) < 1e-9
        and abs(a.lag - b.lag) < 1e-6
    )


def _same_ground(a: Point, b: Point) -> bool:
    if a.lifted is None or b.lifted is None:
        return a.lifted is b.lifted
    return all(np.array_equal(m, n) for m, n in zip(a.lifted, b.lifted, strict=True))


@dataclass(frozen=True)
class Found:
    """The settled sets, best first, and how many sets were compared."""

    settled: tuple[Settled, ...]
    compared: int


SHAPES = ("recalibration", *STATIC, "force_offset", "bottoming")
"""What may be taken for another function of deflection and surface."""


def _other_shapes(names: SetName, families: dict[str, Family]) -> list[SetName]:
    """Return the set with each other function of deflection and surface in the place of its own ones."""
    if not {"recalibration", "bottoming", *STATIC} & set(names):
        return []
    rest = [n for n in names if n not in (*SHAPES, "shape")]
    return [law_whole((*rest, n)) for n in SHAPES if n in families]


def _confined(names: SetName, families: dict[str, Family]) -> list[SetName]:
    """Return, for what is unknown over the deflection in a set, what acts at one end of it in its place."""
    if not {"deflection", "direction", "surface"} & set(names):
        return []
    rest = [n for n in names if not families[n].agnostic]
    return [law_whole((*rest, n)) for n in CONFINED if n in families]


def _better(one: Settled, other: Settled) -> bool:
    return (one.log_evidence, one.likely) > (other.log_evidence, other.likely)


def _grounded(zero: Point, screened: Callable[[Point], Screen]) -> tuple[Point, Screen]:
    """Return the believed law with or without a first guess of lift-off, whichever sets explain better, screened."""
    assert zero.lifted is not None
    points = [zero]
    if any(lifted.any() for lifted in zero.lifted):
        points.append(replace(zero, lifted=tuple(np.zeros_like(lifted) for lifted in zero.lifted)))
    screens = []
    for point in points:
        screen = screened(point)
        screen.beam()
        screens.append((point, screen))
    return max(screens, key=lambda found: found[1].best(1)[0].log_evidence)


def search(
    scene: Scene,
    noises: Sequence[Noise],
    families: Sequence[Family],
    zeta: float,
    progress: Callable[[str], None] | None = None,
) -> Found:
    """Return the settled sets of families, best first."""
    by_name = {f.name: f for f in families}
    zero = Point(np.zeros((len(scene.radii), 4)), lifted=lifted_from_force(scene))
    settled: dict[SetName, Settled] = {}
    compared = 0

    def settle_all(wanted: Sequence[SetName], start: Point) -> None:
        waiting = list(wanted)
        while waiting:
            names = waiting.pop()
            if names in settled:
                continue
            settled[names] = settle(scene, noises, by_name, names, zeta, start)
            needed = material(settled[names].products, settled[names].candidate, settled[names].layout)
            if needed != names:
                waiting.append(needed)

    def screened(point: Point) -> Screen:
        built = build(scene, point, families, quick=True)
        return Screen(measure(built, noises, families, point), layout_of(built, families), zeta)

    zero, screen = _grounded(zero, screened)
    point = zero
    for turn in range(5):
        if turn:
            screen = screened(point)
        before = max(settled.values(), key=lambda s: s.log_evidence) if settled else None
        top = before.names if before else screen.best(1)[0].names
        screen.neighbours(top)
        compared += len(screen.seen)
        settle_all([c.names for c in screen.best(8)], point)
        settle_all(screen.instead_of_unknown(top), point)
        if turn == 0:
            alone = [s for s in screen.seeds() if len(s) == 1]
            settle_all(alone, point)
            if min(s.candidate.explained.chi_square for s in settled.values()) > POOR:
                settle_all(screen.seeds(), point)
        best = max(settled.values(), key=lambda s: s.log_evidence)
        if progress is not None:
            shown = ", ".join(best.names).replace("_", " ") or "nothing missing"
            progress(f"{compared} sets of effects compared; best so far: {shown}")
        if before is not None and best.names == before.names:
            break
        point = best.point
    settle_all(
        [law_whole(n for n in best.names if n != gone) for gone in best.names if gone != "shape"], point
    )
    top = max(settled.values(), key=lambda s: s.log_evidence).names
    # Around a point that is far off a set may come to rest short of its best: the likeliest begin once more.
    likeliest = [s.names for s in sorted(settled.values(), key=lambda s: -s.log_evidence)[:AGAIN]]
    shapes = [names for one in likeliest for names in _other_shapes(one, by_name)]
    for names in dict.fromkeys([*likeliest, *shapes, *_confined(top, by_name)]):
        fresh = settle(scene, noises, by_name, names, zeta, zero)
        if names not in settled or _better(fresh, settled[names]):
            settled[names] = fresh
    best = max(settled.values(), key=lambda s: s.log_evidence)
    for names in screen.beside(best.names, 3):
        if names not in settled:
            settled[names] = settle(scene, noises, by_name, names, zeta, best.point)
    for name in (n for n in CONFINED if n in by_name):
        best = max(settled.values(), key=lambda s: s.log_evidence)
        names = law_whole((*best.names, name))
        if name in best.names:
            continue
        if names not in settled:
            settled[names] = settle(scene, noises, by_name, names, zeta, best.point)
        more = settled[names]
        settled[names] = replace(more, candidate=beside_all(more.products, more.candidate, name, zeta))
    order = sorted(settled.values(), key=lambda s: -s.log_evidence)
    return Found(tuple(order), compared)
