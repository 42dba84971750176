"""The set that is believed: the likeliest of the search whose every effect earns its place in the catalogue's own form.

The search speaks in columns, more of them than an effect has parameters: together they can follow what another effect's
form has missed. So the weak effects of a set are left out of its fit once more, one by one. One that does not gain what
it costs there is not believed, and the likeliest set without it, if one comes near, is fitted in its turn.
So it is with a set that leaves more of the forces than the believed tire did.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from radialtire import CATALOGUE, TireModel

from ..preprocessing.kinematics import FloatArray
from ..simulation.simulate import simulate
from .columns import build
from .judge import power_of, prior_of
from .naming import BEYOND, named
from .refit import Case, Refit, refit
from .rivals import one_constant_rate
from .scene import Scene
from .screen import CLOSE
from .search import Settled
from .starts import strengths
from .worth import begun_anew, gain, without

WEAK, WEAK_BESIDE = 0.5, 0.1
"""An effect whose own part is below so many noises, or this part of another one's size, is asked: what is larger is no
error of another's form."""

ASKED = 3
"""So many are asked at most, the weakest first."""

TRIES = 3
"""Sets that are fitted at most before one is believed."""


def choose(
    settled: Sequence[Settled], believed: TireModel, cases: Sequence[Case], scene: Scene, power: float
) -> tuple[tuple[Settled, ...], Refit]:
    """Return the settled sets with the one that is believed first, and its fit.

    settled: best first; power: part of the evidence that counts. A set that was not believed comes last, with what its
    weakest effect gains for its likelihood.
    """
    left, doubted = list(settled), list[tuple[Settled, float]]()
    while True:
        fitted = fitted_set(left[0], believed, cases, scene, power)
        gains, fitted = _gains(left[0], fitted, believed, cases, scene, power)
        if _leaves_more(left[0], fitted, believed, cases):
            gains |= dict.fromkeys(named(left[0]), -np.inf)
        failing = sorted((n for n in gains if gains[n] < 0.0), key=lambda n: gains[n])
        following = {n: _without(left, n, gains[n]) for n in failing}
        gone = next((n for n in failing if following[n]), None)
        if gone is None or len(doubted) == TRIES - 1:
            break
        doubted.append((left[0], gains[gone]))
        left = following[gone]
    best = left[0].log_evidence
    return (*left, *(_doubted(s, best + gain) for s, gain in doubted)), fitted


def _without(left: Sequence[Settled], failing: str, gain: float) -> list[Settled]:
    """Return the sets without an effect, the one to be believed first; nothing where none comes near.

    gain: what the effect gains in the catalogue's form; the set without it is as much likelier there, whatever the
    columns say, which follow that form less well. Of an effect beyond its bounds (-inf) nothing is known.
    """
    others = [s for s in left if failing not in named(s)]
    best = left[0]
    same = [
        s for s in others if set(named(s)) == set(named(best)) - {failing} and np.isfinite(s.log_evidence)
    ]
    if same and np.isfinite(gain):
        likely = best.log_evidence - gain
        raised = replace(same[0], candidate=replace(same[0].candidate, log_evidence=likely, likely=likely))
        return [raised, *(s for s in others if s is not same[0])]
    near = bool(others) and others[0].log_evidence >= best.log_evidence - CLOSE
    return others if near else []


