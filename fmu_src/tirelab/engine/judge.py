"""Whether a set of explanations is believed: its evidence with the price of each, its signs, and what is material."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace

import numpy as np

from ..preprocessing.kinematics import IndexArray
from .columns import Layout
from .evidence import Explained, Products, explain
from .families import STATIC, Family

EFFECT_PRIOR = -4.0
"""Log prior odds of one more effect: one in fifty, the choice among fifteen and one in three that there is one more."""

OFFSET_PRIOR = -3.0
"""The same for a zero that is off: every rig has two of them, and none is ever exact."""

LAW_PRIOR = -1.0
"""Log prior odds that the believed law is another tire's: the article's own is wrong by up to 13.5 %."""

AGNOSTIC_PRIOR = -9.0
"""Log prior odds that something beyond the catalogue acts in one given coordinate: one in eight thousand."""

STANDING_PRIOR = -6.0
"""The same where a line or a span has been seen to stand out, once in a hundred recordings of noise."""

HIDDEN_PRIOR = -7.0
"""Log prior odds of an effect of the deflection alone beside a law whose shape is free: it explains what that can."""

MATERIAL = 0.1
"""An effect that nothing else in its set can stand for, to less than this many noises, changes the RMSE by half a
percent, sqrt(1 + 0.1^2): it is not named, whatever its significance (but may be a rival). It is twice the error of form
that every family may have (`diagnosis.LEAST_ERROR`)."""

MATERIAL_UNKNOWN = 0.2
"""The same for what is beyond the catalogue: its columns, up to twenty-six without a form of their own, also follow
what the measure of the noise's colour is off by."""

MATERIAL_CONFINED = 0.05
"""The same for what acts in a few percent of the samples: there it is several times as large."""

CONFINED_FORM = 0.4
"""Part of another effect's error of form that may lie where a confined one acts: the root of a sixth of the samples."""

OWN = 0.1
"""Part of a confined effect that nothing else can stand for, at least: else it bends what the others do everywhere."""

CONFINED = ("bottoming", "saturation")

SPAN, SPAN_COLUMNS = "span", 2
"""What acts within spans of time: an offset and a part of the force in each."""

MATERIAL_SPAN = 0.8
"""The same for it, inside the spans: slow noise of half the noise's power, 0.7, wanders off by as much for a while."""

LAW = ("recalibration", "shape")

MATERIAL_OFFSET = 0.08
"""The same for an offset beside a free law: that law imitates all of it but its sharp end where the tire lifts off."""

OFFSETS = ("deflection_offset", "force_offset")

MATERIAL_SLOW = 0.7
"""The same for what slow noise and hum of the amplifier look like, as they are and not whitened: up to half the noise's
power, sqrt(1/2), they are noise."""

FORM_ERROR = 0.03
"""What a family may miss of its own effect, as a part of it: a second one smaller than that is not believed."""

UNKNOWN_FORM = 0.1
"""The same beside or of what is beyond the catalogue: its form is anybody's, and a form that a known effect misses is
no unknown one."""

FEW_VARIANTS = 8
"""Up to so many variants of a family are compared as wholes, more by what their leading columns explain."""


SetName = tuple[str, ...]


@dataclass(frozen=True)
class Candidate:
    """A set of families with its evidence; groups are the columns in use.

    likely: its log evidence, material or not; log_evidence: the same, nothing (-inf) where a part of it is not material
    """

    names: SetName
    log_evidence: float
    likely: float
    groups: tuple[IndexArray, ...]
    explained: Explained


def judge(p: Products, layout: Layout, names: SetName, zeta: float) -> Candidate:
    """Return the candidate of the families `names`: best variants, evidence with priors, signs checked."""
    choice = {n: layout.variants[n][0] for n in names}
    many = [n for n in names if len(layout.variants[n]) > 1]
    static = [n for n in names if n in STATIC]
    prior = sum(prior_of(layout.families[n], "recalibration" in names or n in static[1:]) for n in names)
    for turn in range(2 if len(many) > 1 else 1):
        for n in many:
            others = [choice[m] for m in names if m != n and (turn or m not in many[many.index(n) :])]
            choice[n] = _best_variant(p, layout, others, n)
    prior -= sum(float(np.log(len(layout.variants[n]))) for n in many)
    groups = tuple(choice[n] for n in names)
    explained = explain(p, groups, zeta)
    if "force_lag" in names and not _lag_is_one(names, groups, explained):
        number = names.index("force_lag")
        groups = tuple(g[:1] if i == number else g for i, g in enumerate(groups))
        explained = explain(p, groups, zeta)
    if RELAXATION in names:
        groups, explained = _above_nothing(p, groups, explained, names.index(RELAXATION), zeta)
    evidence = explained.log_evidence + prior
    held = _signs_hold(p, layout, names, groups, explained) and not _cancel(p, names, groups, explained)
    if not np.isfinite(evidence) or not held:
        evidence = -np.inf
    believed = -np.inf if _negligible(p, layout, names, groups, explained) else evidence
    return Candidate(names, believed, evidence, groups, explained)


