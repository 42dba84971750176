"""The identification of a tire from recordings, stage by stage."""

from __future__ import annotations

import itertools
from collections.abc import Callable, Sequence

import numpy as np
from numpy.typing import NDArray
from radialtire import FLAT_RADIUS, Hull1996, PowerLaw, TestedRange, TireModel
from radialtire.curvature_law import SURFACES_MAX, CurvatureLaw
from radialtire.model import Law
from radialtire.tirefile import LAWS

from ..errors import TirelabError, check_recordings_given
from ..recordings.recording import Recording
from ..recordings.zero import refuse_far_zeros
from ..simulation.simulate import simulate
from .forms import Form, HullForm, form_of
from .intervals import profile
from .joint import JointFit, joint_fit
from .misfit import diagnosis_refused, misfit_sentence, noise_beside
from .noise import PowerFit, with_covariance
from .power_fit import chunks, fit_power, inner_products
from .result import Constant, Identification, SurfaceFit, recording_notes, statements
from .surfaces import CM_PER_M, Surface, names, surfaces_of
from .two_stage import second_stage

Progress = Callable[[str, int, int], None]
"""Called with the stage, the number of its steps that are done, and their total (0: not known)."""

ROUNDING = 1e-9
"""Part of a curvature by which the tested range is wider, as radii are rounded to nine digits."""

UNREAD = 1e-9
"""Part of the largest force that no reading resolves: a law that leaves less leaves rounding."""

Array = NDArray[np.float64]


def identify(
    recordings: Recording | Sequence[Recording],
    *,
    law: str = "auto",
    name: str = "",
    progress: Progress = lambda what, done, total: None,
) -> Identification:
    """Return the tire identified from one recording or several.

    law: "hull1996", "curvature_law", "power_law", or "auto": what the number of surfaces allows
    name: of the tire; progress: see Progress

    Raises TirelabError where the recordings do not determine that law, TypeError for what is no recording.

    Reference: Hull, Wang & Moore, Cycling Science, Spring 1996, section Methods.
    """
    if law not in ("auto", *LAWS):
        raise TirelabError(f"no law is named {law!r}; known are auto, {', '.join(LAWS)}")
    recordings = (
        recordings if isinstance(recordings, Sequence) and not isinstance(recordings, str) else [recordings]
    )
    check_recordings_given(recordings)
    refuse_far_zeros(recordings)
    surfaces = surfaces_of(recordings)
    chosen, why = _law_for(surfaces, law)
    pairs = []
    for i, surface in enumerate(surfaces):
        progress("A and B of each surface", i, len(surfaces))
        pairs.append(fit_power(surface))
    fits = with_covariance(surfaces, pairs)
    progress("A and B of each surface", len(surfaces), len(surfaces))

    form = form_of(surfaces, chosen)
    start = _start(form, fits)
    joint = joint_fit(surfaces, fits, form, start, _counting(progress, "joint fit", 0))
    stepped = _counting(progress, "intervals of the constants", len(form.parameters))
    profiles = profile(form, fits, joint.logs, joint.uncertainties, stepped)
    uncertainties = profiles.widening * joint.uncertainties

    constants = _constants(form, joint.logs, start, uncertainties, profiles.intervals)
    rows = tuple(
        _row(surface, fit, pair)
        for surface, fit, pair in zip(surfaces, fits, form.coefficients(joint.logs).tolist(), strict=True)
    )
    alone = tuple(0 in s.samples for s in surfaces)
    tire = _tire(form.law(joint.logs), surfaces, recordings, name)
    rmse = _rmse(surfaces, form.coefficients(joint.logs))
    noise = noise_beside(recordings, [r.force - simulate(tire, r) for r in recordings])
    read = rmse > UNREAD * max(surface.force_max for surface in surfaces)
    misfit = misfit_sentence(rmse, noise, refused=diagnosis_refused(recordings, part=False)) if read else ""
    return Identification(
        tire=tire,
        surfaces=rows,
        constants=constants,
        correlation=_correlation(joint),
        condition=joint.condition,
        rmse=rmse,
        two_stage_rmse=_rmse(surfaces, form.coefficients(start)),
        chi_square=profiles.chi_square,
        freedom=profiles.freedom,
        reading_noise=noise,
        misfit=misfit,
        notes=(
            *why,
            *recording_notes(rows, alone),
            *statements(
                constants,
                rows,
                profiles.widening * _law_uncertainties(form, joint),
                profiles.chi_square,
                profiles.freedom,
            ),
            *([misfit] if misfit else []),
        ),
    )


