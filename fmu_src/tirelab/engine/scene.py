"""The recordings of one diagnosis as the engine's candidates see them, with what is computed of them once."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass, field, fields
from functools import cached_property

import numpy as np

from ..preprocessing.dataset import Dataset, Experiment
from ..preprocessing.kinematics import FloatArray, Motion
from ..preprocessing.lines_and_segments import LinesAndSegments
from ..preprocessing.robust_scale import robust_sigma


@dataclass(frozen=True)
class Record(Experiment):
    """One recording as the candidates see it, with what was computed of it.

    whole: the recording of which this one is a part
    """

    whole: Record | None = field(default=None, repr=False)
    memory: dict[str, FloatArray] = field(default_factory=dict, repr=False, compare=False)
    standing: list[LinesAndSegments] = field(default_factory=list, repr=False, compare=False)

    @cached_property
    def thin(self) -> Record:
        """The recording at its `rows` alone; what remembers is still computed on the whole of it."""
        rows = self.rows
        if rows.size == self.time.size:
            return self
        motion = Motion(**{k: v if k == "noise" else v[rows] for k, v in self.motion.__dict__.items()})
        return Record(
            self.time[rows],
            self.force[rows],
            motion,
            self.surface[rows],
            self.coefficient[rows],
            self.exponent[rows],
            np.arange(rows.size),
            self.number,
            self,
            standing=self.standing,
        )

    @property
    def outstanding(self) -> LinesAndSegments:
        """What stands out of the recording, once that has been looked for."""
        return self.standing[0] if self.standing else LinesAndSegments()

    def kept(self, name: str, compute: Callable[[Motion], Iterable[FloatArray]]) -> FloatArray:
        """Return what `compute` makes of the whole motion, one row each at this record's samples, computed once."""
        if name not in self.memory:
            if self.whole is None:
                self.memory[name] = np.stack(list(compute(self.motion)))
            else:
                self.memory[name] = np.stack([row[self.whole.rows] for row in compute(self.whole.motion)])
        return self.memory[name]

    def kept_lines(self, course: FloatArray, weight: FloatArray, count: int) -> FloatArray:
        """Return `strongest_lines` of the leftover over a course, found once.

        The lowest ones belong to its slow change and are left out.
        """
        name = f"lines {course[-1]:.9g} {float(np.mean(np.abs(weight))):.3g}"
        if name not in self.memory:
            self.memory[name] = strongest_lines(course, weight, self.leftover, count)
        return self.memory[name]

    @property
    def leftover(self) -> FloatArray:
        """What a smooth function of deflection and direction leaves of the bare law's residual [N]."""
        if "leftover" not in self.memory:
            elastic = self.elastic(self.motion.deflection)
            depth = np.clip(self.motion.deflection / self.motion.deflection.max(), 0.0, 1.0)
            basis = [
                np.cos(np.pi * j * depth) * side for j in range(6) for side in (1.0, self.motion.direction)
            ]
            columns = np.stack([*basis, elastic, self.motion.rate, self.motion.acceleration], axis=1)
            columns /= np.sqrt(np.mean(columns**2, axis=0)) + 1e-12
            residual = self.force - elastic
            gram = columns.T @ columns + 1e-6 * residual.size * np.eye(columns.shape[1])
            self.memory["leftover"] = residual - columns @ np.linalg.solve(gram, columns.T @ residual)
        return self.memory["leftover"]


def strongest_lines(course: FloatArray, weight: FloatArray, values: FloatArray, count: int) -> FloatArray:
    """Return the `count` strongest lines of `values` over a `course` that does not fall, strongest first.

    Shape (count, 2): the line [1/unit of course], and the root mean square of its part over the noise that the
    differences of neighbours show; its time course is that of `weight`.
    """
    rising, first = np.unique(course, return_index=True)
    if rising.size < 64:
        return np.zeros((count, 2))
    even = np.linspace(rising[0], rising[-1], rising.size)
    resampled = np.interp(even, rising, (weight * values)[first])
    spectrum = np.abs(np.fft.rfft((resampled - resampled.mean()) * np.hanning(even.size), 4 * even.size))
    frequencies = np.fft.rfftfreq(4 * even.size, float(even[1] - even[0]))
    spectrum[frequencies < 3.0 / (rising[-1] - rising[0])] = 0.0
    sigma = robust_sigma(np.diff(values, 2)) / np.sqrt(6.0) + 1e-12
    lines = []
    for _ in range(count):
        at = int(np.argmax(spectrum))
        waves = np.stack(
            [weight * f(2.0 * np.pi * frequencies[at] * course) for f in (np.sin, np.cos)], axis=1
        )
        fitted = waves @ np.linalg.lstsq(waves, values, rcond=None)[0]
        # A fast line stands in the differences too: what it leaves then measures the noise better.
        rest = min(sigma, float(np.std(values - fitted)) + 1e-12)
        lines.append((float(frequencies[at]), float(np.sqrt(np.mean(fitted**2))) / rest))
        spectrum[max(at - 12, 0) : at + 13] = 0.0
    return np.array(lines)


@dataclass(frozen=True)
class Scene:
    """All recordings of one diagnosis with the scales that make their columns comparable.

    radii [m]: support points of the law's shape; deepest [m] and strongest [N]: largest deflection and elastic force
    longest [s]: duration of the longest recording; finest [s]: shortest sampling step
    """

    records: tuple[Record, ...]
    radii: tuple[float, ...]
    deepest: float
    strongest: float
    highest: float
    longest: float
    finest: float


def scene_of(dataset: Dataset) -> Scene:
    """Return the scene of a dataset."""
    records = tuple(
        Record(**{f.name: getattr(e, f.name) for f in fields(Experiment)}) for e in dataset.experiments
    )
    return Scene(
        records,
        dataset.radii,
        dataset.max_deflection,
        dataset.max_elastic_force,
        dataset.max_force,
        dataset.duration,
        dataset.min_step,
    )