def _gains(
    settled: Settled, fitted: Refit, believed: TireModel, cases: Sequence[Case], scene: Scene, power: float
) -> tuple[dict[str, float], Refit]:
    """Return the log posterior odds of each weak effect of a fitted set (none of one that is beyond its bounds), and
    the fit, begun anew where an effect seemed not to gain.
    """
    own = dict(zip(settled.names, settled.candidate.explained.unique, strict=True))
    groups = dict(zip(settled.names, settled.candidate.groups, strict=True))
    names = [n for n in named(settled) if n in own]
    gains = {n: -np.inf for n in names if _beyond_bounds(n, fitted)}
    sizes = dict(zip(settled.names, settled.candidate.explained.size, strict=True))
    beside = {n: max((sizes[m] for m in names if m != n), default=0.0) for n in names}
    asked = [n for n in names if own[n] < max(WEAK, WEAK_BESIDE * beside[n]) and n not in gains]
    weak = sorted(asked, key=lambda n: own[n])
    cleared = cleared_of(settled, cases, scene)
    for name in weak[:ASKED]:
        prior = prior_of(settled.layout.families[name], "recalibration" in names)
        counted = power_of(settled.products, name, groups[name], power)
        less = without(name, fitted, believed, cleared, scene.radii)
        gains[name] = gain(fitted, less, counted) + prior
        if gains[name] < 0.0:
            fitted = begun_anew(
                name, fitted, less, believed, cleared, scene.radii, scene.deepest, scene.highest
            )
            gains[name] = gain(fitted, less, counted) + prior
    return gains, fitted


def _beyond_bounds(name: str, fitted: Refit) -> bool:
    """Return whether the fit pushes an effect's strength to the largest value that the catalogue finds plausible."""
    if name not in CATALOGUE:
        return False
    at = strengths(CATALOGUE[name])
    return any(
        k.owner == name and k.index in at and value >= k.high
        for k, value in zip(fitted.knobs, fitted.values, strict=True)
    )


def _leaves_more(settled: Settled, fitted: Refit, believed: TireModel, cases: Sequence[Case]) -> bool:
    """Return whether a set of known effects leaves more of the forces than the believed tire did: no correction at all.

    What follows whitened residuals may do so where an offset that slow noise allows would make up for it.
    """
    if any(n in BEYOND for n in settled.names):
        return False
    after, before = (
        sum(float(np.sum((c.force - simulate(tire, c.smooth, c.smooth)) ** 2)) for c in cases)
        for tire in (fitted.tire, believed)
    )
    return after > before


def _doubted(settled: Settled, likely: float) -> Settled:
    return replace(settled, candidate=replace(settled.candidate, log_evidence=-np.inf, likely=likely))


def parts_of(settled: Settled, scene: Scene) -> dict[str, list[FloatArray]]:
    """Return what each family of a settled set adds [N], for each recording."""
    built = build(scene, settled.point, [settled.layout.families[n] for n in settled.names])
    parts: dict[str, list[FloatArray]] = {}
    for name, group, values in zip(
        settled.names, settled.candidate.groups, settled.candidate.explained.coefficients, strict=True
    ):
        own = group - settled.layout.start[name]
        parts[name] = [b.columns[name][:, own] @ values for b in built]
    return parts


def fitted_set(
    settled: Settled,
    believed: TireModel,
    cases: Sequence[Case],
    scene: Scene,
    power: float,
) -> Refit:
    """Return the settled set fitted to the cases in the catalogue's own forms."""
    names = [n for n in settled.names if n not in BEYOND and n != "shape"]
    parts = parts_of(settled, scene)
    cleared = cleared_of(settled, cases, scene)
    middle = np.log(50.0 * scene.deepest)
    shape = settled.point.shape
    law = np.stack([shape[:, 0] - shape[:, 1] * middle, shape[:, 1]], axis=1)
    return refit(
        believed,
        names,
        parts,
        law,
        cleared,
        scene.radii,
        scene.deepest,
        scene.highest,
        power,
        one_constant_rate(scene),
    )


def cleared_of(settled: Settled, cases: Sequence[Case], scene: Scene) -> list[Case]:
    """Return the cases with what is beyond the catalogue taken out: no effect is bent to follow it."""
    parts = parts_of(settled, scene)
    beyond = [n for n in settled.names if n in BEYOND]
    return [
        replace(case, beyond=sum((parts[n][i] for n in beyond), case.beyond)) for i, case in enumerate(cases)
    ]
