"""Effects before a simulation of others, tried with the simulation itself.

An effect before the law (an offset or a lag of the deflection, a series spring) changes the deflection that the
simulation is given. What it makes of that, its law tells only if it does nothing else; where it has a rate, a memory or
a kink of its own it has to be asked. Each such effect is then fitted by replays,

    minimise |F - F_simulation(x_t)|^2 over the strength of the effect,    x_t = x after the effect,

from where the law alone has its minimum; over its other parameters too, if more than noise is left.
The recordings are diagnosed again as if the deflection had been read as x_t; what is left then says whether the effect
is there (`asked.log_odds`).
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray
from radialtire import CATALOGUE, TireModel

from ..errors import TirelabError
from ..estimation.explanation import catalogue_names
from ..estimation.findings import Estimate, NamedEffect
from ..estimation.problem import parameters_of_effect, with_readings
from ..fmu.foreign_replay import Progress, replay_foreign
from ..planning.waveforms import Limits
from ..recordings.recording import Recording
from ..regressors.dataset import Dataset, arranged, dataset_of
from ..report.titles import short_title
from ..selection.search import EFFECTIVE, LIKE_NOISE
from ..simulation.simulate import deflection_of, simulate, upstream_names
from .asked import Asked, Before, log_odds
from .confidence import EITHER
from .diagnose import diagnosed
from .held_out import rmse
from .simulation_correction import Believed, believed_force
from .verdict import FitErrors, Verdict

FloatArray = NDArray[np.float64]

Diagnose = Callable[[Believed, Sequence[str], Before], Verdict]
"""Diagnoses the recordings beside a simulation, with a catalogue of these effects and with what is known before."""

MOST_REPLAYS = 6
"""Budget: replays of the fitted recordings for one effect."""

SETTLED = 1e-3
"""Relative change of the error below which the fit of an effect ends."""

TRIED = 1e-3
"""Part of the usual strength of an effect that is tried for the slope of the law's response."""


def diagnose_beside(believed: Believed, limits: Limits | None, report: Progress) -> Verdict:
    """Return the verdict on recordings beside a simulation; limits: of the rig that would drive the next test.

    Where the simulation is an FMU whose law does not stand for it, effects before it are tried with the FMU.
    """

    def diagnosed_of(several: Believed, catalogue: Sequence[str] | None, before: Before) -> Verdict:
        return diagnosed(Asked(several.fitted, several.tire, several.kept, catalogue, limits, report, before))

    nothing = Before(tried=believed.model is not None)
    found = diagnosed_of(believed, None, nothing)
    if not nothing.tried or believed.rmse <= found.fit.left:
        return found
    return _with_effects_before(believed, found, diagnosed_of, report)


def _with_effects_before(believed: Believed, found: Verdict, diagnose: Diagnose, report: Progress) -> Verdict:
    """Return the verdict that was found, or one for which effects before the simulation were tried with it."""
    upstream = upstream_names()
    others = [name for name in catalogue_names() if name not in upstream]
    best, errors = found, found.fit
    known = Before((), (), None, found.fit, found.where, found.recordings, found.held_out, tried=True)
    if set(upstream) & {effect.name for effect in found.effects}:
        errors = replace(found.fit, after=_left_by(believed, found, report))
        if log_odds(errors.after, found.fit.after) > 0.0:
            report("diagnosing without the effects before the simulation, which refutes them")
            without = diagnose(believed, others, Before(tried=True))
            if without.fit.after < errors.after:
                best, errors = without, without.fit
    while best.remainder.size > LIKE_NOISE:
        dataset = dataset_of(believed.fitted, believed.tire)
        untried = [name for name in upstream if name not in dict(known.values)]
        tried = [_moved_by(name, believed, dataset, report) for name in untried]
        for moved in sorted((m for m in tried if m is not None), key=lambda m: m.left):
            report(f"diagnosing with the {short_title(moved.name)} before the simulation")
            before, beside = moved.beside(known, errors), _given(believed, moved, report)
            other = diagnose(beside, others, before)
            own = other.effects[: len(before.effects)]
            if own[-1].probability > EITHER:
                believed, known, best, errors = beside, replace(before, effects=own), other, other.fit
                break
        else:
            break
    return best


@dataclass(frozen=True)
class _Moved:
    """An effect before the simulation, fitted by replays.

    values: of all its parameters; estimates: of those that were fitted, by their names; before, left: error [N] without
    it and with it alone; noise [N]: of the recordings
    """

    name: str
    values: tuple[float, ...]
    estimates: Mapping[str, Estimate]
    before: float
    left: float
    noise: float

    def beside(self, known: Before, without: FitErrors) -> Before:
        """Return what is known with this effect; without: the errors [N] of the likeliest verdict without it."""
        missed = max(self.before**2 - self.noise**2, 1e-300)
        share = min((self.before**2 - self.left**2) / missed, 1.0)
        effect = NamedEffect(self.name, self.estimates, share, probability=EITHER, together=1.0)
        return replace(
            known,
            effects=(*known.effects, effect),
            values=(*known.values, (self.name, self.values)),
            without=without,
        )


@dataclass(frozen=True)
class _Point:
    """Positions (k,) of the fitted parameters, in usual sizes, the residual (n,) [N] there, and its slopes (n, k)."""

    at: FloatArray
    residual: FloatArray
    slopes: FloatArray

    @property
    def error(self) -> float:
        """Root mean square of the residual [N]."""
        return float(np.sqrt(np.mean(self.residual**2)))


