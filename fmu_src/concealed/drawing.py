"""Draw a blind trial: hide effects of the requested size, record, and state which sets of effects count as right."""

from collections.abc import Sequence
from dataclasses import asdict

import numpy as np

from .alternatives import (
    LOOPS,
    Explanations,
    explanations,
    indistinguishable,
    loss_of,
    one_constant_rate,
)
from .bench import Bench
from .effects import BY_NAME, Conditions, Effect
from .measurement import Instrument, drawn_instrument
from .motion import FloatArray, Motion
from .scenario import Plan, Setup, drawn_alike, drawn_setup, drawn_tests, planned
from .sizing import Size, measured, misfit_size, resized
from .tires import ContactPatchTire, PowerTire, best_power_law
from .trial import Answer, FileTruth, Parameters, Record, Trial, recorded

#: Smallest and largest requested size over the noise.
SIZES = (1.0, 30.0)
#: Leaving a true effect out must lose this much log-likelihood, or the trial is drawn anew.
VISIBLE = 30.0
#: A tire counts as another above this loss and this RMS over the noise (the least size of any effect), as the
#: same below the smaller loss; between them both answers count as right.
OTHER_TIRE_LOSS, SAME_TIRE_LOSS = 40.0, 4.0
OTHER_TIRE_SIZE = 1.0
#: Least loss, absolute and as a share of the whole loss, that every pair of named effects must leave of an
#: effect outside the catalogue.
BEYOND_CATALOGUE, BEYOND_SHARE = 150.0, 0.2
#: Attempts at one choice of effects, and choices of effects of the same kind.
ATTEMPTS, MOST_ROUNDS = 25, 20


class Undrawable(RuntimeError):
    """No trial of the wanted kind came out of a seed; it does not happen with the constants as they are."""


def draw(seed: int, *, kind: str | None = None) -> Trial:
    """Draw one trial from a seed; the same seed gives the same trial.

    kind: "none", "single", "masked" (one effect under another tire's coefficients), "pair", "triple" or
    "open" (outside of any catalogue); None draws it too.
    """
    for round_ in range(MOST_ROUNDS):
        plan = planned(stream(seed, round_, 0), kind)
        kind = plan.kind
        for attempt in range(1, ATTEMPTS + 1):
            trial = _attempt(seed, plan, stream(seed, round_, attempt))
            if trial is not None:
                return trial
    raise Undrawable(f"seed {seed} gave no trial of the kind {kind} in {MOST_ROUNDS * ATTEMPTS} attempts")


def stream(seed: int, *key: int) -> np.random.Generator:
    """The random numbers of one part of a trial."""
    return np.random.default_rng(np.random.SeedSequence(seed, spawn_key=key))


def _attempt(seed: int, plan: Plan, rng: np.random.Generator) -> Trial | None:
    """One trial to the plan, or None where an effect stayed invisible or a name would not be fair."""
    setup = drawn_setup(rng, plan)
    train, others = drawn_tests(rng, plan, setup.limits)
    instrument = drawn_instrument(rng)
    bare = Bench(setup.tire)
    conditions = Conditions(train, tuple(bare.force(m) for m in train), setup.tire, instrument.noise)
    simulated = [m.recorded(Bench(setup.baseline).force(m)) for m in train]
    misfit = [m.recorded(f) - s for m, f, s in zip(train, conditions.elastic, simulated, strict=True)]
    another = _is_another_tire(plan, bare, train, misfit, instrument)
    if another is not plan.another_tire and (another is not None or plan.another_tire):
        return None

    bench, sizes = _hidden(rng, plan, bare, conditions)
    if any(size.raw < 0.95 * SIZES[0] for size in sizes.values()):
        return None
    explained = _explained(plan, setup, bench, conditions, misfit, instrument)
    if not _is_fair(plan, bench, explained):
        return None
    right, margins, rule = _right(plan, train, explained)
    if another is None:
        right = tuple(s for names in right for s in (names, _with_recalibration(names)))
        rule = "; ".join(filter(None, (rule, "the believed law is a little misshapen for this tire")))
    if another is not False:
        sizes["recalibration"] = misfit_size(bare, train, misfit, instrument.noise)

    made = _recordings(rng, bench, instrument, train, others, setup)
    answer = Answer(
        kind=plan.kind,
        effects=_effects(bench, plan, setup),
        hidden={e.name: e.parameters() for e in bench.effects if e.name not in BY_NAME},
        right=right,
        margins=margins,
        rule=rule,
        sizes=sizes,
        where=regions_of(bench, train),
        noise=instrument.noise,
        files={record.name: file_truth(record, setup.baseline, floors) for record, floors in made},
        tire={"form": type(setup.tire).__name__, **asdict(setup.tire)},
        instrument=asdict(instrument),
    )
    records = tuple(record for record, _ in made)
    return Trial(
        seed,
        records[: len(train)],
        records[len(train) :],
        answer,
        setup.baseline,
        setup.source,
        instrument.noise,
        bench,
        instrument,
        train,
    )


