"""The compiled simulation is the step of the FMU, sample by sample; and its stages are what a fit needs."""

from __future__ import annotations

import json
import math
import os
import subprocess
import sys
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray
from radialtire import CATALOGUE, Effect, Hull1996, PowerLaw, TireModel
from radialtire.effect import PLACES
from sampled_motion import Motion
from tirelab.preprocessing.samples import alone
from tirelab.recordings.recording import Recording
from tirelab.simulation import simulate as simulation
from tirelab.simulation.channels import channel_rows, measured_of
from tirelab.simulation.simulate import (
    coefficients,
    downstream,
    elastic_force,
    elastic_stage,
    respond_series,
    simulate,
    track,
)

FloatArray = NDArray[np.float64]

FIELDS = ("time", "deflection", "surface_radius", "force")


def stepped(tire: TireModel, motion: Motion) -> FloatArray:
    """The force by the steps of the FMU."""
    state = tire.initial_state
    force = np.empty(motion.time.size)
    channels = np.stack(channel_rows(motion.measured, force.size), axis=1).tolist()
    for i in range(force.size):
        x, R, t = motion.deflection[i], motion.surface_radius[i], motion.time[i]
        force[i], state = tire.step(float(x), float(R), float(t), state, tuple(channels[i]))
    return force


def random_motion(seed: int, count: int = 400) -> Motion:
    """A motion of three sines with noise, lift-off, uneven times and surfaces that change."""
    random = np.random.default_rng(seed)
    time = random.uniform(0.0, 1e3) + np.cumsum(random.uniform(1e-4, 0.02, count))
    x = np.full(count, random.uniform(0.0, 0.015))
    for _ in range(3):
        x += random.uniform(0.0, 0.006) * np.sin(random.uniform(0.5, 30.0) * time + random.uniform(0.0, 6.0))
    x += random.uniform(0.0, 2e-5) * random.standard_normal(count)
    radii = random.choice([math.inf, 0.0127, 0.08, 0.3, -0.4, -0.6], 5)
    measured = {
        "pressure": 3e5 + 1e5 * np.sin(time),
        "temperature": 295.0 + random.uniform(0.0, 20.0) * np.linspace(0.0, 1.0, count),
    }
    kept = random.integers(0, 2, len(measured))
    chosen = {name: values for (name, values), k in zip(measured.items(), kept, strict=True) if k}
    return Motion(time, x, np.repeat(radii, math.ceil(count / 5))[:count], chosen)


def random_values(effect: Effect, random: np.random.Generator) -> tuple[float, ...]:
    """Values around everyday ones, the extras drawn from their starts to a third of their range."""
    values = []
    for p in effect.parameters:
        if p.optional and p.neutral is None and random.random() < 0.7:
            drawn = p.start + random.uniform(0.0, 0.3) * (p.maximum - p.start)
        else:
            drawn = p.nominal_value * random.uniform(0.3, 3.0)
        values.append(min(max(p.minimum, drawn), p.maximum))
    return tuple(values)


def random_tire(names: list[str], seed: int) -> TireModel:
    random = np.random.default_rng(seed)
    effects = [(CATALOGUE[name], random_values(CATALOGUE[name], random)) for name in names]
    effects.sort(key=lambda pair: PLACES.index(pair[0].place))
    law = (
        Hull1996()
        if random.random() < 0.5
        else PowerLaw(random.uniform(100.0, 900.0), random.uniform(0.8, 1.8))
    )
    return TireModel(law, tuple(effects), reading_noise=float(random.choice([0.0, 8e-6])))


def same(tire: TireModel, motion: Motion) -> None:
    """Hold the two to 1e-12 of the largest force: the roundings of one power or exponential, not of the method."""
    expected = stepped(tire, motion)
    assert np.max(np.abs(simulate(tire, motion) - expected)) <= 1e-12 * np.max(np.abs(expected))


@pytest.mark.parametrize("name", CATALOGUE)
@pytest.mark.parametrize("seed", [1, 2, 3])
def test_one_effect_is_simulated_as_it_is_stepped(name: str, seed: int) -> None:
    same(random_tire([name], seed), random_motion(seed))


@given(st.lists(st.sampled_from(list(CATALOGUE)), unique=True, max_size=6), st.integers(0, 10_000))
@settings(max_examples=40, deadline=None)
def test_any_set_of_effects_is_simulated_as_it_is_stepped(names: list[str], seed: int) -> None:
    same(random_tire(names, seed), random_motion(seed, 150))


