"""Which sets of named effects explain a trial as well as the truth does, by linear fits and a rule.

The answers of the kinds none to open hold what this module finds: it stays as it is, because the bytes of these answers
depend on it. Its rule that every loop is right at one constant rate, and its limit of 10 in log-likelihood, resemble
what a diagnosis may assume. `equivalence` assumes neither; the proof counts both. The wide kinds use `equivalence`
alone, and of this module only the linear fits, as a screen.
"""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from itertools import combinations

import numpy as np
from scipy.fft import dct
from scipy.optimize import nnls

from .bench import Bench
from .measurement import Instrument
from .motion import FloatArray, Motion
from .regressors import EITHER_SIGN, NAMES, Range, regressors

#: Recordings decide between two explanations whose log-likelihoods differ by this much (odds of 22 000 to 1).
DECIDED = 10.0
#: Effects whose loops look alike at one constant rate on one surface.
LOOPS = (
    "rate_independent_hysteresis",
    "viscous_damping",
    "viscoelastic_relaxation",
    "force_lag",
)

Names = frozenset[str]


@dataclass(frozen=True)
class Explanations:
    """Least loss of log-likelihood of any set of effects, for a residual free of noise.

    The residual and all regressors are whitened: each coefficient of their cosine transform is divided by the noise's
    standard deviation there. The regressors of a set may enter in any amount that their sign allows; half the least
    sum of squares is the loss of log-likelihood.

    factor: Cholesky factor of the regressors' Gram matrix; target: the residual projected on it; unexplained: sum of
    squares of the residual outside the span of all regressors; members: columns of `factor` of each name.
    """

    factor: FloatArray
    target: FloatArray
    unexplained: float
    members: Mapping[str, tuple[int, ...]]

    def loss(self, names: Iterable[str]) -> float:
        """Loss of log-likelihood [1] when these effects are all there is."""
        chosen = [(name, i) for name in sorted(names) for i in self.members.get(name, ())]
        if not chosen:
            return 0.5 * (self.unexplained + float(self.target @ self.target))
        columns = [self.factor[:, i] for _, i in chosen]
        columns += [-self.factor[:, i] for name, i in chosen if name in EITHER_SIGN]
        matrix = np.stack(columns, axis=1)
        _, left = nnls(matrix, self.target, maxiter=50 * matrix.shape[1])
        return 0.5 * (self.unexplained + float(left) ** 2)

    def best(self, base: Iterable[str], more: int) -> float:
        """Least loss [1] of all sets of so many names beside the given ones."""
        given = set(base)
        left = [name for name in NAMES if name not in given]
        return min(self.loss({*given, *chosen}) for chosen in combinations(left, more))


def whitened(values: FloatArray, instrument: Instrument, step: float, stiffness: float) -> FloatArray:
    """Cosine transform along the first axis, every coefficient over its noise's standard deviation."""
    spread = np.sqrt(instrument.spectrum(values.shape[0], step, stiffness))
    transform = dct(values, axis=0, norm="ortho")
    return np.asarray(transform / (spread if values.ndim == 1 else spread[:, None]), dtype=np.float64)


def explanations(
    bench: Bench,
    motions: Sequence[Motion],
    residuals: Sequence[FloatArray],
    known: Mapping[str, Sequence[FloatArray]],
    instrument: Instrument,
    law_shape: bool,
) -> Explanations:
    """Prepare the losses of all sets.

    bench: the tire with its effects; the regressors use the tire alone. Samples at which contact is lost have no
    weight, because the regressors do not model that; nor have blurred samples. residuals [N]: noise-free residuals of
    the baseline tire on the recorded samples; known [N]: what each true effect adds, as a further regressor of its
    name; law_shape: see `regressors.regressors`.
    """
    common = Range.of(bench, tuple(motions))
    blocks, targets = [], []
    members: dict[str, tuple[int, ...]] = {}
    for k, motion in enumerate(motions):
        columns = regressors(bench, motion, common, law_shape)
        parts, first = [], 0
        for name in NAMES:
            of_name = columns[name]
            if name in known:
                of_name = np.concatenate([of_name, known[name][k][:, None]], axis=1)
            members[name] = tuple(range(first, first + of_name.shape[1]))
            first += of_name.shape[1]
            parts.append(of_name)
        stiffness = _stiffness(bench, motion)
        counted = ~motion.recorded(bench.contact_lost(motion))
        if motion.blurred is not None:
            counted &= ~motion.recorded(motion.blurred)
        stacked = np.concatenate([*parts, residuals[k][:, None]], axis=1) * counted[:, None]
        white = whitened(stacked, instrument, motion.sample_step, stiffness)
        blocks.append(white[:, :-1])
        targets.append(white[:, -1])
    matrix, target = np.concatenate(blocks), np.concatenate(targets)
    norms = np.sqrt(np.sum(matrix**2, axis=0))
    matrix = matrix / np.where(norms > 0.0, norms, 1.0)
    # all sets share one Gram matrix; its factor replaces the long regressors in every smaller problem
    gram = matrix.T @ matrix
    factor = np.linalg.cholesky(gram + 1e-9 * np.eye(gram.shape[0])).T
    projected = np.linalg.solve(factor.T, matrix.T @ target)
    unexplained = max(float(target @ target - projected @ projected), 0.0)
    return Explanations(factor, projected, unexplained, members)


def loss_of(
    bench: Bench, motions: Sequence[Motion], residuals: Sequence[FloatArray], instrument: Instrument
) -> float:
    """Loss of log-likelihood [1] when the residuals [N] are taken for noise."""
    total = 0.0
    for motion, residual in zip(motions, residuals, strict=True):
        white = whitened(residual, instrument, motion.sample_step, _stiffness(bench, motion))
        total += 0.5 * float(white @ white)
    return total


def indistinguishable(explained: Explanations, truth: Names) -> dict[Names, float]:
    """Sets no larger than the truth that lose less than `DECIDED` against it, and their loss; none holds another.

    A name is in every such set if all other names together lose `DECIDED` or more without it, because more names
    never lose more. So few sets are left to test.
    """
    truth_loss = explained.loss(truth)
    needed = {name for name in NAMES if explained.loss(set(NAMES) - {name}) - truth_loss >= DECIDED}
    optional = [name for name in NAMES if name not in needed]
    found: dict[Names, float] = {}
    for more in range(len(truth) - len(needed) + 1):
        for chosen in combinations(optional, more):
            names = frozenset(needed.union(chosen))
            if names == truth or any(smaller < names for smaller in found):
                continue
            loss = explained.loss(names) - truth_loss
            if loss < DECIDED:
                found[names] = loss
    return found


def one_constant_rate(motions: Sequence[Motion]) -> bool:
    """Whether all recordings run at one and the same rate, up and down, on one surface.

    Off the corners the rate stays within 5 % of its median, and at most a fifth of the samples is at corners.
    """
    if len({r for m in motions for r in m.surfaces}) != 1:
        return False
    rates = np.concatenate([np.abs(m.recorded(m.rate)) for m in motions])
    middle = float(np.median(rates))
    return middle > 0.0 and float(np.mean(np.abs(rates / middle - 1.0) > 0.05)) < 0.2


def _stiffness(bench: Bench, motion: Motion) -> float:
    """RMS of the elastic tangent over the recorded samples [N/m]."""
    ones = np.ones_like(motion.deflection)
    high = bench.tire.force(motion.deflection + 5e-5, motion.radius, ones)
    low = bench.tire.force(motion.deflection - 5e-5, motion.radius, ones)
    return float(np.sqrt(np.mean(((high - low) / 1e-4) ** 2)))
