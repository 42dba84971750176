"""Series compliance, gas, leak, warming, bottoming, zeros and ceiling of the rig."""

import math
from collections.abc import Callable

import numpy as np
import pytest
from concealed.bench import Bench
from concealed.effects import (
    Effect,
    ExponentialLeak,
    GaugeZero,
    LoadCellZero,
    OrificeLeak,
    PolytropicGas,
    QuadraticRim,
    RationalClip,
    SoftClip,
    SoftplusRim,
    WarmingAir,
    YieldingWheel,
)
from concealed.motion import FloatArray, Motion
from scipy.optimize import curve_fit

MakeMotion = Callable[..., Motion]
Added = Callable[[Effect, Motion], FloatArray]


@pytest.fixture
def press(flat_motion: MakeMotion) -> Motion:
    """One slow press from 0 to 2.5 cm."""
    time = np.linspace(0.0, 15.0, 1501)
    return flat_motion(time, 0.025 * time / 15.0)


def refitted(motion: Motion, force: FloatArray) -> tuple[float, float, float]:
    """A, B and the RMS [N] that a power law leaves of a force."""
    x = 100.0 * motion.deflection

    def law(x: FloatArray, a: float, b: float) -> FloatArray:
        return np.asarray(a * x**b)

    (a, b), _ = curve_fit(law, x, force, p0=(550.0, 1.4))
    return float(a), float(b), float(np.sqrt(np.mean((force - law(x, a, b)) ** 2)))


def test_wheel_and_tire_carry_the_same_force(press: Motion, bench: Bench) -> None:
    """F(x - d) = k d (1 + d/d_h) at every sample."""
    soft = Bench(bench.tire, (YieldingWheel(1.0 / 4e5, 0.02),))
    tire = soft.contact(press).deflection
    wheel = press.deflection - tire
    force = 550.9 * (100.0 * tire) ** 1.422
    assert 4e5 * wheel * (1.0 + wheel / 0.02) == pytest.approx(force, abs=0.01)
    assert soft.force(press) == pytest.approx(force, abs=0.01)


def test_a_wheel_of_2e6_hides_in_a_and_b(press: Motion, bench: Bench) -> None:
    """It becomes A = 530, B = 1.403 and leaves 0.02 % of the peak (computed on the article's law)."""
    force = Bench(bench.tire, (YieldingWheel(1.0 / 2e6, 1e6),)).force(press)
    a, b, left = refitted(press, force)
    assert a == pytest.approx(530.0, abs=1.0)
    assert b == pytest.approx(1.403, abs=1e-3)
    assert 100.0 * left / np.max(force) == pytest.approx(0.02, abs=0.01)


def test_a_millimetre_of_offset_hides_in_a_and_b(press: Motion, bench: Bench) -> None:
    """1 mm becomes A = 634, B = 1.32 and leaves 0.6 % of the peak (computed on the article's law)."""
    force = Bench(bench.tire, (GaugeZero(1e-3),)).force(press)
    a, b, left = refitted(press, force)
    assert a == pytest.approx(634.0, abs=2.0)
    assert b == pytest.approx(1.32, abs=0.01)
    assert 100.0 * left / np.max(force) == pytest.approx(0.6, abs=0.15)


def test_a_millimetre_of_offset_is_22_newtons_of_preload(press: Motion, bench: Bench) -> None:
    """The article: "a preload of 22 N ... would be enough to account for the offset" of 1 mm."""
    force = Bench(bench.tire, (GaugeZero(1.04e-3),)).force(press)
    assert force[0] == pytest.approx(22.0, abs=1.0)


def test_gas_follows_the_polytropic_law(press: Motion) -> None:
    """At 25 mm a volume loss e gives p_abs/(1 - e)^n; in gauge over the inflation of 344.7 kPa."""
    ratio = PolytropicGas(0.05, 1.3, 2.5, 0.335).gas_ratio(np.array([0.0, 0.025]), np.full(2, math.inf))
    expected = ((344.7 + 101.3) / 0.95**1.3 - 101.3) / 344.7
    assert np.asarray(ratio) == pytest.approx([1.0, expected], rel=1e-12)


def test_a_healthy_tire_compresses_by_a_few_percent() -> None:
    """Work against pressure: 20.9 J at 344.7 kPa out of 3.7 litres, so 2 to 3 % of gauge pressure."""
    energy = 550.9 * 2.5**2.422 / 2.422 / 100.0
    fraction = energy / 344.7e3 / (math.pi * 0.62 * math.pi * 0.0245**2)
    for index, percent in ((1.0, 2.2), (1.4, 3.1)):
        gas = PolytropicGas(fraction, index, 2.5, 0.335)
        ratio = np.asarray(gas.gas_ratio(np.array([0.025]), np.array([math.inf])))
        assert 100.0 * (ratio[0] - 1.0) == pytest.approx(percent, abs=0.1)
    assert PolytropicGas.limit > fraction


