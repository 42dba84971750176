"""The engine's one entry: what explains the misfit of a baseline tire on recordings.

It estimates the noise, selects a set of effects, fits it in the catalogue's own forms, accepts or refuses it, and
lists the alternatives that the recordings cannot rule out.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace

import numpy as np
from radialtire import TireModel

from ..names import REFITTED_LAW, UNKNOWN
from ..preprocessing.data_checks import check_signal
from ..preprocessing.dataset import Dataset, Recorded
from ..preprocessing.kinematics import BoolArray, FloatArray
from ..preprocessing.noise_model import Noise
from ..simulation.simulate import smoothed_motion
from .background import background
from .beyond import AGNOSTIC_FAMILIES, SURFACE, worth_trying
from .choice import choose, cleared_of, fitted_set
from .columns import build, layout_of, lifted_from_force, measure
from .evidence import explain as explained_by
from .families import CATALOGUE_FAMILIES, LAW_FAMILIES, Family
from .findings import Alternative, Estimate, Evidence, FittedModel, NamedEffect, Refitted
from .naming import BEYOND, named
from .place import Point
from .plainer import noise_of_less
from .refit import Case, Refit, again, owners_of
from .rivals import confidence_of, rivals_of
from .scene import Scene, scene_of
from .search import Settled, search
from .second_look import second_look

CATALOGUE_NAMES: tuple[str, ...] = (REFITTED_LAW, *(f.name for f in CATALOGUE_FAMILIES))
"""Every effect that a verdict may name."""

LESS = 2
"""Times that a diagnosis is repeated with more of the misfit taken for noise."""

FORM_ERROR = 0.007
LEAST_ERROR = 0.05
"""Errors of form that every family may have: part of its effect's size, and of the noise (see `coarsening`)."""

Progress = Callable[[str], None]


@dataclass(frozen=True)
class _State:
    """What the engine needs to fit once more."""

    settled: tuple[Settled, ...]
    fitted: Refit
    baseline: TireModel
    cases: tuple[Case, ...]
    scene: Scene
    power: float


@dataclass(frozen=True)
class Explanation:
    """What explains the misfit.

    effects: those that are accepted; unexplained_by: coordinates on which something unknown depends; alternatives:
    other sets, likeliest first; confidence: 0 to 1; model: the accepted set, fitted; residuals [N]: what it leaves of
    each recording; noises: of each recording; evidence: all sets that were compared to the end, the accepted one first
    compared: number of sets compared; evaluations: simulations of whole recordings in the final fit
    """

    effects: tuple[NamedEffect, ...]
    unexplained_by: tuple[str, ...]
    alternatives: tuple[Alternative, ...]
    confidence: float
    model: FittedModel
    residuals: tuple[FloatArray, ...]
    noises: tuple[Noise, ...]
    evidence: tuple[Evidence, ...]
    compared: int
    evaluations: int
    _state: _State = field(repr=False)

    def refitted(self, kept: Sequence[BoolArray]) -> Refitted:
        """Return the accepted set fitted to the samples `kept` of each recording alone."""
        state = self._state
        cleared = cleared_of(state.settled[0], state.cases, state.scene)
        fitted = [
            replace(c, noise=replace(c.noise, weight=c.noise.weight * k[c.rows]))
            for c, k in zip(cleared, kept, strict=True)
        ]
        refitted = again(state.baseline, state.fitted, fitted, state.scene.radii)
        return Refitted(refitted.tire, refitted.residuals)

    def alternative_model(self, names: tuple[str, ...]) -> FittedModel | None:
        """Return an alternative fitted to the recordings; None where it was not compared to the end."""
        state = self._state
        other = next((s for s in state.settled if named(s) == names), None)
        if other is None:
            return None
        fitted = fitted_set(other, state.baseline, state.cases, state.scene, state.power)
        return _model(names, fitted, state)


