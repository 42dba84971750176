"""The plan of a wide trial: tire, effects and tests of the kinds loud, press, foreign, outside, beside and set."""

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace

import numpy as np

from ..bench import Bench
from ..drawing import hidden_effects, in_sizes
from ..effects import BY_NAME, Conditions, Effect
from ..measurement import Instrument, drawn_instrument
from ..motion import Motion
from ..regressors import NAMES
from ..scenario import Plan, Setup, drawn_alike, drawn_setup, drawn_tests, planned
from ..sizing import Size, misfit_size
from ..tires import PowerTire, Tire, contact_patch_tire, deviating_tire, fitted_table
from . import press
from .foreign import FOREIGN
from .gauge_drift import DEFLECTION_DRIFT, DRIFTING
from .laws import drawn_law
from .outside import OUTSIDE, StiffeningTread
from .permanent import PERMANENT, PERMANENT_SET

#: Sizes over the noise, between which each kind draws evenly over the logarithm.
LOUD, PRESS, STRANGE, BEYOND = (30.0, 1000.0), (1.5, 30.0), (5.0, 300.0), (3.0, 100.0)
#: Sizes over the noise of a known effect beside an unknown one, and the part of its size that the latter has.
KNOWN, BESIDE = (10.0, 300.0), (0.2, 2.0)
#: A loud trial is measured by an instrument as much quieter; a foreign or outside one by up to as much.
QUIETER_LOUD, QUIETER = 1.0 / 30.0, 1.0 / 20.0
#: How often a loud trial hides what.
LOUD_KINDS: Mapping[str, float] = {"single": 0.4, "masked": 0.15, "pair": 0.3, "triple": 0.15}
#: The law is what is foreign as often as this many forms together; how often outside and beside have another tire.
LAWS, OUTSIDE_TIRE, BESIDE_TIRE = 2, 0.2, 0.35
#: What a first file hides, as often as it is listed; "law": a law that is no power of x.
FIRST_FILES = (
    *("rate_independent_hysteresis",) * 6,
    *("series_compliance", "viscoelastic_relaxation", "law", "") * 3,
    *("viscous_damping", "deflection_offset") * 2,
    "force_offset",
    "mullins_softening",
)


@dataclass(frozen=True)
class World:
    """All that is decided before anything is recorded.

    names: what a catalogue would call the hidden effects, recalibration among them; baseline: None where it is fitted
    to the recordings. heldout: the last one is of a training kind.
    """

    names: tuple[str, ...]
    bench: Bench
    baseline: PowerTire | None
    source: str
    train: tuple[Motion, ...]
    heldout: tuple[Motion, ...]
    instrument: Instrument
    sizes: Mapping[str, Size]


def loud(rng: np.random.Generator, turn: int) -> World | None:
    """Effects of the catalogue, 30 to 1000 times the noise: alone, in pairs, in threes, under another tire's law."""
    kind = str(rng.choice(list(LOUD_KINDS), p=list(LOUD_KINDS.values())))
    plan = replace(planned(rng, kind), poorly_excited=False, may_hide=False)
    setup = drawn_setup(rng, plan)
    forms = [BY_NAME[n][int(rng.integers(len(BY_NAME[n])))] for n in plan.wanted]
    return of_plan(rng, plan, as_baseline(setup, plan), forms, (LOUD, (QUIETER_LOUD, QUIETER_LOUD)))


def foreign(rng: np.random.Generator, turn: int) -> World | None:
    """One effect in a form that no catalogue holds, 5 to 300 times the noise; or a law that is no power of x."""
    of_law = turn % (len(FOREIGN) + LAWS) >= len(FOREIGN)
    form = FOREIGN[turn % (len(FOREIGN) + LAWS) % len(FOREIGN)]
    plan = Plan("single", ("recalibration",) if of_law else (form.name,), None, False, False)
    setup = drawn_setup(rng, plan)
    if of_law:
        tire = drawn_law(rng, deviating_tire(rng))
        table = fitted_table(tire, setup.limits.deepest, setup.limits.surfaces)
        setup = replace(setup, tire=tire, baseline=table, source="table")
    else:
        setup = as_baseline(setup, plan)
    return of_plan(rng, plan, setup, [] if of_law else [form], (STRANGE, (QUIETER, 1.0)))


def outside(rng: np.random.Generator, turn: int) -> World | None:
    """What the catalogue lacks altogether, 3 to 100 times the noise, one time in five on another tire."""
    form = OUTSIDE[turn % len(OUTSIDE)]
    names = ("recalibration",) if rng.random() < OUTSIDE_TIRE else ()
    plan = Plan("open", names, form, False, False)
    setup = as_baseline(drawn_setup(rng, plan), plan)
    # a knee at one force shows on surfaces of unlike stiffness only; on one surface it is one at a deflection
    if form is StiffeningTread and len(setup.limits.surfaces) < 2:
        return None
    return of_plan(rng, plan, setup, [form], (BEYOND, (QUIETER, 1.0)))


def beside(rng: np.random.Generator, turn: int) -> World | None:
    """A known effect and beside it one that the catalogue lacks, a fifth of it to twice as large; one time in three on
    another tire.
    """
    form = OUTSIDE[turn % len(OUTSIDE)]
    known = str(rng.choice([name for name in NAMES if name != "recalibration"]))
    other = ("recalibration",) if rng.random() < BESIDE_TIRE else ()
    plan = Plan("open", (known, *other), form, False, False)
    setup = as_baseline(drawn_setup(rng, plan), plan)
    if form is StiffeningTread and len(setup.limits.surfaces) < 2:
        return None
    forms = [BY_NAME[known][int(rng.integers(len(BY_NAME[known])))], form]
    return of_plan(rng, plan, setup, forms, (KNOWN, (QUIETER, 1.0)), BESIDE)


