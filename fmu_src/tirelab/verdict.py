"""What we can and cannot say: the effects found, how sure, what else it could be and why, what stays unexplained."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np
from radialtire import TireModel

from .explain.beyond import AGNOSTIC_FAMILIES
from .explain.judge import MATERIAL
from .explain.motion import FloatArray
from .explain.scene import Scene
from .explain.search import Settled
from .locate import Span
from .separate import SeparatingTest
from .titles import UNKNOWN

BEYOND = frozenset(f.name for f in AGNOSTIC_FAMILIES)

DECIDABLE = 6.0
"""Sets within this log evidence of the best one are rivals: odds of 400 to 1, by evidence that is itself uncertain by
the form of the effects."""

MOST_RIVALS = 4

FORM_DOUBT = 0.5
"""Power to which odds between sets are taken: the forms of two sets err independently, each as allowed for."""

SUREST = 0.9
"""No verdict is surer than this: of 89 verdicts that nothing rivalled, on 140 trials of the independent rig, 81 were
right (`concealed` seeds 6400 to 6539)."""


@dataclass(frozen=True)
class Estimate:
    """A parameter's value with its standard deviation and unit."""

    value: float
    std: float
    unit: str


@dataclass(frozen=True)
class NamedEffect:
    """An effect that was left out: its parameters, and the share of the squared misfit that it accounts for."""

    name: str
    parameters: Mapping[str, Estimate]
    share: float


@dataclass(frozen=True)
class Rival:
    """Another set of effects that the recordings cannot rule out: log evidence below the verdict's, and why."""

    names: tuple[str, ...]
    log_odds: float
    reason: str


@dataclass(frozen=True)
class Evidence:
    """One set that was compared: log evidence over that of the verdict, chi square per sample, effects' sizes.

    size, unique: root mean square of each effect's part, and of what no other one in the set can stand for, over the
    noise
    """

    names: tuple[str, ...]
    log_evidence: float
    chi_square: float
    size: tuple[float, ...]
    unique: tuple[float, ...]


@dataclass(frozen=True)
class Correction:
    """What was learned of something beyond the catalogue: force [N] over one coordinate, and that it repeats.

    by: coordinate; at: its values in `unit`; force [N]; repeats: part of the misfit on blocks of time held out that the
    correction learned on the others explains, negative where it does not repeat
    after, held_out_after: RMSE [N] of the corrected tire with the force added, on what was fitted and what was not
    """

    by: str
    unit: str
    at: FloatArray = field(repr=False)
    force: FloatArray = field(repr=False)
    repeats: float = 0.0
    after: float = float("nan")
    held_out_after: float = float("nan")

    def to_contract(self) -> dict[str, object]:
        """Return an entry of `corrections` in diagnosis.json; the curve itself is in the report."""
        return {
            "by": self.by,
            "unit": self.unit,
            "repeats": self.repeats,
            "after": _number(self.after),
            "held_out_after": _number(self.held_out_after),
        }


@dataclass(frozen=True)
class Fit:
    """Noise and root mean square errors [N]; held_out_by: what was held out (see `held_out.HeldOut`)."""

    noise: float
    before: float
    after: float
    held_out_before: float
    held_out_after: float
    held_out_by: str


@dataclass(frozen=True)
class Verdict:
    """The answer of a diagnosis.

    effects: what is missing, empty where nothing is; confidence: 0 to 1; rivals: other sets, likeliest first
    unexplained: whether something acts that no effect explains, by `unexplained_by` (coordinates)
    summary: sentences for a reader; where: places of the misfit before the correction, of what the corrected law leaves
    of it where other effects are missing too; tire: the corrected one
    evidence: all sets that were compared to the end; separating_test: what would tell a rival apart, None where no
    motion within the rig's limits does (the summary then says so)
    compared: number of sets compared; evaluations: simulations of whole recordings in the final fit
    """

    effects: tuple[NamedEffect, ...]
    confidence: float
    rivals: tuple[Rival, ...]
    unexplained: bool
    unexplained_by: tuple[str, ...]
    corrections: tuple[Correction, ...]
    summary: str
    where: tuple[Span, ...]
    fit: Fit
    tire: TireModel
    evidence: tuple[Evidence, ...]
    separating_test: SeparatingTest | None
    compared: int
    evaluations: int

    @property
    def names(self) -> tuple[str, ...]:
        """Names of the effects, with "unknown" where something stays unexplained."""
        return (*(e.name for e in self.effects), *((UNKNOWN,) if self.unexplained else ()))

    def to_contract(self) -> dict[str, object]:
        """Return the content of diagnosis.json but for the names of the files beside it.

        What was learned of something unknown is told under "corrections", which is absent where nothing is unknown.
        """
        learned = {"corrections": [c.to_contract() for c in self.corrections]} if self.corrections else {}
        return {
            "schema": 1,
            "verdict": {
                "effects": [
                    {
                        "name": e.name,
                        "parameters": {
                            p: {"value": v.value, "std": v.std, "unit": v.unit}
                            for p, v in e.parameters.items()
                        },
                        "share": e.share,
                    }
                    for e in self.effects
                ],
                "confidence": self.confidence,
                "alternatives": [list(r.names) for r in self.rivals],
                "unexplained": self.unexplained,
                "summary": self.summary,
                "separating_test": None
                if self.separating_test is None
                else self.separating_test.to_contract(),
                **learned,
            },
            "where": [s.to_contract() for s in self.where],
            "fit": {
                "noise": self.fit.noise,
                "before": self.fit.before,
                "after": self.fit.after,
                "held_out_before": _number(self.fit.held_out_before),
                "held_out_after": _number(self.fit.held_out_after),
                "held_out_by": self.fit.held_out_by,
            },
        }


