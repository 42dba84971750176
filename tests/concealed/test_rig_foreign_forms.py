"""Foreign forms and physics outside the catalogue against figures that follow from their equations by hand."""

import math
from collections.abc import Callable

import numpy as np
import pytest
from concealed.bench import Bench
from concealed.effects import Effect
from concealed.effects.relaxation import overstress
from concealed.measurement import CoarseInstrument, Instrument
from concealed.motion import FloatArray, Motion
from concealed.tires import article_tire
from concealed.wide.foreign import (
    AsymmetricFriction,
    BindingSpring,
    BreakawayFriction,
    BroadIwanFriction,
    HealingSoftening,
    LoopedRim,
    QuadraticDashpot,
    ReboundValve,
    RootDashpot,
    StretchedRelaxation,
    UnevenDashpot,
)
from concealed.wide.laws import BentTire, ExponentialTire, PolynomialTire, TwoSlopeTire
from concealed.wide.outside import (
    Backlash,
    Chatter,
    ClippedGauge,
    LateralCrosstalk,
    StiffeningTread,
    Thixotropy,
    WavyGauge,
)

Sine = Callable[..., Motion]
Added = Callable[[Effect, Motion], FloatArray]
Flat = Callable[[FloatArray, FloatArray], Motion]
FLAT = np.array([math.inf])


def triangle(flat_motion: Flat, speed: float, cycles: int = 2) -> Motion:
    """Triangles between 5 and 20 mm at one speed, from contact on."""
    corners = np.concatenate([[0.0], np.tile([0.02, 0.005], cycles)])
    at = np.concatenate([[0.0], np.cumsum(np.abs(np.diff(corners)) / speed)])
    time = np.linspace(0.0, at[-1], 8001)
    return flat_motion(time, np.interp(time, at, corners))


def at(motion: Motion, rising: bool, deflection: float) -> int:
    """A sample of the last cycle at a deflection on the way in or out."""
    x, half = motion.deflection, motion.time.size // 2
    going = np.gradient(x) > 0.0
    near = np.where(going == rising, np.abs(x - deflection), np.inf)
    return half + int(np.argmin(near[half:]))


@pytest.mark.parametrize(
    ("effect", "in_force", "out_force", "doubled"),
    [
        (UnevenDashpot(300.0, 2.0), 3.0, -6.0, 2.0),
        (QuadraticDashpot(300.0, 0.02), 1.5, -1.5, 4.0),
        # u/(|u| + 0.01)^(1/2) at u = 1/2: 0.5 / 0.7141; doubled: 1/1.005 over that
        (RootDashpot(300.0, 0.02), 6.0 * 0.70014, -6.0 * 0.70014, 1.42132),
    ],
)
def test_dampers_follow_their_law(
    flat_motion: Flat, added: Added, effect: Effect, in_force: float, out_force: float, doubled: float
) -> None:
    """At 10 mm/s: 300 N s/m times the law."""
    slow, fast = triangle(flat_motion, 0.01), triangle(flat_motion, 0.02)
    force, quicker = added(effect, slow), added(effect, fast)
    inward, outward = at(slow, True, 0.0125), at(slow, False, 0.0125)
    assert force[inward] == pytest.approx(in_force, rel=1e-3)
    assert force[outward] == pytest.approx(out_force, rel=1e-3)
    assert quicker[inward] == pytest.approx(doubled * in_force, rel=1e-3)


def test_a_rebound_valve_opens_on_the_way_back_alone(flat_motion: Flat, added: Added) -> None:
    """At 10 mm/s beyond 4 mm/s: 300 N s/m times 6 mm/s; at 3 mm/s it is shut."""
    quick, slow = triangle(flat_motion, 0.01), triangle(flat_motion, 0.003)
    force = added(ReboundValve(300.0, 0.004), quick)
    assert force[at(quick, True, 0.0125)] == 0.0
    assert force[at(quick, False, 0.0125)] == pytest.approx(-1.8, rel=1e-3)
    assert np.abs(added(ReboundValve(300.0, 0.004), slow))[slow.deflection > 0.006].max() == 0.0


def test_breakaway_friction_peaks_after_a_reversal(flat_motion: Flat, added: Added) -> None:
    """Plateau f; the largest of z (1 + p u e^(1 - u)) with z = 1 - 2 e^(-3 u), below f (1 + p); both branches alike."""
    motion = triangle(flat_motion, 0.01)
    force = added(BreakawayFriction(50.0, 5e-4, 0.4), motion)
    assert force[at(motion, True, 0.019)] == pytest.approx(50.0, rel=1e-3)
    assert force[at(motion, False, 0.006)] == pytest.approx(-50.0, rel=1e-3)
    u = np.linspace(0.0, 20.0, 20001)
    expected = 50.0 * float(np.max((1.0 - 2.0 * np.exp(-3.0 * u)) * (1.0 + 0.4 * u * np.exp(1.0 - u))))
    half = motion.time.size // 2
    assert float(np.max(force[half:])) == pytest.approx(expected, rel=0.01)
    assert expected > 1.2 * 50.0