def permanent(rng: np.random.Generator, turn: int) -> World | None:
    """A part that keeps some of its deflection, 5 to 300 times the noise, every other time beside another effect."""
    world = _of_form(rng, turn, PERMANENT_SET, PERMANENT)
    # what stays is of the deflection alone: on another surface its force at the deepest point is not known
    if world is None or any(len(motion.surfaces) > 1 for motion in (*world.train, *world.heldout)):
        return None
    return world


def drifting(rng: np.random.Generator, turn: int) -> World | None:
    """A gauge whose zero drifts, 5 to 300 times the noise, every other time beside another effect."""
    return _of_form(rng, turn, DEFLECTION_DRIFT, DRIFTING)


def _of_form(rng: np.random.Generator, turn: int, name: str, named: tuple[type[Effect], ...]) -> World | None:
    """A world of what `NAMES` lacks, its forms in turn, every other time beside another effect."""
    others = (str(rng.choice([other for other in NAMES if other != "recalibration"])),)
    names = (name, *(others if turn // len(named) % 2 else ()))
    plan = Plan("single", names, None, False, False)
    setup = as_baseline(drawn_setup(rng, plan), plan)
    forms = [
        named[turn % len(named)],
        *(BY_NAME[n][int(rng.integers(len(BY_NAME[n])))] for n in names[1:]),
    ]
    return of_plan(rng, plan, setup, forms, (STRANGE, (QUIETER, 1.0)))


def first_file(rng: np.random.Generator, turn: int) -> World | None:
    """An engineer's first file of a press; the baseline is what a power law fitted to it gives."""
    like = deviating_tire(rng)
    what = str(rng.choice(FIRST_FILES))
    tire: Tire = drawn_law(rng, like) if what == "law" else like
    if what != "law" and rng.random() < 0.3:
        tire = contact_patch_tire(rng)
    train, heldout = press.drawn_motions(rng, press.drawn_limits(rng))
    instrument = press.drawn_instrument(rng)
    bare = Bench(tire)
    elastic = tuple(bare.force(m) for m in train)
    stiffness = max(
        float(np.max(f)) / float(np.max(m.deflection)) for m, f in zip(train, elastic, strict=True)
    )
    steps = stiffness * math.hypot(instrument.gauge, instrument.gauge_step / math.sqrt(12.0))
    conditions = Conditions(train, elastic, tire, math.hypot(instrument.noise, steps))
    forms = [BY_NAME[what][int(rng.integers(len(BY_NAME[what])))]] if what in BY_NAME else []
    bench, sizes = hidden_effects(rng, bare, forms, conditions, PRESS)
    names = (*(form.name for form in forms), "recalibration")
    return World(names, bench, None, "table", train, heldout, instrument, sizes)


#: The kinds; a world comes from random numbers and the turn of a form among those of its kind.
WORLDS: Mapping[str, Callable[[np.random.Generator, int], World | None]] = {
    "loud": loud,
    "press": first_file,
    "foreign": foreign,
    "outside": outside,
    "beside": beside,
    "set": permanent,
    "drift": drifting,
}


def of_plan(
    rng: np.random.Generator,
    plan: Plan,
    setup: Setup,
    forms: list[type[Effect]],
    loudness: tuple[tuple[float, float], tuple[float, float]],
    second: tuple[float, float] | None = None,
) -> World | None:
    """Hide the forms; loudness: sizes over the noise, and factors between which the instrument is made quieter; second:
    parts of the first form's size, between which that of the second lies, where it has none of its own.
    """
    sizes_over_noise, factors = loudness
    train, others = drawn_tests(rng, plan, setup.limits)
    heldout = (*others, drawn_alike(rng, train, setup.limits))
    factor = float(np.exp(rng.uniform(*np.log(factors))))
    instrument = _quieter(drawn_instrument(rng), factor)
    bare = Bench(setup.tire)
    elastic = tuple(bare.force(m) for m in train)
    conditions = Conditions(train, elastic, setup.tire, instrument.noise)
    if second is None:
        bench, sizes = hidden_effects(rng, bare, forms, conditions, sizes_over_noise)
    else:
        first, part = (float(np.exp(rng.uniform(*np.log(own)))) for own in (sizes_over_noise, second))
        effects = [form.drawn(rng, conditions) for form in forms]
        bench, sizes = in_sizes(bare, effects, conditions, [first, first * part])
        sizes_over_noise = second[0] * sizes_over_noise[0], sizes_over_noise[1]
    if any(size.raw < 0.95 * sizes_over_noise[0] for size in sizes.values()):
        return None
    if plan.another_tire:
        elastic_miss = [
            m.recorded(f - Bench(setup.baseline).force(m)) for m, f in zip(train, elastic, strict=True)
        ]
        size = misfit_size(bare, train, elastic_miss, instrument.noise)
        if size.raw < sizes_over_noise[0]:
            return None
        sizes["recalibration"] = size
    return World(plan.names, bench, setup.baseline, setup.source, train, heldout, instrument, sizes)


def as_baseline(setup: Setup, plan: Plan) -> Setup:
    """The setup with the baseline's own tire, unless another tire is planned: at this loudness any other one shows."""
    return setup if plan.another_tire else replace(setup, tire=setup.baseline)


def _quieter(instrument: Instrument, factor: float) -> Instrument:
    parts = ("white", "drifting", "pink", "hum", "quantum", "gauge")
    return replace(instrument, **{part: factor * getattr(instrument, part) for part in parts})
