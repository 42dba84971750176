"""The plan of a trial, before anything is simulated: kind, effects, tires, surfaces, tests."""

import math
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from . import article
from .effects import Effect
from .excitation import EXCITATIONS, DepthLimits
from .motion import Motion
from .open_world import OPEN_WORLD
from .regressors import NAMES
from .tires import (
    PowerTire,
    Tire,
    article_tire,
    contact_patch_tire,
    deviating_tire,
    fitted_table,
)

#: How often each kind is drawn: nothing at all one time in six.
KINDS = {"none": 1 / 6, "single": 1 / 3, "masked": 1 / 6, "pair": 1 / 8, "triple": 1 / 24, "open": 1 / 6}

#: Tests that excite an effect well; in others a second effect may look the same.
INFORMATIVE_TESTS: Mapping[str, tuple[str, ...]] = {
    "deflection_offset": (
        "article_triangle",
        "single_rate_triangle",
        "growing_triangle",
        "many_rates_triangle",
    ),
    "force_offset": (
        "article_triangle",
        "single_rate_triangle",
        "ramp_and_hold",
        "ride",
        "many_rates_triangle",
    ),
    "rate_independent_hysteresis": ("many_rates_triangle", "ride", "multisine"),
    "viscous_damping": ("many_rates_triangle", "sweep", "multisine", "ride", "burst"),
    "viscoelastic_relaxation": ("ramp_and_hold", "staircase", "many_rates_triangle"),
    "series_compliance": ("article_triangle", "growing_triangle", "ramp_and_hold", "ride"),
    "gas_compression": ("article_triangle", "growing_triangle", "ramp_and_hold", "ride"),
    "bottoming": ("hits", "article_triangle", "ride", "growing_triangle", "many_rates_triangle"),
    "mullins_softening": ("growing_triangle", "article_triangle", "many_rates_triangle"),
    "pressure_leak": ("article_triangle", "growing_triangle", "many_rates_triangle", "sweep"),
    "warm_up": ("article_triangle", "many_rates_triangle", "sweep", "sine", "ride"),
    "inertia": ("sweep", "multisine", "ride", "burst"),
    "force_lag": ("sweep", "multisine", "ride", "burst", "many_rates_triangle"),
    "saturation": ("hits", "article_triangle", "ride", "growing_triangle"),
    "frame_resonance": ("sweep", "multisine", "ride", "many_rates_triangle"),
    "bead_snap": ("article_triangle", "growing_triangle", "many_rates_triangle", "ride", "hits"),
    "adhesion": ("article_triangle", "growing_triangle", "many_rates_triangle", "single_rate_triangle"),
    "one_sided_play": ("article_triangle", "growing_triangle", "many_rates_triangle", "ride"),
}
#: How often a single effect gets a test of one constant rate alone, and how often an elastic one may stay
#: invisible.
POORLY_EXCITED, MAY_STAY_HIDDEN = 0.12, 0.2
#: Largest force of the article's tests [N] and of its load cell [N].
ARTICLE_FORCE, CELL_FORCE = 2240.0, 4000.0
#: Largest deflections of the article's tests [m].
DEFLECTIONS = (0.0127, 0.03175)
#: Depth of a held-out motion over that of the training motions: no deeper than the fitted data.
HELD_OUT_DEPTH = (0.75, 0.92)


@dataclass(frozen=True)
class Plan:
    """Kind, names of the effects, the form outside the catalogue, and whether the tests may excite them poorly."""

    kind: str
    names: tuple[str, ...]
    open_form: type[Effect] | None
    poorly_excited: bool
    may_hide: bool

    @property
    def another_tire(self) -> bool:
        """Whether the tire differs from the baseline tire."""
        return "recalibration" in self.names

    @property
    def wanted(self) -> tuple[str, ...]:
        """Names that the tests are chosen for."""
        own = (self.open_form.name,) if self.open_form is not None else ()
        return (*own, *(name for name in self.names if name != "recalibration"))


@dataclass(frozen=True)
class Setup:
    """The tire on the bench, the baseline tire, where the latter comes from, and the depth limits."""

    tire: Tire
    baseline: PowerTire
    source: str
    limits: DepthLimits


