"""The search for the set of explanations with the most evidence.

A screening compares thousands of sets on one matrix of products, linear around the believed law or around the best set
so far. The sets at its top are settled: the law's shape, offset, compliance and lag, in which the force is not linear, are
carried along until they stand still. Screening around the best settled set goes on until no neighbour beats it.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from itertools import product as combinations

import numpy as np

from ..noise import Noise
from .evidence import Explained, Products, explain, products_of
from .families import Family, Place, Point, lagged, place_at
from .motion import FloatArray
from .scene import Scene

EFFECT_PRIOR = -3.0
"""Log prior odds of one more effect: one in twenty, about one over the number of effects to choose from."""

AGNOSTIC_PRIOR = -8.0
"""Log prior odds that something beyond the catalogue acts in one given coordinate: one in three thousand."""

BEAM = 6
DEEPEST_SET = 6
CLOSE = 30.0
"""Sets within this log evidence of the best one in the screening are settled."""

LAG_STAGES = (0, 1, 2)

SetName = tuple[str, ...]


@dataclass(frozen=True)
class Built:
    """One recording's columns of every family at a point, and what they are to explain."""

    place: Place
    columns: dict[str, FloatArray]
    residual: FloatArray


def build(scene: Scene, point: Point, families: Sequence[Family]) -> list[Built]:
    """Return the columns of `families` for each recording, around `point`, and the residual there."""
    built = []
    for record in scene.records:
        place = place_at(record, scene, point)
        columns = {f.name: f.build(place) for f in families}
        elastic = place.elastic
        if point.lag > 0.0:
            elastic = lagged(record.time, elastic[:, None], point.lag, point.stages)[:, 0]
            for f in families:
                if not f.after_lag:
                    columns[f.name] = lagged(record.time, columns[f.name], point.lag, point.stages)
            if "force_lag" in columns:
                first = np.gradient(elastic, record.time)
                columns["force_lag"] = np.stack([first, np.gradient(first, record.time)], axis=1)
        built.append(Built(place, columns, record.force - elastic))
    return built


def pointed(point: Point, name: str, columns: int) -> FloatArray:
    """Return the coefficients of family `name` that the point already holds."""
    values = np.zeros(columns)
    if name == "recalibration":
        values = point.shape[:, 0:2].ravel()
    elif name == "shape":
        values = point.shape[:, 2:4].ravel()
    elif name == "deflection_offset":
        values = np.array([point.offset])
    elif name == "series_compliance":
        values = np.array([-point.compliance])
    elif name == "force_lag":
        values = np.array([-point.lag, 0.0])
    return values


def moved(point: Point, name: str, values: FloatArray) -> Point:
    """Return the point with the coefficients of family `name` taken up, as far as one step may go."""
    if name in ("recalibration", "shape"):
        shape = point.shape.copy()
        powers = slice(0, 2) if name == "recalibration" else slice(2, 4)
        old = shape[:, powers]
        shape[:, powers] = old + np.clip(values.reshape(old.shape) - old, -0.6, 0.6)
        return replace(point, shape=shape)
    if name == "deflection_offset":
        return replace(point, offset=point.offset + float(np.clip(values[0] - point.offset, -3e-3, 3e-3)))
    if name == "series_compliance":
        return replace(point, compliance=float(np.clip(-values[0], 0.0, point.compliance * 2.0 + 3e-6)))
    if name == "force_lag":
        return replace(point, lag=float(np.clip(-values[0], 0.0, 2.0 * point.lag + 0.02)))
    return point


@dataclass(frozen=True)
class Layout:
    """Where the columns of each family stand in the matrix, and its variants."""

    families: dict[str, Family]
    start: dict[str, int]
    count: dict[str, int]
    variants: dict[str, list[FloatArray]]

    def whole(self, name: str) -> FloatArray:
        """Return all column numbers of a family."""
        return np.arange(self.start[name], self.start[name] + self.count[name])


def layout_of(built: Sequence[Built], families: Sequence[Family]) -> Layout:
    """Return the layout of the families' columns."""
    start, count, variants, at = {}, {}, {}, 0
    for f in families:
        width = built[0].columns[f.name].shape[1]
        start[f.name], count[f.name] = at, width
        variants[f.name] = [np.asarray(v) + at for v in f.variants(width)]
        at += width
    return Layout({f.name: f for f in families}, start, count, variants)


