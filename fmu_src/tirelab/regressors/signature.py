"""The signature of an effect: the responses that it may have to the recorded motion.

Parameters are drawn from their priors, the baseline tire with the effect is simulated along the motion, and the force
of the baseline is subtracted. The responses, scaled to one size, are taken as draws from a normal law. The signature
holds their mean and the leading vectors of a singular value decomposition, each scaled by its standard deviation. The
priors are multiples of the recording's force and travel. What acts on the signal of others, as a lag does, is drawn
again beside each fitted set: a lag beside a damper is not a lag of the tire alone.

The elastic law has a signature of its own: how a refitted law, or one of another shape, would differ.

    dF / F = a + b l + c l^2 + d l^3 + h(x),   l = ln(x / x_ref)

a and b: common to all surfaces, and further ones on each; h: straight lines between the heights of a law's shape, with
a kink at each. Kinks with independent priors make a smooth law likelier than one that goes up and down, as smoothing
splines do (P. H. C. Eilers, B. D. Marx, Statist. Sci. 11 (1996) 89). These are the derivatives of the law that is
fitted and delivered, so that every law that can be fitted is considered. Their scale is not declared: it maximises the
marginal likelihood (type II), like that of the effects.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from radialtire import CATALOGUE, Effect, TireModel
from scipy.interpolate import BSpline

from ..names import REFITTED_LAW
from ..preprocessing.samples import MOST_SURFACES, surface_numbers
from ..simulation.simulate import UPSTREAM, beyond_zero
from .dataset import Dataset, Experiment, arranged, own_deflection
from .draws import (
    LEAST_DRAWN,
    MOST_OF_LOAD,
    OVERSIZED,
    SIZED,
    at_reading,
    centre_and_spread,
    drawn,
    strength_of,
    strengthened,
)

FloatArray = NDArray[np.float64]


LAW = REFITTED_LAW
"""The name under which a refitted law stands in a verdict."""

SHAPE, CURVE = (name for name, effect in CATALOGUE.items() if "law" in effect.traits)
"""The effects in which a refitted law keeps its shape: bend, twist and the heights of a tire; the curve of a part."""

FACTOR, EXPONENT, BEND, TWIST, KINK = 0.1, 0.07, 0.03, 0.01, 0.05
"""Standard deviations of a, b, c, d and each kink at the scale 1, a kink by what it changes over the whole span. Only
their proportions matter, since the scale is found from the recordings."""

PRELOAD = 0.05
"""The same of a part's preload, over the largest force: that of a force's offset."""

HEIGHTS = sum(p.name.startswith("height") for p in CATALOGUE[SHAPE].parameters)
"""Number of heights in the shape of a refitted law."""

RAMPS = np.clip(np.subtract.outer(np.arange(HEIGHTS), np.arange(HEIGHTS - 1)), 0, None) / (HEIGHTS - 1.0)
"""The heights (rows) that follow from a kink of size 1 at each height but the last (columns); of a part the forces."""

LEAST_RATIO = 0.01
"""The least x / x_ref, as in the effect SHAPE."""


def candidates() -> tuple[str, ...]:
    """Return the names of the effects that may be missing; the law comes beside them."""
    return tuple(name for name in CATALOGUE if name not in (SHAPE, CURVE))


def acts_on_signal(name: str) -> bool:
    """Whether an effect changes what other effects are given or give, so that its response depends on them."""
    return name != LAW and CATALOGUE[name].place in (*UPSTREAM, "law", "scale", "reading")


def form_error(name: str, tire: TireModel | None = None) -> float:
    """Return the declared form error of an effect, or of the refitted law of a tire or a part."""
    law = CURVE if tire is not None and tire.two_sided else SHAPE
    return CATALOGUE[law if name == LAW else name].form_error


def kink_spread(dataset: Dataset) -> float:
    """Return the standard deviation of each kink at the scale 1: of ln F, for a part of its force [N]."""
    return KINK * (dataset.scales.force if dataset.tire.two_sided else 1.0)


def span_of(dataset: Dataset) -> tuple[float, float]:
    """Return the lowest and the highest deflection [m] of the part itself in the recordings."""
    return float(dataset.deflection.min()), float(dataset.deflection.max())


def preload_spread(dataset: Dataset) -> float:
    """Return the standard deviation [N] of the change of a part's preload at the scale 1; a tire has no preload."""
    return PRELOAD * dataset.scales.force if dataset.tire.two_sided else 0.0


