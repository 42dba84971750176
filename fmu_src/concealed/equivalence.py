"""Which sets of named effects no analysis of the recordings could tell from the truth, by the rig's own simulations.

Each other set is fitted to the hidden forces, free of noise, in the rig's own formulation (`templates`). Let L be the
sum of squares of what the fit leaves, every coefficient over its noise. The best test between that set and the truth,
which knows both, errs with the probability Phi(-L^(1/2)/2) (Neyman & Pearson, Phil. Trans. A 231, 289, 1933). Where
this is at least `SIGNIFICANCE`, the set leaves no more than the noise can explain, and it counts as right. Samples at
which the readings cannot tell the rate (the corners of a triangle under a coarse gauge) have no weight in L: only the
rig knows what the motion is there.
"""

from collections.abc import Mapping
from contextlib import suppress
from dataclasses import dataclass, replace
from itertools import combinations, product

import numpy as np
from scipy.ndimage import maximum_filter1d
from scipy.optimize import least_squares
from scipy.stats import norm

from .alternatives import Explanations, Names, explanations, whitened
from .bench import Bench
from .effects import BY_NAME
from .measurement import Instrument
from .motion import FloatArray, Motion
from .reading import estimated
from .regressors import NAMES
from .templates import Template, templates
from .tires import Tire
from .wide.laws import BentTire

#: Least error probability of the best test between a set and the truth at which both count as right.
SIGNIFICANCE = 0.01
#: Sum of squares, over the noise, that a set may leave beside what the truth leaves.
TELLING = float((2.0 * norm.isf(SIGNIFICANCE)) ** 2)
#: Part of the true effects that a set replaces by others which its linear fit may leave: what its other forms may miss.
FAR = 1e-2
#: Most sets that are fitted, most starts of one fit, and most steps of a fit.
MOST_SETS, MOST_STARTS, MOST_STEPS = 10, 2, 25
#: A set of so many names is fitted from its best start alone.
MANY_NAMES = 3
#: Most sets of a foreign form's family and one more name that are fitted.
MOST_COMPLETING = 4
#: The rate is unknown where its best estimate errs by more than this part of its RMS; a motion of which more than
#: `MOST_BLURRED` would be unknown is one that readings follow nowhere, and it is taken whole.
UNKNOWN_RATE, MOST_BLURRED = 0.25, 0.3
#: Limits of a, b and c of a bent law: 50 % in force, 0.3 in the exponent.
BENDS = (0.5, 0.3, 0.15)


BEYOND = 1e9
"""What a set leaves whose force is no number."""


@dataclass(frozen=True)
class Hidden:
    """What is hidden and the recordings of it, free of noise.

    bench: tire and effects; law: that of a set without recalibration; motions: the training motions as the gauge shows
    them; forces [N]: on the recorded samples.
    """

    bench: Bench
    law: Tire
    motions: tuple[Motion, ...]
    forces: tuple[FloatArray, ...]
    instrument: Instrument

    @classmethod
    def of(cls, bench: Bench, law: Tire, motions: tuple[Motion, ...], instrument: Instrument) -> "Hidden":
        """The recordings that a bench makes of some motions."""
        forces = tuple(m.recorded(bench.force(m)) for m in motions)
        return cls(
            bench, law, tuple(_blurred(bench.seen(m), instrument) for m in motions), forces, instrument
        )

    @property
    def surfaces(self) -> tuple[float, ...]:
        """Distinct radii [m]."""
        return tuple(sorted({r for m in self.motions for r in m.surfaces}))


@dataclass(frozen=True)
class Equivalent:
    """Sets that count as right beside the truth, with the sum of squares that each leaves beyond the truth's.

    truth_leaves: what the truth's own names leave in the rig's forms (0 but for a foreign form); whole: what no name
    at all leaves; fitted: how many sets were fitted; skipped: how many sets near enough were not, for want of time.
    """

    sets: Mapping[Names, float]
    truth_leaves: float
    whole: float
    fitted: int
    skipped: int


def _blurred(motion: Motion, instrument: Instrument) -> Motion:
    """The motion with the samples at which its readings cannot tell the rate."""
    readings = instrument.read(np.random.default_rng(0), motion.recorded(motion.deflection))
    error = np.abs(estimated(motion, readings).rate - motion.rate)
    unknown = error > UNKNOWN_RATE * float(np.sqrt(np.mean(motion.rate**2)))
    if not unknown.any() or float(np.mean(unknown)) > MOST_BLURRED:
        return motion
    # the estimate knows the recorded samples: what lies within one of them is as unknown as it is
    near = maximum_filter1d(unknown.astype(np.int8), 2 * motion.stride + 1) > 0
    return replace(motion, blurred=near)


