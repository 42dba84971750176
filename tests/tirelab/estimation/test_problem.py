"""Free parameters and the problem that they make: positions on the priors' axes and back, tires, responses."""

from __future__ import annotations

import math

import numpy as np
import pytest
from drives import damped
from fits import values_of
from radialtire import CATALOGUE, PowerLaw, TireModel
from tirelab.estimation.problem import (
    FreeParameter,
    law_start,
    law_surfaces,
    parameters_of_effect,
    parameters_of_law,
    problem_of,
    tire_of,
    with_readings,
)
from tirelab.names import REFITTED_LAW
from tirelab.recordings.recording import Recording
from tirelab.regressors.dataset import Dataset, dataset_of
from tirelab.regressors.signature import SHAPE
from tirelab.simulation.simulate import simulate

DATASET: Dataset = dataset_of([damped(4, samples=2000)], TireModel())
DAMPED = with_readings("viscous_damping", (300.0, 1.0, 0.0, 0.0, 1.0, 0.0, 0.0), DATASET)


def free(**more: object) -> FreeParameter:
    given = {"centre": 2.0, "spread": 0.5, "logarithm": False, "low": -4.0, "high": 4.0, "minimum": 0.0}
    return FreeParameter("made", 0, "k", "N", **{**given, "maximum": 10.0, **more})  # type: ignore[arg-type]


@pytest.mark.parametrize("value", [0.5, 2.0, 3.9])
@pytest.mark.parametrize("logarithm", [False, True])
def test_a_value_comes_back_from_its_position(value: float, logarithm: bool) -> None:
    one = free(logarithm=logarithm, centre=math.log(2.0) if logarithm else 2.0, high=8.0, low=-8.0)
    assert one.value(one.position(value)) == pytest.approx(value)
    assert one.position(2.0) == pytest.approx(0.0)


def test_positions_and_values_stay_within_their_bounds() -> None:
    one = free()
    assert one.position(1e6) == 4.0
    assert one.value(100.0) == 4.0
    assert one.value(-100.0) == 0.0


def test_an_optional_form_that_is_off_at_its_bound_begins_inside() -> None:
    at_bound = free(plain=0.0, optional=True)
    assert at_bound.low < at_bound.start < at_bound.position(1.0)
    inside = free(plain=2.0, optional=True)
    assert inside.start == inside.position(2.0)


def test_every_parameter_of_an_effect_with_a_prior_is_free_but_readings() -> None:
    for name, effect in CATALOGUE.items():
        expected = [p.name for p in effect.parameters if p.prior is not None and p.role != "reading"]
        assert [p.label for p in parameters_of_effect(name, DATASET.scales)] == expected


def test_a_strength_of_either_sign_may_lie_far_beyond_its_priors_spread() -> None:
    """Its prior's own scale is the likeliest: |q| where that is more than 1. A logarithm needs none."""
    values = {"force_offset": (0.0,), "rate_independent_hysteresis": values_of("rate_independent_hysteresis")}
    problem = problem_of(DATASET, values, plain=True)
    signed = [p.owner == "force_offset" for p in problem.parameters]
    assert sum(signed) == 1
    for position in (-12.0, -0.3, 0.0, 5.0):
        found = problem.widths(np.full(len(signed), position))
        np.testing.assert_allclose(found, np.where(signed, max(abs(position), 1.0), 1.0))


def test_of_two_strengths_of_an_effect_the_lesser_may_be_next_to_nothing() -> None:
    """A friction is constant, in proportion to the load, or both. The larger one has the prior that is declared."""
    values = {"rate_independent_hysteresis": values_of("rate_independent_hysteresis")}
    problem = problem_of(DATASET, values, plain=True)
    assert [p.label for p in problem.parameters[:2]] == ["slip_force", "load_share"]

    def widths(slip: float, share: float) -> list[float]:
        return problem.widths(np.array([slip, share, *[-4.0] * (len(problem.parameters) - 2)])).tolist()

    others = [1.0] * (len(problem.parameters) - 2)
    assert widths(-3.0, 0.5) == [3.0, 1.0, *others]
    assert widths(0.5, -3.0) == [1.0, 3.0, *others]
    assert widths(-2.0, -3.0) == [1.0, 3.0, *others]
    assert widths(-0.5, 4.0) == [1.0, 1.0, *others]


