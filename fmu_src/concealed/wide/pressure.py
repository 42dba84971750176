"""A tire that is pressed at two or three pressures, which are measured beside the force.

The kind stands apart from the others: it has a stream of random numbers of its own, and is drawn only where it is asked
for by its name. The tire is the baseline's at the reference pressure; beside the pressure one effect may be hidden, in
the sizes of the drawn kinds. A leak, warm air and compressed air move the gauge as well, and on a tire whose whole
force follows the pressure the reading then explains them: both answers count as right.
"""

from __future__ import annotations

import dataclasses
from collections.abc import Mapping
from dataclasses import asdict, dataclass
from typing import ClassVar

import numpy as np

from ..alternatives import Names
from ..bench import Bench
from ..drawing import SIZES, VISIBLE, Undrawable, file_truth, regions_of, stream
from ..effects import BY_NAME, Conditions, Effect
from ..effects.effect import Contact
from ..equivalence import Hidden, equivalent, linearized
from ..motion import FloatArray, Motion
from ..regressors import NAMES
from ..scenario import Plan, drawn_setup
from ..sizing import Size, misfit_size
from ..trial import PRESSURE, Answer, Parameters, Trial, recorded
from .worlds import World, as_baseline, of_plan

#: The name of the kind, and its stream of random numbers (see `drawing.STREAM`).
KIND, STREAM = "pressure", (1_000_003, 4)
ATTEMPTS = 400
#: How often an effect is hidden beside the pressure.
BESIDE = 0.6
#: Gauge pressures over the reference, and the least ratio of the highest to the lowest of a trial.
LEVELS, APART = (0.5, 1.25), 1.3
#: Share of the force that the air carries at the reference and 1 cm, and the power of the deflection in that share.
SHARES, POWERS = (0.5, 1.0), (-0.08, 0.08)
#: What moves the pressure itself.
MOVING = frozenset({"pressure_leak", "warm_up", "gas_compression"})


@dataclass(frozen=True)
class PressedAir(Effect):
    """F = F_0 (1 + a (p/p_0 - 1)) with the air's share a = s (x / 1 cm)^q, at most 1.

    `strength` s [1]; power q [1]; level: gauge pressure over the reference [1]. Casing and air grow with other powers
    of the deflection: for a thin toroid all is air (s = 1, q = 0).
    """

    power: float
    level: float

    name: ClassVar[str] = PRESSURE
    unit: ClassVar[str] = "1"
    limit: ClassVar[float] = 1.0

    @classmethod
    def drawn(cls, rng: np.random.Generator, conditions: Conditions) -> PressedAir:
        """Any share of the casing, at the reference pressure."""
        return cls(rng.uniform(*SHARES), rng.uniform(*POWERS), 1.0)

    def softening(self, contact: Contact) -> FloatArray:
        """Factor on the elastic force."""
        deep = 100.0 * np.maximum(contact.deflection, 1e-6)
        return 1.0 + np.minimum(self.strength * deep**self.power, 1.0) * (self.level - 1.0)

    def gauge_pressure(self) -> float:
        """What the pressure would be over the reference without anything else that moves it."""
        return self.level


def draw(seed: int) -> Trial:
    """Draw one trial from a seed; errors: Undrawable where no world of the seed is fair."""
    for attempt in range(ATTEMPTS):
        trial = _trial(stream(seed, *STREAM, attempt), seed)
        if trial is not None:
            return trial
    raise Undrawable(f"seed {seed} gave no trial of the kind {KIND} in {ATTEMPTS} attempts")


