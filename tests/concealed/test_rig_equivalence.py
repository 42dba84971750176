"""What the rig's own fits take for indistinguishable, against the table of look-alikes and known transformations."""

import math

import numpy as np
import pytest
from concealed.bench import Bench
from concealed.effects import Effect
from concealed.effects.damping import LinearDashpot
from concealed.effects.friction import IwanFriction
from concealed.effects.machine import GaugeZero, PureDelay
from concealed.effects.rim import SoftplusRim
from concealed.effects.series import YieldingWheel
from concealed.equivalence import TELLING, Hidden, equivalent, fitted, linearized
from concealed.excitation import EXCITATIONS, DepthLimits
from concealed.measurement import CoarseInstrument, Instrument
from concealed.motion import Motion, even_grid, rounded
from concealed.templates import templates
from concealed.tires import PowerTire, Surface, article_tire
from concealed.wide.foreign import QuadraticDashpot
from scipy.stats import norm

NOISE = Instrument(white=6.0)
Names = frozenset[str]


def motions(*names: str) -> tuple[Motion, ...]:
    rng = np.random.default_rng(5)
    return tuple(EXCITATIONS[name](rng, DepthLimits((math.inf,), (0.025,))) for name in names)


def quick_triangle(turning: float) -> Motion:
    """Three triangles of 30 s that turn round within some time [s], sampled at 10 Hz."""
    stride = 10
    time = even_grid(900 * stride + 1, 0.1 / stride)
    path = 0.024 * np.abs((time / 15.0 + 1.0) % 2.0 - 1.0)
    return Motion("t", time, rounded(path, 0.1 / stride, turning), np.full(time.size, math.inf), stride)


def hidden(effect: Effect, moved: tuple[Motion, ...], instrument: Instrument = NOISE) -> Hidden:
    bench = Bench(article_tire(), (effect,))
    return Hidden.of(bench, bench.tire, moved, instrument)


def alternatives(effect: Effect, moved: tuple[Motion, ...], instrument: Instrument = NOISE) -> set[Names]:
    seen = hidden(effect, moved, instrument)
    return set(equivalent(seen, linearized(seen), frozenset({effect.name}), 1).sets)


def test_the_limit_is_where_the_best_test_errs_in_one_case_of_a_hundred() -> None:
    assert norm.cdf(-0.5 * math.sqrt(TELLING)) == pytest.approx(0.01)


def test_viscosity_is_friction_at_one_rate_and_not_at_three() -> None:
    """The table of look-alikes: N = 3e5 samples on one constant-rate triangle, 17 with three rates."""
    dashpot = LinearDashpot(4000.0)
    friction = frozenset({"rate_independent_hysteresis"})
    assert friction in alternatives(dashpot, (quick_triangle(0.0),))
    assert friction not in alternatives(dashpot, motions("many_rates_triangle"))


def test_friction_with_a_long_breakaway_is_no_viscosity() -> None:
    found = alternatives(IwanFriction(60.0, 2e-3, 0.5, 0.0, 2000.0), (quick_triangle(0.0),))
    assert frozenset({"viscous_damping"}) not in found


def test_a_wheel_in_series_looks_like_another_tire() -> None:
    """2e6 N/m leaves 0.02 % of the peak after A and B are refitted: N = 4e4 samples at one pressure."""
    found = alternatives(YieldingWheel(1.0 / 2e6, 0.03), motions("article_triangle"))
    assert frozenset({"recalibration"}) in found


def test_a_knee_and_a_lag_are_nothing_else() -> None:
    assert not alternatives(SoftplusRim(1e5, 0.022, 2e-4), motions("article_triangle"))
    assert not alternatives(PureDelay(0.01), motions("sweep"))


def test_a_coarse_gauge_hides_what_a_fine_one_shows() -> None:
    """A shift of 1 mm under refitted A and B leaves 0.6 % of the peak: seen under 1 N of noise, not under 60 N."""
    shifted, moved = GaugeZero(1e-3), motions("article_triangle")
    refit = frozenset({"recalibration"})
    assert refit not in alternatives(shifted, moved, Instrument(white=1.0))
    # 60 N / 1e5 N/m * 12^(1/2) is 2 mm of step
    assert refit in alternatives(shifted, moved, CoarseInstrument(white=1.0, gauge_step=2e-3))


def test_the_truth_fits_itself_and_a_foreign_form_is_measured() -> None:
    moved = motions("many_rates_triangle")
    own = hidden(LinearDashpot(300.0), moved)
    names = frozenset({"viscous_damping"})
    assert fitted(own, names, templates(own.bench, own.motions, 6.0), 0.0) < 1.0
    foreign = hidden(QuadraticDashpot(600.0, 0.02), moved)
    found = equivalent(foreign, linearized(foreign), names, 1)
    # v |v| is a power of the rate that the rig's form reaches
    assert found.truth_leaves < 1e-3 * found.whole


def test_a_law_that_a_set_holds_beside_its_effects_is_found() -> None:
    """A e^0.06 x^(B + 0.02) and friction, against the baseline A x^B: both names together leave nothing."""
    flat = Surface(math.inf, 550.9, 1.422)
    tire = PowerTire((Surface(math.inf, flat.a * math.exp(0.06), flat.b + 0.02),))
    bench = Bench(tire, (IwanFriction(60.0, 1e-3, 0.5, 0.0, 2000.0),))
    seen = Hidden.of(bench, PowerTire((flat,)), motions("growing_triangle"), NOISE)
    forms = templates(bench, seen.motions, 6.0)
    friction = frozenset({"rate_independent_hysteresis"})
    assert fitted(seen, friction | {"recalibration"}, forms, TELLING) <= TELLING
    assert fitted(seen, friction, forms, TELLING) > 100.0 * TELLING


def test_corners_at_which_no_reading_tells_the_rate_have_no_weight() -> None:
    """Steps of 0.3 mm under 0.16 mm between samples: the rate is unknown at the corners at least."""
    seen = hidden(LinearDashpot(300.0), (quick_triangle(0.4),), CoarseInstrument(white=6.0, gauge=3e-5))
    blurred = seen.motions[0].blurred
    assert blurred is not None
    turn = int(np.argmin(np.abs(seen.motions[0].time - 15.0)))
    assert blurred[turn]
    assert np.mean(blurred) < 0.3