def measure(
    built: Sequence[Built], noises: Sequence[Noise], families: Sequence[Family], point: Point, samples: Sequence[slice | FloatArray] | None = None
) -> Products:
    """Return the products of all columns, with the coefficients that the point holds given back to the data."""
    columns, data = [], []
    for b, noise in zip(built, noises, strict=True):
        held = b.residual.copy()
        for f in families:
            values = pointed(point, f.name, b.columns[f.name].shape[1])
            if np.any(values):
                held += b.columns[f.name] @ values
        columns.append(noise.whitened(np.concatenate([b.columns[f.name] for f in families], axis=1)))
        data.append(noise.whitened(held))
    return products_of(np.concatenate(columns), np.concatenate(data))


@dataclass(frozen=True)
class Candidate:
    """A set of families with its evidence; groups are the columns in use."""

    names: SetName
    log_evidence: float
    groups: tuple[FloatArray, ...]
    explained: Explained


def judge(p: Products, layout: Layout, names: SetName, zeta: float) -> Candidate:
    """Return the candidate of the families `names`: best variants, evidence with priors, signs checked."""
    choice = {n: layout.variants[n][0] for n in names}
    many = [n for n in names if len(layout.variants[n]) > 1]
    prior = 0.0
    for n in names:
        prior += AGNOSTIC_PRIOR if layout.families[n].agnostic else EFFECT_PRIOR
    for turn in range(2 if len(many) > 1 else 1):
        for n in many:
            others = [choice[m] for m in names if m != n and (turn or m not in many[many.index(n) :])]
            choice[n] = _best_variant(p, layout, others, n)
    prior -= sum(float(np.log(len(layout.variants[n]))) for n in many)
    groups = tuple(choice[n] for n in names)
    explained = explain(p, groups, zeta)
    evidence = explained.log_evidence + prior
    if not _signs_hold(p, layout, names, groups, explained):
        evidence = -np.inf
    return Candidate(names, evidence, groups, explained)


def _best_variant(p: Products, layout: Layout, others: Sequence[FloatArray], name: str) -> FloatArray:
    """Return the variant whose leading column explains most on top of the others."""
    variants = layout.variants[name]
    leads = np.array([v[0] for v in variants])
    moment, square = p.moment[leads], np.diag(p.gram)[leads]
    if others:
        fixed = np.concatenate(others)
        inner = np.linalg.inv(p.gram[np.ix_(fixed, fixed)] + 1e-5 * p.samples * np.eye(fixed.size))
        cross = p.gram[np.ix_(leads, fixed)]
        moment = moment - cross @ (inner @ p.moment[fixed])
        square = square - np.einsum("ij,jk,ik->i", cross, inner, cross)
    gain = moment**2 / np.maximum(square, 1e-5 * p.samples)
    sign = layout.families[name].sign
    if sign:
        gain = np.where(sign * moment > 0.0, gain, 0.0)
    return variants[int(np.argmax(gain))]


def _signs_hold(
    p: Products, layout: Layout, names: SetName, groups: Sequence[FloatArray], explained: Explained
) -> bool:
    for name, group, coefficients in zip(names, groups, explained.coefficients, strict=True):
        sign = layout.families[name].sign
        if not sign:
            continue
        lead = group if name in ("rate_independent_hysteresis", "viscoelastic_relaxation", "viscous_damping", "pressure_leak", "warm_up", "mullins_softening") else group[:1]
        scale = np.where(np.isfinite(p.scale[group]), p.scale[group], 0.0)
        projection = float(np.sum(p.gram[np.ix_(lead, group)] @ (coefficients * scale)))
        if sign * projection < 0.0:
            return False
    return True


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
    def names(self) -> SetName:
        """The families of the set."""
        return self.candidate.names


def settle(
    scene: Scene, noises: Sequence[Noise], families: dict[str, Family], names: SetName, zeta: float, start: Point
) -> Settled:
    """Return the set `names` at the point where it stands still."""
    stages = LAG_STAGES if "force_lag" in names else (0,)
    found = [_settle(scene, noises, families, names, zeta, replace(start, stages=s)) for s in stages]
    return max(found, key=lambda s: s.log_evidence)


def _settle(
    scene: Scene, noises: Sequence[Noise], families: dict[str, Family], names: SetName, zeta: float, start: Point
) -> Settled:
    chosen = [families[n] for n in names]
    point = _only(start, names)
    best: Settled | None = None
    for _ in range(6):
        built = build(scene, point, chosen)
        layout = layout_of(built, chosen)
        p = measure(built, noises, chosen, point) if chosen else _nothing(built, noises)
        candidate = judge(p, layout, names, zeta)
        settled = Settled(candidate, point, p, layout)
        gained = candidate.log_evidence - best.log_evidence if best else np.inf
        if best is None or gained > 0.0:
            best = settled
        following = point
        for name, values in zip(names, candidate.explained.coefficients, strict=True):
            following = moved(following, name, values)
        if _same(point, following) or (np.isfinite(gained) and abs(gained) < 0.05):
            break
        point = following
    assert best is not None
    return best


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
    )