def test_a_bare_tire_has_its_law_on_every_surface() -> None:
    motion = random_motion(7)
    A, B = coefficients(Hull1996(), motion.surface_radius)
    loaded = np.maximum(motion.deflection, 0.0)
    # a second formulation: numpy's own power, within a few roundings
    assert elastic_force(motion.deflection, A, B) == pytest.approx(A * (100.0 * loaded) ** B, rel=1e-14)
    same(TireModel(), motion)


def test_a_surface_that_changes_at_every_sample_is_asked_for_at_every_sample() -> None:
    radius = np.linspace(0.05, 5.0, 50)
    A, B = coefficients(Hull1996(), radius)
    assert list(zip(A, B, strict=True)) == [Hull1996().coefficients(float(R)) for R in radius]


def test_one_sample_is_a_recording() -> None:
    motion = Motion(np.array([5.0]), np.array([0.01]), np.array([math.inf]))
    for name in CATALOGUE:
        same(random_tire([name], 4), motion)


def test_zero_intervals_are_looked_at_again() -> None:
    motion = random_motion(3)
    repeated = Motion(
        *(np.repeat(a, 2) for a in (motion.time, motion.deflection, motion.surface_radius)),
        {name: np.repeat(values, 2) for name, values in motion.measured.items()},
    )
    same(random_tire(list(CATALOGUE), 5), repeated)


def test_a_channel_is_found_as_an_attribute_and_absent_where_it_is_none() -> None:
    @dataclass(frozen=True)
    class Read:
        pressure: FloatArray
        temperature: None = None

    pressure = np.array([2e5, 3e5])
    assert measured_of(Read(pressure)) == {"pressure": pressure}
    assert measured_of(object()) == {}
    rows = channel_rows({"pressure": pressure}, 2)
    assert rows[0].tolist() == [2e5, 3e5]
    assert np.isnan(rows[1]).all()


@dataclass(frozen=True)
class Known:
    """Rate and acceleration of a motion."""

    rate: FloatArray
    acceleration: FloatArray


def test_a_motion_that_is_known_has_no_delay() -> None:
    time = np.arange(0.0, 2.0, 0.01)
    angle = 2.0 * np.pi * 5.0
    motion = Motion(time, 0.012 + 0.004 * np.sin(angle * time), np.full(time.size, math.inf))
    known = Known(0.004 * angle * np.cos(angle * time), -0.004 * angle**2 * np.sin(angle * time))
    tire = TireModel(
        effects=(
            (CATALOGUE["viscous_damping"], (300.0, 1.0, 0.0, 0.0, 1.0, 0.0, 0.0)),
            (CATALOGUE["inertia"], (2.0,)),
        )
    )
    elastic = simulate(TireModel(), motion)
    expected = elastic + 300.0 * known.rate + 2.0 * known.acceleration
    assert simulate(tire, motion, known) == pytest.approx(expected, rel=1e-12)
    # Without look-ahead a step of 0.3 of the angle leaves some of its third power.
    assert np.max(np.abs(simulate(tire, motion) - expected)[10:]) > 0.01 * np.max(np.abs(expected - elastic))


def test_behind_a_spring_the_rate_is_that_of_the_tire() -> None:
    time = np.arange(0.0, 2.0, 1e-3)
    motion = Motion(time, 0.01 + 0.002 * np.sin(2.0 * np.pi * time), np.full(time.size, math.inf))
    known = Known(0.004 * np.pi * np.cos(2.0 * np.pi * time), np.zeros(time.size))
    stiffness, compliance, damping = 4e4, 1e-5, 100.0
    law = PowerLaw(stiffness / 100.0, 1.0)
    series = CATALOGUE["series_compliance"]
    spring = (
        series,
        (compliance, *(p.nominal_value if not p.optional else p.start for p in series.parameters[1:])),
    )
    tire = TireModel(law, (spring, (CATALOGUE["viscous_damping"], (damping, 1.0, 0.0, 0.0, 1.0, 0.0, 0.0))))
    # Of a deflection u a linear tire behind a linear spring has u / (1 + k c), and of its rate the same part.
    part = 1.0 / (1.0 + stiffness * compliance)
    expected = part * (stiffness * motion.deflection + damping * known.rate)
    # The rate is a difference of two tries, whose rounding is a part of 1e-16 of the deflection over their time.
    assert simulate(tire, motion, known) == pytest.approx(expected, abs=1e-6 * part * damping * 0.004 * np.pi)