def _counting(progress: Progress, what: str, total: int) -> Callable[[], None]:
    """Return what is called after each step of a stage; total: of its steps, 0 where it is not known."""
    number = itertools.count(1)
    return lambda: progress(what, next(number), total)


def _tire(law: Law, surfaces: Sequence[Surface], recordings: Sequence[Recording], name: str) -> TireModel:
    recorded = ", ".join(dict.fromkeys(recording.name for recording in recordings))
    return TireModel(
        law=law,
        tested_range=_tested_range(surfaces),
        name=name or f"tire identified from {recorded}",
        source=f"identified by tirelab from the recordings {recorded}",
    )


def _law_for(surfaces: Sequence[Surface], law: str) -> tuple[str, list[str]]:
    """Return the law's name and the sentences that say why it was chosen."""
    convex = sum(s.curvature > 0.0 for s in surfaces)
    concave = sum(s.curvature < 0.0 for s in surfaces)
    sides = (convex > 0) + (concave > 0)
    enough = 1 not in (convex, concave) and sides > 0 and len(surfaces) > 1 + 2 * sides
    here = f"{len(surfaces)} surface{'s' if len(surfaces) > 1 else ''} ({names(surfaces)})"
    needs = (
        "equations 3 and 4 need two radii on each side that occurs, and one surface more than A has constants: four "
        "surfaces with one side, six with both"
    )
    if law == "auto":
        law = Hull1996.name if enough else PowerLaw.name if len(surfaces) == 1 else CurvatureLaw.name
    if law == Hull1996.name:
        if not enough:
            raise TirelabError(
                f"{here} cannot determine the constants: {needs}; record more, or choose curvature_law"
            )
        missing = [side for side, count in (("convex", convex), ("concave", concave)) if count == 0]
        return law, [f"no {side} surface was recorded: the law takes such ground as flat" for side in missing]
    if law == PowerLaw.name:
        if len(surfaces) == 1:
            return law, [f"{here}: A and B are constant; how they depend on the radius is not known"]
        return law, [f"{here} share one A and one B, as asked"]
    if len(surfaces) > SURFACES_MAX:
        raise TirelabError(
            f"{here} are more than the {SURFACES_MAX} that a law over curvature holds, and {needs}; leave some out, or "
            "record more on the side that has one"
        )
    asked = "as asked" if enough else f"since {needs}"
    return law, [
        f"{here}: A and B are interpolated over the curvature 1/R between them and constant beyond, {asked}"
    ]


def _start(form: Form, fits: Sequence[PowerFit]) -> Array:
    pairs = np.array([(fit.coefficient, fit.exponent) for fit in fits])
    if isinstance(form, HullForm):
        return second_stage(form, pairs)
    logs: Array = np.log(pairs)
    return logs.ravel() if len(form.parameters) == logs.size else logs.mean(axis=0)


def _constants(
    form: Form, logs: Array, start: Array, uncertainties: Array, intervals: Array
) -> tuple[Constant, ...]:
    combination = form.combination()
    values, two_stage = np.exp(combination @ logs), np.exp(combination @ start)
    return tuple(
        Constant(
            name=p.name,
            symbol=p.symbol,
            unit=p.unit,
            value=float(values[k]),
            two_stage=float(two_stage[k]),
            uncertainty=float(values[k] * uncertainties[k]),
            low=float(np.exp(intervals[k, 0])),
            high=float(np.exp(intervals[k, 1])),
        )
        for k, p in enumerate(form.parameters)
    )