def _same(a: Point, b: Point) -> bool:
    return (
        np.allclose(a.shape, b.shape, atol=1e-4)
        and abs(a.offset - b.offset) < 1e-7
        and abs(a.compliance - b.compliance) < 1e-9
        and abs(a.lag - b.lag) < 1e-6
    )


def _nothing(built: Sequence[Built], noises: Sequence[Noise]) -> Products:
    data = np.concatenate([n.whitened(b.residual) for b, n in zip(built, noises, strict=True)])
    return Products(np.zeros((0, 0)), np.zeros(0), float(data @ data), data.size, np.zeros(0))


@dataclass(frozen=True)
class Found:
    """The settled sets, best first, and how many sets were compared."""

    settled: tuple[Settled, ...]
    compared: int


class Screen:
    """Candidates compared around one point, each judged once."""

    def __init__(self, products: Products, layout: Layout, zeta: float) -> None:
        self.products, self.layout, self.zeta = products, layout, zeta
        self.seen: dict[SetName, Candidate] = {}

    def judged(self, names: SetName) -> Candidate:
        """Return the candidate of `names`, judged now or before."""
        key = tuple(sorted(names))
        if key not in self.seen:
            self.seen[key] = judge(self.products, self.layout, key, self.zeta)
        return self.seen[key]

    def allowed(self, names: SetName, name: str) -> bool:
        """Return whether `name` may be added: not twice, and the law's shape only beside its coefficients."""
        return name not in names and (name != "shape" or "recalibration" in names)

    def beam(self) -> None:
        """Grow sets one family at a time, keeping the best of each size."""
        level: list[SetName] = [()]
        best = self.judged(()).log_evidence
        for _ in range(DEEPEST_SET):
            grown = {tuple(sorted((*s, n))) for s in level for n in self.layout.families if self.allowed(s, n)}
            level = sorted(grown, key=lambda s: -self.judged(s).log_evidence)[:BEAM]
            top = self.judged(level[0]).log_evidence
            if top < best - 3.0:
                return
            best = max(best, top)

    def neighbours(self, names: SetName) -> None:
        """Judge every set that differs from `names` by one family more, less or other."""
        for gone in ("", *names):
            left = tuple(n for n in names if n != gone)
            if "shape" in left and "recalibration" not in left:
                left = tuple(n for n in left if n != "shape")
            self.judged(left)
            for n in self.layout.families:
                if self.allowed(left, n):
                    self.judged((*left, n))

    def best(self, count: int) -> list[Candidate]:
        """Return the `count` best candidates within CLOSE of the best."""
        order = sorted(self.seen.values(), key=lambda c: -c.log_evidence)
        return [c for c in order[:count] if c.log_evidence > order[0].log_evidence - CLOSE]


def search(
    scene: Scene,
    noises: Sequence[Noise],
    families: Sequence[Family],
    zeta: float,
    progress: Callable[[str], None] | None = None,
) -> Found:
    """Return the settled sets of families, best first."""
    by_name = {f.name: f for f in families}
    zero = Point(np.zeros((len(scene.radii), 4)))
    settled: dict[SetName, Settled] = {}
    compared = 0

    def settle_all(candidates: Sequence[Candidate], start: Point) -> None:
        for c in candidates:
            if c.names not in settled and np.isfinite(c.log_evidence):
                settled[c.names] = settle(scene, noises, by_name, c.names, zeta, start)

    point = zero
    for turn in range(5):
        built = build(scene, point, families)
        screen = Screen(measure(built, noises, families, point), layout_of(built, families), zeta)
        if turn == 0:
            screen.beam()
        before = max(settled.values(), key=lambda s: s.log_evidence) if settled else None
        top = before.names if before else screen.best(1)[0].names
        screen.neighbours(top)
        compared += len(screen.seen)
        settle_all(screen.best(6), point)
        best = max(settled.values(), key=lambda s: s.log_evidence)
        if progress is not None:
            progress(f"{compared} sets compared; best so far: {', '.join(best.names) or 'nothing'}")
        if before is not None and best.names == before.names:
            break
        point = best.point
    smaller = [screen.judged(tuple(n for n in best.names if n != gone)) for gone in best.names if not (gone == "recalibration" and "shape" in best.names)]
    settle_all(smaller, point)
    order = sorted(settled.values(), key=lambda s: -s.log_evidence)
    return Found(tuple(order), compared)
