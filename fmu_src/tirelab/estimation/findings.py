"""What the estimation hands to the diagnosis: effects, sets that were compared, fitted models, and the remainder.

A parameter's uncertainty includes the error of the forms. The remainder is what the named effects leave beyond the
noise: how much, where, and on what it depends.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace

import numpy as np
from numpy.typing import NDArray
from radialtire import TireModel

from ..regressors.dataset import Dataset, spikes
from ..regressors.signature import LAW, form_error, size_of
from ..selection.search import LIKE_NOISE
from ..simulation.channels import Sampled
from ..simulation.simulate import simulate
from .fit import Fit
from .problem import COMMON, law_surfaces, tire_of

FloatArray = NDArray[np.float64]


SHAPE_INDICES = range(2, COMMON)
"""Where the shape stands among the values of a refitted law."""

DETERMINED = 0.5
"""Part of the prior's standard deviation below which the recordings determine a parameter."""


@dataclass(frozen=True)
class FittedParameter:
    """value and its standard deviation, in the parameter's unit; determined: whether the recordings say more than the
    prior did.
    """

    owner: str
    name: str
    unit: str
    value: float
    deviation: float
    determined: bool


def estimates_of(fit: Fit) -> tuple[FittedParameter, ...]:
    """Return all fitted parameters; of a refitted law the changes of A and B on each surface.

    Their covariance is that of Laplace's approximation with the variance V of noise and discrepancy, beside the forms'
    errors.
    """
    slopes = fit.jacobian
    if not slopes.shape[1]:
        return ()
    whole = fit.slopes
    covariance = _covariance(whole / np.sqrt(fit.variance))
    spread = np.sqrt(np.diag(covariance))[: slopes.shape[1]]
    found = []
    for p, position, own in zip(fit.problem.parameters, fit.positions, spread, strict=True):
        if p.owner == LAW and p.index not in SHAPE_INDICES:
            continue
        value = p.value(float(position))
        slope = p.spread * (value if p.logarithm else 1.0)
        determined = bool(own < DETERMINED or p.group > 0)
        found.append(FittedParameter(p.owner, p.label, p.unit, value, float(slope * own), determined))
    return (*_on_surfaces(fit, covariance), *found)


