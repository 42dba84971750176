"""The recordings of one diagnosis prepared for fitting: motion, baseline law, surface weights and fitted rows."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Protocol

import numpy as np
from radialtire import FLAT_RADIUS, TireModel

from .kinematics import FloatArray, IndexArray, Motion, motion_of

LEAST_CM = 1e-2
"""Below this deflection [cm] the logarithm of the deflection is held: the force there is below every noise."""

ROWS = 8000
"""Samples that are compared in the search, evenly spaced, all experiments together."""

PEAK_QUANTILE = 0.999
"""Part of the readings that lie below the largest force but for noise and spikes."""

MOST_FREE_SURFACES = 12
"""Recordings with more radii than this (terrain) share these many support points of the law's shape."""


class Recorded(Protocol):
    """What is diagnosed: the samples of one recording, arrays of one length, time rising."""

    @property
    def name(self) -> str:
        """What the recording is called."""
        ...

    @property
    def time(self) -> FloatArray:
        """[s]."""
        ...

    @property
    def deflection(self) -> FloatArray:
        """[m], compressed > 0."""
        ...

    @property
    def surface_radius(self) -> FloatArray:
        """[m], convex > 0, concave < 0, flat infinite."""
        ...

    @property
    def force(self) -> FloatArray:
        """[N], compressive > 0."""
        ...


@dataclass(frozen=True)
class Experiment:
    """One recording prepared for fitting; arrays of one length n.

    time [s] from its start; force [N] as read; motion: its kinematics; surface (n, surfaces): weights of the law's
    support points, rows sum to 1; coefficient A [N/cm^B], exponent B [1] of the baseline law; rows: indices of the
    samples that are compared; number: of the recording, from 0; two_sided: whether the part can pull
    """

    time: FloatArray
    force: FloatArray
    motion: Motion
    surface: FloatArray
    coefficient: FloatArray
    exponent: FloatArray
    rows: IndexArray
    number: int
    two_sided: bool = False

    @cached_property
    def sampled(self) -> Experiment:
        """The experiment at its `rows` alone."""
        rows = self.rows
        motion = Motion(**{k: v if k == "noise" else v[rows] for k, v in self.motion.__dict__.items()})
        return Experiment(
            self.time[rows],
            self.force[rows],
            motion,
            self.surface[rows],
            self.coefficient[rows],
            self.exponent[rows],
            np.arange(rows.size),
            self.number,
            self.two_sided,
        )

    @property
    def step(self) -> float:
        """Median time between samples [s]."""
        return float(np.median(np.diff(self.time)))

    def elastic(self, deflection: FloatArray) -> FloatArray:
        """Return the baseline law's force [N] at `deflection` [m], sample by sample."""
        x = 100.0 * deflection
        if self.two_sided:
            return self.coefficient * np.sign(x) * np.abs(x) ** self.exponent
        return self.coefficient * np.maximum(x, 0.0) ** self.exponent

    def stiffness(self, deflection: FloatArray) -> FloatArray:
        """Return the baseline law's tangent dF/dx [N/m] at `deflection` [m]."""
        size = np.abs(deflection) if self.two_sided else deflection
        loaded = np.maximum(100.0 * size, LEAST_CM)
        slope = 100.0 * self.coefficient * self.exponent * loaded ** (self.exponent - 1.0)
        return np.where(size > 0.0, slope, 0.0)


@dataclass(frozen=True)
class Dataset:
    """All experiments of one diagnosis and the scales that make their regressors comparable.

    radii [m]: support points of the law's shape; max_deflection [m], max_elastic_force [N], max_force [N]: largest
    deflection, largest force of the baseline law, largest reading but for noise; duration [s] of the longest
    experiment; min_step [s]: shortest sampling step
    """

    experiments: tuple[Experiment, ...]
    radii: tuple[float, ...]
    max_deflection: float
    max_elastic_force: float
    max_force: float
    duration: float
    min_step: float


def dataset_of(recordings: Sequence[Recorded], baseline: TireModel) -> Dataset:
    """Return the dataset of `recordings`, with the law of the `baseline` tire."""
    radii = _support_radii(np.concatenate([np.unique(r.surface_radius) for r in recordings]))
    share = ROWS // len(recordings)
    experiments = []
    for number, recording in enumerate(recordings):
        time = recording.time
        distinct, inverse = np.unique(recording.surface_radius, return_inverse=True)
        pairs = np.array([baseline.law.coefficients(float(r)) for r in distinct])
        weights = np.stack([_hats(float(r), radii) for r in distinct])
        experiments.append(
            Experiment(
                time - time[0],
                recording.force,
                motion_of(time, recording.deflection),
                weights[inverse],
                pairs[inverse, 0],
                pairs[inverse, 1],
                np.arange(0, time.size, -(-time.size // share)),
                number,
                baseline.two_sided,
            )
        )
    return Dataset(
        tuple(experiments),
        radii,
        max(float(e.motion.deflection.max()) for e in experiments),
        max(float(e.elastic(e.motion.deflection).max()) for e in experiments),
        max(float(np.quantile(np.abs(e.force), PEAK_QUANTILE)) for e in experiments),
        max(float(e.time[-1]) for e in experiments),
        min(e.step for e in experiments),
    )


def _curvature(radius: float) -> float:
    return 0.0 if abs(radius) >= FLAT_RADIUS else 1.0 / radius


def _support_radii(radii: FloatArray) -> tuple[float, ...]:
    distinct = sorted({_curvature(float(r)) for r in radii})
    if len(distinct) > MOST_FREE_SURFACES:
        distinct = list(np.quantile(distinct, np.linspace(0.0, 1.0, MOST_FREE_SURFACES)))
    return tuple(np.inf if c == 0.0 else 1.0 / c for c in distinct)


def _hats(radius: float, radii: tuple[float, ...]) -> FloatArray:
    """Return the weights of linear interpolation over the curvature at `radius` [m]."""
    bends = np.array([_curvature(r) for r in radii])
    here = _curvature(radius)
    return np.array([np.interp(here, bends, row) for row in np.eye(bends.size)])
