"""What a motion can show: from drives whose answer is plain."""

from __future__ import annotations

import numpy as np
import pytest
from radialtire import CATALOGUE, TireModel
from tirelab.recordings.recording import Recording
from tirelab.regressors.dataset import dataset_of
from tirelab.regressors.excitation import Excitation, excitation_of
from tirelab.simulation.simulate import simulate


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
    # Only the time within one of a way's twelve cells: (1 / 24)^2 of all.
    assert shown.returns == pytest.approx(1.0 / 576.0, rel=0.05)
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
