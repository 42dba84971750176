"""The chosen explanation as a tire: parameters of the catalogue's own effects fitted through the simulation itself.

The search speaks in columns. Here each effect's part is first matched by its catalogue form alone, then all parameters
are fitted together on whitened residuals, with the changes of the law's coefficients on each measured surface.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from radialtire import CATALOGUE, Effect, Parameter, Recalibrated, State, TireModel
from radialtire.effect import PLACES
from scipy.optimize import least_squares

from ..preprocessing.kinematics import FloatArray, IndexArray
from ..preprocessing.noise_model import Noise
from ..simulation.simulate import Sampled, SmoothedMotion, simulate
from .starts import matched, spread, with_effect

LOOSE = 100.0
"""Standard deviation of the weak prior on a parameter, in its scale: it only holds what no sample moves."""

SPIKED = 3.0
"""Residuals beyond so many noises count by their size, not its square."""

MOST_ROUNDS = 40
STEP = 1e-4
"""Step of the difference quotients, as a part of a parameter's scale."""

HARDLY = 0.1
"""Part of a parameter's price: what gains less than it is held before the rest is asked for the whole price."""

DETERMINED = 0.25
"""An extra freedom is determined where its standard deviation is below this part of its prior's, that of a value
anywhere within its bounds."""

RELAXATION = "viscoelastic_relaxation"

OF_RATE = ("rate_exponent", "thinning")
"""Parameters that say how a force changes with the rate: at one rate they are not determined, whatever the short
reversals would have them be."""

TIMED = (RELAXATION, "viscous_damping", "force_lag", "deflection_lag", "warm_up", "pressure_leak")
"""Effects of the time: what is not determined of them may go far astray in a test that is driven at another rate."""

OF_READING = {"play": 4.0}
"""Parameters that are not fitted but follow from the noise of the deflection's reading, as multiples of it."""


@dataclass(frozen=True)
class Case:
    """One recording with its noise, the samples that are compared, and what of their force is not to be followed.

    smooth: the recording with the noise of its deflection taken out, to which parameters are fitted, and its motion
    """

    recording: Sampled
    smooth: SmoothedMotion
    force: FloatArray
    noise: Noise
    rows: IndexArray
    beyond: FloatArray


@dataclass(frozen=True)
class Knob:
    """One number that is fitted: the effect or "law" it belongs to, its index there, scale, bounds and start."""

    owner: str
    index: int
    label: str
    unit: str
    scale: float
    low: float
    high: float


@dataclass(frozen=True)
class Refit:
    """A fitted tire: values and standard deviations of its knobs, what it leaves of each recording [N].

    jacobian: of the whitened residuals over the scaled knobs; cost: half the sum of their squares, spikes counted less
    """

    tire: TireModel
    knobs: tuple[Knob, ...]
    values: FloatArray
    deviations: FloatArray
    residuals: tuple[FloatArray, ...]
    jacobian: FloatArray
    cost: float
    evaluations: int


