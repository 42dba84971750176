"""The results of the estimation: named effects, the sets that were compared, fitted models, and the remainder.

The uncertainty of a parameter includes the form errors. The remainder is the part of the misfit beyond the noise that
the named effects leave: how large it is, where it lies, and on what it depends.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace

import numpy as np
from numpy.typing import NDArray
from radialtire import CATALOGUE, TireModel
from radialtire.recalibrated import changed_at
from scipy.special import chdtr

from ..preprocessing.data_checks import spikes
from ..regressors.dataset import Dataset
from ..regressors.signature import LAW, form_error, reference_of, size_of
from ..selection.search import LIKE_NOISE
from ..simulation.channels import Sampled
from ..simulation.simulate import simulate
from .coordinates import coordinates_of
from .fit import Fit
from .problem import COMMON, law_surfaces, tire_of

FloatArray = NDArray[np.float64]


DETERMINED = 0.5
"""A parameter counts as determined by the recordings if its standard deviation is below this part of the prior's."""


@dataclass(frozen=True)
class FittedParameter:
    """Value and standard deviation of a parameter in its unit; determined: whether the recordings determine it, and not
    its prior.
    """

    owner: str
    name: str
    unit: str
    value: float
    deviation: float
    determined: bool


def estimates_of(fit: Fit) -> tuple[FittedParameter, ...]:
    """Return all fitted parameters; of a refitted law the changes of A and B on each surface, its shape and preload.

    Their covariance is that of Laplace's approximation, with the variance V of noise and discrepancy and with the form
    errors as further coefficients.
    """
    slopes = fit.jacobian
    if not slopes.shape[1]:
        return ()
    covariance = _covariance(_with_form_errors(fit))
    spread = np.sqrt(np.diag(covariance))[: slopes.shape[1]]
    found = []
    for p, position, own in zip(fit.problem.parameters, fit.positions, spread, strict=True):
        if p.owner == LAW and (p.index < 2 or p.index in _of_surfaces(fit)):
            continue
        value = p.value(float(position))
        slope = p.spread * (value if p.logarithm else 1.0)
        determined = bool(own < DETERMINED or p.group > 0)
        found.append(FittedParameter(p.owner, p.label, p.unit, value, float(slope * own), determined))
    return (*_on_surfaces(fit, covariance), *found)


def significances_of(fit: Fit) -> dict[str, float]:
    """Return for each effect the probability that not all its parameters together are neutral (Wald's test).

    It may be sure where no single one is: of a lag and a delay often the sum alone is known. 1 for a refitted law.
    """
    apart: dict[str, dict[int, float]] = {name: {} for name in fit.names}
    for i, p in enumerate(fit.problem.parameters):
        neutral = None if p.owner == LAW else CATALOGUE[p.owner].parameters[p.index].neutral
        if neutral is not None:
            value = p.value(float(fit.positions[i]))
            apart[p.owner][i] = (value - neutral) / (p.spread * (value if p.logarithm else 1.0))
    covariance = _covariance(_with_form_errors(fit))
    found = dict.fromkeys(apart, 1.0)
    for name, own in ((n, d) for n, d in apart.items() if d):
        left, at = np.array(list(own.values())), list(own)
        found[name] = float(chdtr(len(own), left @ np.linalg.solve(covariance[np.ix_(at, at)], left)))
    return found


def _with_form_errors(fit: Fit) -> NDArray[np.float64]:
    """Return the columns (m, k + f) of the parameters, the drift and the form errors, those of effects at least as
    declared, in units of the noise and the discrepancy.

    A part of an error looks like another value of a parameter, and the residual does not show it, however well the rest
    fits: an effect's response may be off by its form error as a whole, too. A refitted law has any strength anyway.
    """
    curves, found = fit.problem.curves(fit.positions), fit.scales.tolist()
    scales = [own if name == LAW else max(own, 1.0) for name, own in zip(curves, found, strict=True)]
    forms = [f * scale for f, scale in zip(fit.near.forms, scales, strict=True)]
    pairs = zip(curves.items(), scales, strict=True)
    wholes = [form_error(name) * scale * curve[:, None] for (name, curve), scale in pairs if name != LAW]
    columns = [fit.jacobian, fit.drift * fit.near.drift, *forms, *wholes]
    return np.asarray(np.concatenate(columns, axis=1) / np.sqrt(fit.variance))