def equivalent(
    hidden: Hidden, linear: Explanations, truth: Names, most: int, base: Names = frozenset()
) -> Equivalent:
    """Return the sets of at most `most` names that cannot be told from the truth; none holds another or the truth.

    linear: see `linearized`; a set is fitted only where its generous linear regressors leave little. base: names that
    every set holds. The truth itself is fitted where its form is foreign.
    """
    forms = templates(hidden.bench, hidden.motions, hidden.instrument.noise)
    foreign = [e for e in hidden.bench.effects if type(e) not in BY_NAME.get(e.name, ())]
    truth_leaves = fitted(hidden, truth, forms, 0.0) if foreign and truth else 0.0
    whole = 2.0 * linear.loss(())
    allowed = truth_leaves + TELLING
    near = [names for names in _near(linear, truth, base, most, 0.5 * allowed) if not truth <= names]
    found: dict[Names, float] = {}
    tried = skipped = 0
    for names in near:
        if any(smaller < names for smaller in found):
            continue
        if tried == MOST_SETS:
            skipped += 1
            continue
        tried += 1
        leaves = fitted(hidden, names, forms, allowed)
        if leaves <= allowed:
            found[names] = max(leaves - truth_leaves, 0.0)
    return Equivalent(found, truth_leaves, whole, tried, skipped)


def completing(hidden: Hidden, linear: Explanations, truth: Names) -> dict[Names, float]:
    """Sets of the truth and one more name that leave no more than the noise can explain, where the truth leaves more.

    The one more name describes what a foreign form has beside its family's: both answers are right.
    """
    forms = templates(hidden.bench, hidden.motions, hidden.instrument.noise)
    near = [names for names in _near(linear, truth, truth, len(truth) + 1, 0.5 * TELLING) if truth < names]
    leaves = {names: fitted(hidden, names, forms, TELLING) for names in near[:MOST_COMPLETING]}
    return {names: left for names, left in leaves.items() if left <= TELLING}


def linearized(hidden: Hidden) -> Explanations:
    """The generous linear fits of all sets to what the law of a set without recalibration leaves."""
    elastic = Bench(hidden.law)
    known: dict[str, list[FloatArray]] = {e.name: [] for e in hidden.bench.effects if e.name in NAMES}
    if hidden.law is not hidden.bench.tire:
        known["recalibration"] = []
    residuals = []
    for motion, force in zip(hidden.motions, hidden.forces, strict=True):
        residuals.append(force - motion.recorded(elastic.force(motion)))
        whole = hidden.bench.force(motion)
        for name in known:
            if name == "recalibration":
                part = Bench(hidden.bench.tire).force(motion) - elastic.force(motion)
            else:
                part = whole - hidden.bench.without(name).force(motion)
            known[name].append(motion.recorded(part))
    bench = Bench(hidden.bench.tire)
    return explanations(bench, hidden.motions, residuals, known, hidden.instrument, law_shape=True)


def fitted(hidden: Hidden, names: Names, forms: Mapping[str, tuple[Template, ...]], enough: float) -> float:
    """Least sum of squares over the noise [1] of a set of names; the fit stops as soon as it is below `enough`."""
    effects = sorted(names - {"recalibration"})
    radii = hidden.surfaces if "recalibration" in names else ()
    starts = [_Model(hidden, chosen, radii) for chosen in product(*(forms[name] for name in effects))]
    ranked = sorted((model.begun() for model in starts), key=lambda pair: pair[0])
    best = ranked[0][0]
    for _, model, values in ranked[: MOST_STARTS if len(names) < MANY_NAMES else 1]:
        if best <= enough:
            break
        best = min(best, model.least(values, enough))
    return best


class _Enough(Exception):
    """A fit is good enough."""


