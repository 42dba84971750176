"""Where the fit of an effect begins: the values whose response comes nearest to its part in the search."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from itertools import product
from typing import Protocol

import numpy as np
from radialtire import CATALOGUE, Effect, State, TireModel
from radialtire.effect import PLACES
from scipy.optimize import nnls

from ..preprocessing.kinematics import FloatArray, IndexArray
from ..simulation.simulate import Sampled, simulate


class Compared(Protocol):
    """A recording and the samples of it that are compared."""

    @property
    def recording(self) -> Sampled:
        """The recording."""
        ...

    @property
    def rows(self) -> IndexArray:
        """Indices of its samples."""
        ...


GRIDS: dict[str, dict[str, tuple[float, ...]]] = {
    "rate_independent_hysteresis": {"reach": (3e-4, 1e-3, 3e-3)},
    "viscoelastic_relaxation": {"relaxation_time_1": (0.02, 0.1, 0.5, 2.0, 10.0, 50.0)},
    "mullins_softening": {"ratio": (0.05, 0.15, 0.5)},
    "warm_up": {"time_constant": (3.0, 10.0, 30.0, 100.0)},
}
"""Starting values of what an effect is not linear in, where everyday ones are not enough."""


def starts_of(effect: Effect, deepest: float, highest: float) -> list[State]:
    """Return values of an effect from which its fit may begin; deepest [m], highest [N]: what was driven and read."""
    grids = dict(GRIDS.get(effect.name, {}))
    if effect.name == "bottoming":
        grids = {"onset": tuple(deepest * q for q in (0.5, 0.65, 0.75, 0.85, 0.92, 0.96, 0.98, 0.99))}
    if effect.name == "saturation":
        # Sharp at first: beyond a sharp ceiling that nothing reaches there is no slope.
        grids = {
            "limit": tuple(highest * q for q in (0.4, 0.6, 0.75, 0.85, 0.92, 0.96, 0.98, 0.99, 1.0, 1.005))
        }
    if effect.name == "force_lag":
        return [
            (lag, delay, 0.0)
            for time in (1e-3, 4e-3, 2e-2)
            for lag, delay in ((time, 0.0), (0.0, time), (0.5 * time, 0.5 * time))
        ]
    names = [p.name for p in effect.parameters]
    found = []
    for combination in product(*grids.values()):
        values = list(effect.nominal)
        for name, value in zip(grids, combination, strict=True):
            values[names.index(name)] = value
        found.append(tuple(values))
    if effect.name in ("deflection_offset", "force_offset", "force_drift"):
        found.append(tuple(-v for v in found[0]))
    return found


def strengths(effect: Effect) -> list[int]:
    """Return the indices of the parameters to which an effect's force is in proportion."""
    return [
        i
        for i, p in enumerate(effect.parameters)
        if p.neutral is not None and not p.optional and p.name != "limit"
    ]


def matched(
    effect: Effect,
    target: Sequence[FloatArray],
    cases: Sequence[Compared],
    tire: TireModel,
    deepest: float,
    highest: float,
) -> State:
    """Return the effect's values whose response comes nearest to its part in the search [N]."""
    best: tuple[float, State] = (np.inf, effect.nominal)
    amplitudes = strengths(effect)
    wanted = np.concatenate(target)
    bare = np.concatenate([simulate(tire, c.recording)[c.rows] for c in cases])
    for values in starts_of(effect, deepest, highest):
        trial = values
        for _ in range(3 if amplitudes else 1):
            with_it = with_effect(tire, effect, trial)
            response = np.concatenate([simulate(with_it, c.recording)[c.rows] for c in cases]) - bare
            miss = float(np.sum((response - wanted) ** 2))
            if miss < best[0]:
                best = (miss, trial)
            power = float(response @ response)
            if power <= 0.0 or not amplitudes:
                break
            factor = float(np.clip(response @ wanted / power, 0.02, 50.0))
            scaled = list(trial)
            for i in amplitudes:
                p = effect.parameters[i]
                scaled[i] = float(np.clip(trial[i] * factor, p.minimum, p.maximum))
            trial = tuple(scaled)
    return best[1]


SMALL = 0.01
"""A share whose response is that of any other in proportion."""


def spread(target: Sequence[FloatArray], cases: Sequence[Compared], tire: TireModel) -> dict[str, float]:
    """Return parameters of a relaxation with one term to a decade, whose shares come nearest to its part [N]."""
    effect = CATALOGUE["viscoelastic_relaxation"]
    bare = np.concatenate([simulate(tire, c.recording)[c.rows] for c in cases])
    terms = [p for p in effect.parameters if p.name.startswith("share")]
    responses = []
    for term in terms:
        values = tuple(SMALL if p is term else p.start for p in effect.parameters)
        with_it = with_effect(tire, effect, values)
        responses.append(np.concatenate([simulate(with_it, c.recording)[c.rows] for c in cases]) - bare)
    shares, _ = nnls(np.stack(responses, axis=1) / SMALL, np.concatenate(target), maxiter=1000)
    times = {p.name: p.start for p in effect.parameters if p.name.startswith("relaxation_time")}
    return {t.name: min(float(g), t.maximum) for t, g in zip(terms, shares, strict=True)} | times


def with_effect(tire: TireModel, effect: Effect, values: State) -> TireModel:
    """Return the tire with the effect at these values, in the order of the signal's way."""
    others = [(e, v) for e, v in tire.effects if e.name != effect.name]
    order = sorted(
        [*others, (effect, values)],
        key=lambda e: (PLACES.index(e[0].place), list(CATALOGUE).index(e[0].name)),
    )
    return replace(tire, effects=tuple(order))