def test_a_form_lies_within_three_standard_deviations_of_its_prior_or_where_it_is_plain() -> None:
    """99.7 % of a normal law; towards its plain value, such as none of an optional part, it may go on."""
    for name, effect in CATALOGUE.items():
        for p in parameters_of_effect(name, DATASET.scales):
            parameter = effect.parameters[p.index]
            if parameter.role == "form":
                plain = p.position(parameter.start) if parameter.optional else 0.0
                assert p.value(plain) == pytest.approx(parameter.start, abs=1e-12) or not parameter.optional
                assert min(plain, -3.0) - 1e-9 <= p.low <= p.high <= max(plain, 3.0) + 1e-9
    (rebound,) = [
        p for p in parameters_of_effect("rate_independent_hysteresis", DATASET.scales) if p.label == "rebound"
    ]
    assert rebound.value(-99.0) == pytest.approx(1.5**-3)
    assert rebound.value(99.0) == pytest.approx(1.5**3)
    (valve,) = [p for p in parameters_of_effect("viscous_damping", DATASET.scales) if p.label == "rebound"]
    assert valve.value(99.0) == pytest.approx(64.0)  # what acts the other way too is a percent and a half


def test_a_gauge_may_be_late_as_behind_a_filter_of_second_order_and_a_few_hertz() -> None:
    """Butterworth's of 4 Hz is a delay of sqrt(2) / (2 pi 4 Hz) = 56 ms, to the second order: else a mass is left."""
    (delay,) = [p for p in parameters_of_effect("deflection_lag", DATASET.scales) if p.label == "delay"]
    assert delay.value(99.0) > np.sqrt(2.0) / (8.0 * np.pi)


def test_a_law_on_one_surface_has_no_parameters_of_a_surface_of_its_own() -> None:
    one, two = parameters_of_law(1), parameters_of_law(2)
    # Of two surfaces the common part and a surface's own together spread as one part does alone.
    assert len(two) == len(one) + 4
    assert math.hypot(two[0].spread, two[len(one)].spread) == pytest.approx(one[0].spread)


def test_positions_lead_back_to_the_values() -> None:
    problem = problem_of(DATASET, {"viscous_damping": DAMPED}, plain=False)
    values = problem.values(problem.positions({"viscous_damping": DAMPED}))
    np.testing.assert_allclose(values["viscous_damping"], DAMPED)


def test_in_the_plain_form_optional_parameters_stay() -> None:
    plain = problem_of(DATASET, {"viscous_damping": DAMPED}, plain=True)
    whole = problem_of(DATASET, {"viscous_damping": DAMPED}, plain=False)
    assert {p.label for p in plain.parameters} < {p.label for p in whole.parameters}
    assert not any(p.optional for p in plain.parameters)


def test_the_residual_is_the_misfit_less_the_tires_response() -> None:
    problem = problem_of(DATASET, {"viscous_damping": DAMPED}, plain=True)
    at = problem.positions({"viscous_damping": DAMPED})
    (e,) = DATASET.experiments
    by_hand = (e.misfit - (simulate(problem.tire(at), e, e) - e.baseline))[e.counts] / e.noise
    np.testing.assert_allclose(problem.residual(at), by_hand)


def test_the_curve_of_an_effect_alone_is_its_whole_response() -> None:
    problem = problem_of(DATASET, {"viscous_damping": DAMPED}, plain=True)
    at = problem.positions({"viscous_damping": DAMPED})
    np.testing.assert_allclose(problem.curves(at)["viscous_damping"], DATASET.response(problem.tire(at)))


def test_the_baselines_law_is_where_a_refit_begins() -> None:
    tire = tire_of(DATASET, {REFITTED_LAW: law_start(DATASET)})
    assert law_surfaces(DATASET) == 1
    np.testing.assert_allclose(DATASET.response(tire), 0.0, atol=1e-9)


@pytest.mark.parametrize(
    ("tire", "shaped"),
    [(TireModel(), {REFITTED_LAW, SHAPE}), (TireModel(inflated=False, two_sided=True), {REFITTED_LAW})],
)
def test_another_shape_of_a_tires_law_is_a_hypothesis_of_its_own(tire: TireModel, shaped: set[str]) -> None:
    """Another factor and exponent are one hypothesis; of a part no shape was measured, so none is unusual."""
    dataset = dataset_of([damped(4, samples=2000)], tire)
    start = {REFITTED_LAW: law_start(dataset)}
    assert problem_of(dataset, start, plain=True).hypotheses == {REFITTED_LAW}
    assert problem_of(dataset, start, plain=False).hypotheses == shaped
    bent = {REFITTED_LAW: (0.1, 0.05, 0.02, *start[REFITTED_LAW][3:])}
    assert problem_of(dataset, bent, plain=True).hypotheses == shaped