def test_asymmetric_friction_slips_at_two_levels(flat_motion: Flat, added: Added) -> None:
    motion = triangle(flat_motion, 0.01)
    force = added(AsymmetricFriction(40.0, 5e-4, 0.5), motion)
    assert force[at(motion, True, 0.019)] == pytest.approx(40.0, rel=1e-3)
    assert force[at(motion, False, 0.006)] == pytest.approx(-20.0, rel=1e-3)


def test_broad_friction_is_independent_of_rate_and_never_above_its_slip_force(
    flat_motion: Flat, added: Added
) -> None:
    effect = BroadIwanFriction(40.0, 6e-4, 2.5, 0.0, 2000.0)
    slow, fast = triangle(flat_motion, 0.001), triangle(flat_motion, 0.1)
    assert added(effect, slow) == pytest.approx(added(effect, fast), abs=1e-6)
    assert float(np.max(np.abs(added(effect, slow)))) <= 40.0 + 1e-9


def test_a_looped_stop_gives_back_less(
    sine_motion: Sine, added: Added, loop_area: Callable[..., float]
) -> None:
    """Work taken up: (1 - back) times the energy k d^2/2 of the stop, with d beyond onset and half its softness."""
    motion = sine_motion(0.5)
    force = added(LoopedRim(1e5, 0.02, 1e-5, 0.8), motion)
    assert loop_area(motion, force) == pytest.approx(0.2 * 0.5 * 1e5 * 0.005**2, rel=0.03)


def test_softening_heals_at_rest(flat_motion: Flat, added: Added) -> None:
    """After a peak at 20 mm the tire is softer at 10 mm; after twelve healing times it is as before."""
    time = np.linspace(0.0, 130.0, 13001)
    motion = flat_motion(time, np.interp(time, [0.0, 2.0, 3.0, 130.0], [0.0, 0.02, 0.01, 0.01]))
    effect = HealingSoftening(0.2, 10.0)
    lost = -added(effect, motion) / Bench(article_tire()).force(motion)[-1]
    soon = int(np.searchsorted(time, 3.0))
    # memory after 1 s of healing lies between 0.02 and x + (0.02 - x) e^-0.1
    assert 0.2 * -math.expm1(-5.0 * (1.0 - 0.01 / 0.019)) < lost[soon] < 0.2 * -math.expm1(-2.5)
    assert lost[-1] < 1e-4


def test_a_stretched_relaxation_of_exponent_one_is_maxwells(sine_motion: Sine, added: Added) -> None:
    motion = sine_motion(0.2, low=0.002)
    elastic = Bench(article_tire()).force(motion)
    expected = 0.1 * overstress(elastic, motion.step, 0.7)
    assert added(StretchedRelaxation(0.1, 0.7, 1.0), motion) == pytest.approx(expected, abs=0.2)


def test_a_binding_spring_is_soft_first_and_twice_as_stiff_at_its_force() -> None:
    """d = s F_h ln(1 + F/F_h): slope s at rest, s/2 at F_h."""
    spring = BindingSpring(1e-6, 800.0)
    forces = np.array([0.0, 1.0, 800.0, 801.0])
    shortening = np.asarray(spring.shortening(forces))
    assert shortening[1] == pytest.approx(1e-6, rel=1e-3)
    assert shortening[3] - shortening[2] == pytest.approx(0.5e-6, rel=1e-3)


@pytest.mark.parametrize(
    "law",
    [
        PolynomialTire(article_tire(), 1.0, 0.3),
        ExponentialTire(article_tire(), 0.02),
        TwoSlopeTire(article_tire(), 0.008, 2.0),
    ],
)
def test_laws_that_are_no_power_meet_the_article_at_two_centimetres(
    law: PolynomialTire | ExponentialTire | TwoSlopeTire,
) -> None:
    ones = np.ones(2)
    force = law.force(np.array([0.0, 0.02]), np.full(2, math.inf), ones)
    assert force == pytest.approx([0.0, 550.9 * 2.0**1.422])
    # no power law: the slope of ln F over ln x is not the same everywhere
    x = np.array([0.004, 0.0041, 0.02, 0.0205])
    logs = np.log(law.force(x, np.full(4, math.inf), np.ones(4)))
    slopes = np.diff(logs)[::2] / np.diff(np.log(x))[::2]
    assert abs(slopes[1] - slopes[0]) > 0.1


def test_two_slopes_are_two() -> None:
    x = np.array([0.001, 0.002, 0.018, 0.019])
    force = TwoSlopeTire(article_tire(), 0.009, 2.0).force(x, np.full(4, math.inf), np.ones(4))
    assert (force[3] - force[2]) / (force[1] - force[0]) == pytest.approx(2.0, rel=1e-2)


def test_a_bent_law_is_a_power_law_with_other_coefficients() -> None:
    """exp(a + b ln x) A x^B = A e^a x^(B + b)."""
    bent = BentTire(article_tire(), (math.inf,), ((0.1, -0.05, 0.0),))
    force = bent.force(np.array([0.015]), FLAT, np.ones(1))
    assert force[0] == pytest.approx(550.9 * math.exp(0.1) * 1.5 ** (1.422 - 0.05))


