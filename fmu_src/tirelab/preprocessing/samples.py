"""All samples of one diagnosis, in which the misfit is located: motion, law of the baseline, and a selection of rows.

The sets of effects are compared in blocks of samples instead, see `regressors.dataset`.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Protocol, TypeVar

import numpy as np
from radialtire import TireModel

from .motion import BoolArray, FloatArray, IndexArray, Motion, motion_of
from .noise import STILL

ROWS = 8000
"""Number of samples in which the misfit is located: evenly spaced, of all recordings together."""

MOST_SURFACES = 8
"""With more surfaces than these (terrain) none is told from the others, and a law is refitted with one change for all
of them."""

OF_TIME = frozenset({"time", "rate", "acceleration"})
"""Coordinates that need the times of the samples."""


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


R = TypeVar("R", bound=Recorded)


@dataclass(frozen=True)
class RawExperiment:
    """One recording; arrays of one length n.

    time [s] from its start; force [N] as read; motion: its kinematics; coefficient A [N/cm^B], exponent B [1] of the
    baseline law; rows: indices of the samples in which the misfit is located; number: of the recording, from 0
    two_sided: whether the part can pull
    """

    time: FloatArray
    force: FloatArray
    motion: Motion
    coefficient: FloatArray
    exponent: FloatArray
    rows: IndexArray
    number: int
    two_sided: bool = False

    @cached_property
    def sampled(self) -> RawExperiment:
        """The experiment at its `rows` alone."""
        rows = self.rows
        motion = Motion(**{k: v if k == "noise" else v[rows] for k, v in self.motion.__dict__.items()})
        return RawExperiment(
            self.time[rows],
            self.force[rows],
            motion,
            self.coefficient[rows],
            self.exponent[rows],
            np.arange(rows.size),
            self.number,
            self.two_sided,
        )

    def elastic(self, deflection: FloatArray) -> FloatArray:
        """Return the baseline law's force [N] at `deflection` [m], sample by sample."""
        x = 100.0 * deflection
        if self.two_sided:
            return self.coefficient * np.sign(x) * np.abs(x) ** self.exponent
        return self.coefficient * np.maximum(x, 0.0) ** self.exponent


Placed = tuple[FloatArray, IndexArray]
"""Deflections (n,) [m] and the numbers of their surfaces (see `surface_numbers`)."""


@dataclass(frozen=True)
class RawDataset:
    """All experiments of one diagnosis; radii [m]: of their surfaces; max_deflection [m]: the largest."""

    experiments: tuple[RawExperiment, ...]
    radii: tuple[float, ...]
    max_deflection: float


def raw_dataset_of(recordings: Sequence[Recorded], baseline: TireModel) -> RawDataset:
    """Return the dataset of `recordings`, with the law of the `baseline` tire."""
    share = ROWS // len(recordings)
    experiments = []
    for number, recording in enumerate(recordings):
        time = recording.time
        distinct, inverse = np.unique(recording.surface_radius, return_inverse=True)
        pairs = np.array([baseline.law.coefficients(float(r)) for r in distinct])
        experiments.append(
            RawExperiment(
                time - time[0],
                recording.force,
                motion_of(time, recording.deflection, timed=is_timed([recording])),
                pairs[inverse, 0],
                pairs[inverse, 1],
                np.arange(0, time.size, -(-time.size // share)),
                number,
                baseline.two_sided,
            )
        )
    radii = np.unique(np.concatenate([np.unique(r.surface_radius) for r in recordings]))
    return RawDataset(
        tuple(experiments),
        tuple(radii.tolist()),
        max(float(e.motion.deflection.max()) for e in experiments),
    )


def surface_numbers(radii: Sequence[FloatArray]) -> list[IndexArray]:
    """Return the number of the surface at each sample from the radii [m] of one or more recordings, each (n,), the same
    number in all of them; one number for all where there are more than MOST_SURFACES.
    """
    known = np.unique(np.concatenate([np.unique(own) for own in radii]))
    if known.size > MOST_SURFACES:
        return [np.zeros(own.size, dtype=np.intp) for own in radii]
    return [np.searchsorted(known, own) for own in radii]


def within(fitted: Iterable[Placed], asked: Iterable[Placed]) -> list[BoolArray]:
    """Return which samples lie within the deflections that are fitted on their surface, or on all surfaces where theirs
    is none of the fitted ones.

    Beyond them no law is known: what it leaves there says nothing of any effect. At the end where a tire or a part is
    deflected least, a way that is no stroke is not beyond.
    """
    (deflection, own), others = map(np.concatenate, zip(*fitted, strict=True)), list(asked)
    count = 1 + max(int(own.max()), *(int(number.max()) for _, number in others))
    least, most = np.full(count, deflection.min()), np.full(count, deflection.max())
    for number in np.unique(own):
        there = deflection[own == number]
        least[number], most[number] = there.min(), there.max()
    way, lower, upper = STILL * (most - least), np.abs(least), np.abs(most)
    least, most = least - way * (lower < upper), most + way * (upper < lower)
    return [(least[n] <= x) & (x <= most[n]) for x, n in others]


def alone(recording: R) -> R:
    """Return a recording without the history before it: a fit begins at rest (see `simulation.channels.begun`)."""
    if getattr(recording, "history", None) is None:
        return recording
    return replace(recording, history=None)  # type: ignore[type-var]


def is_timed(recordings: Sequence[Recorded]) -> bool:
    """Whether the time of every recording was measured; without the attribute `timed` it was."""
    return all(getattr(recording, "timed", True) for recording in recordings)
