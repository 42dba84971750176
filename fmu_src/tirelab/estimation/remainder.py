"""What the named effects leave beyond the noise: how much, where, and on what it depends."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from ..regressors.dataset import Dataset, spikes
from .fit import Fit

FloatArray = NDArray[np.float64]

BINS = 15
"""Parts of a coordinate's range in which the mean remainder is taken."""

STRUCTURED = 6.0
"""Chi-square per bin of the mean remainder above which it depends on a coordinate: coloured noise reaches 2 to 3."""


UNEXPLAINED_SIZE, UNEXPLAINED_SHARE = 1.0, 0.1
"""A remainder is unexplained where it is more than the noise, and more than this share of the misfit: the error of the
effects' forms has reached a share of 0.05."""


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
    compared with another, at sharp turns of the motion or quicker than the blocks.
    """

    share: float
    size: float
    force: float
    depends: tuple[Dependence, ...]
    uncompared: float = 0.0

    def to_dict(self) -> dict[str, object]:
        """Return the entry `remainder` of diagnosis.json."""
        return {
            "share": self.share,
            "size": self.size,
            "rms": self.force,
            "uncompared": self.uncompared,
            "depends_on": [
                {"by": d.coordinate, "share": d.share, "from": d.begin, "to": d.end} for d in self.depends
            ],
        }

    @property
    def unexplained(self) -> bool:
        """Whether it is something that no named effect explains, and not the error of their forms."""
        return self.size > UNEXPLAINED_SIZE and self.share > UNEXPLAINED_SHARE


def remainder_of(fit: Fit) -> Remainder:
    """Return what a fitted set leaves beyond the noise of the averaged misfit."""
    dataset = fit.problem.dataset
    left = fit.residual
    n = left.size
    beyond = max(fit.power - n, 0.0)
    missed = max(float(dataset.misfit @ dataset.misfit) - n, 1e-12)
    noise = np.concatenate([np.full(int(e.counts.sum()), e.noise) for e in dataset.experiments])
    level = float(np.sqrt(np.mean([e.floor.level**2 for e in dataset.experiments])))
    force = float(np.sqrt(beyond / n) * np.sqrt(np.mean(noise**2)))
    return Remainder(
        min(beyond / missed, 1.0), force / max(level, 1e-300), force, _dependences(dataset, left)
    )


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
    hidden = 1.0 - (compared.force / force) ** 2
    size = force / max(noise, 1e-300)
    return replace(compared, share=min(beyond / missed, 1.0), size=size, force=force, uncompared=hidden)


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
