"""Draw a blind trial: hide effects in the size asked for, record, and say honestly what counts as right."""

from dataclasses import asdict

import numpy as np

from concealed.bench import Bench
from concealed.effects import BY_NAME, Effect, Scene
from concealed.measurement import Instrument, drawn_instrument
from concealed.motion import FloatArray, Motion
from concealed.rivals import (
    LOOPS,
    Explanations,
    explanations,
    indistinguishable,
    loss_of,
    one_constant_rate,
)
from concealed.scenario import KINDS, Belief, Plan, alike, believed_in, planned, tests
from concealed.sizing import Size, measured, misfit_size, resized
from concealed.tires import ContactPatchTire, PowerTire, best_power_law
from concealed.trial import Answer, FileTruth, Parameters, Record, Trial, recorded

#: Smallest and largest requested size over the noise.
SIZES = (1.0, 30.0)
#: A true effect must be missed by this loss of log-likelihood when it is left out, or the trial is drawn
#: anew.
VISIBLE = 30.0
#: A tire counts as another above this loss and this RMS over the noise, as large as any effect has to be; as
#: the same below the smaller loss; between them either name is fair.
OTHER_TIRE_LOSS, SAME_TIRE_LOSS = 40.0, 4.0
OTHER_TIRE_SIZE = 1.0
#: What no pair of named effects may explain of an effect of the open world: loss, and share of the whole
#: loss.
BEYOND_CATALOGUE, BEYOND_SHARE = 150.0, 0.2
#: Attempts at one choice of effects, and choices of effects of the same kind.
ATTEMPTS, MOST_ROUNDS = 25, 20


class Undrawable(RuntimeError):
    """No trial of the wanted kind came out of a seed; it does not happen with the constants as they are."""


def draw(seed: int, *, kind: str | None = None) -> Trial:
    """Draw one trial from a seed; the same seed gives the same trial.

    kind: "none", "single", "masked" (one effect under another tire's coefficients), "pair", "triple" or
    "open" (outside of any catalogue); None draws it too.
    Errors: ValueError for another kind or a negative seed.
    """
    if kind is not None and kind not in KINDS:
        raise ValueError(f"kind is {kind!r}, but a trial is one of {', '.join(KINDS)}")
    if seed < 0:
        raise ValueError(f"seed is {seed}, but seeds are not negative")
    for round_ in range(MOST_ROUNDS):
        plan = planned(_stream(seed, round_, 0), kind)
        kind = plan.kind
        for attempt in range(1, ATTEMPTS + 1):
            trial = _attempt(seed, plan, _stream(seed, round_, attempt))
            if trial is not None:
                return trial
    raise Undrawable(f"seed {seed} gave no trial of the kind {kind} in {MOST_ROUNDS * ATTEMPTS} attempts")


def _stream(seed: int, *key: int) -> np.random.Generator:
    return np.random.default_rng(np.random.SeedSequence(seed, spawn_key=key))


def _attempt(seed: int, plan: Plan, rng: np.random.Generator) -> Trial | None:
    """One trial to the plan, or None where an effect stayed invisible or a name would not be fair."""
    belief = believed_in(rng, plan)
    train, others = tests(rng, plan, belief.reach)
    instrument = drawn_instrument(rng)
    bare = Bench(belief.tire)
    scene = Scene(train, tuple(bare.force(m) for m in train), belief.tire, instrument.noise)
    believed = [m.recorded(Bench(belief.believed).force(m)) for m in train]
    misfit = [m.recorded(f) - b for m, f, b in zip(train, scene.elastic, believed, strict=True)]
    another = _is_another_tire(plan, bare, train, misfit, instrument)
    if another is not plan.another_tire and (another is not None or plan.another_tire):
        return None

    bench, sizes = _hidden(rng, plan, bare, scene)
    if any(size.raw < 0.95 * SIZES[0] for size in sizes.values()):
        return None
    explained = _explained(plan, belief, bench, scene, misfit, instrument)
    if not _is_fair(plan, bench, explained):
        return None
    right, margins, rule = _right(plan, train, explained)
    if another is None:
        right = tuple(s for names in right for s in (names, _with_recalibration(names)))
        rule = "; ".join(filter(None, (rule, "the believed law is a little misshapen for this tire")))
    if another is not False:
        sizes["recalibration"] = misfit_size(bare, train, misfit, instrument.noise)

    records: list[Record] = []
    files: dict[str, FileTruth] = {}

    def record(name: str, motion: Motion) -> None:
        made, floors = recorded(bench, instrument, motion, name, rng)
        records.append(made)
        files[name] = _file_truth(made, belief.believed, floors)

    for i, motion in enumerate(train):
        record(f"train_{i}.csv", motion)
    for i, motion in enumerate(others):
        record(f"heldout_{i}.csv", motion)
    record(f"heldout_{len(others)}.csv", alike(rng, train, belief.reach))
    answer = Answer(
        kind=plan.kind,
        effects=_effects(bench, plan, belief),
        hidden={e.name: e.parameters() for e in bench.effects if e.name not in BY_NAME},
        right=right,
        margins=margins,
        rule=rule,
        sizes=sizes,
        where=_places(bench, train),
        noise=instrument.noise,
        files=files,
        tire={"form": type(belief.tire).__name__, **asdict(belief.tire)},
        instrument=asdict(instrument),
    )
    return Trial(
        seed,
        tuple(records[: len(train)]),
        tuple(records[len(train) :]),
        answer,
        belief.believed,
        belief.source,
        instrument.noise,
        bench,
        instrument,
    )