def planned(rng: np.random.Generator, kind: str | None) -> Plan:
    """Draw the kind, unless it is given, and the effects."""
    drawn = str(rng.choice(list(KINDS), p=list(KINDS.values())))
    kind = kind or drawn
    may_hide = bool(rng.random() < MAY_STAY_HIDDEN)
    others = [name for name in NAMES if name != "recalibration"]
    names: tuple[str, ...] = ()
    open_form: type[Effect] | None = None
    if kind == "single":
        names = (str(rng.choice(NAMES)),)
    elif kind == "masked":
        names = (str(rng.choice(others)), "recalibration")
    elif kind in ("pair", "triple"):
        names = tuple(str(n) for n in rng.choice(others, 2 if kind == "pair" else 3, replace=False))
        names += ("recalibration",) if rng.random() < 0.35 else ()
    elif kind == "open":
        open_form = OPEN_WORLD[int(rng.integers(len(OPEN_WORLD)))]
        names = ("recalibration",) if rng.random() < 0.25 else ()
    # a spring in series under refitted coefficients cannot be seen at one pressure, whatever its size
    if "recalibration" in names and "series_compliance" in names and not may_hide:
        return planned(rng, kind)
    # a slow triangle has no acceleration but at its corners, between two samples
    poorly_excited = kind == "single" and names != ("inertia",) and bool(rng.random() < POORLY_EXCITED)
    return Plan(kind, names, open_form, poorly_excited, may_hide)


def drawn_setup(rng: np.random.Generator, plan: Plan) -> Setup:
    """Draw the surfaces, the tire, and the baseline tire."""
    surfaces = _surfaces(rng, plan.poorly_excited)
    kind = rng.random()
    if not plan.another_tire:
        tire: Tire = article_tire() if kind < 0.6 else deviating_tire(rng)
        if kind > 0.9:
            tire = contact_patch_tire(rng)
        source = "hull1996" if kind < 0.6 else "table"
    else:
        tire = deviating_tire(rng) if kind < 0.65 else contact_patch_tire(rng)
        source = "hull1996" if kind < 0.75 else "table"
    ceiling = ARTICLE_FORCE if rng.random() < 0.8 else CELL_FORCE
    deepest = DEFLECTIONS[1] * rng.uniform(0.7, 1.0)
    limits = DepthLimits(surfaces, tuple(_depth(tire, r, ceiling, deepest) for r in surfaces))
    if source == "hull1996":
        return Setup(tire, article_tire(), source, limits)
    if isinstance(tire, PowerTire):
        return Setup(tire, tire, source, limits)
    listed = article.ARTICLE_SURFACES
    depths = [_depth(tire, r, ceiling, deepest) for r in listed]
    return Setup(tire, fitted_table(tire, depths, listed), source, limits)


def drawn_tests(
    rng: np.random.Generator, plan: Plan, limits: DepthLimits
) -> tuple[tuple[Motion, ...], tuple[Motion, ...]]:
    """Draw the training motions, chosen to excite the effects, and held-out ones of another kind."""
    if plan.poorly_excited:
        names = [str(rng.choice(("article_triangle", "single_rate_triangle")))]
    else:
        names = [str(rng.choice(INFORMATIVE_TESTS.get(name, tuple(EXCITATIONS)))) for name in plan.wanted]
        most = max(len(names), 1)
        while len(names) < most + int(rng.integers(0, 2)):
            names.append(str(rng.choice(list(EXCITATIONS))))
    train = tuple(EXCITATIONS[name](rng, limits.scaled(rng.uniform(0.92, 1.0))) for name in names)
    left = [name for name in EXCITATIONS if name not in names]
    kinds = [str(n) for n in rng.choice(left, int(rng.integers(1, 3)), replace=False)]
    others = tuple(EXCITATIONS[name](rng, limits.scaled(rng.uniform(*HELD_OUT_DEPTH))) for name in kinds)
    return train, others


def drawn_alike(rng: np.random.Generator, train: tuple[Motion, ...], limits: DepthLimits) -> Motion:
    """Draw one more held-out motion, of the kind of one of the training motions."""
    name = str(rng.choice([motion.name for motion in train]))
    return EXCITATIONS[name](rng, limits.scaled(rng.uniform(*HELD_OUT_DEPTH)))


def _surfaces(rng: np.random.Generator, poorly_excited: bool) -> tuple[float, ...]:
    """One surface, mostly the flat, or two to four mounted in turn."""
    if poorly_excited or rng.random() < 0.5:
        return (math.inf,) if rng.random() < 0.7 else (float(rng.choice(article.ARTICLE_SURFACES)),)
    chosen = rng.choice(len(article.ARTICLE_SURFACES), int(rng.integers(2, 5)), replace=False)
    return tuple(article.ARTICLE_SURFACES[int(i)] for i in chosen)


def _depth(tire: Tire, radius: float, ceiling: float, deepest: float) -> float:
    """Deflection [m] up to which a surface may be pressed: to the ceiling [N], within the article's range."""
    deflection = np.linspace(0.0, deepest, 200)
    force = tire.force(deflection, np.full_like(deflection, radius), np.ones_like(deflection))
    return max(float(deflection[np.searchsorted(force, ceiling) - 1]), DEFLECTIONS[0])
