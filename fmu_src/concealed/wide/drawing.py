"""Draw a wide trial: a world, its recordings, and the sets of names that count as right, derived by simulation."""

from dataclasses import asdict, dataclass, replace

import numpy as np

from ..alternatives import Explanations, Names
from ..drawing import (
    BEYOND_CATALOGUE,
    BEYOND_SHARE,
    SAME_TIRE_LOSS,
    VISIBLE,
    Undrawable,
    file_truth,
    regions_of,
    stream,
)
from ..effects import BY_NAME
from ..equivalence import SIGNIFICANCE, TELLING, Equivalent, Hidden, completing, equivalent, linearized
from ..regressors import NAMES
from ..tires import PowerTire
from ..trial import Answer, Parameters, Record, Trial, recorded
from . import press, pressure
from .gauge_drift import DEFLECTION_DRIFT
from .permanent import PERMANENT_SET
from .worlds import WORLDS, World

#: The kinds that are drawn only where they are asked for; their places decide what their seeds mean.
WIDE_KINDS = ("loud", "press", "foreign", "outside", pressure.KIND, "beside", "set", "drift")
#: Those of them of which a proof of all kinds draws in turn; which these are decides what its seeds mean.
IN_TURN = ("loud", "press", "foreign", "outside", "beside")
#: Streams of random numbers of these trials stand apart from those of the other kinds by this key.
STREAM = 1_000_003
ATTEMPTS, PATIENCE = 400, 40
MANY = 1_000_000
#: The family of a foreign form has to explain this part of the misfit (root mean square) in the rig's own forms.
STANDS_FOR = 0.5
#: Where its family leaves more than this part, one more name beside the family may be right too.
COMPLETED = 0.15
REFIT = "recalibration"
#: What a catalogue has a name for and the rig's own forms cannot stand for, and the kinds that hide one of it.
LACKED, LACKING = frozenset({PERMANENT_SET, DEFLECTION_DRIFT}), ("set", "drift")
#: The kinds in which something acts that the rig's own forms cannot stand for, that or what no catalogue holds.
UNKNOWN = ("outside", "beside", *LACKING)


@dataclass(frozen=True)
class WideAnswer(Answer):
    """What is hidden in a wide trial, and how the right sets were derived (see `equivalence`).

    significance: error probability of the best test at which a set counts as right; truth_leaves: part of the misfit
    (root mean square over the noise) that the true names leave in the rig's forms, 0 but for a foreign form;
    sets_fitted, sets_skipped: how many sets were fitted, and how many were not for want of time; attempts: how many
    worlds were drawn until every hidden effect mattered.
    """

    significance: float
    truth_leaves: float
    sets_fitted: int
    sets_skipped: int
    attempts: int