def test_thixotropy_thins_while_it_moves_and_sets_at_rest(flat_motion: Flat, added: Added) -> None:
    """At speed v the broken part tends to (v/l)/(v/l + 1/T): 0.01/0.02 over that plus 1/10 is 5/6."""
    time = np.linspace(0.0, 300.0, 30001)
    x = np.interp(time, [0.0, 1.0, 200.0, 300.0], [0.0, 0.01, 0.01, 0.011])
    force = added(Thixotropy(60.0, 0.02, 10.0), flat_motion(time, x))
    moving = int(np.searchsorted(time, 0.99))
    rate = 0.01 / 0.02 + 0.1
    broken = 0.5 / rate * -math.expm1(-rate * 0.99)
    assert force[moving] == pytest.approx(60.0 * (1.0 - broken), rel=1e-2)
    # at rest it sets again: slow creep at 0.01 mm/s meets nearly the whole structure, tanh(0.01) of it
    assert force[int(np.searchsorted(time, 200.5))] == pytest.approx(60.0 * math.tanh(0.01), rel=2e-2)


def test_backlash_holds_the_tire_after_a_reversal_above_the_opening(flat_motion: Flat) -> None:
    motion = triangle(flat_motion, 0.01)
    play = Backlash(4e-4, 0.01).gauge_error(motion)
    assert play[at(motion, True, 0.018)] == pytest.approx(-2e-4, abs=1e-6)
    assert play[at(motion, False, 0.015)] == pytest.approx(2e-4, abs=1e-6)
    assert play[at(motion, True, 0.008)] == 0.0


def test_a_tread_stiffens_beyond_a_force(sine_motion: Sine, added: Added) -> None:
    motion = sine_motion(0.1)
    elastic = Bench(article_tire()).force(motion)
    force = added(StiffeningTread(0.25, 900.0), motion)
    assert force[elastic < 900.0] == pytest.approx(0.0)
    assert float(np.max(force)) == pytest.approx(0.25 * (float(np.max(elastic)) - 900.0))


def test_chatter_rings_at_its_frequency_after_each_slip(flat_motion: Flat, added: Added) -> None:
    time = np.linspace(0.0, 20.0, 20001)
    motion = flat_motion(time, 0.004 + 0.001 * time / 20.0 * 10.0)
    force = added(Chatter(10.0, 0.0051, 5.0, 0.5), motion)
    start = int(np.searchsorted(time, 10.2)) + 1
    ring = force[start : start + 2000]
    frequency = np.fft.rfftfreq(ring.size, 1e-3)[1 + int(np.argmax(np.abs(np.fft.rfft(ring))[1:]))]
    assert frequency == pytest.approx(5.0, abs=0.5)
    assert float(np.max(ring)) == pytest.approx(10.0, rel=0.05)
    assert float(np.max(np.abs(force[: start - 5]))) < 1e-9


def test_crosstalk_knows_nothing_of_the_motion(flat_motion: Flat, added: Added) -> None:
    time = np.linspace(0.0, 100.0, 10001)
    motion = flat_motion(time, 0.01 + 0.005 * np.sin(2.0 * np.pi * 0.3 * time))
    force = added(LateralCrosstalk(30.0, 0.2, 7), motion)
    assert float(np.std(force)) == pytest.approx(30.0, rel=1e-6)
    assert abs(float(np.corrcoef(force, motion.deflection)[0, 1])) < 0.2


def test_a_clipped_gauge_shows_its_end_while_the_force_goes_on(sine_motion: Sine) -> None:
    motion = sine_motion(0.2)
    bench = Bench(article_tire(), (ClippedGauge(0.2, 0.025),))
    assert float(np.max(bench.shown(motion.deflection))) == pytest.approx(0.02)
    assert bench.force(motion) == pytest.approx(Bench(article_tire()).force(motion))


def test_a_wavy_gauge_stays_monotonic_and_true_at_zero() -> None:
    x = np.linspace(0.0, 0.025, 5001)
    shown = WavyGauge(2e-4, 0.004, 0.7).reading(x)
    assert shown[0] == pytest.approx(0.0, abs=1e-12)
    assert np.all(np.diff(shown) > 0.0)
    assert float(np.ptp(shown - x)) == pytest.approx(4e-4, rel=1e-3)


def test_a_coarse_gauge_writes_whole_steps_of_their_known_variance() -> None:
    """A step q adds the variance (k q)^2 / 12 to every coefficient of the force's cosine transform."""
    rng = np.random.default_rng(2)
    coarse = CoarseInstrument(white=1.0, gauge_step=20e-6)
    true = np.linspace(0.0, 0.02, 40_000)
    read = coarse.read(rng, true)
    assert read / 20e-6 == pytest.approx(np.round(read / 20e-6), abs=1e-6)
    assert float(np.std(read - true)) == pytest.approx(20e-6 / math.sqrt(12.0), rel=0.01)
    more = coarse.spectrum(50, 0.1, 1e5) - Instrument(white=1.0).spectrum(50, 0.1, 1e5)
    assert more == pytest.approx((1e5 * 20e-6) ** 2 / 12.0)