def _number(value: float) -> float | None:
    return float(value) if np.isfinite(value) else None


STATIC = frozenset(
    {"deflection_offset", "series_compliance", "gas_compression", "recalibration", "bottoming", "saturation"}
)

CONCERNS: tuple[tuple[frozenset[str], frozenset[str]], ...] = (
    (
        frozenset({"deflection", "direction"}),
        frozenset(
            {
                "recalibration",
                "deflection_offset",
                "series_compliance",
                "gas_compression",
                "bottoming",
                "saturation",
            }
        ),
    ),
    (
        frozenset({"time", "time, added", "jump", "period", "period, added"}),
        frozenset({"pressure_leak", "warm_up", "force_drift", "mullins_softening"}),
    ),
    # Whatever changes with time has a mean, which is a factor or an offset.
    (frozenset({"time", "jump"}), frozenset({"recalibration"})),
    (frozenset({"time, added"}), frozenset({"force_offset"})),
    (
        frozenset({"rate", "rate and deflection", "acceleration", "resonance"}),
        frozenset({"viscous_damping", "viscoelastic_relaxation", "force_lag", "inertia"}),
    ),
)
"""Coordinates, and the effects that are told by them: where one stays unexplained, its effects cannot be named."""


SHADOW = 0.5
"""Beside something unknown an effect is named where its own part is at least this part of the unknown one: a smaller
one may be the unknown's shadow, which smooth functions alone do not follow."""


def named(settled: Settled) -> tuple[str, ...]:
    """Return the names of a settled set as a verdict gives them: none that may come from what stays unexplained."""
    beyond = BEYOND & set(settled.names)
    if not beyond:
        return tuple(n for n in settled.names if n != "shape")
    explained = settled.candidate.explained
    doubtful = beyond | {n for coordinates, effects in CONCERNS if coordinates & beyond for n in effects}
    unknown = max(s for n, s in zip(settled.names, explained.size, strict=True) if n in doubtful)
    known = [
        n
        for n, own in zip(settled.names, explained.unique, strict=True)
        if n not in doubtful and n != "shape" and own >= SHADOW * unknown
    ]
    return (*known, UNKNOWN)


def confidence_of(settled: Sequence[Settled]) -> float:
    """Return the probability of the first set's names among all sets that were settled."""
    logs = np.array([s.log_evidence for s in settled])
    weights = np.exp(FORM_DOUBT * (np.where(np.isfinite(logs), logs, -np.inf) - logs[0]))
    same = np.array([named(s) == named(settled[0]) for s in settled])
    return SUREST * float(np.sum(weights[same]) / np.sum(weights))


def rivals_of(settled: Sequence[Settled], scene: Scene) -> tuple[Rival, ...]:
    """Return the sets of other names within DECIDABLE of the first one, and those that one rate cannot rule out."""
    best = settled[0]
    found: dict[tuple[str, ...], float] = {}
    for s in settled[1:]:
        gap = best.log_evidence - s.log_evidence
        if not np.isfinite(gap) or _adds_nothing(s, best):
            continue
        if gap < DECIDABLE and named(s) != named(best) and named(s) not in found:
            found[named(s)] = gap
    for names in one_rate_rivals(named(best), scene):
        found.setdefault(names, DECIDABLE)
    for names, gap in static_rivals(settled):
        found.setdefault(names, gap)
    order = sorted(found.items(), key=lambda item: item[1])[:MOST_RIVALS]
    return tuple(Rival(names, gap, reason_of(named(best), names, scene)) for names, gap in order)


HIDING = ("series_compliance", "gas_compression")
"""What a law that is free on every surface can stand for, at one pressure and on one rig."""

SHAPE_DOUBT = 30.0
"""Sets that differ in functions of deflection and surface alone are rivals within this log evidence: each has a form of
its own for what the law's shape, itself wrong by up to 13.5 %, may be."""


