"""The search for the set of explanations with the most evidence.

A screening compares thousands of sets on one matrix of products, linear around the believed law or around the best set
so far. The sets at its top are settled: the law's shape, offset, compliance and lag, in which the force is not linear, are
carried along until they stand still. Screening around the best settled set goes on until no neighbour beats it.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, replace

import numpy as np
from scipy.ndimage import median_filter

from ..noise import Noise, first_guess
from .evidence import Explained, Products, explain, products_of
from .beyond import AGNOSTIC_FAMILIES
from .families import LAGS, STATIC, Family, Place, Point, place_at
from .lag import lagged
from .motion import BoolArray, FloatArray
from .scene import Scene

EFFECT_PRIOR = -3.0
"""Log prior odds of one more effect: one in twenty, about one over the number of effects to choose from."""

LAW_PRIOR = -1.0
"""Log prior odds that the believed law is another tire's: the article's own is wrong by up to 13.5 %."""

AGNOSTIC_PRIOR = -8.0
"""Log prior odds that something beyond the catalogue acts in one given coordinate: one in three thousand."""

HIDDEN_PRIOR = -5.0
"""Log prior odds of an effect of the deflection alone beside a law whose shape is free: it explains what that can."""

MATERIAL = 0.1
"""An effect that nothing else in its set can stand for, to less than this many noises, changes the RMSE by half a
percent: it is not named, whatever its significance."""

POOR = 1.15
"""Where no settled set comes nearer to the noise than this chi square per sample, every effect is settled alone too."""

FORM_ERROR = 0.015
"""What a family may miss of its own effect, as a part of it: a second one smaller than that is not believed."""

MATERIAL_BEYOND = {f.name: 0.25 for f in AGNOSTIC_FAMILIES} | {"time, added": 0.6}
"""The same for what is beyond the catalogue: slow noise and hum of the amplifier, up to half the noise, are noise."""

BEAM = 6
FEW_VARIANTS = 3
"""Up to so many variants of a family are compared as wholes, more by what their leading columns explain."""

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
    raw: dict[str, FloatArray]


def build(scene: Scene, point: Point, families: Sequence[Family]) -> list[Built]:
    """Return the columns of `families` for each recording, around `point`, and the residual there."""
    built = []
    for number, record in enumerate(scene.records):
        place = place_at(record, scene, point)
        raw = {f.name: f.build(place) for f in families}
        columns = dict(raw)
        force = place.elastic
        on_ground = None
        if point.lifted is not None:
            on_ground = ~point.lifted[number]
            force = force * on_ground
        read = _through_reading(record.time, force, point)
        for f in families:
            if f.after_lag:
                continue
            if on_ground is not None:
                columns[f.name] = columns[f.name] * on_ground[:, None]
            if f.name == "force_lag" and point.lag > 0.0:
                # Away from no lag its slope alone is a column: the other lags are reached by moving the point.
                moving = np.zeros_like(columns[f.name])
                moving[:, 0] = np.gradient(read, record.time)
                moving[:, -1] = np.gradient(moving[:, 0], record.time)
                columns[f.name] = moving
            else:
                columns[f.name] = _through_reading(record.time, columns[f.name], point)
        built.append(Built(place, columns, record.force - read, raw))
    return built


def _through_reading(time: FloatArray, values: FloatArray, point: Point) -> FloatArray:
    if point.lag <= 0.0:
        return values
    flat = values[:, None] if values.ndim == 1 else values
    return lagged(time, flat, point.lag, point.stages).reshape(values.shape)


def lifted_from_force(scene: Scene) -> tuple[BoolArray, ...]:
    """Return where each recording reads no force although the bare law has some: a first guess of lift-off."""
    found = []
    for record in scene.records:
        elastic = record.elastic(record.motion.deflection)
        sigma = first_guess(record.force - elastic).innovation
        found.append((median_filter(record.force, 3) < 2.0 * sigma) & (elastic > 4.0 * sigma))
    return tuple(found)


def lifted_at(
    built: Sequence[Built], point: Point, families: Sequence[Family], coefficients: Sequence[FloatArray], groups: Sequence[FloatArray]
) -> tuple[BoolArray, ...]:
    """Return where the force of the point and its families would be a pull."""
    found = []
    for b in built:
        force = b.place.elastic.copy()
        for f, values, columns in zip(families, coefficients, groups, strict=True):
            if f.after_lag or f.name in ("force_lag", "inertia"):
                continue
            raw = b.raw[f.name]
            held = pointed(point, f.name, raw.shape[1])
            force += raw[:, columns] @ (values - held[columns])
        found.append(force <= 0.0)
    return tuple(found)


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
        values = np.zeros(columns)
        values[0] = -point.lag
    return values


def moved(point: Point, name: str, values: FloatArray, group: FloatArray) -> Point:
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
        if group[0] == 0:
            return replace(point, lag=float(np.clip(-values[0], 0.0, 2.0 * point.lag + 0.02)))
        # One of the finite lags: its coefficient is near -1 where it is the right one.
        lag, _ = LAGS[int(group[0]) - 1]
        return replace(point, lag=lag * float(np.clip(-values[0], 0.3, 1.5)))
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
    built: Sequence[Built], noises: Sequence[Noise], families: Sequence[Family], point: Point
) -> Products:
    """Return the products of all columns, with the coefficients that the point holds given back to the data."""
    columns, data = [], []
    for b, noise in zip(built, noises, strict=True):
        held = b.residual.copy()
        for f in families:
            values = pointed(point, f.name, b.columns[f.name].shape[1])
            if np.any(values):
                held += b.columns[f.name] @ values
        rows = b.place.record.rows
        columns.append(noise.whitened_at(np.concatenate([b.columns[f.name] for f in families], axis=1), rows))
        data.append(noise.whitened_at(held, rows))
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
    static = [n for n in names if n in STATIC]
    prior = sum(_prior(layout.families[n], "recalibration" in names or n in static[1:]) for n in names)
    for turn in range(2 if len(many) > 1 else 1):
        for n in many:
            others = [choice[m] for m in names if m != n and (turn or m not in many[many.index(n) :])]
            choice[n] = _best_variant(p, layout, others, n)
    prior -= sum(float(np.log(len(layout.variants[n]))) for n in many)
    groups = tuple(choice[n] for n in names)
    explained = explain(p, groups, zeta)
    if "force_lag" in names and not _lag_is_one(names, groups, explained):
        number = names.index("force_lag")
        groups = tuple(g[:1] if i == number else g for i, g in enumerate(groups))
        explained = explain(p, groups, zeta)
    evidence = explained.log_evidence + prior
    immaterial = _negligible(names, explained)
    if immaterial or not np.isfinite(evidence) or not _signs_hold(p, layout, names, groups, explained):
        evidence = -np.inf
    return Candidate(names, evidence, groups, explained)


def _lag_is_one(names: SetName, groups: Sequence[FloatArray], explained: Explained) -> bool:
    """Return whether slope and bend of the force belong to one lag: a bend of at most about half its square."""
    number = names.index("force_lag")
    if groups[number].size < 2:
        return True
    slope, bend = explained.coefficients[number]
    return bool(abs(bend) <= 0.6 * slope**2)


def _negligible(names: SetName, explained: Explained) -> list[str]:
    """Return the families of a set whose own part is not material, or less than the form of another one may err."""
    found = []
    effects = [(n, s) for n, s in zip(names, explained.size, strict=True) if n not in ("recalibration", "shape")]
    for name, unique in zip(names, explained.unique, strict=True):
        if name in ("recalibration", "shape"):
            continue
        largest = max((s for n, s in effects if n != name), default=0.0)
        least = MATERIAL_BEYOND.get(name, MATERIAL)
        if unique < max(least, FORM_ERROR * largest):
            found.append(name)
    return found


def _prior(family: Family, recalibrated: bool) -> float:
    if family.name == "shape":
        return 0.0
    if family.name == "recalibration":
        return LAW_PRIOR
    if family.agnostic:
        return AGNOSTIC_PRIOR
    return HIDDEN_PRIOR if recalibrated and family.name in STATIC else EFFECT_PRIOR


def _best_variant(p: Products, layout: Layout, others: Sequence[FloatArray], name: str) -> FloatArray:
    """Return the variant whose leading column explains most on top of the others."""
    variants = layout.variants[name]
    if len(variants) <= FEW_VARIANTS:
        return max(variants, key=lambda v: explain(p, [*others, v], 1.0).log_evidence)
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
    for turn in range(6):
        built = build(scene, point, chosen)
        layout = layout_of(built, chosen)
        p = measure(built, noises, chosen, point) if chosen else _nothing(built, noises)
        candidate = judge(p, layout, names, zeta)
        settled = Settled(candidate, point, p, layout)
        gained = candidate.log_evidence - best.log_evidence if best else np.inf
        # The first guess of lift-off follows the noise and flatters: the model's own replaces it at once.
        if best is None or turn == 1 or gained > 0.0:
            best = settled
        starts = np.cumsum([0, *(layout.count[n] for n in names)])
        own = [g - start for g, start in zip(candidate.groups, starts, strict=False)]
        lifted = lifted_at(built, point, chosen, candidate.explained.coefficients, own)
        following = replace(point, lifted=lifted)
        for name, values, group in zip(names, candidate.explained.coefficients, own, strict=True):
            following = moved(following, name, values, group)
        if _same(point, following) or (turn > 1 and abs(gained) < 0.05):
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
        point.lifted,
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


def _nothing(built: Sequence[Built], noises: Sequence[Noise]) -> Products:
    data = np.concatenate(
        [n.whitened_at(b.residual, b.place.record.rows) for b, n in zip(built, noises, strict=True)]
    )
    return Products(np.zeros((0, 0)), np.zeros(0), float(data @ data), data.size, np.zeros(0))


def law_whole(names: Iterable[str]) -> SetName:
    """Return the set in order, with the law's shape beside its coefficients and never alone."""
    distinct = set(names) - {"shape"}
    return tuple(sorted(distinct | {"shape"} if "recalibration" in distinct else distinct))


