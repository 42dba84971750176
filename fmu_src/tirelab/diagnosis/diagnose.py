"""The one way through a diagnosis: recordings and a believed tire in, a verdict out."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace

import numpy as np
from radialtire import TireModel

from ..engine.background import background
from ..engine.beyond import AGNOSTIC_FAMILIES, SURFACE, worth_trying
from ..engine.choice import choose, cleared_of, fitted_set
from ..engine.columns import build, layout_of, lifted_from_force, measure
from ..engine.evidence import explain
from ..engine.families import CATALOGUE_FAMILIES, LAW_FAMILIES, Family
from ..engine.naming import BEYOND, named
from ..engine.place import Point
from ..engine.plainer import noise_of_less
from ..engine.refit import Case, Refit, owners_of, smooth_of
from ..engine.rivals import confidence_of, rivals_of
from ..engine.search import Settled, search
from ..engine.second_look import second_look
from ..errors import TirelabError
from ..preprocessing.dataset import Scene, scene_of
from ..preprocessing.kinematics import FloatArray
from ..preprocessing.noise_model import Noise
from ..simulation.simulate import simulate
from .discriminating_test import Limits, SeparatingTest, separate
from .held_out import HeldOut, Recorded, given, rmse, split
from .localization import beyond_law, locate
from .residual_model import learned
from .summary import summarise
from .titles import UNKNOWN
from .verdict import Estimate, Evidence, Fit, NamedEffect, Rival, Verdict

CATALOGUE_NAMES: tuple[str, ...] = ("recalibration", *(f.name for f in CATALOGUE_FAMILIES))
"""Every effect that a verdict may name."""

FEWEST_SAMPLES = 100
"""Fewer samples cannot tell fifteen effects and the noise apart."""

FEWEST_STEPS = 8
"""Fewest distinct deflections: a cycle seen in fewer has no shape."""

TRIED = 3
"""Rivals, likeliest first, that a test is looked for to tell apart: each costs a fit."""

LESS = 2
"""Times that a diagnosis is repeated with more of the misfit taken for noise."""

FORM_ERROR = 0.007
LEAST_ERROR = 0.05
"""Errors of form that every family may have: part of its effect's size, and of the noise (see `coarsening`)."""


class PoorRecording(TirelabError):
    """The recordings are too short or too poor to say anything."""


def diagnose(
    recordings: Sequence[Recorded],
    tire: TireModel = TireModel(),  # noqa: B008
    *,
    held_out: Sequence[Recorded] = (),
    catalogue: Sequence[str] = CATALOGUE_NAMES,
    limits: Limits | None = None,
    progress: Callable[[str], None] | None = None,
) -> Verdict:
    """Return what the believed `tire` leaves out of the recordings.

    held_out: recordings on which the correction is only judged (without any, a part of `recordings` that the fit is
    repeated without, see `held_out.split`); catalogue: names of the effects that may be found
    (CATALOGUE_NAMES; without one of them what it does is something unknown); limits: of the rig that would drive a
    further test; progress: called with a sentence now and then

    Raises PoorRecording where the recordings are too short or too poor, ValueError for an unknown name in `catalogue`.
    """
    unknown = set(catalogue) - set(CATALOGUE_NAMES)
    if unknown:
        raise ValueError(
            f"no effect is named {', '.join(sorted(unknown))}; known are {', '.join(CATALOGUE_NAMES)}"
        )
    _check(recordings)
    tell = progress or (lambda sentence: None)
    scene = scene_of([(r.time, r.deflection, r.surface_radius, r.force) for r in recordings], tire)
    families = _families(catalogue)
    zero = Point(np.zeros((len(scene.radii), 4)), lifted=lifted_from_force(scene))
    tell("finding the noise")
    noises = background(scene, families, zero)
    everything, families = families, worth_trying(families, scene)
    _check_signal(scene, noises)
    power = coarsening(scene, noises, families, zero)
    found = search(scene, noises, families, power, tell)
    clearer = second_look(found.settled[0], scene, everything, zero)
    if clearer is not None:
        tell("looking at lines and spans that stand out")
        noises, families = clearer, worth_trying(everything, scene)
        found = search(scene, noises, families, power, tell)
    for _ in range(LESS):
        tell("asking whether less would do")
        wider = noise_of_less(found.settled[0], scene, noises, families, power)
        if wider is None:
            break
        noises = wider
        found = search(scene, noises, families, power, tell)

    tell("fitting the parameters")
    believed = replace(tire, reading_noise=float(np.median([r.motion.noise for r in scene.records])))
    cases = [
        Case(
            recording,
            smooth_of(recording, record.motion),
            recording.force,
            noise,
            record.rows,
            np.zeros(record.rows.size),
        )
        for recording, noise, record in zip(recordings, noises, scene.records, strict=True)
    ]
    settled, fitted = choose(found.settled, believed, cases, scene, power)
    best = settled[0]
    cleared = cleared_of(best, cases, scene)
    before = [r.force - simulate(tire, r) for r in recordings]
    beyond = tuple(n for n in best.names if n in BEYOND)
    tell("judging the correction on what it was not fitted to")
    kept = (
        given(held_out, recordings, scene, before, fitted, tire)
        if held_out
        else split(recordings, scene, before, cleared, fitted, believed)
    )
    corrections = learned(beyond, scene, fitted.residuals, kept)
    fit = _figures(before, fitted, noises, kept)
    effects = _effects(best, fitted)
    rivals = tuple(r for r in rivals_of(settled, scene) if set(r.names) - {UNKNOWN} <= set(catalogue))
    confidence = confidence_of(rivals)
    apart = beyond_law(recordings, before, believed, fitted.tire)
    places = locate(recordings, scene, apart, noises, None if beyond else fitted.residuals)
    test = None
    if rivals:
        tell("looking for the test that would tell")
        test = _separating(best, fitted, rivals, settled, believed, cases, scene, power, fit.noise, limits)
    return Verdict(
        effects,
        confidence,
        rivals,
        bool(beyond),
        beyond,
        corrections,
        summarise(effects, rivals, corrections, confidence, fit, test),
        places,
        fit,
        fitted.tire,
        _table(settled),
        test if test is not None and test.tells else None,
        found.compared,
        fitted.evaluations,
    )