def gap_of(tire: TireModel) -> tuple[Effect, tuple[float, ...]] | None:
    """Return the effect that holds the gap of a part's law, and its values; None of a tire and of a part without a gap.

    A part's law that begins beyond a gap has an offset of the deflection as one of its constants, as others have a
    preload: no recording of the part tells a change of it from another zero of the gauge.
    """
    offsets = [(e, v) for e, v in tire.effects if e.holds_gap]
    return offsets[0] if offsets and not tire.inflated and not tire.two_sided else None


def gap_spread(dataset: Dataset) -> float:
    """Return the standard deviation [m] of the change of a part's gap at the scale 1; 0 where it has none."""
    gap = gap_of(dataset.tire)
    return centre_and_spread(gap[0].parameters[0], dataset.scales)[1] if gap else 0.0


def _spline(x: FloatArray, span: tuple[float, float], forces: FloatArray) -> FloatArray:
    """Return the curve of a part along its forces, at deflections (m,) within the span."""
    step = (span[1] - span[0]) / (HEIGHTS - 3.0)
    return np.asarray(BSpline(span[0] + step * np.arange(-3.0, HEIGHTS + 1.0), forces, 3)(x))


def _beside_law(tire: TireModel, experiment: Experiment) -> FloatArray:
    """Return the force [N] of a part without a deflection and what its curve adds to that."""
    pretension = np.full(experiment.time.size, tire.pretension)
    if tire.curve is None:
        return pretension
    return pretension + beyond_zero(tire.curve, own_deflection(tire, experiment))


def reference_of(dataset: Dataset) -> float:
    """Return the deflection [m] about which a law is refitted, where a change of B alone leaves its force."""
    return at_reading(next(p for p in CATALOGUE[SHAPE].parameters if p.name == "reference"), dataset.scales)


def law_signature(dataset: Dataset) -> Signature:
    """Return the law's signature, of size 1 where A changes by FACTOR, or a part's preload or gap, if that is more."""
    x, radius = dataset.deflection, dataset.gathered([e.surface_radius for e in dataset.experiments])
    tire = dataset.tire  # what it is without a deflection, and its curve, are no factor's
    force = dataset.stacked([e.baseline - _beside_law(tire, e) for e in dataset.experiments])
    reference = reference_of(dataset)
    way = np.log(np.maximum((np.abs(x) if tire.two_sided else x) / reference, LEAST_RATIO))
    changes = [FACTOR + 0.0 * way, EXPONENT * way]
    columns = [force * part for part in (*changes, BEND * way**2, TWIST * way**3)]
    if tire.two_sided:
        one = dataset.stacked([np.full(e.time.size, kink_spread(dataset)) for e in dataset.experiments])
        columns += [one * _spline(x, span_of(dataset), forces) for forces in RAMPS.T]
    else:
        places = 2.0 * reference * np.arange(1, HEIGHTS + 1) / HEIGHTS
        columns += [force * kink_spread(dataset) * np.interp(x, places, heights) for heights in RAMPS.T]
    if len(dataset.radii) > 1:
        shapes = [np.sqrt(0.5) * force * part for part in changes]
        columns[: len(shapes)] = shapes
        if len(dataset.radii) <= MOST_SURFACES:
            columns += [s * (radius == r) for r in dataset.radii for s in shapes]
    size = size_of(FACTOR * force)
    if dataset.tire.two_sided:
        many = dataset.experiments
        columns.append(dataset.stacked([np.full(e.time.size, preload_spread(dataset)) for e in many]))
        size = max(size, size_of(columns[-1]))
    if gap := gap_of(tire):
        far = gap_spread(dataset)
        ways = [arranged(tire, [(gap[0].name, (gap[1][0] + step,))]) for step in (far, -far)]
        columns.append(0.5 * (dataset.response(ways[0]) - dataset.response(ways[1])))
        size = max(size, size_of(columns[-1]))
    basis = np.column_stack(columns) / max(size, 1e-300)
    none = np.zeros((0, force.size))
    return Signature(LAW, np.zeros(force.size), basis, False, none, (), np.zeros(0))


DRAWS = 32
COLUMNS = 8
ENERGY = 0.999
"""Number of draws of an effect, most columns of its signature, and the part of the variance that these must hold."""

PROBED = 4
"""Number of draws that show whether a response is another one beside another tire."""

AS_GOOD = 0.75
"""Part of what an effect explains that another one must explain to take its place."""

ALIKE = float(np.sqrt(AS_GOOD))
"""Cosine between two responses above which either may take the place of the other."""

FEWEST = 6
"""Fewest draws with a response; with fewer, the recordings cannot show the effect."""

SILENT = 1e-7
"""A response below this part of the baseline force counts as none."""