def power_of(p: Products, name: str, group: IndexArray, zeta: float) -> float:
    """Return the part of the evidence that counts for an effect beside all else: few samples err little by their form.

    Samples count as 1 / (1/n + 1/c) (see `diagnosis.coarsening`), n of them: those in which a confined effect acts.
    """
    if name not in CONFINED:
        return zeta
    worth = zeta * p.samples / max(1.0 - zeta, 1e-12)
    return max(zeta, worth / (worth + float(p.acting[group[0]])))


def beside_all(p: Products, candidate: Candidate, name: str, zeta: float) -> Candidate:
    """Return a set with what one of its effects explains beside all others counted by its own power."""
    number = candidate.names.index(name)
    power = power_of(p, name, candidate.groups[number], zeta)
    more = 0.5 * (power - zeta) * candidate.explained.unique[number] ** 2 * p.samples
    return replace(candidate, log_evidence=candidate.log_evidence + more, likely=candidate.likely + more)


def _lag_is_one(names: SetName, groups: Sequence[IndexArray], explained: Explained) -> bool:
    """Return whether slope and bend of the force belong to one lag: a bend of at most about half its square."""
    number = names.index("force_lag")
    if groups[number].size < 2:
        return True
    slope, bend = explained.coefficients[number]
    return bool(abs(bend) <= 0.6 * slope**2)


def _negligible(
    p: Products, layout: Layout, names: SetName, groups: Sequence[IndexArray], explained: Explained
) -> list[str]:
    """Return the families of a set whose own part is not material, or less than the form of another one may err."""
    found = []
    sizes = dict(zip(names, explained.size, strict=True))
    own = dict(zip(names, explained.unique, strict=True))
    of_law = [i for i, n in enumerate(names) if n in LAW]
    law = explained.together(of_law) if of_law else 0.0
    for name in names:
        if name == "shape":
            continue
        unique = law if name == "recalibration" else own[name]
        slow = layout.families[name].like_noise
        if slow and _as_it_is(p, layout, names, groups, explained, name) < MATERIAL_SLOW:
            found.append(name)
            continue
        beyond = layout.families[name].agnostic
        doubt = max(
            (
                (UNKNOWN_FORM if beyond or layout.families[n].agnostic else FORM_ERROR) * size
                for n, size in sizes.items()
                if n not in (name, *LAW)
            ),
            default=0.0,
        )
        usual = MATERIAL
        if name in CONFINED:
            confined = own[name] >= OWN * sizes[name]
            usual, doubt = MATERIAL_CONFINED, (CONFINED_FORM if confined else 1.0) * doubt
        elif name in OFFSETS and "recalibration" in names:
            usual = MATERIAL_OFFSET
        elif beyond and name != SPAN:
            usual = MATERIAL_UNKNOWN
        elif name == SPAN:
            inside = float(np.sum(p.acting[groups[names.index(name)]])) / SPAN_COLUMNS / p.samples
            usual = max(usual, MATERIAL_SPAN * float(np.sqrt(min(inside, 1.0))))
        if unique < max(usual, doubt):
            found.append(name)
    return found


def _as_it_is(
    p: Products,
    layout: Layout,
    names: SetName,
    groups: Sequence[IndexArray],
    explained: Explained,
    name: str,
) -> float:
    """Return the own part of a slow family over the noise's level: whitened, hardly anything is left of it."""
    number = names.index(name)
    own = groups[number] - layout.start[name]
    values = explained.coefficients[number]
    whole = float(values @ p.plain[name][np.ix_(own, own)] @ values)
    part = explained.unique[number] / max(explained.size[number], 1e-300)
    return min(part, 1.0) * float(np.sqrt(max(whole, 0.0) / p.samples))