def static_rivals(settled: Sequence[Settled]) -> list[tuple[tuple[str, ...], float]]:
    """Return the sets with another function of deflection and surface in the place of the first one's, and their gap.

    Beside a free law a compliance or the air's compression can always be there, unseen.
    """
    best = settled[0]
    names = named(best)
    statics = {"recalibration", *HIDING} & set(names)
    if not statics or UNKNOWN in names:
        return []
    rest = set(names) - statics
    found = []
    for s in settled[1:]:
        gap = best.log_evidence - s.log_evidence
        others = set(named(s))
        if gap < SHAPE_DOUBT and others != set(names) and others - {"recalibration", *HIDING} == rest:
            found.append((named(s), gap))
    if "recalibration" in names:
        found += [(tuple(sorted({*names, h})), DECIDABLE) for h in HIDING if h not in names]
    return found


def _adds_nothing(settled: Settled, best: Settled) -> bool:
    """Return whether a set is the best one with something beside it that is not material."""
    more = set(named(settled)) - set(named(best))
    if not more or not set(named(best)) < set(named(settled)):
        return False
    own = dict(zip(settled.names, settled.candidate.explained.unique, strict=True))
    law = (
        settled.candidate.explained.together(
            [i for i, n in enumerate(settled.names) if n in ("recalibration", "shape")]
        )
        if "recalibration" in settled.names
        else 0.0
    )
    return all((law if n == "recalibration" else own.get(n, 1.0)) < MATERIAL for n in more)


LOOPS = ("rate_independent_hysteresis", "viscous_damping", "viscoelastic_relaxation", "force_lag")
"""What makes a loop; at one constant rate on one surface any one of them can be the cause."""

SAME_RATE = 0.06
"""Rates within this part of their median count as one."""

AT_CORNERS = 0.12
"""Part of the samples that may stand at the corners of a triangle, where the rate is on its way."""


def one_constant_rate(scene: Scene) -> bool:
    """Return whether all recordings run at one rate up and down on one surface."""
    if len(scene.radii) > 1:
        return False
    # Steps of the smoothed deflection: its derivative rings around corners.
    rates = np.abs(np.concatenate([np.diff(r.motion.deflection) / np.diff(r.time) for r in scene.records]))
    middle = float(np.median(rates))
    return middle > 0.0 and float(np.mean(np.abs(rates / middle - 1.0) > SAME_RATE)) < AT_CORNERS


def one_rate_rivals(names: tuple[str, ...], scene: Scene) -> list[tuple[str, ...]]:
    """Return the sets in which another loop takes the place of the only one, where one rate cannot tell."""
    loops = [n for n in names if n in LOOPS]
    if len(loops) != 1 or not one_constant_rate(scene):
        return []
    return [tuple(sorted({*names, other} - set(loops))) for other in LOOPS if other != loops[0]]


def poverty(scene: Scene) -> list[str]:
    """Return what the recordings lack that tells effects apart."""
    lacks = []
    if one_constant_rate(scene):
        lacks.append("there is one constant rate only")
    if len(scene.radii) == 1:
        lacks.append("there is one surface only")
    rates = [np.abs(r.motion.rate) for r in scene.records]
    typical = max(float(np.sqrt(np.mean(r**2))) for r in rates)
    held = max(_longest_rest(r.time, np.abs(r.motion.rate) < 0.02 * typical) for r in scene.records)
    if held < 1.0:
        lacks.append("nothing is held still for a second")
    if max(float(r.motion.cycle.max()) for r in scene.records) < 1.0:
        lacks.append("no cycle is repeated")
    return lacks


def _longest_rest(time: FloatArray, still: np.ndarray) -> float:
    ends = np.flatnonzero(np.diff(np.concatenate([[0], still.astype(int), [0]])))
    return max(
        (float(time[b - 1] - time[a]) for a, b in zip(ends[::2], ends[1::2], strict=True)), default=0.0
    )


SLOW = frozenset({"pressure_leak", "warm_up", "mullins_softening", "force_drift"})


def reason_of(names: tuple[str, ...], other: tuple[str, ...], scene: Scene) -> str:
    """Return why the recordings cannot tell two sets apart, in a clause."""
    apart = set(names) ^ set(other)
    lacks = poverty(scene)
    if apart <= STATIC:
        return "all of them are functions of deflection and surface alone, at one pressure and stiffness of the rig"
    if apart <= set(LOOPS):
        told = [x for x in lacks if "surface" not in x]
        return " and ".join(told) if told else "their loops are alike at the rates driven"
    if apart <= SLOW:
        return "all of them change slowly with time, and no cycle from the beginning comes again after a rest"
    if UNKNOWN in apart:
        return "a smooth function of the coordinates follows the misfit as well"
    return " and ".join(lacks) if lacks else "the difference is smaller than these recordings can show"