def _recordings(
    rng: np.random.Generator,
    bench: Bench,
    instrument: Instrument,
    train: tuple[Motion, ...],
    others: tuple[Motion, ...],
    setup: Setup,
) -> list[tuple[Record, tuple[float, float]]]:
    """The training recordings, the held-out ones of another kind and last the one alike, each with its noise floors."""
    motions = {f"train_{i}.csv": motion for i, motion in enumerate(train)}
    motions |= {f"heldout_{i}.csv": motion for i, motion in enumerate(others)}
    made = [recorded(bench, instrument, motion, name, rng) for name, motion in motions.items()]
    last = drawn_alike(rng, train, setup.limits)
    return [*made, recorded(bench, instrument, last, f"heldout_{len(others)}.csv", rng)]


def _is_another_tire(
    plan: Plan, bare: Bench, train: tuple[Motion, ...], misfit: list[FloatArray], instrument: Instrument
) -> bool | None:
    """Whether the recordings show that the baseline law is not this tire's; None where that is doubtful."""
    loss = loss_of(bare, train, misfit, instrument)
    size = float(np.sqrt(np.mean(np.concatenate(misfit) ** 2))) / instrument.noise
    if loss < SAME_TIRE_LOSS:
        return False
    if size > OTHER_TIRE_SIZE:
        return True if loss > OTHER_TIRE_LOSS else not plan.another_tire
    return None


def _with_recalibration(names: tuple[str, ...]) -> tuple[str, ...]:
    """The same set with recalibration added."""
    return tuple(sorted({*names, "recalibration"} - {"none"}))


def _hidden(
    rng: np.random.Generator, plan: Plan, bare: Bench, conditions: Conditions
) -> tuple[Bench, dict[str, Size]]:
    """Hide the planned effects, each in a size drawn evenly over the logarithm."""
    forms = [BY_NAME[n][int(rng.integers(len(BY_NAME[n])))] for n in plan.wanted if n in BY_NAME]
    if plan.open_form is not None:
        forms.append(plan.open_form)
    return hidden_effects(rng, bare, forms, conditions, SIZES)


def hidden_effects(
    rng: np.random.Generator,
    bare: Bench,
    forms: Sequence[type[Effect]],
    conditions: Conditions,
    sizes_over_noise: tuple[float, float],
) -> tuple[Bench, dict[str, Size]]:
    """Hide effects of some forms, each in a size [noise] drawn evenly over the logarithm between two."""
    effects = [form.drawn(rng, conditions) for form in forms]
    least, most = np.log(sizes_over_noise)
    return in_sizes(bare, effects, conditions, np.exp(rng.uniform(least, most, len(effects))).tolist())


def in_sizes(
    bare: Bench, effects: list[Effect], conditions: Conditions, wanted: Sequence[float]
) -> tuple[Bench, dict[str, Size]]:
    """Hide effects, each in a size [noise]."""
    bench = Bench(bare.tire, tuple(effects))
    # a second round, because the size of each effect depends on the others
    for _ in range(min(len(effects), 2)):
        for i in range(len(effects)):
            effects[i] = resized(bench, effects[i], conditions.motions, conditions.noise, wanted[i])
            bench = bench.replacing(effects[i])
    sizes = {
        effect.name: measured(bench, effect, conditions.motions, conditions.noise, size)
        for effect, size in zip(effects, wanted, strict=True)
    }
    return bench, sizes


def _explained(
    plan: Plan,
    setup: Setup,
    bench: Bench,
    conditions: Conditions,
    misfit: list[FloatArray],
    instrument: Instrument,
) -> Explanations:
    """How well every set of names explains the noise-free residuals of the baseline tire."""
    residuals: list[FloatArray] = []
    known: dict[str, list[FloatArray]] = {e.name: [] for e in bench.effects if e.name in BY_NAME}
    for motion, bare, miss in zip(conditions.motions, conditions.elastic, misfit, strict=True):
        force = bench.force(motion)
        added = motion.recorded(force - bare)
        residuals.append(added + miss if plan.another_tire else added)
        for name in known:
            known[name].append(motion.recorded(force - bench.without(name).force(motion)))
    if plan.another_tire:
        known["recalibration"] = misfit
    law_shape = plan.another_tire and isinstance(setup.tire, ContactPatchTire)
    return explanations(bench, conditions.motions, residuals, known, instrument, law_shape)