def _trial(rng: np.random.Generator, seed: int) -> Trial | None:
    others = [name for name in NAMES if name != "recalibration"]
    names = (str(rng.choice(others)),) if rng.random() < BESIDE else ()
    plan = Plan("single" if names else "none", names, None, False, False)
    setup = as_baseline(drawn_setup(rng, plan), plan)
    forms = [BY_NAME[n][int(rng.integers(len(BY_NAME[n])))] for n in names]
    world = of_plan(rng, plan, setup, forms, (SIZES, (1.0, 1.0)))
    if world is None or world.baseline is None:
        return None
    found: Mapping[Names, float] = {}
    if names:
        hidden = Hidden.of(world.bench, world.bench.tire, world.train, world.instrument)
        linear = linearized(hidden)
        if linear.loss(()) - linear.loss(names) < VISIBLE:
            return None
        found = equivalent(hidden, linear, frozenset(names), 1).sets
    conditions = Conditions(world.train, (), world.bench.tire, world.instrument.noise)
    air = PressedAir(1.0, 0.0, 1.0) if MOVING & set(names) else PressedAir.drawn(rng, conditions)
    levels = _levels(rng)
    runs = [(m, levels[0]) for m in world.train] + [(world.train[0], level) for level in levels[1:]]
    held = [(m, float(rng.uniform(min(levels), max(levels)))) for m in world.heldout[:-1]]
    held.append((world.heldout[-1], levels[-1]))
    motions = {f"train_{i}.csv": run for i, run in enumerate(runs)}
    motions |= {f"heldout_{i}.csv": run for i, run in enumerate(held)}
    made = [
        recorded(_at(world.bench, air, level), world.instrument, motion, file, rng)
        for file, (motion, level) in motions.items()
    ]
    answer = Answer(
        kind=KIND,
        effects={e.name: e.parameters() for e in (*world.bench.effects, air)},
        hidden={},
        right=_right(frozenset(names), found),
        margins={" + ".join(sorted(s)): round(0.5 * left, 3) for s, left in found.items()},
        rule="the pressure that is read explains what moves it" if MOVING & set(names) else "",
        sizes={**world.sizes, PRESSURE: _size(world, air, runs)},
        where=regions_of(world.bench, world.train),
        noise=world.instrument.noise,
        files={record.name: file_truth(record, world.baseline, floors) for record, floors in made},
        tire={"form": type(world.bench.tire).__name__, **_described(world, levels)},
        instrument=asdict(world.instrument),
    )
    records = tuple(record for record, _ in made)
    return Trial(
        seed,
        records[: len(runs)],
        records[len(runs) :],
        answer,
        world.baseline,
        world.source,
        world.instrument.noise,
        _at(world.bench, air, levels[0]),
        world.instrument,
        tuple(motion for motion, _ in runs),
    )


def _levels(rng: np.random.Generator) -> tuple[float, ...]:
    """Two or three gauge pressures over the reference, in any order."""
    count = int(rng.integers(2, 4))
    while True:
        levels = np.exp(rng.uniform(np.log(LEVELS[0]), np.log(LEVELS[1]), count))
        if float(np.max(levels) / np.min(levels)) >= APART:
            return tuple(float(level) for level in levels)


def _at(bench: Bench, air: PressedAir, level: float) -> Bench:
    return Bench(bench.tire, (*bench.effects, dataclasses.replace(air, level=level)))


def _size(world: World, air: PressedAir, runs: list[tuple[Motion, float]]) -> Size:
    """What the pressure adds to the force at the levels of the training recordings."""
    added = [
        motion.recorded(_at(world.bench, air, level).force(motion) - world.bench.force(motion))
        for motion, level in runs
    ]
    return misfit_size(world.bench, tuple(motion for motion, _ in runs), added, world.instrument.noise)


def _right(names: Names, found: Mapping[Names, float]) -> tuple[tuple[str, ...], ...]:
    """The sets that count as right, the true one first; what stands for the hidden effect does so at one pressure."""
    sets = [names, *found, *([names - MOVING] if names & MOVING else [])]
    return tuple(dict.fromkeys(tuple(sorted({*s, PRESSURE})) for s in sets))


def _described(world: World, levels: tuple[float, ...]) -> Parameters:
    return {**asdict(world.bench.tire), "levels": list(levels)}