def explain_misfit(
    recordings: Sequence[Recorded],
    dataset: Dataset,
    baseline: TireModel,
    catalogue: Sequence[str],
    progress: Progress,
) -> Explanation:
    """Return what explains the misfit of the `baseline` tire on `recordings`, prepared as `dataset`.

    catalogue: names of the effects that may be found, of CATALOGUE_NAMES; progress: called with a sentence now and then
    Raises PoorRecording where the force does not follow the deflection.
    """
    scene = scene_of(dataset)
    families = _families(catalogue)
    zero = Point(np.zeros((len(scene.radii), 4)), lifted=lifted_from_force(scene))
    progress("estimating the noise")
    noises = background(scene, families, zero)
    everything, families = families, worth_trying(families, scene)
    check_signal(dataset, noises)
    power = coarsening(scene, noises, families, zero)
    found = search(scene, noises, families, power, progress)
    clearer = second_look(found.settled[0], scene, everything, zero)
    if clearer is not None:
        progress("screening the residual once more")
        noises, families = clearer, worth_trying(everything, scene)
        found = search(scene, noises, families, power, progress)
    for _ in range(LESS):
        progress("checking whether fewer effects explain the misfit")
        wider = noise_of_less(found.settled[0], scene, noises, families, power)
        if wider is None:
            break
        noises = wider
        found = search(scene, noises, families, power, progress)

    progress("fitting the parameters")
    fitted_baseline = replace(
        baseline, reading_noise=float(np.median([r.motion.noise for r in scene.records]))
    )
    cases = tuple(
        Case(
            recording,
            smoothed_motion(recording, record.motion),
            recording.force,
            noise,
            record.rows,
            np.zeros(record.rows.size),
        )
        for recording, noise, record in zip(recordings, noises, scene.records, strict=True)
    )
    settled, fitted = choose(found.settled, fitted_baseline, cases, scene, power)
    state = _State(settled, fitted, fitted_baseline, cases, scene, power)
    alternatives = tuple(r for r in rivals_of(settled, scene) if set(r.names) - {UNKNOWN} <= set(catalogue))
    return Explanation(
        _effects(settled[0], fitted),
        tuple(n for n in settled[0].names if n in BEYOND),
        alternatives,
        confidence_of(alternatives),
        _model(named(settled[0]), fitted, state),
        fitted.residuals,
        tuple(noises),
        _evidence(settled),
        found.compared,
        fitted.evaluations,
        state,
    )


def _model(names: tuple[str, ...], fitted: Refit, state: _State) -> FittedModel:
    return FittedModel(names, fitted.tire, state.baseline, fitted.knobs, fitted.values, state.scene.radii)


def coarsening(scene: Scene, noises: Sequence[Noise], families: Sequence[Family], point: Point) -> float:
    """Return the power of the coarsened evidence: n samples count as 1 / (1/n + 1/c).

    c = 6 / d^2, where d is the root mean square error in units of the noise that a family's form may have: with it a
    wrong second effect gains less than three in log evidence.
    """
    built = build(scene, point, families)
    layout = layout_of(built, families)
    p = measure(built, noises, families, point)
    law = [layout.whole(f.name) for f in families if f.name in ("recalibration", "shape")]
    left = min(explained_by(p, law, 1.0).chi_square, p.power / p.samples)
    size = np.sqrt(max(left - 1.0, 0.0))
    worth = 6.0 / (LEAST_ERROR**2 + (FORM_ERROR * size) ** 2)
    return float(worth / (worth + p.samples))


def _families(catalogue: Sequence[str]) -> tuple[Family, ...]:
    known = [f for f in CATALOGUE_FAMILIES if f.name in catalogue]
    law = LAW_FAMILIES if "recalibration" in catalogue else (SURFACE,)
    return (*law, *known, *AGNOSTIC_FAMILIES)


def _effects(settled: Settled, fitted: Refit) -> tuple[NamedEffect, ...]:
    sizes = dict(zip(settled.names, settled.candidate.explained.size, strict=True))
    powers = {n: sizes[n] ** 2 for n in settled.names}
    whole = sum(powers.values()) or 1.0
    found = []
    for name in named(settled):
        if name == UNKNOWN:
            continue
        owners = owners_of(name)
        parameters = {
            k.label: Estimate(float(v), float(d), k.unit)
            for k, v, d in zip(fitted.knobs, fitted.values, fitted.deviations, strict=True)
            if k.owner in owners
        }
        power = powers[name] + (powers.get("shape", 0.0) if name == "recalibration" else 0.0)
        found.append(NamedEffect(name, parameters, float(power / whole)))
    return tuple(sorted(found, key=lambda e: -e.share))


def _evidence(settled: Sequence[Settled]) -> tuple[Evidence, ...]:
    rows = []
    for s in settled:
        kept = [i for i, n in enumerate(s.names) if n != "shape"]
        rows.append(
            Evidence(
                tuple(s.names[i] for i in kept),
                s.log_evidence - settled[0].log_evidence,
                float(s.candidate.explained.chi_square),
                tuple(s.candidate.explained.size[i] for i in kept),
                tuple(s.candidate.explained.unique[i] for i in kept),
            )
        )
    return tuple(rows)