@dataclass(frozen=True)
class _Model:
    """A set of effects in chosen forms, and a law bent on the given radii (none: the law as it is)."""

    hidden: Hidden
    chosen: tuple[Template, ...]
    radii: tuple[float, ...]

    def left(self, values: FloatArray) -> FloatArray:
        """What the set leaves of the hidden forces, every coefficient of the cosine transform over its noise."""
        effects, at = [], 0
        for template in self.chosen:
            effects.append(template.made(values[at : at + len(template.values)]))
            at += len(template.values)
        tire = self.hidden.law
        if self.radii:
            bends = tuple((float(a), float(b), float(c)) for a, b, c in values[at:].reshape(-1, 3))
            tire = BentTire(self.hidden.bench.tire, self.radii, bends)
        bench = Bench(tire, tuple(effects))
        parts = []
        for motion, force in zip(self.hidden.motions, self.hidden.forces, strict=True):
            try:
                miss = motion.recorded(bench.force(motion)) - force
            except OverflowError:  # a parameter far from every tire
                miss = np.full_like(force, BEYOND)
            if motion.blurred is not None:
                miss = np.where(motion.recorded(motion.blurred), 0.0, miss)
            stiffness = _stiffness(self.hidden.law, motion)
            parts.append(whitened(miss, self.hidden.instrument, motion.sample_step, stiffness))
        return np.nan_to_num(np.concatenate(parts), nan=BEYOND, posinf=BEYOND, neginf=-BEYOND)

    def begun(self) -> tuple[float, "_Model", FloatArray]:
        """Start values whose strengths are projections of the misfit on each effect, and what they leave."""
        values = np.array([v for t in self.chosen for v in t.values] + [0.0] * 3 * len(self.radii))
        low, high = self._bounds()
        heads = (
            np.cumsum([0, *(len(t.values) for t in self.chosen[:-1])]) if self.chosen else np.array([], int)
        )
        base = values.copy()
        base[heads] = 0.0
        misfit = self.left(base)
        for head in heads:
            small = base.copy()
            small[head] = min(0.2, high[head])
            slope = (self.left(small) - misfit) / small[head]
            power = float(slope @ slope)
            if power > 0.0:
                values[head] = np.clip(-float(slope @ misfit) / power, low[head], high[head])
            if not self.chosen[int(np.searchsorted(heads, head))].signed:
                values[head] = max(values[head], 0.05)
        values = np.clip(values, low, high)
        return float(np.sum(self.left(values) ** 2)), self, values

    def least(self, values: FloatArray, enough: float) -> float:
        """Least sum of squares from some start values on."""
        best = [float(np.sum(self.left(values) ** 2))]
        if not values.size:
            return best[0]

        def watched(at: FloatArray) -> FloatArray:
            left = self.left(at)
            best.append(min(best[-1], float(np.sum(left**2))))
            if best[-1] <= enough:
                raise _Enough
            return left

        low, high = self._bounds()
        inside = np.clip(values, low + 1e-6 * (high - low), high - 1e-6 * (high - low))
        scale = np.maximum(0.1 * (high - low), 1e-3)
        scale = np.minimum(scale, np.maximum(np.abs(inside), 0.05))
        with suppress(_Enough):
            least_squares(watched, inside, bounds=(low, high), x_scale=scale, max_nfev=MOST_STEPS)
        return best[-1]

    def _bounds(self) -> tuple[FloatArray, FloatArray]:
        limits = [t.bounds for t in self.chosen]
        bends = list(BENDS) * len(self.radii)
        low = [x for bounds in limits for x in bounds[0]] + [-b for b in bends]
        high = [x for bounds in limits for x in bounds[1]] + bends
        return np.array(low, dtype=np.float64), np.array(high, dtype=np.float64)


def _near(linear: Explanations, truth: Names, base: Names, most: int, allowed: float) -> list[Names]:
    """The sets that hold `base` and whose linear fit loses little, the smallest and best first.

    Little is `allowed`, and `FAR` of what is lost where the true names in the set are all there is.
    """
    highest = allowed + FAR * linear.loss(())
    needed = base.union(name for name in NAMES if linear.loss(set(NAMES) - {name}) >= highest)
    optional = [name for name in NAMES if name not in needed]
    near: list[tuple[int, float, tuple[str, ...]]] = []
    for more in range(max(most - len(needed), -1) + 1):
        for chosen in combinations(optional, more):
            names = needed.union(chosen)
            loss = linear.loss(names)
            if loss <= highest and loss <= allowed + FAR * linear.loss(names & truth):
                near.append((len(names), loss, tuple(sorted(names))))
    return [frozenset(names) for _, _, names in sorted(near)]


def _stiffness(law: Tire, motion: Motion) -> float:
    """RMS of the elastic tangent over the motion [N/m]."""
    ones = np.ones_like(motion.deflection)
    high = law.force(motion.deflection + 5e-5, motion.radius, ones)
    low = law.force(motion.deflection - 5e-5, motion.radius, ones)
    return float(np.sqrt(np.mean(((high - low) / 1e-4) ** 2)))