def coarsening(scene: Scene, noises: Sequence[Noise], families: Sequence[Family], point: Point) -> float:
    """Return the power of the coarsened evidence: n samples count as 1 / (1/n + 1/c).

    c = 6 / d^2, where d is the root mean square error in units of the noise that a family's form may have: with it a
    wrong second effect gains less than three in log evidence.
    """
    built = build(scene, point, families)
    layout = layout_of(built, families)
    p = measure(built, noises, families, point)
    law = [layout.whole(f.name) for f in families if f.name in ("recalibration", "shape")]
    left = min(explain(p, law, 1.0).chi_square, p.power / p.samples)
    size = np.sqrt(max(left - 1.0, 0.0))
    worth = 6.0 / (LEAST_ERROR**2 + (FORM_ERROR * size) ** 2)
    return float(worth / (worth + p.samples))


def _families(catalogue: Sequence[str]) -> tuple[Family, ...]:
    known = [f for f in CATALOGUE_FAMILIES if f.name in catalogue]
    law = LAW_FAMILIES if "recalibration" in catalogue else (SURFACE,)
    return (*law, *known, *AGNOSTIC_FAMILIES)


def _check(recordings: Sequence[Recorded]) -> None:
    if not recordings:
        raise PoorRecording("no recording was given; name at least one to diagnose")
    for r in recordings:
        where = f"recording {r.name}"
        if r.time.size < FEWEST_SAMPLES:
            raise PoorRecording(
                f"{where} has {r.time.size} samples; at least {FEWEST_SAMPLES} are needed to tell anything"
            )
        if np.ptp(r.deflection) <= 0.0:
            raise PoorRecording(f"{where} holds one constant deflection; record at least one full cycle")
        if np.ptp(r.force) <= 0.0:
            raise PoorRecording(f"{where} holds one constant force; check that the load cell was connected")
        if float(r.deflection.max()) <= 0.0:
            raise PoorRecording(f"{where} never loads the tire: its deflection stays at or below 0 m")
        distinct = np.unique(np.round(r.deflection / (1e-3 * np.ptp(r.deflection)))).size
        if distinct < FEWEST_STEPS:
            raise PoorRecording(
                f"{where} shows {distinct} distinct deflections only; sample each cycle at {FEWEST_STEPS} points"
            )


def _check_signal(scene: Scene, noises: Sequence[Noise]) -> None:
    for number, (record, noise) in enumerate(zip(scene.records, noises, strict=True), start=1):
        motion = record.motion
        travel = float(np.sqrt(np.mean(np.diff(motion.deflection) ** 2)))
        if motion.noise > 0.3 * float(np.std(motion.deflection)):
            raise PoorRecording(
                f"the deflection of recording {number} is noise: no motion of the tire can be seen in it"
            )
        if travel > 0.7 * float(np.std(motion.deflection)):
            raise PoorRecording(
                f"recording {number} has about one sample to a cycle; sample each cycle at {FEWEST_STEPS} points"
            )
        related = float(np.corrcoef(record.force, record.elastic(motion.deflection))[0, 1])
        if not np.isfinite(related) or abs(related) < 0.2 or noise.level > 0.9 * float(np.std(record.force)):
            raise PoorRecording(
                f"the force of recording {number} does not follow its deflection (correlation {related:.2f}); "
                "check channels and units"
            )


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


def _figures(before: Sequence[FloatArray], fitted: Refit, noises: Sequence[Noise], kept: HeldOut) -> Fit:
    sizes = np.array([b.size for b in before], dtype=float)
    level = float(np.sqrt(np.sum(sizes * np.array([n.level for n in noises]) ** 2) / sizes.sum()))
    return Fit(level, rmse(before), rmse(fitted.residuals), kept.before, kept.after, kept.by, kept.cleared)


def _separating(
    best: Settled,
    fitted: Refit,
    rivals: Sequence[Rival],
    settled: Sequence[Settled],
    believed: TireModel,
    cases: Sequence[Case],
    scene: Scene,
    power: float,
    noise: float,
    limits: Limits | None,
) -> SeparatingTest | None:
    """Return the test that tells the first rival that one tells; else the one that comes nearest to it."""
    nearest: SeparatingTest | None = None
    for rival in rivals[:TRIED]:
        if UNKNOWN in rival.names:
            continue
        other = next((s for s in settled if named(s) == rival.names), None)
        if other is None:
            continue
        second = fitted_set(other, believed, cases, scene, power)
        reach = limits or Limits(
            deepest=scene.deepest,
            fastest=max(0.1, 2.0 * max(float(np.abs(r.motion.rate).max()) for r in scene.records)),
        )
        test = separate(
            (fitted.tire, named(best)),
            (second.tire, rival.names),
            believed,
            second.knobs,
            second.values,
            scene.radii,
            noise,
            reach,
        )
        if nearest is None or test.separation > nearest.separation:
            nearest = test
        if test.tells:
            break
    return nearest


def _table(settled: Sequence[Settled]) -> tuple[Evidence, ...]:
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


__all__ = ["CATALOGUE_NAMES", "PoorRecording", "Recorded", "diagnose"]
