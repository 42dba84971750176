"""Trials of the wide kinds: drawn on request only, of the sizes asked for, with answers that are fair."""

import math
import os
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from concealed import IN_TURN, KINDS, WIDE_KINDS, Trial, answer_json, derived_right, draw
from concealed.effects import BY_NAME
from concealed.regressors import NAMES
from concealed.wide.drawing import LACKING
from concealed.wide.foreign import FOREIGN
from concealed.wide.outside import OUTSIDE
from concealed.wide.press import fitted_power_law
from scipy.optimize import curve_fit

COUNT = 3
DRAWN = [pytest.param(kind, marks=pytest.mark.slow) if kind in LACKING else kind for kind in WIDE_KINDS]
"""The kinds; trials of what the rig has no name for are drawn again so often that they take longest."""

Drawn = Callable[[str], list[Trial]]


@pytest.fixture(scope="module")
def drawn() -> Drawn:
    """Some trials of a kind, drawn once."""
    kept: dict[str, list[Trial]] = {}

    def of(kind: str) -> list[Trial]:
        if kind not in kept:
            kept[kind] = [draw(seed, kind=kind) for seed in range(300, 300 + COUNT)]
        return kept[kind]

    return of


def test_wide_kinds_are_never_drawn_unasked() -> None:
    assert IN_TURN == ("loud", "press", "foreign", "outside", "beside")
    assert WIDE_KINDS == ("loud", "press", "foreign", "outside", "pressure", "beside", "set", "drift")
    assert not set(WIDE_KINDS) & set(KINDS)
    assert sum(KINDS.values()) == pytest.approx(1.0)


@pytest.mark.parametrize("kind", DRAWN)
def test_the_same_seed_gives_the_same_wide_trial(drawn: Drawn, kind: str) -> None:
    one = drawn(kind)[0]
    other = draw(one.seed, kind=kind)
    assert answer_json(one) == answer_json(other)
    assert all(np.array_equal(a.force, b.force) for a, b in zip(one.train, other.train, strict=True))
    assert one.answer.kind == kind


@pytest.mark.parametrize("kind", DRAWN)
def test_the_true_set_comes_first_and_held_out_tests_are_of_both_sorts(drawn: Drawn, kind: str) -> None:
    own = {"pressure": {"inflation_pressure"}, "set": {"permanent_set"}, "drift": {"deflection_drift"}}.get(
        kind, set()
    )
    beside = {"recalibration", *own}
    for trial in drawn(kind):
        truth = set(trial.answer.right[0]) - {"none", "unknown"}
        hidden = {e.name for e in trial.bench.effects if e.name in NAMES}
        assert hidden <= truth <= hidden | beside
        assert len(set(trial.answer.right)) == len(trial.answer.right)
        assert derived_right(trial) == trial.answer.right
        shown = {r.excitation for r in trial.train}
        assert trial.heldout[-1].excitation in shown
        assert any(r.excitation not in shown for r in trial.heldout)


def test_loud_effects_are_thirty_to_a_thousand_times_the_noise(drawn: Drawn) -> None:
    for trial in drawn("loud"):
        sizes = [s.raw for name, s in trial.answer.sizes.items() if name != "recalibration"]
        assert all(0.95 * 30.0 < size < 1.1 * 1000.0 for size in sizes)
        assert trial.answer.sizes
        assert all(type(e) in BY_NAME[e.name] for e in trial.bench.effects)


def test_foreign_forms_have_the_name_of_their_family(drawn: Drawn) -> None:
    for trial in drawn("foreign"):
        for effect in trial.bench.effects:
            assert type(effect) in FOREIGN
            assert trial.answer.right[0] == (effect.name,)
        assert trial.bench.effects or trial.answer.right[0] == ("recalibration",)
        assert 0.0 <= trial.answer.truth_leaves <= 0.5  # type: ignore[attr-defined]


def test_outside_the_catalogue_no_name_is_right_but_unknown_and_another_tires(drawn: Drawn) -> None:
    assert not {form.name for form in OUTSIDE} & set(NAMES)
    for trial in drawn("outside"):
        assert len(trial.bench.effects) == 1
        assert type(trial.bench.effects[0]) in OUTSIDE
        assert all("unknown" in names for names in trial.answer.right)
        assert set().union(*trial.answer.right) <= {"unknown", "recalibration"}


