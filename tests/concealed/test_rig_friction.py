"""Friction of the rig: closed forms of one element, independence of rate, memory."""

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest
from concealed.effects import BoucWenFriction, Effect, IwanFriction
from concealed.effects.friction import jenkins
from concealed.motion import FloatArray, Motion

MakeMotion = Callable[..., Motion]
Added = Callable[[Effect, Motion], FloatArray]
Area = Callable[[Motion, FloatArray], float]

IWAN = IwanFriction(50.0, 1e-3, 0.6, 1.0, 2000.0)
BOUC_WEN = BoucWenFriction(50.0, 1e-3, 1.8, 0.4, 1.0, 2000.0)


def test_one_element_loses_what_its_parallelogram_encloses() -> None:
    """Stroke X, reach r: z runs from -1 to 1 over 2 r, so the loop encloses 2 (X - 2 r)."""
    stroke, reach = 0.02, 0.003
    x = stroke * (0.5 - 0.5 * np.cos(np.linspace(0.0, 6.0 * np.pi, 6001)))
    z = jenkins(x, np.array([reach]))[0]
    last = slice(4000, 6001)
    area = np.sum(0.5 * (z[last][1:] + z[last][:-1]) * np.diff(x[last]))
    assert area == pytest.approx(2.0 * (stroke - 2.0 * reach), rel=1e-4)


def test_a_closed_minor_loop_leaves_no_trace() -> None:
    """Return-point memory: back at the turning point the state is the one that was left."""
    path = np.concatenate([np.linspace(0.0, 0.02, 200), np.linspace(0.02, 0.018, 50)[1:]])
    path = np.concatenate([path, np.linspace(0.018, 0.02, 50)[1:]])
    states = jenkins(path, np.array([0.0005, 0.003, 0.01, 0.05]))
    assert states[:, -1] == pytest.approx(states[:, 199], abs=1e-12)


@pytest.mark.parametrize(
    ("exponent", "limit"), [(1.0, lambda s: -np.expm1(-s)), (2.0, np.tanh)], ids=["exponential", "tanh"]
)
def test_first_loading_of_bouc_wen_has_closed_forms(
    exponent: float, limit: Callable[[FloatArray], FloatArray], flat_motion: MakeMotion, added: Added
) -> None:
    """With z' = (1 - z^n)/r: z = 1 - exp(-x/r) for n = 1, tanh(x/r) for n = 2; the steps err by 0.2 %."""
    x = np.linspace(0.0, 0.02, 2001)
    effect = BoucWenFriction(40.0, 2e-3, exponent, 0.5, 0.0, 2000.0)
    force = added(effect, flat_motion(np.arange(2001) * 0.01, x))
    deep = x > 3e-3
    assert force[deep] == pytest.approx(40.0 * limit(x / 2e-3)[deep], rel=2e-3)


@pytest.mark.parametrize("effect", [IWAN, BOUC_WEN], ids=["iwan", "bouc-wen"])
def test_the_loop_is_the_same_at_every_rate(
    effect: Effect, sine_motion: MakeMotion, added: Added, loop_area: Area
) -> None:
    """Nothing of the rate may enter: 0.05, 0.5 and 5 Hz, the frequencies of the table of look-alikes."""
    areas = []
    for frequency in (0.05, 0.5, 5.0):
        motion = sine_motion(frequency)
        areas.append(loop_area(motion, added(effect, motion)))
    assert areas[0] > 0.0
    assert areas[1:] == pytest.approx(areas[:1] * 2, rel=1e-9)


@pytest.mark.parametrize("effect", [IWAN, BOUC_WEN], ids=["iwan", "bouc-wen"])
def test_load_proportional_friction_follows_the_load(
    effect: Effect, sine_motion: MakeMotion, added: Added, bench: object
) -> None:
    """Sliding at full slip, F = f F_e/F_ref: the branches of load and unload differ by twice that."""
    motion = sine_motion(0.1)
    force = added(effect, motion)
    at = int(np.argmin(np.abs(motion.deflection[-4001:-2001] - 0.0125)))
    up, down = force[-4001 + at], force[-1 - at]
    elastic = 550.9 * 1.25**1.422
    assert up - down == pytest.approx(2.0 * 50.0 * elastic / 2000.0, rel=0.02)


def test_the_articles_hysteresis_lies_within_reach(sine_motion: MakeMotion, added: Added) -> None:
    """100 N between loading and unloading at a peak of 1540 N, 6.5 % (Hull, Wang & Moore 1996)."""
    effect = replace(IWAN, load_share=0.0).with_strength(50.0)
    motion = sine_motion(1.0 / 30.0)
    force = added(effect, motion)[-4001:]
    assert float(np.ptp(force)) == pytest.approx(100.0, rel=0.02)
    assert effect.limit >= 50.0
