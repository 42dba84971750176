"""What counts as right: effects that look alike are alternatives where the recordings cannot decide."""

import math

import numpy as np
import pytest
from concealed.alternatives import DECIDED, Explanations, explanations, indistinguishable, loss_of
from concealed.bench import Bench
from concealed.effects import Effect, IwanFriction, LinearDashpot, PureDelay, SoftplusRim, YieldingWheel
from concealed.excitation import EXCITATIONS, DepthLimits
from concealed.measurement import Instrument
from concealed.motion import Motion
from concealed.open_world import KnobRipple
from concealed.regressors import NAMES
from concealed.tires import article_tire

FLAT = DepthLimits((math.inf,), (0.025,))
NOISE = Instrument(white=6.0)


def explained(effect: Effect, motions: tuple[Motion, ...]) -> Explanations:
    bare = Bench(article_tire())
    bench = Bench(bare.tire, (effect,))
    added = [m.recorded(bench.force(m) - bare.force(m)) for m in motions]
    known = {effect.name: added} if effect.name in NAMES else {}
    return explanations(bench, motions, added, known, NOISE, law_shape=False)


def motions(*names: str) -> tuple[Motion, ...]:
    rng = np.random.default_rng(5)
    return tuple(EXCITATIONS[name](rng, FLAT) for name in names)


def test_the_truth_explains_everything() -> None:
    for effect in (IwanFriction(60.0, 1e-3, 0.5, 1.0, 2000.0), LinearDashpot(400.0), PureDelay(0.01)):
        view = explained(effect, motions("ride"))
        assert view.loss({effect.name}) == pytest.approx(0.0, abs=0.1)
        assert view.loss(()) > 100.0


def test_white_noise_counts_the_samples() -> None:
    """Loss = sum r^2/(2 s^2) for white noise: Parseval."""
    (motion,) = motions("sine")
    bare = Bench(article_tire())
    residual = motion.recorded(3.0 * np.sin(motion.time))
    expected = float(np.sum(residual**2)) / 2.0 / 36.0
    assert loss_of(bare, (motion,), [residual], NOISE) == pytest.approx(expected, rel=1e-9)


def test_slow_noise_hides_slow_effects() -> None:
    (motion,) = motions("article_triangle")
    bare = Bench(article_tire())
    drift = [motion.recorded(5.0 * motion.time / motion.duration)]
    slow = Instrument(white=2.0, drifting=math.sqrt(32.0), correlation_time=3.0)
    assert loss_of(bare, (motion,), drift, slow) < 0.2 * loss_of(bare, (motion,), drift, NOISE)


def test_one_rate_does_not_separate_viscosity_from_friction_but_three_do() -> None:
    """The table of look-alikes: N = 3e5 samples on one constant-rate triangle, 17 with three rates."""
    effect = LinearDashpot(150.0)
    single = explained(effect, motions("single_rate_triangle"))
    assert single.loss({"rate_independent_hysteresis"}) < DECIDED
    several = explained(effect, motions("many_rates_triangle"))
    assert several.loss({"rate_independent_hysteresis"}) > 100.0 * DECIDED
    assert not indistinguishable(several, frozenset({"viscous_damping"}))


def test_a_wheel_in_series_looks_like_another_tire() -> None:
    """2e6 N/m leaves 0.02 % of the peak after A and B are refitted: N = 4e4 samples at one pressure."""
    view = explained(YieldingWheel(1.0 / 2e6, 0.03), motions("article_triangle"))
    found = indistinguishable(view, frozenset({"series_compliance"}))
    assert frozenset({"recalibration"}) in found
    assert view.loss(()) > 10.0 * DECIDED


def test_a_knee_is_no_other_tire() -> None:
    view = explained(SoftplusRim(1e5, 0.022, 2e-4), motions("article_triangle", "ride"))
    assert not indistinguishable(view, frozenset({"bottoming"}))


def test_a_negative_loop_is_a_lag_and_nothing_else() -> None:
    view = explained(PureDelay(0.01), motions("sweep"))
    assert not indistinguishable(view, frozenset({"force_lag"}))


def test_no_pair_of_names_explains_a_ripple() -> None:
    view = explained(KnobRipple(20.0, 0.004, 0.3), motions("article_triangle", "ride"))
    assert view.best((), 2) > 0.5 * view.loss(())