def _row(surface: Surface, fit: PowerFit, pair: list[float]) -> SurfaceFit:
    own = inner_products(surface, fit.coefficient, fit.exponent)[2, 2]
    law = inner_products(surface, pair[0], pair[1])[2, 2]
    error, at = _largest_error(surface, pair[0], pair[1])
    uncertainty = np.sqrt(np.diag(fit.covariance))
    return SurfaceFit(
        surface_radius=surface.radius,
        recordings=tuple(dict.fromkeys(p.name for p in surface.pieces)),
        samples=sum(surface.samples),
        resting=surface.resting,
        coefficient=fit.coefficient,
        coefficient_uncertainty=float(uncertainty[0]),
        exponent=fit.exponent,
        exponent_uncertainty=float(uncertainty[1]),
        rmse=float((own / surface.weight_sum) ** 0.5),
        noise=fit.noise,
        independent=fit.independent,
        loop=fit.loop,
        law_coefficient=pair[0],
        law_exponent=pair[1],
        law_rmse=float((law / surface.weight_sum) ** 0.5),
        largest_error=error,
        at=at,
        relative_error=error / surface.force_max,
        deflection_max=surface.deflection_max,
        force_max=surface.force_max,
    )


def _largest_error(surface: Surface, coefficient: float, exponent: float) -> tuple[float, float]:
    """Return the largest error [N], without sign, and its deflection [m]."""
    largest, at = 0.0, 0.0
    for piece in surface.pieces:
        for chunk in chunks(piece):
            x = piece.log_deflection[chunk]
            error = np.abs(piece.force[chunk] - coefficient * np.exp(exponent * x))
            worst = int(error.argmax())
            if error[worst] > largest:
                largest, at = float(error[worst]), float(np.exp(x[worst])) / CM_PER_M
    return largest, at


def _rmse(surfaces: Sequence[Surface], pairs: Array) -> float:
    squares = sum(
        float(inner_products(s, A, B)[2, 2]) for s, (A, B) in zip(surfaces, pairs.tolist(), strict=True)
    )
    return float((squares / sum(s.weight_sum for s in surfaces)) ** 0.5)


def _law_uncertainties(form: Form, joint: JointFit) -> Array:
    """Return the standard uncertainties of the law's A and B on each surface (n, 2)."""
    by_constants = form.derivatives(joint.logs) @ np.linalg.inv(form.combination())
    variances = np.einsum("nik,kl,nil->ni", by_constants, joint.covariance, by_constants)
    found: Array = np.sqrt(np.maximum(variances, 0.0))
    return found


def _correlation(joint: JointFit) -> Array:
    """Return the correlation of the constants' logarithms; that of an undetermined constant with others is 0."""
    spread = joint.uncertainties
    known = np.isfinite(spread) & (spread > 0.0)
    found = np.eye(spread.size)
    both = np.ix_(known, known)
    found[both] = joint.covariance[both] / np.outer(spread[known], spread[known])
    return found


def _tested_range(surfaces: Sequence[Surface]) -> TestedRange:
    """Return the range of the recordings; flat ground is anything flatter than FLAT_RADIUS."""
    curvatures = [s.curvature for s in surfaces]
    lowest, highest = min(curvatures), max(curvatures)
    flat = 1.0 / FLAT_RADIUS if 0.0 in curvatures else 0.0
    return TestedRange(
        curvature_min=lowest - max(abs(lowest) * ROUNDING, flat),
        curvature_max=highest + max(abs(highest) * ROUNDING, flat),
        deflection_max=max(s.deflection_max for s in surfaces),
        force_max=max(s.force_max for s in surfaces),
    )