def test_beside_a_late_gauge_a_damper_is_a_damper_and_a_mass() -> None:
    """c d/dt (x + tau v) = c v + c tau a, however few samples a cycle has: no step tells the two apart."""
    time = np.arange(0.0, 2.0, 0.01)
    angle = 2.0 * np.pi * 20.0
    motion = Motion(time, 1e-3 * np.sin(angle * time), np.full(time.size, math.inf))
    known = Known(1e-3 * angle * np.cos(angle * time), -1e-3 * angle**2 * np.sin(angle * time))
    damper = CATALOGUE["viscous_damping"], (100.0, 1.0, 0.0, 0.0, 1.0, 0.0, 0.0)
    late, mass = (CATALOGUE["deflection_lag"], (0.02, 0.0)), (CATALOGUE["inertia"], (100.0 * 0.02,))
    bare = TireModel(PowerLaw(1e-12, 1.0), tested_range=None, two_sided=True)
    gauge, weight = (
        simulate(replace(bare, effects=e), motion, known) for e in ((late, damper), (damper, mass))
    )
    assert gauge == pytest.approx(weight, abs=1e-6 * float(np.max(np.abs(weight))))


@pytest.mark.parametrize("noise", [0.0, 2e-5])
def test_behind_what_stays_the_rate_is_that_of_the_tire(noise: float) -> None:
    """An effect before the law remembers the readings alone, not those that are tried for a rate."""
    effects = (CATALOGUE["permanent_set"], (0.3, 0.8, 0.004, 0.0)), (CATALOGUE["viscous_damping"], None)
    tire = TireModel(
        effects=tuple((e, e.nominal if v is None else v) for e, v in effects), reading_noise=noise
    )
    motion = random_motion(5)
    assert simulate(tire, motion) == pytest.approx(stepped(tire, motion), rel=1e-12, abs=1e-9)


def test_stages_can_be_kept_and_continued() -> None:
    tire = random_tire(["series_compliance", "pressure_leak", "viscous_damping", "inertia", "force_lag"], 8)
    motion = random_motion(8)
    history, force = elastic_stage(tire, motion)
    force = np.maximum(downstream(tire, history, force, ("parallel",)), 0.0)
    assert np.array_equal(downstream(tire, history, force, ("mass", "reading")), simulate(tire, motion))


@pytest.mark.parametrize(
    ("name", "linear"),
    [
        ("rate_independent_hysteresis", ("slip_force", "load_share")),
        ("viscous_damping", ("damping",)),
        ("viscoelastic_relaxation", ("share_1", "share_2", "share_3", "share_4", "share_5")),
        ("bottoming", ("stiffness",)),
        ("inertia", ("mass",)),
    ],
)
def test_what_enters_linearly_is_a_sum_of_columns(name: str, linear: tuple[str, ...]) -> None:
    # the answer to a signal of zero is the sum of value times column, within roundings
    effect = CATALOGUE[name]
    motion = random_motion(9)
    history, _ = elastic_stage(TireModel(effects=((effect, effect.nominal),)), motion)
    nothing = np.zeros_like(motion.time)
    drawn = random_values(effect, np.random.default_rng(3))
    values = {parameter.name: value for parameter, value in zip(effect.parameters, drawn, strict=True)}
    if name == "bottoming":
        values["onset"] = float(np.median(motion.deflection))
    columns = []
    for chosen in linear:
        unit = {n: (float(n == chosen) if n in linear else v) for n, v in values.items()}
        columns.append(values[chosen] * respond_series(effect, tuple(unit.values()), nothing, history))
    whole = respond_series(effect, tuple(values.values()), nothing, history)
    assert np.max(np.abs(whole)) > 0.0
    assert np.sum(columns, axis=0) == pytest.approx(whole, abs=1e-11 * np.max(np.abs(whole)))


def test_a_history_may_be_given_a_better_rate() -> None:
    # a fit that may look ahead puts in the rate it knows
    tire = TireModel(effects=((CATALOGUE["viscous_damping"], (300.0, 1.0, 0.0, 0.0, 1.0, 0.0, 0.0)),))
    motion = random_motion(10)
    history, force = elastic_stage(tire, motion)
    known = replace(history, rate=np.ones_like(force))
    loaded = motion.deflection > 0.0
    added = downstream(tire, known, force, ("parallel",)) - force
    assert added == pytest.approx(np.where(loaded, 300.0, 0.0), abs=1e-10)


def test_the_track_of_a_straight_line_is_its_slope() -> None:
    time = np.linspace(0.0, 1.0, 400)
    rate, acceleration = track(time, 0.01 + 0.02 * time, 2e-3)
    assert rate[1:] == pytest.approx(0.02, rel=1e-6)
    assert acceleration == pytest.approx(0.0, abs=1e-6)