def assemble(
    believed: TireModel, knobs: Sequence[Knob], values: FloatArray, radii: Sequence[float]
) -> TireModel:
    """Return the believed tire with the knobs' values: effects in catalogue order, the law changed on `radii` [m]."""
    chosen: dict[str, list[float]] = {}
    law = np.zeros((len(radii), 2))
    changed = False
    for knob, value in zip(knobs, values, strict=True):
        bounded = float(min(max(value, knob.low), knob.high))
        if knob.owner == "law":
            law[knob.index // 2, knob.index % 2] = bounded
            changed = True
        else:
            effect = CATALOGUE[knob.owner]
            chosen.setdefault(knob.owner, [_before(p, believed.reading_noise) for p in effect.parameters])[
                knob.index
            ] = bounded
    effects = {e.name: (e, v) for e, v in believed.effects} | {
        name: (CATALOGUE[name], tuple(v)) for name, v in chosen.items()
    }
    order = sorted(
        effects.values(), key=lambda e: (PLACES.index(e[0].place), list(CATALOGUE).index(e[0].name))
    )
    new_law = believed.law
    if changed:
        rows = tuple((float(r), float(a), float(b)) for r, (a, b) in zip(radii, law, strict=True))
        new_law = Recalibrated(believed.law, rows)
    return replace(believed, law=new_law, effects=tuple(order))


def _before(parameter: Parameter, reading_noise: float) -> float:
    """Return a parameter's value before it is fitted."""
    if parameter.name in OF_READING:
        return min(OF_READING[parameter.name] * reading_noise, parameter.maximum)
    return parameter.start if parameter.optional else parameter.nominal_value


def knobs_of(names: Sequence[str], radii: Sequence[float], extras: bool, deepest: float) -> tuple[Knob, ...]:
    """Return what is fitted for the effects `names` and, with "recalibration", the law on `radii` [m]."""
    knobs: list[Knob] = []
    for name in names:
        if name == "recalibration":
            for i, radius in enumerate(radii):
                where = "flat" if np.isinf(radius) else f"{100.0 * radius:.4g} cm"
                knobs.append(Knob("law", 2 * i, f"log factor on A, {where}", "1", 0.05, -3.0, 3.0))
                knobs.append(Knob("law", 2 * i + 1, f"change of B, {where}", "1", 0.02, -1.0, 1.0))
            shape = CATALOGUE["elastic_shape"]
            knobs += [_knob(shape, 0, 0.02), _knob(shape, 1, 0.02)]
            continue
        effect = CATALOGUE[name]
        for index, parameter in enumerate(effect.parameters):
            if parameter.name in OF_READING or (parameter.optional and not extras):
                continue
            knobs.append(_knob(effect, index, _scale(parameter)))
    return tuple(knobs)


def _knob(effect: Effect, index: int, scale: float) -> Knob:
    p = effect.parameters[index]
    return Knob(effect.name, index, p.name, p.unit, scale, p.minimum, p.maximum)


def _scale(parameter: Parameter) -> float:
    if parameter.name == "limit":
        return 100.0
    everyday = abs(parameter.nominal_value)
    return everyday if everyday > 0.0 else min(0.3, 0.1 * (parameter.maximum - parameter.minimum))


def refit(
    believed: TireModel,
    names: Sequence[str],
    parts: dict[str, list[FloatArray]],
    law: FloatArray,
    cases: Sequence[Case],
    radii: Sequence[float],
    deepest: float,
    highest: float,
    power: float = 1.0,
    one_rate: bool = False,
) -> Refit:
    """Return the believed tire with the effects `names` fitted to the cases.

    parts: what each effect adds in the search [N], at the rows of each case; law (surfaces, 2): guess of the law's
    changes on `radii` [m]; deepest [m], highest [N]: largest deflection and reading; power: part of the evidence
    that counts (see `explain.evidence`); one_rate: whether all cases are driven at one rate
    """
    law_knobs = [k for k in knobs_of(names, radii, False, deepest) if k.owner == "law"]
    tire = assemble(believed, law_knobs, law.ravel()[: len(law_knobs)], radii)
    starts: dict[str, State] = {}
    terms: dict[str, float] = {}
    for name in names:
        if name == RELAXATION:
            terms = spread(parts[name], cases, tire)
        if name != "recalibration":
            starts[name] = matched(CATALOGUE[name], parts[name], cases, tire, deepest, highest)
            tire = with_effect(tire, CATALOGUE[name], starts[name])
    knobs = tuple(k for k in knobs_of(names, radii, True, deepest) if not (one_rate and k.label in OF_RATE))
    plain = tuple(k for k in knobs if not _extra(k))
    fitted = fit_knobs(believed, plain, np.array([_start(k, starts, law, None) for k in plain]), cases, radii)
    if len(plain) == len(knobs):
        return fitted
    # Freedoms that wake together may end in a valley of their own: first those that begin at no effect, then those of
    # one effect after the other; each gain has to pay.
    evaluations, best = fitted.evaluations, fitted
    for owner in (None, *dict.fromkeys(k.owner for k in knobs if k.label in AWAKE)):
        if owner is None:
            group = tuple(k for k in knobs if k.label not in AWAKE)
        else:
            group = tuple(k for k in knobs if k in best.knobs or (k.owner == owner and _extra(k)))
        if group == best.knobs:
            continue
        start = [terms.get(k.label, _start(k, starts, law, best)) for k in group]
        whole, terms = fit_knobs(believed, group, np.array(start), cases, radii), {}
        whole = _lighter(whole, power, believed, cases, radii)
        evaluations += whole.evaluations
        best = min((best, whole), key=lambda f: _priced(f, power))
    return replace(best, evaluations=evaluations)


def _priced(fitted: Refit, power: float) -> float:
    """Return what a fit leaves with the price of its parameters."""
    return power * fitted.cost + len(fitted.knobs) * price_of(fitted, power)


def _lighter(
    whole: Refit, power: float, believed: TireModel, cases: Sequence[Case], radii: Sequence[float]
) -> Refit:
    """Return the fit without the extra knobs that do not earn their price.

    What hardly gains goes first: the fit may settle elsewhere then, and tells better what the rest is worth. Where the
    fit misses what the quadratic could spare, the more needed half comes back, but for the knobs of TIMED effects.
    """
    evaluations, found = whole.evaluations, list[Refit]()
    for part in (HARDLY, 1.0):
        spare = spare_knobs(whole, power, part)
        while spare:
            left = tuple(k for k in whole.knobs if k not in spare)
            less = fit_knobs(believed, left, np.array([_value(whole, k) for k in left]), cases, radii)
            evaluations += less.evaluations
            missed = [k for k in spare if k.owner not in TIMED]
            if _priced(less, power) <= _priced(whole, power) or not missed:
                whole = less
                break
            spare = tuple(k for k in spare if k not in missed[len(missed) // 2 :])
        found.append(whole)
    return replace(min(found, key=lambda f: _priced(f, power)), evaluations=evaluations)


def again(believed: TireModel, fitted: Refit, cases: Sequence[Case], radii: Sequence[float]) -> Refit:
    """Return the knobs of a fit fitted anew to other cases; the law starts as believed, and stays so where unseen."""
    start = [0.0 if k.owner == "law" else float(v) for k, v in zip(fitted.knobs, fitted.values, strict=True)]
    return fit_knobs(believed, fitted.knobs, np.array(start), cases, radii)


def owners_of(name: str) -> tuple[str, ...]:
    """Return the owners of the knobs that belong to a name of the verdict."""
    return ("law", "elastic_shape") if name == "recalibration" else (name,)


def _extra(knob: Knob) -> bool:
    return knob.owner != "law" and CATALOGUE[knob.owner].parameters[knob.index].optional


def spare_knobs(whole: Refit, power: float, part: float = 1.0) -> tuple[Knob, ...]:
    """Return the extra knobs of a fit that may as well stay at their plain values, the least needed one first.

    Those are held one after the other in the fit's own quadratic. One keeps its freedom where the samples determine it
    (see DETERMINED) and, counted by `power`, the log likelihood gains more than half the logarithm of their number, the
    price of one parameter (Schwarz, Ann. Stat. 6, 1978); part: of that price.
    """
    price = part * price_of(whole, power)
    knobs, spare = list(whole.knobs), list[Knob]()
    scale = np.array([k.scale for k in knobs])
    values = whole.values / scale
    information = whole.jacobian.T @ whole.jacobian + np.eye(len(knobs)) / LOOSE**2
    while True:
        covariance = np.linalg.inv(information)
        needs = [
            _need(k, values[i], float(covariance[i, i]), power, price) if _extra(k) else np.inf
            for i, k in enumerate(knobs)
        ]
        least = int(np.argmin(needs))
        if needs[least] > 1.0:
            return tuple(spare)
        away = _plain(knobs[least]) / knobs[least].scale - values[least]
        values = values + covariance[:, least] / covariance[least, least] * away
        left = [i for i in range(len(knobs)) if i != least]
        information, values = information[np.ix_(left, left)], values[left]
        spare.append(knobs.pop(least))


def price_of(fitted: Refit, power: float) -> float:
    """Return what one more parameter has to gain in log likelihood."""
    return 0.5 * math.log(max(power * fitted.jacobian.shape[0], math.e))


def _need(knob: Knob, value: float, variance: float, power: float, price: float) -> float:
    """Return how much an extra knob is needed, by what its freedom asks for: above 1 it keeps it."""
    away = value - _plain(knob) / knob.scale
    anywhere = (knob.high - knob.low) / knob.scale / np.sqrt(12.0)
    gain = 0.5 * power * away**2 / variance
    return float(min(gain / price, DETERMINED * anywhere / np.sqrt(variance)))


def _value(fitted: Refit, knob: Knob) -> float:
    return float(fitted.values[fitted.knobs.index(knob)])


def _plain(knob: Knob) -> float:
    return CATALOGUE[knob.owner].parameters[knob.index].start


AWAKE = {"gathering": 0.02, "thinning": 30.0, "width": 1e-3, "knee": 10.0, "quality": 0.6}
"""Where a freedom begins that has no slope where it is off: a stroke [m], the inverse of a usual rate [s/m], a length
in the tread [m], a percent of a usual force [N] and a low-pass between Bessel's and Butterworth's."""


def _start(knob: Knob, starts: dict[str, State], law: FloatArray, before: Refit | None) -> float:
    if before is not None:
        for k, v in zip(before.knobs, before.values, strict=True):
            if (k.owner, k.index) == (knob.owner, knob.index):
                return float(v)
    if knob.owner == "law":
        return float(law.ravel()[knob.index])
    if knob.owner in starts and not _extra(knob):
        return float(starts[knob.owner][knob.index])
    return AWAKE.get(knob.label, float(CATALOGUE[knob.owner].parameters[knob.index].start))


def fit_knobs(
    believed: TireModel,
    knobs: tuple[Knob, ...],
    start: FloatArray,
    cases: Sequence[Case],
    radii: Sequence[float],
) -> Refit:
    """Return the knobs fitted to the cases from `start` on."""
    scale = np.array([k.scale for k in knobs])
    low, high = np.array([k.low for k in knobs]) / scale, np.array([k.high for k in knobs]) / scale
    evaluations = 0

    def residual(scaled: FloatArray) -> FloatArray:
        nonlocal evaluations
        evaluations += 1
        tire = assemble(believed, knobs, scaled * scale, radii)
        parts = [
            c.noise.whitened((c.force - simulate(tire, c.smooth, c.smooth))[c.rows] - c.beyond) for c in cases
        ]
        return np.concatenate(parts)

    centre = np.clip(start / scale, low, high)
    if not knobs:
        plain = tuple(c.force - simulate(believed, c.recording) for c in cases)
        left = residual(centre)
        # The same loss as below, of SciPy's least_squares.
        cost = float(np.sum(SPIKED**2 * (np.sqrt(1.0 + (left / SPIKED) ** 2) - 1.0)))
        return Refit(believed, (), np.zeros(0), np.zeros(0), plain, np.zeros((0, 0)), cost, 1)

    def penalised(scaled: FloatArray) -> FloatArray:
        return np.concatenate([residual(scaled), (scaled - centre) / LOOSE])

    def slopes(scaled: FloatArray) -> FloatArray:
        # Steps of the same size everywhere: relative ones are lost in rounding where a parameter is off.
        base = penalised(scaled)
        columns = []
        for i in range(scaled.size):
            aside = scaled.copy()
            aside[i] += STEP if scaled[i] + STEP <= high[i] else -STEP
            columns.append((penalised(aside) - base) / (aside[i] - scaled[i]))
        return np.stack(columns, axis=1)

    inside = np.clip(
        centre, low + 1e-9 * np.maximum(1.0, np.abs(low)), high - 1e-9 * np.maximum(1.0, np.abs(high))
    )
    answer = least_squares(
        penalised,
        inside,
        jac=slopes,
        bounds=(low, high),
        x_scale="jac",
        loss="soft_l1",
        f_scale=SPIKED,
        max_nfev=MOST_ROUNDS,
        method="trf",
    )
    found = np.where(answer.x - low < STEP, low, np.where(high - answer.x < STEP, high, answer.x))
    values = found * scale
    tire = assemble(believed, knobs, values, radii)
    jacobian = slopes(found)[: -len(knobs)]
    total = sum(c.force.size for c in cases)
    information = jacobian.T @ jacobian * total / max(jacobian.shape[0], 1) + np.eye(len(knobs)) / LOOSE**2
    spread = np.sqrt(np.diag(np.linalg.inv(information))) * scale
    residuals = tuple(c.force - simulate(tire, c.recording) for c in cases)
    anywhere = np.array([(k.high - k.low) / np.sqrt(12.0) for k in knobs])
    return Refit(
        tire,
        knobs,
        values,
        np.minimum(spread, anywhere),
        residuals,
        jacobian,
        float(answer.cost),
        evaluations,
    )