def _is_fair(plan: Plan, bench: Bench, explained: Explanations) -> bool:
    """Whether no true effect can be left out, and no pair of named effects explains one outside the catalogue."""
    if plan.open_form is not None:
        base = set(plan.names)
        whole, best = explained.loss(base), explained.best(base, 2)
        return best > BEYOND_CATALOGUE and best > BEYOND_SHARE * whole
    truth = frozenset(plan.names)
    truth_loss = explained.loss(truth)
    elastic = {e.name for e in bench.effects if e.elastic_only}
    for name in truth:
        excused = plan.may_hide and plan.another_tire and name in elastic | {"recalibration"}
        if not excused and explained.loss(truth - {name}) - truth_loss < VISIBLE:
            return False
    return True


def _right(
    plan: Plan, train: tuple[Motion, ...], explained: Explanations
) -> tuple[tuple[tuple[str, ...], ...], dict[str, float], str]:
    """The sets that count as right: the exact one, then those that fit the recordings as well."""
    if plan.kind == "none":
        return (("none",),), {}, ""
    if plan.kind == "open":
        sets = ((*plan.names, "unknown"), ("unknown",)) if plan.names else (("unknown",),)
        return (
            sets,
            {"any pair of names": round(explained.best(plan.names, 2), 3)},
            "part of the misfit may be called unknown too" if plan.names else "",
        )
    truth = frozenset(plan.names)
    margins = indistinguishable(explained, truth)
    rule = "recordings cannot tell them apart" if margins else ""
    sets_found = list(margins)
    loops = truth & set(LOOPS) - {"force_lag"}
    if len(loops) == 1 and one_constant_rate(train):
        rule = "one constant rate on one surface"
        for loop in LOOPS:
            swapped = truth - loops | {loop}
            if swapped != truth and swapped not in sets_found:
                sets_found.append(swapped)
    right = (tuple(sorted(truth)), *(tuple(sorted(s)) or ("none",) for s in sets_found))
    return right, {" + ".join(sorted(s)) or "none": round(loss, 3) for s, loss in margins.items()}, rule


def _effects(bench: Bench, plan: Plan, setup: Setup) -> dict[str, Parameters]:
    """Parameters of the named effects; for another tire its best power law and that of the baseline."""
    effects: dict[str, Parameters] = {e.name: e.parameters() for e in bench.effects if e.name in BY_NAME}
    if plan.another_tire:
        surfaces = []
        for radius, deep in zip(setup.limits.surfaces, setup.limits.deepest, strict=True):
            true, baseline = best_power_law(setup.tire, radius, deep), setup.baseline.at(radius)
            surfaces.append(
                {
                    "radius": radius,
                    "a": true.a,
                    "b": true.b,
                    "believed_a": baseline.a,
                    "believed_b": baseline.b,
                }
            )
        effects["recalibration"] = {"surfaces": surfaces}
    return effects


def file_truth(record: Record, baseline: PowerTire, floors: tuple[float, float]) -> FileTruth:
    """What is known of a recording: its noise floors [N] and what the baseline leaves."""
    force = baseline.force(record.deflection, record.radius, np.ones_like(record.force))
    rmse = float(np.sqrt(np.mean((record.force - force) ** 2)))
    return FileTruth(record.time.size, record.excitation, rmse, *floors)


def regions_of(bench: Bench, train: tuple[Motion, ...]) -> tuple[Parameters, ...]:
    """Regions of the localized effects in the training recordings, with the share of samples in them."""
    regions: list[Parameters] = []
    for effect in bench.effects:
        for i, motion in enumerate(train):
            contact = bench.contact(motion)
            active = effect.active(contact)
            share = 1.0 if active is None else float(np.mean(motion.recorded(active)))
            for region in effect.regions(motion):
                span = {"by": region.by, "from": region.begin, "to": region.end, "unit": region.unit}
                regions.append({"effect": effect.name, "recording": f"train_{i}.csv", **span, "share": share})
    return tuple(regions)