def test_the_law_of_a_part_has_its_preload_and_that_of_a_tire_has_none() -> None:
    part = TireModel(PowerLaw(50.0, 1.0), two_sided=True, preload=20.0, tested_range=None)
    dataset = dataset_of([damped(4, samples=2000)], part)
    start = law_start(dataset)
    assert len(start) == len(law_start(DATASET)) + 1
    moved = tire_of(dataset, {REFITTED_LAW: (*start[:-1], 5.1)})
    assert moved.preload == pytest.approx(25.1)
    (e,) = dataset.experiments
    np.testing.assert_allclose(dataset.response(moved), 5.1 / e.noise, rtol=1e-9)
    last = problem_of(dataset, {REFITTED_LAW: start}, plain=False).parameters[-1]
    assert (last.label, last.unit, last.group) == ("preload", "N", 8)
    assert last.value(last.position(-3.0)) == pytest.approx(-3.0)


def test_the_law_of_a_part_that_begins_beyond_a_gap_has_its_gap() -> None:
    """F = k (x - x0): another gap is as much another deflection, of k newtons each metre."""
    offset = CATALOGUE["deflection_offset"]
    part = TireModel(PowerLaw(50.0, 1.0), effects=((offset, (-0.001,)),), inflated=False, tested_range=None)
    dataset = dataset_of([damped(4, samples=2000)], part)
    start = law_start(dataset)
    assert len(start) == len(law_start(DATASET)) + 1
    moved = tire_of(dataset, {REFITTED_LAW: (*start[:-1], 0.0002)})
    ((_, (x0,)),) = moved.effects
    assert x0 == pytest.approx(-0.0012)
    (e,) = dataset.experiments
    loaded = (e.deflection > 0.0015)[e.counts]
    np.testing.assert_allclose(dataset.response(moved)[loaded], -5000.0 * 0.0002 / e.noise, rtol=1e-6)
    last = problem_of(dataset, {REFITTED_LAW: start}, plain=False).parameters[-1]
    assert (last.label, last.unit) == ("gap", "m")
    assert last.value(last.position(-0.0003)) == pytest.approx(-0.0003)


def test_a_law_with_every_kink_at_its_bound_is_one_that_a_tire_file_holds() -> None:
    """Kinks add up along the deflection: nine of 2 are a height of 10, where a tire's is at most 2."""
    start = law_start(DATASET)
    for bound in (2.0, -2.0):
        moved = tire_of(DATASET, {REFITTED_LAW: (*start[:4], *[bound] * 9, *start[13:])})
        ((_, values),) = moved.effects
        assert values[-1] == bound
        assert values[3] == 0.0


def pressed(length: float, load: float, inflated: bool) -> Dataset:
    """A part of 40 N/cm^1.3, pressed by 20 mm and read with 0.2 N of noise, with lengths and loads times these."""
    time = np.arange(0.0, 10.0, 0.01)
    way = 0.01 * (1.0 - np.cos(2.0 * np.pi * 0.3 * time))
    read = 40.0 * (100.0 * way) ** 1.3 + 0.2 * np.random.default_rng(2).normal(size=time.size)
    believed = PowerLaw(50.0 * load * length**-1.2, 1.2)
    part = TireModel(believed, two_sided=not inflated, inflated=inflated, tested_range=None)
    recording = Recording("press", time, length * way, np.full(time.size, np.inf), load * read)
    return dataset_of([recording], part)


@pytest.mark.parametrize("inflated", [True, False])
@pytest.mark.parametrize(("length", "load"), [(1e-4, 1e-6), (10.0, 1e3)])
def test_a_law_is_refitted_alike_in_any_unit_of_length_and_force(
    length: float, load: float, inflated: bool
) -> None:
    """Micrometres, or metres and kilonewtons: the same changes leave the same, to a hundredth of the noise."""
    usual, other = (
        problem_of(data, {REFITTED_LAW: law_start(data)}, plain=False)
        for data in (pressed(1.0, 1.0, inflated), pressed(length, load, inflated))
    )
    assert [p.label for p in usual.parameters] == [p.label for p in other.parameters]
    moved = np.random.default_rng(3).normal(size=len(usual.parameters))
    for positions in (0.0 * moved, 0.3 * moved, moved):
        np.testing.assert_allclose(other.residual(positions), usual.residual(positions), rtol=1e-5, atol=0.01)