def prior_of(family: Family, recalibrated: bool) -> float:
    """Return the log prior odds that a family is in a set; recalibrated: whether the law is free in it."""
    if family.name == "shape":
        return 0.0
    if family.name == "recalibration":
        return LAW_PRIOR
    if family.agnostic:
        return STANDING_PRIOR if family.standing else AGNOSTIC_PRIOR
    if family.name in OFFSETS:
        return OFFSET_PRIOR
    hidden = recalibrated and family.name in STATIC
    return HIDDEN_PRIOR if hidden else EFFECT_PRIOR


def _best_variant(p: Products, layout: Layout, others: Sequence[IndexArray], name: str) -> IndexArray:
    """Return the variant whose leading column explains most on top of the others."""
    variants = layout.variants[name]
    if len(variants) <= FEW_VARIANTS:
        return max(variants, key=lambda v: explain(p, [*others, v], 1.0).log_evidence)
    leads = np.array([v[0] for v in variants])
    moment, square = p.moment[leads], np.diag(p.gram)[leads]
    if others:
        fixed = np.concatenate(others)
        inner = np.linalg.inv(p.gram[np.ix_(fixed, fixed)] + 1e-5 * p.samples * np.eye(fixed.size))
        cross = p.gram[np.ix_(leads, fixed)]
        moment = moment - cross @ (inner @ p.moment[fixed])
        square = square - np.einsum("ij,jk,ik->i", cross, inner, cross)
    gain = moment**2 / np.maximum(square, 1e-5 * p.samples)
    sign = layout.families[name].sign
    if sign:
        gain = np.where(sign * moment > 0.0, gain, 0.0)
    return variants[int(np.argmax(gain))]


WHOLE_SIGN = (
    "rate_independent_hysteresis",
    "viscous_damping",
    "pressure_leak",
    "warm_up",
    "mullins_softening",
)
"""Effects whose columns all have the sign; of others the leading column has it."""

RELAXATION = "viscoelastic_relaxation"


def _signs_hold(
    p: Products, layout: Layout, names: SetName, groups: Sequence[IndexArray], explained: Explained
) -> bool:
    for name, group, coefficients in zip(names, groups, explained.coefficients, strict=True):
        sign = layout.families[name].sign
        if not sign:
            continue
        scale = np.where(np.isfinite(p.scale[group]), p.scale[group], 0.0)
        amounts = coefficients * scale
        if name == RELAXATION:
            if np.any(amounts < 0.0):
                return False
            continue
        lead = group if name in WHOLE_SIGN else group[:1]
        if sign * float(np.sum(p.gram[np.ix_(lead, group)] @ amounts)) < 0.0:
            return False
    return True


CANCEL = 0.5
"""A rim strike and a ceiling that leave less than this part of either between them are a bump: neither's form."""


def _cancel(p: Products, names: SetName, groups: Sequence[IndexArray], explained: Explained) -> bool:
    """Return whether what acts at one end of the deflection is there for the most part to undo another such."""
    numbers = [i for i, n in enumerate(names) if n in CONFINED]
    if len(numbers) < 2:
        return False
    index = np.concatenate([groups[i] for i in numbers])
    scale = np.where(np.isfinite(p.scale[index]), p.scale[index], 0.0)
    amounts = np.concatenate([explained.coefficients[i] for i in numbers]) * scale
    together = float(np.sqrt(max(amounts @ p.gram[np.ix_(index, index)] @ amounts, 0.0) / p.samples))
    return together < CANCEL * min(explained.size[i] for i in numbers)


def _above_nothing(
    p: Products, groups: tuple[IndexArray, ...], explained: Explained, number: int, zeta: float
) -> tuple[tuple[IndexArray, ...], Explained]:
    """Return a set explained anew without the columns of one family whose amounts are below nothing."""
    while groups[number].size > 1 and np.any(explained.coefficients[number] < 0.0):
        kept = explained.coefficients[number] > 0.0
        if not kept.any():
            break
        groups = tuple(g[kept] if i == number else g for i, g in enumerate(groups))
        explained = explain(p, groups, zeta)
    return groups, explained


def law_whole(names: Iterable[str]) -> SetName:
    """Return the set in order, with the law's shape beside its coefficients and never alone."""
    distinct = set(names) - {"shape"}
    return tuple(sorted(distinct | {"shape"} if "recalibration" in distinct else distinct))


def material(p: Products, candidate: Candidate, layout: Layout) -> SetName:
    """Return the set without the families that are not material in it."""
    negligible = _negligible(p, layout, candidate.names, candidate.groups, candidate.explained)
    return law_whole(n for n in candidate.names if n not in negligible)