@dataclass(frozen=True)
class Signature:
    """The signature of one candidate, in units of the noise.

    mean (m,) and basis (m, r): of the drawn responses, divided by their size; signed: whether the size may be negative
    curves (k, m): drawn responses of size 1, to seven digits; values: of their parameters; sizes (k,); none of the law
    """

    name: str
    mean: FloatArray
    basis: FloatArray
    signed: bool
    curves: NDArray[np.floating]
    values: tuple[tuple[float, ...], ...]
    sizes: FloatArray

    @property
    def silent(self) -> bool:
        """Whether the effect had no response on these recordings."""
        return self.name != LAW and not self.sizes.size

    @property
    def columns(self) -> FloatArray:
        """Mean and basis in one matrix (m, 1 + r)."""
        return np.column_stack([self.mean, self.basis])


def size_of(curve: FloatArray) -> float:
    """Return the root mean square of a response."""
    return float(np.sqrt(np.mean(curve**2)))


PARTS, BLOCKS_OF_PART = 5 * HEIGHTS, 8
"""Most parts of the deflection's span, five between two heights of a law, in which a function of the deflection is
straight; and the mean number of blocks of one at least, four for each number of a straight line."""


def single_valued(signatures: Sequence[Signature], dataset: Dataset) -> frozenset[str]:
    """Return the effects that are functions of deflection and surface on this motion, as a law is: friction without a
    reversal, for instance.

    Of most drawn responses the standard deviation about a straight line in each part of the deflection, surface by
    surface (see `surface_numbers`), is below the form error.
    """
    many = dataset.experiments
    x, radius = (dataset.gathered([getattr(e, c) for e in many]) for c in ("deflection", "surface_radius"))
    (surface,) = surface_numbers([radius])
    parts = max(min(PARTS, x.size // (BLOCKS_OF_PART * (int(surface.max()) + 1))), 1)
    place = np.minimum(parts * (x - x.min()) / max(float(np.ptp(x)), 1e-300), parts - 1).astype(int)
    part = surface * parts + place
    return _mostly_below_form_error(signatures, dataset, lambda force: _beside_lines(force, x, part))


def constant(signatures: Sequence[Signature], dataset: Dataset) -> frozenset[str]:
    """Return the effects that are one force on this motion, as a preload is: of most drawn responses the standard
    deviation is below the form error.
    """
    return _mostly_below_form_error(signatures, dataset, lambda force: float(np.std(force)))


def _mostly_below_form_error(
    signatures: Sequence[Signature], dataset: Dataset, apart: Callable[[FloatArray], float]
) -> frozenset[str]:
    """Return the effects of which most drawn responses [N] are `apart` by less than their form error."""
    noise = dataset.gathered([e.noises for e in dataset.experiments])

    def usually(signature: Signature) -> float:
        return float(np.median([apart(f) / max(size_of(f), 1e-300) for f in signature.curves * noise]))

    return frozenset(
        s.name for s in signatures if s.name != LAW and not s.silent and usually(s) < form_error(s.name)
    )


def _beside_lines(values: FloatArray, x: FloatArray, part: NDArray[np.intp]) -> float:
    """Return the standard deviation of values (m,) about the line over x in each part; infinite where all are short."""
    count = np.maximum(np.bincount(part), 1)

    def centred(v: FloatArray) -> FloatArray:
        return np.asarray(v - (np.bincount(part, v) / count)[part])

    over, own = centred(x), centred(values)
    over[np.abs(over) < 1e-9 * np.ptp(x)] = 0.0  # rounding, of a motion that is driven in exact steps
    slope = np.bincount(part, over * own) / np.maximum(np.bincount(part, over**2), 1e-300)
    freedom = int(np.sum(np.maximum(count - 2, 0)))
    beside = float(np.sum((own - slope[part] * over)[count[part] > 2] ** 2))
    return float(np.sqrt(beside / freedom)) if freedom else np.inf


@dataclass(frozen=True)
class Beside:
    """The tire to which an effect is added, its response (m,) and its residual (m,), in units of the noise."""

    tire: TireModel
    response: FloatArray
    residual: FloatArray


def baseline_of(dataset: Dataset) -> Beside:
    """Return the baseline tire, of which the residual is the misfit."""
    return Beside(dataset.tire, np.zeros_like(dataset.misfit), dataset.misfit)


def signature_of(name: str, dataset: Dataset, beside: Beside | None = None) -> Signature:
    """Return the signature of an effect, silent where it has no response on these recordings.

    beside: the tire to which it is added, by default the baseline; it must not have the effect
    """
    beside = baseline_of(dataset) if beside is None else beside
    effect = CATALOGUE[name]
    sets, shares = drawn(effect, dataset.scales, DRAWS)
    force = dataset.load
    misfit = size_of(beside.residual)
    curves: list[FloatArray] = []
    values: list[tuple[float, ...]] = []
    sizes: list[float] = []
    for chosen, share in zip(sets, shares, strict=True):
        wanted = min(misfit * LEAST_DRAWN ** (1.0 - share), MOST_OF_LOAD * force)
        curve, scaled = _sized(effect, chosen, dataset, beside, wanted)
        size = size_of(curve) if curve.size else 0.0
        if not SILENT * force < size < OVERSIZED * max(misfit, wanted):
            continue
        sign = -1.0 if effect.signed and strength_of(effect, scaled) < 0.0 else 1.0
        curves.append(sign * curve / size)
        values.append(tuple(scaled))
        sizes.append(sign * size)
    if len(curves) < FEWEST:
        count = dataset.misfit.size
        nothing = np.zeros((count, 0))
        return Signature(name, np.zeros(count), nothing, effect.signed, nothing.T, (), np.zeros(0))
    whole = np.array(curves)
    mean = whole.mean(axis=0)
    kept = whole.astype(np.float32)
    return Signature(name, mean, _basis(whole - mean), effect.signed, kept, tuple(values), np.array(sizes))


def signatures_of(names: Sequence[str], dataset: Dataset) -> tuple[Signature, ...]:
    """Return the signatures of the effects."""
    return tuple(signature_of(name, dataset) for name in names)


def drawn_beside(signature: Signature, dataset: Dataset, beside: Beside) -> Signature:
    """Return the signature beside another tire: the same one where most draws have the same response (ALIKE)."""
    if signature.silent or likeness(signature, dataset, beside) < ALIKE:
        return signature_of(signature.name, dataset, beside)
    return signature


def likeness(signature: Signature, dataset: Dataset, beside: Beside) -> float:
    """Return the median cosine between drawn responses of an effect and those of the same parameters beside another
    tire, or in other readings of the same motion.
    """
    cosines = []
    for k in range(0, len(signature.values), DRAWS // PROBED):
        tire = arranged(beside.tire, [(signature.name, signature.values[k])])
        curve = dataset.response(tire) - beside.response
        size = size_of(curve) * np.sign(signature.sizes[k])
        cosines.append(np.mean(curve * signature.curves[k]) / size if size else 0.0)
    found = float(np.median(cosines))
    return 1.0 if np.isnan(found) else found


def _sized(
    effect: Effect, values: list[float], dataset: Dataset, beside: Beside, wanted: float
) -> tuple[FloatArray, list[float]]:
    """Return a response near the wanted size, and its parameters; an empty response where it is not finite."""
    adjustable = any(p.role == "strength" for p in effect.parameters)
    for _ in range(3):
        tried = values
        curve = dataset.response(arranged(beside.tire, [(effect.name, tuple(values))])) - beside.response
        size = size_of(curve)
        if not np.isfinite(size):
            return np.zeros(0), values
        if not adjustable or size <= 0.0 or 1.0 / SIZED < size / wanted < SIZED:
            break
        values = strengthened(effect, tried, wanted / size)
    return curve, tried


def _basis(deviations: FloatArray) -> FloatArray:
    gram = deviations @ deviations.T
    powers, vectors = np.linalg.eigh(gram)
    order = np.argsort(powers)[::-1]
    powers, vectors = np.maximum(powers[order], 0.0), vectors[:, order]
    if powers.sum() <= 1e-6 * deviations.size:
        return np.zeros((deviations.shape[1], 0))
    needed = int(np.searchsorted(np.cumsum(powers) / powers.sum(), ENERGY) + 1)
    kept = min(COLUMNS, needed, deviations.shape[0] - 2)
    return np.asarray(deviations.T @ vectors[:, :kept] / np.sqrt(deviations.shape[0]))


def in_other_noise(signature: Signature, before: Dataset, after: Dataset) -> Signature:
    """Return a signature in units of the noise of another dataset of the same recordings."""
    pairs = zip(before.experiments, after.experiments, strict=True)
    factor = np.concatenate([(b.noises / a.noises)[b.counts] for b, a in pairs])
    curves = signature.curves * factor
    sizes = np.sqrt(np.mean(curves**2, axis=1)) if len(curves) else np.ones(0)
    unit = float(sizes.mean()) if sizes.size else float(np.sqrt(np.mean(factor**2)))
    return Signature(
        signature.name,
        signature.mean * factor / unit,
        signature.basis * factor[:, None] / unit,
        signature.signed,
        (curves / sizes[:, None]).astype(np.float32) if sizes.size else curves,
        signature.values,
        signature.sizes * sizes,
    )