def test_a_known_effect_stands_beside_an_unknown_one_of_its_own_order(drawn: Drawn) -> None:
    for trial in drawn("beside"):
        known, unknown = trial.bench.effects
        assert type(known) in BY_NAME[known.name]
        assert type(unknown) in OUTSIDE
        assert all({known.name, "unknown"} <= set(names) for names in trial.answer.right)
        sizes = trial.answer.sizes
        assert sizes[unknown.name].raw >= 0.95 * 0.2 * 10.0
        # sizes are of effects together, after two rounds of resizing
        assert sizes[unknown.name].raw <= 2.4 * sizes[known.name].raw


def test_a_first_file_is_one_file_of_few_triangles_at_one_speed(drawn: Drawn) -> None:
    for trial in drawn("press"):
        (record,) = trial.train
        (motion,) = trial.motions
        turns = np.count_nonzero(np.diff(np.sign(np.diff(motion.deflection[:: motion.stride]))) != 0)
        surfaces = len(motion.surfaces)
        assert surfaces <= 3
        assert turns <= 6 * 3 * surfaces
        speeds = np.abs(motion.rate)
        assert np.mean(np.abs(speeds / np.median(speeds) - 1.0) < 0.02) > 0.9
        step = getattr(trial.instrument, "gauge_step", 0.0)
        if step:
            assert record.deflection / step == pytest.approx(np.round(record.deflection / step), abs=1e-5)
        if trial.instrument.quantum:
            ratio = record.force / trial.instrument.quantum
            assert ratio == pytest.approx(np.round(ratio), abs=1e-5)


def test_every_right_answer_of_a_first_file_has_its_twin_with_a_refitted_law(drawn: Drawn) -> None:
    for trial in drawn("press"):
        right = {frozenset(names) - {"none"} for names in trial.answer.right}
        assert right == {names ^ {"recalibration"} for names in right}


def test_the_baseline_of_a_first_file_is_its_own_power_law(drawn: Drawn) -> None:
    """A second formulation: scipy's curve_fit for least squares of F, the closed form of a line for ln F."""
    record = next(t.train[0] for t in drawn("press") if len(t.motions[0].surfaces) == 1)
    x = 100.0 * record.deflection
    used = (x > 0.01) & (record.force > 0.03 * record.force.max())
    (linear,) = fitted_power_law((record,), logarithmic=False).surfaces
    (a, b), _ = curve_fit(lambda x, a, b: a * x**b, x[used], record.force[used], p0=(500.0, 1.4))
    assert (linear.a, linear.b) == pytest.approx((a, b), rel=1e-4)
    (logarithmic,) = fitted_power_law((record,), logarithmic=True).surfaces
    u, v = np.log(x[used]), np.log(record.force[used])
    slope = float(np.cov(u, v, bias=True)[0, 1] / np.var(u))
    assert logarithmic.b == pytest.approx(slope)
    assert math.log(logarithmic.a) == pytest.approx(float(v.mean() - slope * u.mean()))


def test_the_rule_of_the_other_kinds_is_kept_and_the_fits_are_counted_beside_it() -> None:
    """At one constant rate every loop is right by the rule; by the fits some differ."""
    trial = draw(12, kind="single")
    assert trial.answer.rule == "one constant rate on one surface"
    derived = derived_right(trial)
    assert derived[0] == trial.answer.right[0]
    assert set(derived) != set(trial.answer.right)


@pytest.mark.parametrize("kind", ["press", "foreign"])
def test_a_wide_trial_is_the_same_in_another_process(drawn: Drawn, repository: Path, kind: str) -> None:
    """Neither the order of sets of strings nor anything else of a process may enter the answer."""
    one = drawn(kind)[1]
    program = (
        f"import concealed; print(concealed.answer_json(concealed.draw({one.seed}, kind={kind!r})), end='')"
    )
    env = {**os.environ, "PYTHONHASHSEED": "1", "PYTHONPATH": str(repository / "fmu_src")}
    there = subprocess.run(
        [sys.executable, "-c", program], env=env, capture_output=True, text=True, check=True, timeout=120
    )
    assert there.stdout == answer_json(one)
