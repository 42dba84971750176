"""One case: the recordings, the simulation that is believed, and the sets of effects that are the truth."""

from __future__ import annotations

import zlib
from collections.abc import Callable
from dataclasses import dataclass
from types import ModuleType

import numpy as np
from numpy.typing import NDArray
from radialtire import TireModel
from tirelab.recordings.recording import Recording

from .motion import Motion

FloatArray = NDArray[np.float64]


@dataclass(frozen=True)
class Bench:
    """Gauge and load cell with their noise."""

    rng: np.random.Generator

    def record(
        self,
        name: str,
        motion: Motion,
        force: FloatArray,
        *,
        noise: float = 1.0,
        reading: float = 3e-6,
        radius: float = np.inf,
        pressure: float | None = None,
    ) -> Recording:
        """Return what is recorded; noise [N] of the force, reading [m]: noise of the deflection."""
        samples = motion.time.size
        return Recording(
            name=name,
            time=motion.time,
            deflection=motion.deflection + self.rng.normal(0.0, reading, samples),
            force=force + self.rng.normal(0.0, noise, samples),
            surface_radius=np.full(samples, radius),
            pressure=None if pressure is None else np.full(samples, pressure),
        )


@dataclass(frozen=True)
class Drawn:
    """What is handed in."""

    recordings: list[Recording]
    tire: TireModel


@dataclass(frozen=True)
class Case:
    """truth: the sets that are right, several where two describe the same; odd: the recording that contradicts."""

    name: str
    truth: tuple[frozenset[str], ...]
    odd: str
    make: Callable[[Bench], Drawn]

    def draw(self, seed: int) -> Drawn:
        """Return the case of one seed, which does not depend on the other cases."""
        return self.make(Bench(np.random.default_rng((seed, zlib.crc32(self.name.encode())))))

    def __str__(self) -> str:
        if self.odd:
            return f"{self.odd} contradicts"
        return " or ".join(" + ".join(sorted(names)) or "nothing" for names in self.truth)


def case(*truth: str, odd: str = "") -> Callable[[Callable[[Bench], Drawn]], Case]:
    """Make a case of a function; each truth is a set of effects with + between them, "" for none."""
    sets = tuple(frozenset(filter(None, text.split(" + "))) for text in truth)
    return lambda make: Case(make.__name__, sets, odd, make)


def cases_of(module: ModuleType) -> list[Case]:
    """The cases of a module, in its order."""
    return [found for found in vars(module).values() if isinstance(found, Case)]
