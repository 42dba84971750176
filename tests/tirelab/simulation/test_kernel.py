"""The loops of the kernel, uncompiled and compiled, against loops and formulas typed a second time."""

from __future__ import annotations

import math

import numpy as np
import pytest
from numpy.typing import NDArray
from radialtire import CATALOGUE, Effect, Instant, tracking
from tirelab.simulation import kernel
from tirelab.simulation.compiled import loop

COUNT = 200


def history(seed: int) -> tuple[NDArray[np.float64], ...]:
    """Time, deflection, rate, acceleration, A, B, elastic force, curvature, pressure and temperature of a motion; one
    sample is repeated.
    """
    random = np.random.default_rng(seed)
    time = 3.0 + np.cumsum(random.uniform(1e-3, 0.02, COUNT))
    time[50] = time[49]
    deflection = 0.008 + 0.01 * np.sin(9.0 * time)
    A, B = np.full(COUNT, 550.9), np.full(COUNT, 1.422)
    elastic = A * np.maximum(100.0 * deflection, 0.0) ** B
    return (
        time,
        deflection,
        0.09 * np.cos(9.0 * time),
        -0.81 * np.sin(9.0 * time),
        A,
        B,
        elastic,
        np.linspace(-2.0, 12.0, COUNT),
        np.linspace(2e5, 4e5, COUNT),
        np.linspace(290.0, 310.0, COUNT),
    )


def by_hand(
    effect: Effect, signal: NDArray[np.float64], known: tuple[NDArray[np.float64], ...]
) -> list[float]:
    """The effect's signal, sample by sample, from plain floats and named fields."""
    time, deflection, rate, acceleration, A, B, elastic, curvature, *channels = (a.tolist() for a in known)
    state, answer = effect.initial_state, []
    for i, given in enumerate(signal.tolist()):
        instant = Instant(
            time=time[i] - time[0],
            interval=time[i] - time[i - 1] if i else 0.0,
            first=i == 0,
            deflection=deflection[i],
            rate=rate[i],
            acceleration=acceleration[i],
            coefficient=A[i],
            exponent=B[i],
            elastic_force=elastic[i],
            curvature=curvature[i],
            pressure=channels[0][i],
            temperature=channels[1][i],
        )
        found, state = effect.respond(given, instant, state, effect.nominal)
        answer.append(found)
    return answer


@pytest.mark.parametrize("effect", CATALOGUE.values(), ids=list(CATALOGUE))
def test_the_compiled_loop_responds_as_the_effect_does(effect: Effect) -> None:
    known = history(1)
    signal = {"deflection": known[1], "series": known[1], "scale": np.ones(COUNT)}.get(effect.place, known[6])
    expected, answer = by_hand(effect, signal, known), np.empty(COUNT)
    loop("respond_loop", effect.name, effect.respond)(
        signal, known, effect.initial_state, effect.nominal, answer, (False, np.zeros(answer.size))
    )
    # the same operations: what differs is the rounding of a power or an exponential
    assert answer == pytest.approx(expected, rel=1e-12, abs=1e-12 * np.max(np.abs(expected)))


def test_the_loop_as_it_stands_has_no_effect() -> None:
    # uncompiled the kernel's `respond` only stands for that of an effect
    known = history(2)
    answer = np.empty(COUNT)
    kernel.respond_loop(known[1], known, (), (1e-3,), answer, (False, np.zeros(answer.size)))
    assert np.array_equal(answer, known[1])


@pytest.mark.parametrize("compiled", [False, True])
def test_the_elastic_loop_is_the_power_law(compiled: bool) -> None:
    _, deflection, _, _, A, B, elastic, *_ = history(3)
    answer = np.empty(COUNT)
    (loop("elastic_loop", "law") if compiled else kernel.elastic_loop)(deflection, A, B, answer, False)
    assert (deflection < 0.0).any()
    assert answer == pytest.approx(elastic, rel=1e-14)


@pytest.mark.parametrize("compiled", [False, True])
@pytest.mark.parametrize("noise", [0.0, 8e-6])
def test_the_track_loop_follows_sample_by_sample(compiled: bool, noise: float) -> None:
    time, deflection, *_ = history(4)
    rates, accelerations = np.empty(COUNT), np.empty(COUNT)
    (loop("track_loop", "track") if compiled else kernel.track_loop)(
        time, deflection, noise, rates, accelerations
    )
    track, last = tracking.begin(float(deflection[0])), float(time[0])
    for i, (t, x) in enumerate(zip(time.tolist(), deflection.tolist(), strict=True)):
        if t > last:  # the repeated sample leaves the track as it is
            track = tracking.follow(track, t - last, x, noise)
        last = t
        assert rates[i] == pytest.approx(tracking.rate(track), rel=1e-9, abs=1e-12)
        assert accelerations[i] == pytest.approx(tracking.acceleration(track), rel=1e-9, abs=1e-9)


def test_a_parabola_is_tracked_exactly() -> None:
    # x = x0 + v t + a t^2 / 2 at even intervals, free of noise: its own rate and acceleration
    time = 0.01 * np.arange(60.0)
    rates, accelerations = np.empty(60), np.empty(60)
    loop("track_loop", "track")(time, 0.001 + 0.02 * time + 0.15 * time**2, 0.0, rates, accelerations)
    assert rates[20:] == pytest.approx(0.02 + 0.3 * time[20:], rel=1e-6)
    assert accelerations[20:] == pytest.approx(0.3, rel=1e-4)
    assert math.isclose(rates[0], 0.0)