def _covariance(slopes: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return (S^T S + 1)^-1 from the singular values of S: inverting the sum loses what is small beside the largest."""
    triangle = np.linalg.qr(
        np.concatenate([slopes, np.zeros_like(slopes, shape=(slopes.shape[1],) * 2)]), mode="r"
    )
    _, sizes, ways = np.linalg.svd(triangle)
    return np.asarray(ways.T @ (ways / (1.0 + sizes**2)[:, None]))


def _on_surfaces(fit: Fit, covariance: NDArray[np.float64]) -> list[FittedParameter]:
    """Return the changes of A and B on each surface: those common to all and its own together."""
    at = {p.index: i for i, p in enumerate(fit.problem.parameters) if p.owner == LAW}
    if not at:
        return []
    dataset = fit.problem.dataset
    surfaces = law_surfaces(dataset)
    found = []
    for number, radius in enumerate(dataset.radii[:surfaces]):
        where = "flat" if np.isinf(radius) else f"{100.0 * radius:.4g} cm"
        where = where if surfaces == len(dataset.radii) else "all surfaces"
        for first, name in ((0, "log factor on A"), (1, "change of B")):
            parts = [i for i in (at.get(first), at.get(COMMON + 2 * number + first)) if i is not None]
            weights = np.array([fit.problem.parameters[i].spread for i in parts])
            value = float(weights @ fit.positions[parts])
            deviation = float(np.sqrt(weights @ covariance[np.ix_(parts, parts)] @ weights))
            found.append(FittedParameter(LAW, f"{name}, {where}", "1", value, deviation, determined=True))
    return found


BINS = 15
"""Parts of a coordinate's range in which the mean remainder is taken."""

STRUCTURED = 6.0
"""Chi-square per bin of the mean remainder above which it depends on a coordinate: coloured noise reaches 2 to 3."""

UNEXPLAINED_SIZE = LIKE_NOISE
"""Size of a remainder beyond which it is unexplained: more than the noise."""

UNEXPLAINED_SHARE = 0.1
"""Share of the misfit beyond which a remainder is unexplained, whatever the forms of the named effects may miss."""


@dataclass(frozen=True)
class Dependence:
    """share: of the remainder's power that a function of the coordinate follows; begin, end: where most of it lies, in
    the coordinate's unit.
    """

    coordinate: str
    share: float
    begin: float
    end: float


@dataclass(frozen=True)
class Remainder:
    """share: of the misfit's power beyond the noise; size: root mean square over the noise of the recorded samples;
    force [N]; depends: coordinates, the strongest first; uncompared: share of its power that lies where no set is
    compared with another, at sharp turns of the motion or quicker than the blocks; of_forms: share of its power that
    the errors of the named effects' forms account for.
    """

    share: float
    size: float
    force: float
    depends: tuple[Dependence, ...]
    uncompared: float = 0.0
    of_forms: float = 0.0

    def to_dict(self) -> dict[str, object]:
        """Return the entry `remainder` of diagnosis.json."""
        return {
            "share": self.share,
            "size": self.size,
            "rms": self.force,
            "uncompared": self.uncompared,
            "of_forms": self.of_forms,
            "depends_on": [
                {"by": d.coordinate, "share": d.share, "from": d.begin, "to": d.end} for d in self.depends
            ],
        }

    @property
    def unexplained(self) -> bool:
        """Whether it is something that no named effect explains, and not the error of their forms."""
        beyond_forms = self.size * np.sqrt(1.0 - self.of_forms) > UNEXPLAINED_SIZE
        return bool(beyond_forms or (self.size > UNEXPLAINED_SIZE and self.share > UNEXPLAINED_SHARE))


def remainder_of(fit: Fit) -> Remainder:
    """Return what a fitted set leaves beyond the noise of the averaged misfit, each block for its samples."""
    dataset = fit.problem.dataset
    counts, sizes, noises, levels = np.array(
        [(e.counts.sum(), e.size, e.noise, e.floor.level) for e in dataset.experiments]
    ).T
    samples = np.repeat(sizes, counts.astype(int))
    variance = np.repeat(noises**2, counts.astype(int))
    left, missed = (
        max(float(samples @ (variance * (values**2 - 1.0)) / samples.sum()), 0.0)
        for values in (fit.residual, dataset.misfit)
    )
    level = float(np.sqrt(counts * sizes @ levels**2 / samples.sum()))
    force = float(np.sqrt(left))
    return Remainder(
        min(left / max(missed, 1e-300), 1.0) if left else 0.0,
        force / max(level, 1e-300),
        force,
        _dependences(dataset, fit.residual),
        of_forms=_of_forms(fit),
    )


def _of_forms(fit: Fit) -> float:
    """Return the share of what a fitted set leaves beyond the noise that the errors of its forms account for."""
    count = fit.residual.size
    beyond = fit.unformed - count * (1.0 + fit.form_error**2)
    return float(1.0 - np.clip(beyond / max(fit.power - count, 1e-300), 0.0, 1.0))


def of_the_written_tire(
    compared: Remainder, before: Sequence[FloatArray], after: Sequence[FloatArray], noise: float
) -> Remainder:
    """Return the remainder of the written tire over all samples as recorded but single ones that stand out.

    compared: that of the fitted set in the compared blocks; before, after [N]: what the baseline and the written tire
    leave of each recording where its gauges follow; noise [N]: of the recorded samples, root mean square
    """
    whole, left = (float(np.mean(np.concatenate([v[~spikes(v)] for v in r]) ** 2)) for r in (before, after))
    beyond, missed = max(left - noise**2, 0.0), max(whole - noise**2, 1e-300)
    force = float(np.sqrt(beyond))
    if force <= compared.force:
        return compared
    part = (compared.force / force) ** 2
    return replace(
        compared,
        share=min(beyond / missed, 1.0),
        size=force / max(noise, 1e-300),
        force=force,
        uncompared=1.0 - part,
        of_forms=part * compared.of_forms,
    )


def _dependences(dataset: Dataset, left: FloatArray) -> tuple[Dependence, ...]:
    found = []
    for name, values in _coordinates(dataset).items():
        edges = np.unique(np.quantile(values, np.linspace(0.0, 1.0, BINS + 1)))
        if edges.size < 4:
            continue
        which = np.clip(np.searchsorted(edges, values, side="right") - 1, 0, edges.size - 2)
        count = np.maximum(np.bincount(which, minlength=edges.size - 1), 1)
        mean = np.bincount(which, left, edges.size - 1) / count
        power = mean**2 * count
        if power.sum() < STRUCTURED * power.size:
            continue
        most = int(np.argmax(power))
        share = float(power.sum() / max(left @ left, 1e-300))
        found.append(Dependence(name, share, float(edges[most]), float(edges[most + 1])))
    return tuple(sorted(found, key=lambda d: -d.share))


def _coordinates(dataset: Dataset) -> dict[str, FloatArray]:
    gather, many = dataset.gathered, dataset.experiments
    return {
        "deflection": gather([e.deflection for e in many]),
        "rate": gather([e.rate for e in many]),
        "acceleration": gather([e.acceleration for e in many]),
        "time": gather([e.time - e.time[0] for e in many]),
        "force": gather([e.baseline for e in many]),
    }


STEP = 1e-3
"""Step of the sensitivities, in standard deviations of a parameter's prior."""


@dataclass(frozen=True)
class Estimate:
    """A parameter's value with its standard deviation and unit; determined: whether the recordings say more of it than
    its prior did.
    """

    value: float
    std: float
    unit: str
    determined: bool = True


@dataclass(frozen=True)
class NamedEffect:
    """An effect that the baseline lacks.

    parameters: what was fitted of it; share: of the misfit's power beyond the noise left where it alone is taken out
    probability: that it is there, over all sets that were fitted; grounds: what a calibrated probability rests on
    """

    name: str
    parameters: Mapping[str, Estimate]
    share: float
    probability: float
    grounds: Mapping[str, float] = field(default_factory=dict)


@dataclass(frozen=True)
class Evidence:
    """One set that was fitted: log posterior over that of the chosen one, chi square per sample, sizes of its effects.

    size: root mean square of what each effect adds to the others, over the noise
    """

    names: tuple[str, ...]
    log_evidence: float
    chi_square: float
    size: tuple[float, ...]
    probability: float


@dataclass(frozen=True)
class FittedModel:
    """A set of effects fitted to the recordings in the catalogue's own forms."""

    fit: Fit

    @property
    def names(self) -> tuple[str, ...]:
        """Names of the effects."""
        return self.fit.names

    @property
    def tire(self) -> TireModel:
        """The baseline with exactly these effects."""
        return self.fit.tire

    @property
    def baseline(self) -> TireModel:
        """The tire under the effects."""
        return self.fit.problem.dataset.tire

    @property
    def radii(self) -> tuple[float, ...]:
        """Radii [m] of the recorded surfaces, by their curvature."""
        return tuple(sorted(self.fit.problem.dataset.radii, key=lambda r: 1.0 / r))

    def sensitivities(self, motion: Sampled) -> FloatArray:
        """Return the derivatives (samples, parameters) of the force [N] on a motion, by difference quotients."""
        problem, positions = self.fit.problem, self.fit.positions
        base = simulate(self.tire, motion)
        columns = []
        for i in range(positions.size):
            step = STEP if positions[i] + STEP <= problem.high[i] else -STEP
            moved = positions.copy()
            moved[i] += step
            columns.append((simulate(problem.tire(moved), motion) - base) / step)
        return np.stack(columns, axis=1) if columns else np.zeros((base.size, 0))

    def missed(self, motion: Sampled) -> float:
        """Return the root mean square [N] of what the forms of its effects may miss on a motion."""
        values, dataset, whole = self.fit.values, self.fit.problem.dataset, simulate(self.tire, motion)
        without = {n: tire_of(dataset, {m: v for m, v in values.items() if m != n}) for n in values}
        return math.hypot(*(form_error(n) * size_of(whole - simulate(t, motion)) for n, t in without.items()))


@dataclass(frozen=True)
class Refitted:
    """A set of effects fitted once more: its tire, and what it leaves of each recording [N]."""

    tire: TireModel
    residuals: tuple[FloatArray, ...]