def _is_another_tire(
    plan: Plan, bare: Bench, train: tuple[Motion, ...], misfit: list[FloatArray], instrument: Instrument
) -> bool | None:
    """Whether the recordings can show that the believed law is not this tire's; None where it is doubtful."""
    loss = loss_of(bare, train, misfit, instrument)
    size = float(np.sqrt(np.mean(np.concatenate(misfit) ** 2))) / instrument.noise
    if loss < SAME_TIRE_LOSS:
        return False
    if size > OTHER_TIRE_SIZE:
        return True if loss > OTHER_TIRE_LOSS else not plan.another_tire
    return None


def _with_recalibration(names: tuple[str, ...]) -> tuple[str, ...]:
    """The same set under another tire's coefficients."""
    return tuple(sorted({*names, "recalibration"} - {"none"}))


def _hidden(rng: np.random.Generator, plan: Plan, bare: Bench, scene: Scene) -> tuple[Bench, dict[str, Size]]:
    """Hide the planned effects, each in a size drawn evenly over the logarithm."""
    forms = [BY_NAME[n][int(rng.integers(len(BY_NAME[n])))] for n in plan.wanted if n in BY_NAME]
    if plan.open_form is not None:
        forms.append(plan.open_form)
    effects: list[Effect] = [form.drawn(rng, scene) for form in forms]
    wanted = np.exp(rng.uniform(np.log(SIZES[0]), np.log(SIZES[1]), len(effects))).tolist()
    bench = Bench(bare.tire, tuple(effects))
    # a second round, because each effect is sized in the company of the others
    for _ in range(min(len(effects), 2)):
        for i in range(len(effects)):
            effects[i] = resized(bench, effects[i], scene.motions, scene.noise, wanted[i])
            bench = bench.replacing(effects[i])
    sizes = {
        effect.name: measured(bench, effect, scene.motions, scene.noise, size)
        for effect, size in zip(effects, wanted, strict=True)
    }
    return bench, sizes


def _explained(
    plan: Plan,
    belief: Belief,
    bench: Bench,
    scene: Scene,
    misfit: list[FloatArray],
    instrument: Instrument,
) -> Explanations:
    """How well every set of names can explain what the believed tire leaves over, free of noise."""
    residuals: list[FloatArray] = []
    known: dict[str, list[FloatArray]] = {e.name: [] for e in bench.effects if e.name in BY_NAME}
    for motion, bare, miss in zip(scene.motions, scene.elastic, misfit, strict=True):
        force = bench.force(motion)
        added = motion.recorded(force - bare)
        residuals.append(added + miss if plan.another_tire else added)
        for name in known:
            known[name].append(motion.recorded(force - bench.without(name).force(motion)))
    if plan.another_tire:
        known["recalibration"] = misfit
    shape = plan.another_tire and isinstance(belief.tire, ContactPatchTire)
    return explanations(bench, scene.motions, residuals, known, instrument, shape)


def _is_fair(plan: Plan, bench: Bench, explained: Explanations) -> bool:
    """Whether no true effect can be left out, and the open world is out of the catalogue's reach."""
    if plan.open_form is not None:
        base = set(plan.names)
        whole, best = explained.loss(base), explained.best(base, 2)
        return best > BEYOND_CATALOGUE and best > BEYOND_SHARE * whole
    truth = frozenset(plan.names)
    own = explained.loss(truth)
    elastic = {e.name for e in bench.effects if e.elastic_only}
    for name in truth:
        excused = plan.may_hide and plan.another_tire and name in elastic | {"recalibration"}
        if not excused and explained.loss(truth - {name}) - own < VISIBLE:
            return False
    return True


def _right(
    plan: Plan, train: tuple[Motion, ...], explained: Explanations
) -> tuple[tuple[tuple[str, ...], ...], dict[str, float], str]:
    """The sets that count as right: the exact one, then those that the recordings cannot tell from it."""
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


def _effects(bench: Bench, plan: Plan, belief: Belief) -> dict[str, Parameters]:
    """Parameters of the named effects; for another tire its best power law beside the believed one."""
    effects: dict[str, Parameters] = {e.name: e.parameters() for e in bench.effects if e.name in BY_NAME}
    if plan.another_tire:
        surfaces = []
        for radius, deep in zip(belief.reach.surfaces, belief.reach.deepest, strict=True):
            own, thought = best_power_law(belief.tire, radius, deep), belief.believed.at(radius)
            surfaces.append(
                {"radius": radius, "a": own.a, "b": own.b, "believed_a": thought.a, "believed_b": thought.b}
            )
        effects["recalibration"] = {"surfaces": surfaces}
    return effects


def _file_truth(record: Record, believed: PowerTire, floors: tuple[float, float]) -> FileTruth:
    force = believed.force(record.deflection, record.radius, np.ones_like(record.force))
    baseline = float(np.sqrt(np.mean((record.force - force) ** 2)))
    return FileTruth(record.time.size, record.excitation, baseline, *floors)


def _places(bench: Bench, train: tuple[Motion, ...]) -> tuple[Parameters, ...]:
    """Places of the confined effects in the training recordings, with the share of samples that they take."""
    places: list[Parameters] = []
    for effect in bench.effects:
        for i, motion in enumerate(train):
            contact = bench.contact(motion)
            active = effect.active(contact, contact.elastic)
            share = 1.0 if active is None else float(np.mean(motion.recorded(active)))
            for place in effect.places(motion):
                span = {"by": place.by, "from": place.begin, "to": place.end, "unit": place.unit}
                places.append({"effect": effect.name, "recording": f"train_{i}.csv", **span, "share": share})
    return tuple(places)