def test_a_longer_patch_presses_out_more_air() -> None:
    gas = PolytropicGas(0.05, 1.0, 2.5, 0.335)
    depth = np.full(3, 0.02)
    ratio = np.asarray(gas.gas_ratio(depth, np.array([0.0127, math.inf, -0.381])))
    assert ratio[0] < ratio[1] < ratio[2]


def test_leaks_start_alike_and_only_lose(flat_motion: MakeMotion) -> None:
    """Both lose r p_0 per second at first; the orifice empties the tire at 2/r, the laminar leak never."""
    motion = flat_motion(np.linspace(0.0, 400.0, 4001), np.zeros(4001))
    laminar = np.asarray(ExponentialLeak(0.005).pressure_ratio(motion))
    orifice = np.asarray(OrificeLeak(0.005).pressure_ratio(motion))
    for ratio in (laminar, orifice):
        assert ratio[0] == 1.0
        assert (ratio[1] - ratio[0]) / 0.1 == pytest.approx(-0.005, rel=1e-3)
        assert np.all(np.diff(ratio) <= 0.0)
    assert laminar[2000] == pytest.approx(math.exp(-1.0))
    assert orifice[-1] == 0.0


def test_warm_air_gains_a_psi_for_ten_degrees_fahrenheit(flat_motion: MakeMotion) -> None:
    """Gas law at constant volume: (50 + 14.7) psi/293 K x 5.56 K = 1.23 psi ("about 1 psi" near 40 psi)."""
    motion = flat_motion(np.linspace(0.0, 1000.0, 101), np.zeros(101))
    ratio = np.asarray(WarmingAir(10.0 / 1.8, 0.5, 10.0, 60.0).pressure_ratio(motion))
    assert 50.0 * (ratio[-1] - 1.0) == pytest.approx(1.23, abs=0.01)
    assert np.all(np.diff(ratio) > 0.0)


def test_rims_end_in_a_spring(press: Motion, added: Added) -> None:
    """Far beyond the onset both have the slope k; below it neither does anything."""
    for effect in (QuadraticRim(2e5, 0.02, 0.001), SoftplusRim(2e5, 0.02, 0.0003)):
        force = added(effect, press)
        slope = (force[-1] - force[-50]) / (press.deflection[-1] - press.deflection[-50])
        assert slope == pytest.approx(2e5, rel=1e-4)
        assert np.max(force[press.deflection < 0.017]) < 0.01


def test_zeros_shift(press: Motion, added: Added, bench: Bench) -> None:
    assert added(LoadCellZero(-22.0), press) == pytest.approx(np.full(1501, -22.0))
    shifted = Bench(bench.tire, (GaugeZero(0.5e-3),)).force(press)
    assert shifted[0] == pytest.approx(550.9 * 0.05**1.422, rel=1e-9)


@pytest.mark.parametrize("form", [SoftClip, RationalClip])
def test_no_force_passes_the_ceiling(form: type[SoftClip], press: Motion, bench: Bench) -> None:
    effect = form(0.2, 2028.0, 10.0)
    force = Bench(bench.tire, (effect,)).force(press)
    plain = bench.force(press)
    assert np.max(force) <= effect.ceiling
    assert np.all(np.diff(force) >= -1e-9)
    low = plain < 0.7 * effect.ceiling
    assert force[low] == pytest.approx(plain[low], abs=0.1)


def test_a_rounded_ceiling_is_short_by_w_ln_2_at_its_corner(press: Motion) -> None:
    effect = SoftClip(0.2, 2000.0, 10.0)
    assert effect.channel(press, np.array([1600.0]))[0] == pytest.approx(1600.0 - 10.0 * math.log(2.0))


def test_unloaded_is_without_force(flat_motion: MakeMotion, bench: Bench) -> None:
    """In the air there is neither tire nor friction nor damping, only what the machine adds."""
    motion = flat_motion(np.arange(100) * 0.01, np.linspace(-0.01, -0.001, 100))
    hidden = (YieldingWheel(1e-6, 0.02), SoftplusRim(1e5, 0.02, 1e-4))
    assert not np.any(Bench(bench.tire, hidden).force(motion))
