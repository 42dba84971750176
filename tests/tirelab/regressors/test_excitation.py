"""What the channels show of simulated presses: leak, compressed air and set pressures told apart before any fit.

What a motion can show: from drives whose answer is plain.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from numpy.typing import NDArray
from radialtire import CATALOGUE, PowerLaw, TireModel
from tirelab.recordings.recording import Recording
from tirelab.regressors.dataset import dataset_of
from tirelab.regressors.excitation import Excitation, excitation_of, misread
from tirelab.regressors.signature import candidates, signatures_of
from tirelab.simulation.simulate import simulate

FloatArray = NDArray[np.float64]

LAW = TireModel(PowerLaw(550.9, 1.422), tested_range=None)
SET = 3e5


def pressed(
    pressure: FloatArray | None, *, temperature: FloatArray | None = None, name: str = "press"
) -> Recording:
    """A press of 1 min, 6 cycles of 24 mm, whose force is in proportion to the pressure."""
    time = np.linspace(0.0, 60.0, 1500)
    x = 0.012 * (1.0 - np.cos(0.2 * np.pi * time))
    air = np.ones_like(time) if pressure is None else pressure / SET
    force = 550.9 * (100.0 * x) ** 1.422 * air + np.random.default_rng(3).normal(0.0, 4.0, time.size)
    flat = np.full(time.size, np.inf)
    return Recording(name, time, x, flat, force, pressure=pressure, temperature=temperature)


def shown(*recordings: Recording) -> Excitation:
    return excitation_of(dataset_of(recordings, LAW))


TIME = np.linspace(0.0, 60.0, 1500)
DEPTH = 0.012 * (1.0 - np.cos(0.2 * np.pi * TIME)) / 0.024
GAUGE = np.random.default_rng(5).normal(0.0, 100.0, TIME.size)


def test_without_a_channel_nothing_that_needs_it_can_be() -> None:
    found = shown(pressed(None))
    assert found.channels.impossible == {"inflation_pressure"}
    assert not found.channels.unvaried


def test_a_constant_pressure_refutes_what_would_change_it() -> None:
    found = shown(pressed(SET + GAUGE))
    assert {"pressure_leak", "gas_compression", "warm_up"} <= found.channels.impossible
    reason = found.hidden("inflation_pressure")
    assert "was the same" in reason
    # what stands behind the colon is told alone, as what to do next
    assert reason.endswith(": record at a second pressure")
    assert not found.channels.varied


def test_pressures_that_were_set_are_known_to_vary() -> None:
    found = shown(*(pressed(part * SET + GAUGE, name=f"{part}") for part in (0.7, 1.0, 1.3)))
    assert found.channels.varied == {"pressure"}


@pytest.mark.parametrize(
    ("course", "right", "wrong"),
    [
        (-0.05 * TIME / 60.0, "pressure_leak", {"gas_compression", "warm_up"}),
        (0.03 * DEPTH**2.4, "gas_compression", {"pressure_leak", "warm_up"}),
        (0.04 * (1.0 - np.exp(-TIME / 20.0)), "warm_up", {"pressure_leak", "gas_compression"}),
    ],
    ids=["falls with time", "rises with the deflection", "rises to a level"],
)
def test_the_course_of_the_pressure_tells_its_causes_apart(
    course: FloatArray, right: str, wrong: set[str]
) -> None:
    found = shown(pressed(SET * (1.0 + course) + GAUGE))
    assert right not in found.channels.impossible
    assert wrong <= found.channels.impossible
    # a pressure that only followed one of them was not set: its own gain is not shown
    assert found.hidden("inflation_pressure")


def test_a_pressure_that_swings_with_the_direction_is_no_setting() -> None:
    swing = 0.04 * np.sign(np.sin(0.2 * np.pi * TIME))
    found = shown(pressed(SET * (1.0 + swing) + GAUGE))
    assert found.hidden("inflation_pressure")


def test_recordings_at_two_pressures_show_what_the_pressure_does() -> None:
    found = shown(pressed(SET + GAUGE, name="a"), pressed(0.8 * SET + GAUGE, name="b"))
    assert not found.hidden("inflation_pressure")
    assert "inflation_pressure" not in found.channels.impossible


def test_a_tire_that_kept_its_temperature_has_not_warmed() -> None:
    still = np.full(TIME.size, 293.0)
    assert "temperature was the same" in shown(pressed(None, temperature=still)).hidden("warm_up")
    warming = 293.0 + 8.0 * TIME / 60.0
    assert not shown(pressed(None, temperature=warming)).hidden("warm_up")


def recorded(time: np.ndarray, x: np.ndarray, radius: float = np.inf) -> Recording:
    silent = Recording("drive", time, x, np.full(time.size, radius), np.zeros(time.size))
    noise = np.random.default_rng(2).normal(size=time.size)
    return Recording("drive", time, x, silent.surface_radius, simulate(TireModel(), silent) + noise)


def triangle(cycles: int, seconds: float = 20.0) -> Recording:
    time = np.arange(0.0, cycles * seconds, 0.02)
    phase = (time / seconds) % 1.0
    return recorded(time, 0.02 * np.minimum(2.0 * phase, 2.0 - 2.0 * phase))


def excitation(*recordings: Recording) -> Excitation:
    return excitation_of(dataset_of(recordings, TireModel()))


def of_trait(trait: str) -> list[str]:
    return [name for name, effect in CATALOGUE.items() if trait in effect.traits]


def test_one_triangle_shows_nothing_that_is_slow() -> None:
    shown = excitation(triangle(1))
    assert shown.returns == pytest.approx(0.0, abs=1e-12)
    assert set(shown.reasons(of_trait("slow"))) == set(of_trait("slow"))


def test_a_hold_in_which_the_deflection_creeps_shows_nothing_that_is_slow() -> None:
    """The end of the way in is passed for 40 s, a tenth of it on and on, with a gauge that trembles: one visit."""
    time = np.arange(0.0, 60.0, 0.02)
    x = np.interp(time, [0.0, 5.0, 45.0, 50.0, 60.0], [0.0, 0.018, 0.02, 0.001, 0.001])
    x += 2e-6 * np.random.default_rng(3).normal(size=time.size)
    shown = excitation(recorded(time, x))
    assert set(shown.reasons(of_trait("slow"))) == set(of_trait("slow"))


def test_three_triangles_show_what_is_slow() -> None:
    # Three visits of each deflection, 20 s apart: a variance of 2/3 x 20^2 s^2 of 60^2 / 12 s^2 in all.
    shown = excitation(triangle(3))
    assert shown.returns == pytest.approx(8.0 / 9.0, rel=0.05)
    assert shown.reasons(of_trait("slow")) == {}


def test_triangles_of_one_speed_do_not_tell_loops_apart_and_of_two_they_do() -> None:
    loops = of_trait("loop")
    assert set(excitation(triangle(2)).alike(loops[0])) == set(loops[1:])
    assert excitation(triangle(2), triangle(2, seconds=2.0)).alike(loops[0]) == ()


def test_without_time_nothing_of_time_or_rate_is_shown() -> None:
    shown = excitation_of(dataset_of([triangle(3)], TireModel()), timed=False)
    assert set(shown.reasons(list(CATALOGUE))) == {*of_trait("slow"), *of_trait("rate")}


def test_on_one_surface_a_law_could_be_all_that_is_static() -> None:
    one = excitation(triangle(1))
    read = [n for n, effect in CATALOGUE.items() if effect.reads is not None]
    assert [n for n in CATALOGUE if one.within_law(n)] == [n for n in of_trait("static") if n not in read]
    r = triangle(1)
    two = excitation(r, recorded(r.time, r.deflection, 0.3))
    assert not any(two.within_law(n) for n in CATALOGUE)


def test_what_is_a_function_of_the_deflection_in_this_motion_is_within_the_law_too() -> None:
    motion = replace(excitation(triangle(1)), single_valued=frozenset({"inertia"}))
    assert motion.within_law("inertia")
    assert not motion.within_law("viscous_damping")
    assert not replace(motion, surfaces=2).within_law("inertia")
    assert motion.of_deflection("bottoming")


def test_in_a_single_pull_at_one_speed_everything_is_a_function_of_the_deflection() -> None:
    """One ramp; two of them pass each deflection twice, and so does one with its way back; one holds, one is quicker in
    the end.
    """
    time = np.arange(0.0, 20.0, 0.02)
    pull = recorded(time, 1e-3 * time)
    assert all(excitation(pull).of_deflection(n) for n in CATALOGUE)
    quick = recorded(0.2 * time, 1e-3 * time)
    held = recorded(time, 1e-3 * np.minimum(time, 15.0))
    jump = recorded(time, 1e-3 * np.where(time < 15.0, 0.2 * time, 3.0 + 3.4 * (time - 15.0)))
    for shown in (excitation(pull, quick), *map(excitation, (triangle(1), held, jump))):
        assert not shown.of_deflection("viscous_damping")


def misread_in(recording: Recording) -> frozenset[str]:
    data = dataset_of([recording], TireModel())
    return misread(signatures_of(candidates(), data), data.read_anew([recording]))


def test_the_acceleration_of_a_slow_press_is_the_rounding_of_its_gauge() -> None:
    """A hundred samples pass 169 steps: the roundings make a wave, which a spline follows."""
    slow = triangle(2, seconds=23.7)
    read = recorded(slow.time, 2e-5 * np.round(slow.deflection / 2e-5))
    assert misread_in(read) == {"inertia"}
    assert misread_in(slow) == frozenset()


def test_a_quick_motion_shows_its_acceleration_through_the_same_gauge() -> None:
    time = np.arange(0.0, 4.0, 0.001)
    x = 0.01 * (1.0 - np.cos(2.0 * np.pi * 4.0 * time))
    assert misread_in(recorded(time, 2e-5 * np.round(x / 2e-5))) == frozenset()