def material(candidate: Candidate) -> SetName:
    """Return the set without the families that are not material in it."""
    negligible = _negligible(candidate.names, candidate.explained)
    return law_whole(n for n in candidate.names if n not in negligible)


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
        key = law_whole(names)
        if key not in self.seen:
            self.seen[key] = judge(self.products, self.layout, key, self.zeta)
        return self.seen[key]

    def allowed(self, names: SetName, name: str) -> bool:
        """Return whether `name` may be added: not twice, and the law's shape only beside its coefficients."""
        return name not in names and name != "shape"

    def beam(self) -> None:
        """Grow sets one family at a time, keeping the best of each size."""
        level: list[SetName] = [()]
        best = self.judged(()).log_evidence
        for _ in range(DEEPEST_SET):
            grown = {
                self.judged((*s, n)).names for s in level for n in self.layout.families if self.allowed(s, n)
            }
            level = sorted(grown, key=lambda s: -self.judged(s).log_evidence)[:BEAM]
            top = self.judged(level[0]).log_evidence
            if top < best - 3.0:
                return
            best = max(best, top)

    def neighbours(self, names: SetName) -> None:
        """Judge every set that differs from `names` by one family more, less or other."""
        for gone in ("", *names):
            left = tuple(n for n in names if n not in (gone, "shape"))
            self.judged(left)
            for n in self.layout.families:
                if self.allowed(left, n):
                    self.judged((*left, n))
        self.judged((*(n for n in names if n not in STATIC), "recalibration"))

    def seeds(self) -> list[SetName]:
        """Return every family of the catalogue alone and beside a free law."""
        known = [n for n, f in self.layout.families.items() if not f.agnostic and n not in ("shape", "recalibration")]
        return [law_whole(s) for n in known for s in ((n,), (n, "recalibration"))]

    def instead_of_unknown(self, names: SetName) -> list[SetName]:
        """Return, for what is beyond the catalogue in a set, the three effects that do best in its place."""
        found: list[SetName] = []
        for gone in (n for n in names if self.layout.families[n].agnostic):
            left = tuple(n for n in names if n != gone)
            known = [n for n, f in self.layout.families.items() if not f.agnostic and self.allowed(left, n)]
            found += sorted((law_whole((*left, n)) for n in known), key=lambda s: -self.judged(s).log_evidence)[:3]
        if any(self.layout.families[n].agnostic for n in names) or any(n in STATIC for n in names):
            found.append(law_whole((*(n for n in names if n not in STATIC), "recalibration")))
        return found

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
            needed = material(settled[names].candidate)
            if needed != names:
                waiting.append(needed)

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
        settle_all([c.names for c in screen.best(8)], point)
        settle_all(screen.instead_of_unknown(top), point)
        if turn == 0 and min(s.candidate.explained.chi_square for s in settled.values()) > POOR:
            settle_all(screen.seeds(), point)
        best = max(settled.values(), key=lambda s: s.log_evidence)
        if progress is not None:
            progress(f"{compared} sets compared; best so far: {', '.join(best.names) or 'nothing'}")
        if before is not None and best.names == before.names:
            break
        point = best.point
    settle_all([law_whole(n for n in best.names if n != gone) for gone in best.names if gone != "shape"], point)
    order = sorted(settled.values(), key=lambda s: -s.log_evidence)
    return Found(tuple(order), compared)
