"""The score of recording plans."""

import math

import concealed
import numpy as np
import pytest
from concealed.__main__ import trial_seed
from tirelab.planning.menu import drive_of
from tirelab.planning.rig import Rig
from tirelab.validation.plans import (
    TIME,
    outcome_of,
    ratio_interval,
    rig_of,
    right_sets,
    slow_instead,
    slow_on_one,
    summary,
)


def test_slow_triangles_take_the_same_time_on_the_same_surface() -> None:
    rig = Rig(surfaces=(0.254,), time=60.0)
    for name in ("ramp and hold", "sweep"):
        drive = drive_of(name, 0.25, 0.254, rig)
        slow = slow_instead(drive, rig)
        assert slow.duration == drive.duration
        assert np.array_equal(slow.surface_radius, drive.surface_radius)
        assert slow.fastest < 0.1 * rig.speed
        assert slow.deflection.max() > 0.95 * rig.stroke


def test_the_rig_is_that_of_the_trial() -> None:
    trial = concealed.draw(trial_seed(5, 1), kind="single")
    rig = rig_of(trial)
    radii = np.unique(np.concatenate([r.radius for r in trial.train]))
    assert set(rig.surfaces) <= set(radii.tolist())
    assert rig.stroke <= max(float(r.deflection.max()) for r in trial.train)
    assert (rig.noise, rig.time) == (trial.noise, TIME)


def test_a_stop_beyond_the_stroke_counts_as_nothing_hidden() -> None:
    """Slow triangles from half of the depth at which the stop begins, and from the whole depth."""
    trial = concealed.draw(trial_seed(40112358, 7), kind="single")
    assert trial.answer.right[0] == ("bottoming",)
    radius = float(trial.train[0].radius[0])
    (begin, *_) = (where["from"] for where in trial.answer.where if where["effect"] == "bottoming")
    assert isinstance(begin, float)
    depth = max(float(r.deflection.max()) for r in trial.train)
    for stroke, hidden in ((0.5 * begin, False), (depth, True)):
        rig = Rig(stroke=stroke, surfaces=(radius,), time=60.0, noise=trial.noise)
        sets = right_sets(trial, [drive_of("slow triangles", 0.125, radius, rig)])
        assert sets[0] == {"bottoming"}
        assert (frozenset() not in sets) is hidden


def test_slow_triangles_on_one_surface_are_one_recording() -> None:
    rig = Rig(surfaces=(math.inf, 0.254), time=60.0)
    slow = slow_on_one(rig, 45.0)
    assert slow.duration == pytest.approx(45.0, abs=2.0 * rig.sampling)
    assert set(slow.surface_radius) == {math.inf}
    assert slow.fastest < 0.1 * rig.speed


def test_the_summary_counts() -> None:
    outcomes = (("right", "wrong"), ("right", "undecided"), ("wrong", "wrong"), ("right", "right"))
    rows = [
        {"planned": ([], 0.9, one), "triangles": ([], 0.9, other), "one surface": ([], 0.9, "wrong")}
        for one, other in outcomes
    ]
    planned, triangles, alone, *ratios = summary(rows)
    assert "3 right, 1 wrong, 0 undecided of 4 after the plan" in planned
    assert "1 right, 2 wrong, 1 undecided of 4 after slow triangles of its lengths" in triangles
    assert "0 right, 4 wrong, 0 undecided of 4" in alone
    assert [float(r.split(": ")[1].split()[0]) for r in ratios] == [0.33, 0.25]


def test_the_interval_of_a_ratio_shares_the_trials() -> None:
    """Missed together, the ratio is 1 however few the trials; by chance, it is as wide as the counts make it."""
    both = [True] * 3 + [False] * 5
    assert ratio_interval(both, both) == (1.0, 1.0)
    assert ratio_interval([False] * 8, both)[0] == 0.0
    # The logarithm of the ratio of two multinomial counts of 100 has the variance 2 / 100.
    low, high = ratio_interval([True] * 100 + [False] * 900, [False] * 900 + [True] * 100)
    assert np.log(high / low) == pytest.approx(2.0 * 1.96 * math.sqrt(2.0 / 100.0), rel=0.15)


def test_a_verdict_beside_a_likely_alternative_is_undecided() -> None:
    """By hand: right or wrong by its name alone, undecided below a half or beside what has half of its probability."""
    friction, damping, both = (
        frozenset({"friction"}),
        frozenset({"damping"}),
        frozenset({"friction", "damping"}),
    )
    right = (friction, both)
    for names, confidence, alternatives, expected in (
        (friction, 0.9, [], "right"),
        (both, 0.9, [(damping, 0.1)], "right"),
        (damping, 0.9, [(friction, 0.1)], "wrong"),
        (friction, 0.49, [], "undecided"),
        (friction, 0.6, [(damping, 0.31)], "undecided"),
        (friction, 0.6, [(damping, 0.29)], "right"),
        (friction, 0.6, [(both, 0.4)], "right"),
        (damping, 0.6, [(friction, 0.4)], "undecided"),
        (friction, 0.6, [(damping, math.nan)], "right"),
    ):
        assert outcome_of(names, confidence, alternatives, right) == expected