def _moved_by(name: str, believed: Believed, dataset: Dataset, report: Progress) -> _Moved | None:
    """Return an effect fitted by replays of the simulation; None where it leaves no less than without it.

    dataset: of the fitted recordings
    """
    parameters = CATALOGUE[name].parameters
    free = parameters_of_effect(name, dataset.scales)
    order = sorted(free, key=lambda p: parameters[p.index].role != "strength")
    plain = np.array(with_readings(name, [p.start for p in parameters], dataset))
    usual = np.array([p.value(1.0) - plain[p.index] for p in order])
    bounds = np.array([(p.minimum, p.maximum) for p in order]) - plain[[p.index for p in order], None]

    def tire(at: FloatArray) -> TireModel:
        values = plain.copy()
        for p, moved in zip(order, at * usual[: at.size], strict=False):
            values[p.index] = min(max(plain[p.index] + moved, p.minimum), p.maximum)
        return arranged(believed.tire, [(name, tuple(values.tolist()))])

    def replayed(at: FloatArray) -> FloatArray:
        return np.concatenate([_left(believed, tire(at), r, report) for r in believed.fitted])

    def by_law(at: FloatArray) -> FloatArray:
        return np.concatenate([r.force - simulate(tire(at), r) for r in believed.fitted])

    def slopes_of_law(at: FloatArray) -> FloatArray:
        steps = TRIED * np.eye(at.size)
        return np.stack([(by_law(at + step) - by_law(at)) / TRIED for step in steps], axis=1)

    nothing = np.zeros(1)
    first = _Point(nothing, by_law(nothing), slopes_of_law(nothing))
    noise = rmse([np.array([e.floor.level]) for e in dataset.experiments])
    within = bounds / usual[:, None]
    try:
        found = _least(first, replayed, within[:1])
        if len(order) > 1 and found.at.any() and found.error**2 > (1.0 + LIKE_NOISE**2) * noise**2:
            at = np.concatenate([found.at, np.zeros(len(order) - 1)])
            slopes = np.concatenate([found.slopes, slopes_of_law(at)[:, 1:]], axis=1)
            found = _least(_Point(at, found.residual, slopes), replayed, within)
    except TirelabError:
        return None  # the simulation fails on such a deflection
    if not found.at.any():
        return None
    values = dict(tire(found.at).effects)[CATALOGUE[name]]
    beyond = max(found.error**2 - noise**2, 0.0)
    variance = noise**2 + beyond * max(found.residual.size / EFFECTIVE, 1.0)
    covariance = variance * np.linalg.pinv(found.slopes.T @ found.slopes)
    deviations = usual[: found.at.size] * np.sqrt(np.diag(covariance))
    estimates = {
        p.label: Estimate(values[p.index], float(own), p.unit)
        for p, own in zip(order[: found.at.size], deviations, strict=True)
    }
    return _Moved(name, values, estimates, first.error, found.error, noise)


def _least(start: _Point, residual: Callable[[FloatArray], FloatArray], bounds: FloatArray) -> _Point:
    """Return the point with the least error, by Gauss's method; bounds (k, 2) of the positions.

    The slopes are those of the start, to which each residual adds what it shows of them (C. G. Broyden, Math. Comp. 19
    (1965) 577).
    """
    best = now = start
    for _ in range(MOST_REPLAYS):
        step = np.linalg.lstsq(now.slopes, -now.residual)[0]
        at = np.clip(now.at + step, *bounds.T)
        step = at - now.at
        if not step.any():
            break
        other = residual(at)
        missed = other - now.residual - now.slopes @ step
        point = _Point(at, other, now.slopes + np.outer(missed, step) / float(step @ step))
        best = min(best, point, key=lambda p: p.error)
        if abs(1.0 - point.error / now.error) < SETTLED:
            break
        now = point
    return best


def _given(believed: Believed, moved: _Moved, report: Progress) -> Believed:
    """Return the simulation given the deflection after an effect, with recordings that have it for their own."""
    tire = arranged(believed.tire, [(moved.name, moved.values)])
    several = [
        tuple(_with_other(believed, tire, r, report) for r in own) for own in (believed.fitted, believed.kept)
    ]
    return replace(believed, fitted=several[0], kept=several[1])


def _with_other(believed: Believed, tire: TireModel, recording: Recording, report: Progress) -> Recording:
    """Return a recording with the deflection after the effects of `tire`, and the simulation's force for that."""
    assert believed.model is not None
    r = recording
    recorded = r.force + believed_force(r) - simulate(believed.tire, r)
    moved = replace(r, deflection=deflection_of(tire, r))
    simulated = replay_foreign(believed.model, moved, r.name, believed.timeout, report)
    law = simulate(believed.tire, moved)
    return replace(moved, force=recorded - simulated + law, believed_force=simulated)


def _left(believed: Believed, tire: TireModel, recording: Recording, report: Progress) -> FloatArray:
    """Return what the simulation leaves [N] of a recording, given the deflection after the effects of `tire`, beside
    what the others of them add to its law.
    """
    other = _with_other(believed, tire, recording, report)
    return other.force - simulate(tire, recording)


def _left_by(believed: Believed, found: Verdict, report: Progress) -> float:
    """Return the error [N] of a verdict whose effects before the simulation are given to it."""
    return rmse([_left(believed, found.tire, r, report) for r in believed.fitted])