def draw(seed: int, kind: str) -> Trial:
    """Draw one trial of a wide kind from a seed; errors: Undrawable where no world of the seed is fair."""
    if kind == pressure.KIND:
        return pressure.draw(seed)
    number = WIDE_KINDS.index(kind)
    first = int(stream(seed, STREAM, number).integers(MANY))
    for attempt in range(ATTEMPTS):
        rng = stream(seed, STREAM, number, attempt)
        # a form that is seldom fair is tried for long, so that it comes as often as the others
        world = WORLDS[kind](rng, first + attempt // PATIENCE)
        trial = _trial(rng, seed, kind, world, attempt + 1) if world is not None else None
        if trial is not None:
            return trial
    raise Undrawable(f"seed {seed} gave no trial of the kind {kind} in {ATTEMPTS} attempts")


def _trial(rng: np.random.Generator, seed: int, kind: str, world: World, attempts: int) -> Trial | None:
    if kind == "press":
        made = _recordings(rng, world)
        count = len(world.train)
        records = tuple(record for record, _ in made[:count])
        baseline = press.fitted_power_law(records, logarithmic=bool(rng.random() < 0.5))
    else:
        assert world.baseline is not None
        made, baseline = [], world.baseline
    hidden = Hidden.of(
        world.bench, baseline if REFIT in world.names else world.bench.tire, world.train, world.instrument
    )
    linear = linearized(hidden)
    if not _is_fair(kind, world, linear):
        return None
    found = _equivalent(kind, world, hidden, linear)
    leaves = float(np.sqrt(found.truth_leaves / max(found.whole, 1e-12)))
    if kind == "foreign" and leaves > STANDS_FOR:
        return None
    made = made or _recordings(rng, world)
    right = _right(kind, world, linear, found)
    answer = WideAnswer(
        kind=kind,
        effects=_named(world, baseline),
        hidden={e.name: e.parameters() for e in world.bench.effects if not _is_named(e.name)},
        right=right,
        margins={" + ".join(sorted(s)) or "none": round(0.5 * left, 3) for s, left in found.sets.items()},
        rule="the rig's own fits leave no more than the noise can explain" if len(right) > 1 else "",
        sizes=world.sizes,
        where=regions_of(world.bench, world.train),
        noise=world.instrument.noise,
        files={record.name: file_truth(record, baseline, floors) for record, floors in made},
        tire={"form": type(world.bench.tire).__name__, **asdict(world.bench.tire)},
        instrument=asdict(world.instrument),
        significance=SIGNIFICANCE,
        truth_leaves=leaves,
        sets_fitted=found.fitted,
        sets_skipped=found.skipped,
        attempts=attempts,
    )
    records = tuple(record for record, _ in made)
    count = len(world.train)
    return Trial(
        seed,
        records[:count],
        records[count:],
        answer,
        baseline,
        world.source,
        world.instrument.noise,
        world.bench,
        world.instrument,
        world.train,
    )


def _recordings(rng: np.random.Generator, world: World) -> list[tuple[Record, tuple[float, float]]]:
    """All recordings with their noise floors, the training ones first."""
    motions = {f"train_{i}.csv": m for i, m in enumerate(world.train)}
    motions |= {f"heldout_{i}.csv": m for i, m in enumerate(world.heldout)}
    return [recorded(world.bench, world.instrument, m, name, rng) for name, m in motions.items()]


def _is_fair(kind: str, world: World, linear: Explanations) -> bool:
    """Whether every hidden effect matters, and nothing outside the catalogue can be explained by a pair of names.

    A first file is as it is: what does not matter in it need not be named. Beside something unknown no other effect may
    stand for a hidden one.
    """
    if kind == "press":
        return True
    base = set(world.names) - LACKED
    truth = linear.loss(base)
    if kind in UNKNOWN:
        best = linear.best(base, 2)
        # a set or a drift is told from others by little of what it changes
        share = 0.0 if kind in LACKING else BEYOND_SHARE
        if best <= BEYOND_CATALOGUE or best <= share * truth:
            return False
    if kind == "outside":
        return True
    if kind in UNKNOWN and any(linear.loss(s) - truth < VISIBLE for s in _exchanged(base)):
        return False
    return all(linear.loss(base - {name}) - truth >= VISIBLE for name in base)


def _exchanged(base: set[str]) -> list[set[str]]:
    """All sets with another name in place of one of theirs."""
    return [base - {name} | {other} for name in base for other in NAMES if other not in base]


def _equivalent(kind: str, world: World, hidden: Hidden, linear: Explanations) -> Equivalent:
    truth = frozenset(world.names)
    if kind in UNKNOWN:
        return Equivalent({}, 0.0, 2.0 * linear.loss(()), 0, 0)
    # the baseline of a first file is fitted to it: whether its law is refitted too is a matter of taste
    base = frozenset({REFIT}) if kind == "press" else frozenset()
    most = max(len(truth), 2) if kind == "press" else len(truth)
    found = equivalent(hidden, linear, truth, most, base)
    if kind == "foreign" and found.truth_leaves > max(TELLING, COMPLETED**2 * found.whole):
        found = replace(found, sets={**found.sets, **completing(hidden, linear, truth)})
    return found


def _right(kind: str, world: World, linear: Explanations, found: Equivalent) -> tuple[tuple[str, ...], ...]:
    """The sets that count as right, the true one first."""
    truth = frozenset(world.names)
    if kind == "outside":
        sets = [truth | {"unknown"}, frozenset({"unknown"})]
    elif kind == "beside":
        sets = [truth | {"unknown"}, truth - {REFIT} | {"unknown"}]
    elif kind in LACKING:
        sets = [truth]
    elif kind == "press":
        matters = linear.loss(truth - {REFIT}) - linear.loss(truth) >= SAME_TIRE_LOSS
        sets = [truth if matters else truth - {REFIT}]
        sets += [s for names in (truth, *found.sets) for s in (names - {REFIT}, names | {REFIT})]
    else:
        sets = [truth, *found.sets]
    distinct: dict[Names, None] = dict.fromkeys(frozenset(s) for s in sets)
    return tuple(tuple(sorted(s)) or ("none",) for s in distinct)


def _named(world: World, baseline: PowerTire) -> dict[str, Parameters]:
    """Parameters of the effects that have a name in a catalogue; a refitted law has those of its baseline."""
    named: dict[str, Parameters] = {e.name: e.parameters() for e in world.bench.effects if _is_named(e.name)}
    if REFIT in world.names:
        named[REFIT] = {"believed": [asdict(s) for s in baseline.surfaces]}
    return named


def _is_named(name: str) -> bool:
    """Whether a catalogue has a name for an effect."""
    return name in BY_NAME or name in LACKED