PROGRAM = """
import json
import numpy as np
from radialtire import CATALOGUE, TireModel
from tirelab.simulation.simulate import simulate

class Motion:
    time = np.linspace(0.0, 1.0, 50)
    deflection = 0.01 + 0.005 * np.sin(9.0 * time)
    surface_radius = np.full(50, np.inf)

tire = TireModel(effects=((CATALOGUE["bottoming"], (2e5, 0.012, 2e-4, 1.0)),))
print(json.dumps(simulate(tire, Motion).tolist()))
"""


def run(folder: Path) -> list[float]:
    """The forces of PROGRAM in a fresh process that keeps what it compiles in `folder`."""
    source = Path(simulation.__file__).parents[2]
    environment = {**os.environ, "TIRELAB_CACHE": str(folder), "PYTHONPATH": str(source)}
    done = subprocess.run(
        [sys.executable, "-c", PROGRAM], env=environment, capture_output=True, text=True, check=True
    )
    assert done.stderr == ""
    found: list[float] = json.loads(done.stdout)
    return found


def test_what_was_compiled_is_kept_and_gives_the_same(tmp_path: Path) -> None:
    first = run(tmp_path)
    kept = sorted(tmp_path.rglob("*.nbc"))
    assert kept
    stamps = [path.stat().st_mtime_ns for path in kept]
    assert run(tmp_path) == first
    assert [path.stat().st_mtime_ns for path in sorted(tmp_path.rglob("*.nbc"))] == stamps


@pytest.mark.slow
def test_without_a_folder_to_keep_it_in_it_is_compiled_anew(tmp_path: Path) -> None:
    occupied = tmp_path / "file"
    occupied.write_text("not a folder")
    assert run(occupied) == run(tmp_path / "cache")


def test_a_part_of_a_file_starts_with_what_was_recorded_before_it() -> None:
    """Softening by the deepest deflection so far, and friction: both depend on all that was before."""
    given = {"mullins_softening": {"share": 0.3}, "rate_independent_hysteresis": {"slip_force": 50.0}}
    tire = TireModel(
        effects=tuple(
            (CATALOGUE[name], tuple(own.get(p.name, p.start) for p in CATALOGUE[name].parameters))
            for name, own in given.items()
        )
    )
    motion = random_motion(7)
    whole = Recording(
        "whole", motion.time, motion.deflection, motion.surface_radius, np.zeros(motion.time.size)
    )

    def cut(part: slice) -> Recording:
        return replace(whole, **{name: getattr(whole, name)[part] for name in FIELDS})

    part = replace(cut(slice(150, None)), history=cut(slice(0, 150)))
    np.testing.assert_array_equal(simulate(tire, part), simulate(tire, whole)[150:])
    assert np.abs(simulate(tire, alone(part)) - simulate(tire, part)).max() > 10.0


def test_a_part_that_begins_under_load_is_simulated_as_it_is_stepped() -> None:
    """Relaxation from before the first sample, of the law's force without the preload."""
    effect = CATALOGUE["viscoelastic_relaxation"]
    given = {"share_1": 0.2, "relaxation_time_1": 3.0, "share_3": 0.1, "sudden": 0.5, "freshness": 0.4}
    values = tuple(given.get(p.name, p.start) for p in effect.parameters)
    tire = TireModel(PowerLaw(1000.0, 1.2), ((effect, values),), two_sided=True, preload=50.0)
    motion = random_motion(3)
    same(tire, motion)
    relaxed = replace(tire, effects=((effect, (*values[:-1], 0.0)),))
    assert abs(stepped(tire, motion)[0] - stepped(relaxed, motion)[0]) > 1.0


def test_a_shape_is_of_the_law_alone_and_the_force_of_a_part_is_continuous() -> None:
    """F0 and A x^B times the shape, also at x = 0."""
    effect = CATALOGUE["elastic_shape"]
    bent = {"bend": 0.01, "reference": 2e-4, "height_1": 0.05}
    values = tuple(bent.get(p.name, p.start) for p in effect.parameters)
    tire = TireModel(PowerLaw(1000.0, 1.0), ((effect, values),), two_sided=True, preload=10.0)
    x = np.array([-1e-5, -1e-10, 0.0, 1e-10, 1e-5])
    log_ratio = np.log(np.maximum(np.abs(x) / 2e-4, 0.01))
    expected = 10.0 + 1e5 * x * np.exp(0.01 * log_ratio**2 + 0.05)
    time = np.arange(5.0)
    recording = Recording.from_arrays(time, x, expected, "flat", name="part")
    assert simulation.simulate(tire, recording) == pytest.approx(expected, rel=1e-12)