def _covariance(slopes: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return (S^T S + 1)^-1 from the singular values of S; inverting the sum would lose the small ones to rounding."""
    triangle = np.linalg.qr(
        np.concatenate([slopes, np.zeros_like(slopes, shape=(slopes.shape[1],) * 2)]), mode="r"
    )
    _, sizes, ways = np.linalg.svd(triangle)
    return np.asarray(ways.T @ (ways / (1.0 + sizes**2)[:, None]))


def _of_surfaces(fit: Fit) -> range:
    """Return the indices of the law's parameters that are of one surface: with one alone it has none of its own."""
    surfaces = law_surfaces(fit.problem.dataset)
    return range(COMMON, COMMON + 2 * surfaces if surfaces > 1 else COMMON)


def _on_surfaces(fit: Fit, covariance: NDArray[np.float64]) -> list[FittedParameter]:
    """Return the changes of A and B on each surface, each the sum of the common change and that of the surface.

    The fit changes them about the reference deflection, the law's coefficients are those at 1 cm (see `changed_at`).
    """
    at = {p.index: i for i, p in enumerate(fit.problem.parameters) if p.owner == LAW}
    if not at:
        return []
    dataset = fit.problem.dataset
    surfaces = law_surfaces(dataset)
    covariance = covariance[: fit.positions.size, : fit.positions.size]
    of_exponent = changed_at(reference_of(dataset), 0.0, 1.0)[0]
    found = []
    for number, radius in enumerate(dataset.radii[:surfaces]):
        where = "flat" if np.isinf(radius) else f"{100.0 * radius:.4g} cm"
        where = where if surfaces == len(dataset.radii) else "all surfaces"
        factor, exponent = (
            [at[i] for i in (first, own) if i in at and (i == first or i in _of_surfaces(fit))]
            for first, own in ((0, COMMON + 2 * number), (1, COMMON + 2 * number + 1))
        )
        weights = np.zeros((2, fit.positions.size))
        for row, parts, unit in ((0, factor, 1.0), (0, exponent, of_exponent), (1, exponent, 1.0)):
            weights[row, parts] = [unit * fit.problem.parameters[i].spread for i in parts]
        for name, own in zip(("log factor on A", "change of B"), weights, strict=True):
            value, deviation = float(own @ fit.positions), float(np.sqrt(own @ covariance @ own))
            found.append(FittedParameter(LAW, f"{name}, {where}", "1", value, deviation, determined=True))
    return found


REMAINDER_BINS = 15
"""Number of parts of a coordinate's range in which the mean of the remainder is taken."""

STRUCTURED = 6.0
"""Chi-square per bin of these means above which the remainder depends on the coordinate; coloured noise reaches 2 to
3."""

UNEXPLAINED_SIZE = LIKE_NOISE
"""Size of a remainder, in units of the noise, beyond which it is unexplained."""

UNEXPLAINED_SHARE = 0.1
"""Share of the misfit beyond which a remainder is unexplained, even if the form errors account for it."""


@dataclass(frozen=True)
class Dependence:
    """Dependence of the remainder on a coordinate; share: of the remainder's power that a function of it follows;
    begin, end: part of the range in which most of that lies, in the coordinate's unit.
    """

    coordinate: str
    share: float
    begin: float
    end: float


@dataclass(frozen=True)
class Remainder:
    """What a set leaves of the misfit beyond the noise.

    share: its part of the misfit's power beyond the noise; size: its root mean square over the noise of the recorded
    samples; force [N]: its root mean square; depends: coordinates on which it depends, the strongest first uncompared:
    share of its power by which sets are not compared: in sharp turns of the motion, or quicker than the blocks
    of_forms: share of its power that the form errors of the named effects account for
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
        """Whether no named effect explains it, not even by the error of its form."""
        beyond_forms = self.size * np.sqrt(1.0 - self.of_forms) > UNEXPLAINED_SIZE
        return bool(beyond_forms or (self.size > UNEXPLAINED_SIZE and self.share > UNEXPLAINED_SHARE))


def remainder_of(fit: Fit) -> Remainder:
    """Return the remainder of a fitted set; each block counts with the number of its samples."""
    dataset = fit.problem.dataset
    counts, sizes, levels = np.array([(e.counts.sum(), e.size, e.floor.level) for e in dataset.experiments]).T
    samples = np.repeat(sizes, counts.astype(int))
    variance = dataset.gathered([e.noises**2 for e in dataset.experiments])
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
    """Return the share of the remainder of a fitted set that its form errors account for."""
    count = fit.residual.size
    beyond = fit.beyond_forms - count * (1.0 + fit.form_error**2)
    return float(1.0 - np.clip(beyond / max(fit.power - count, 1e-300), 0.0, 1.0))


def of_the_written_tire(
    compared: Remainder, before: Sequence[FloatArray], after: Sequence[FloatArray], noise: float
) -> Remainder:
    """Return the remainder of the written tire over all recorded samples without single outliers.

    compared: remainder of the fitted set in the compared blocks; before, after [N]: residuals of the baseline and of
    the written tire at the compared samples of each recording; noise [N]: root mean square noise of the recorded
    samples
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
    for name, values in coordinates_of(dataset).items():
        edges = np.unique(np.quantile(values, np.linspace(0.0, 1.0, REMAINDER_BINS + 1)))
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


SENSITIVITY_STEP = 1e-3
"""Step of the difference quotients of the sensitivities, in standard deviations of a parameter's prior."""


@dataclass(frozen=True)
class Estimate:
    """A parameter's value with its standard deviation and unit; determined: whether the recordings determine it, and
    not its prior.
    """

    value: float
    std: float
    unit: str
    determined: bool = True


@dataclass(frozen=True)
class NamedEffect:
    """An effect that the baseline lacks, or has with other values.

    parameters: its fitted parameters by their names; share: part of the misfit's power beyond the noise that comes back
    where it alone is removed; probability: that it is present; grounds: the numbers on which a calibrated probability
    rests, empty where the probability is that of the ranking; in_baseline: whether the baseline has it, with other
    values; together: probability that its parameters together are not neutral (see `significances_of`)
    """

    name: str
    parameters: Mapping[str, Estimate]
    share: float
    probability: float
    grounds: Mapping[str, float] = field(default_factory=dict)
    in_baseline: bool = False
    together: float = 0.0


@dataclass(frozen=True)
class Evidence:
    """A fitted set compared with the chosen one.

    log_evidence: log posterior minus that of the chosen set; chi_square: per block; size: root mean square of the
    response that each effect adds to the others, over the noise; probability: of the set in the tempered ranking
    """

    names: tuple[str, ...]
    log_evidence: float
    chi_square: float
    size: tuple[float, ...]
    probability: float


@dataclass(frozen=True)
class FittedModel:
    """A set of effects fitted to the recordings with the effects' own equations."""

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
        """The tire without the effects."""
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
            step = (
                SENSITIVITY_STEP if positions[i] + SENSITIVITY_STEP <= problem.high[i] else -SENSITIVITY_STEP
            )
            moved = positions.copy()
            moved[i] += step
            columns.append((simulate(problem.tire(moved), motion) - base) / step)
        return np.stack(columns, axis=1) if columns else np.zeros((base.size, 0))

    def missed(self, motion: Sampled) -> float:
        """Return the root mean square [N] of the form errors of its effects on a motion."""
        values, dataset, whole = self.fit.values, self.fit.problem.dataset, simulate(self.tire, motion)
        without = {n: tire_of(dataset, {m: v for m, v in values.items() if m != n}) for n in values}
        return math.hypot(
            *(form_error(n, dataset.tire) * size_of(whole - simulate(t, motion)) for n, t in without.items())
        )


@dataclass(frozen=True)
class Refitted:
    """A set of effects fitted to a part of the data: its tire, and its residual [N] in each recording."""

    tire: TireModel
    residuals: tuple[FloatArray, ...]
