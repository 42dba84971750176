"""Signatures hold the forms that an effect can take on a motion."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from radialtire import CATALOGUE, PowerLaw, Recalibrated, TireModel
from tirelab.estimation.problem import EstimationProblem, law_start, problem_of
from tirelab.preprocessing.noise import Noise
from tirelab.recordings.recording import Recording
from tirelab.regressors.dataset import Dataset, arranged, dataset_of
from tirelab.regressors.draws import quantile
from tirelab.regressors.signature import (
    FACTOR,
    LAW,
    PARTS,
    SHAPE,
    Beside,
    candidates,
    drawn_beside,
    in_other_noise,
    law_signature,
    reference_of,
    signature_of,
    signatures_of,
    single_valued,
    size_of,
)
from tirelab.simulation.simulate import simulate

NOISE = 2.0


@pytest.fixture(scope="module")
def dataset() -> Dataset:
    """Three speeds over 22 mm on the flat, twice each; 2 N of noise beside a misfit of 5 % of the force."""
    time = np.arange(0.0, 60.0, 0.01)
    frequency = np.select([time < 30.0, time < 50.0], [0.1, 0.3], 1.0)
    phase = np.cumsum(frequency) * 0.01
    x = 0.011 * (1.0 - np.cos(2.0 * np.pi * phase))
    silent = Recording("speeds", time, x, np.full(time.size, np.inf), np.zeros(time.size))
    force = 1.05 * simulate(TireModel(), silent)
    noise = NOISE * np.random.default_rng(11).normal(size=time.size)
    return dataset_of([Recording("speeds", time, x, silent.surface_radius, force + noise)], TireModel())


def left_by(columns: np.ndarray, curve: np.ndarray) -> float:
    """Part of a curve's root mean square that no sum of the columns follows."""
    rest = curve - columns @ np.linalg.lstsq(columns, curve, rcond=None)[0]
    return size_of(rest) / size_of(curve)


def test_every_effect_that_this_motion_drives_has_a_signature(dataset: Dataset) -> None:
    found = {s.name for s in signatures_of(candidates(), dataset) if not s.silent}
    # Nothing is near the end of a range here: what only acts there may be silent.
    local = {n for n in CATALOGUE if "localized" in CATALOGUE[n].traits}
    # Nor was any channel recorded beside the motion.
    read = {
        n for n in CATALOGUE if CATALOGUE[n].reads is not None and CATALOGUE[n].reads.reference is not None
    }
    assert found >= set(candidates()) - local - read


def test_draws_have_the_size_one_and_the_values_that_made_them(dataset: Dataset) -> None:
    signature = signature_of("viscous_damping", dataset)
    np.testing.assert_allclose(np.sqrt(np.mean(signature.curves**2, axis=1)), 1.0)
    again = arranged(dataset.tire, [("viscous_damping", signature.values[0])])
    # Curves are kept to seven digits.
    np.testing.assert_allclose(dataset.response(again), signature.curves[0] * signature.sizes[0], rtol=1e-6)


def test_values_that_do_not_reach_the_wanted_size_are_those_of_their_curve() -> None:
    # An indenter in eight cycles to twice the force each; a tenth of the largest depth so far comes back.
    deepest = 7e-7 * np.sqrt(2.0) ** np.repeat(np.arange(-7.0, 1.0), 160)
    way = np.tile(np.concatenate([np.linspace(0.3, 1.0, 80), np.linspace(1.0, 0.3, 80)]), 8)
    come_back = np.tile(np.arange(160) >= 80, 8)
    force = 0.045 * (deepest / 7e-7) ** 2 * np.where(come_back, way**1.5, way**2)
    x = deepest * np.where(come_back, 0.9 + 0.1 * way, way)
    part = TireModel(law=PowerLaw(2.17e6, 1.9), two_sided=True, inflated=False)
    noise = 1e-5 * np.random.default_rng(3).normal(size=x.size)
    recording = Recording("indent", 0.1 * np.arange(x.size), x, np.full(x.size, np.inf), force + noise)
    cycles = dataset_of([recording], part)
    for signature in signatures_of(candidates(), cycles):
        for curve, size, values in zip(signature.curves, signature.sizes, signature.values, strict=True):
            response = cycles.response(arranged(part, [(signature.name, values)]))
            np.testing.assert_allclose(response, curve * size, atol=1e-5 * abs(size))


@pytest.mark.parametrize(
    "name", ["viscous_damping", "rate_independent_hysteresis", "pressure_leak", "inertia"]
)
def test_a_value_that_was_not_drawn_lies_in_the_span_of_a_signature(name: str, dataset: Dataset) -> None:
    signature = signature_of(name, dataset)
    effect = CATALOGUE[name]
    middle = tuple(
        quantile(p, 0.4, dataset.scales) if p.prior and not p.optional else p.start for p in effect.parameters
    )
    curve = dataset.response(arranged(dataset.tire, [(name, middle)]))
    assert left_by(signature.columns, curve) < 0.05


def test_a_change_of_a_and_b_lies_in_the_span_of_the_laws_signature(dataset: Dataset) -> None:
    tire = TireModel(Recalibrated(TireModel().law, ((np.inf, 0.03, 0.02),)))
    assert left_by(law_signature(dataset).columns, dataset.response(tire)) < 0.01


def slopes_of(problem: EstimationProblem) -> list[np.ndarray]:
    """The derivatives of a refitted law by its parameters, on the axes of their priors."""
    origin, step = np.zeros(len(problem.parameters)), 1e-4
    return [
        (problem.residual(origin) - problem.residual(origin + step * row)) / step
        for row in np.eye(origin.size)
    ]


def test_the_laws_signature_is_what_a_refitted_law_can_do(dataset: Dataset) -> None:
    """Its columns are the derivatives of the delivered law."""
    problem = problem_of(dataset, {LAW: law_start(dataset)}, plain=False)
    slopes = slopes_of(problem)
    signature = law_signature(dataset)
    unit = size_of(FACTOR * dataset.stacked([e.baseline for e in dataset.experiments]))
    np.testing.assert_allclose(signature.basis * unit, np.column_stack(slopes), atol=2e-3 * unit)


def bushing(zero: float = 0.0) -> Dataset:
    """A part pulled 8 mm and pressed 14 mm, of 20 N/cm and stiffer when pressed, with the load cell's `zero` [N]."""
    time = np.arange(0.0, 12.0, 0.01)
    x = 0.003 + 0.011 * np.sin(2.0 * np.pi * 0.5 * time)
    force = 2e3 * x + 3e5 * np.maximum(x, 0.0) ** 2 + NOISE * np.random.default_rng(9).normal(size=time.size)
    part = TireModel(PowerLaw(20.0, 1.0), two_sided=True, inflated=False, preload=zero, tested_range=None)
    return dataset_of([Recording("wave", time, x, np.full(time.size, np.inf), force + zero)], part)


def test_of_a_part_it_is_a_curve_over_the_deflection_beside_its_preload() -> None:
    """As above, in units of the preload's change, the largest column; bend and twist are of the law as of a tire."""
    data = bushing()
    problem = problem_of(data, {LAW: law_start(data)}, plain=False)
    assert {p.unit for p in problem.parameters if p.label.startswith("slope change")} == {"N"}
    slopes = slopes_of(problem)
    preload = slopes[-1]
    # The curve adds nothing at no deflection: what it has there is the preload's.
    (e,) = data.experiments
    at_rest = int(np.argmin(np.abs(e.deflection[e.counts])))
    columns = law_signature(data).basis * size_of(preload)
    columns[:, 4:-1] -= columns[at_rest, 4:-1]
    np.testing.assert_allclose(columns, np.column_stack(slopes), atol=2e-2 * size_of(preload))


def test_the_zero_of_a_load_cell_changes_no_signature() -> None:
    """A constant on the force of a part and on its preload: every response is the same."""
    plain, shifted = bushing(), bushing(zero=-400.0)
    np.testing.assert_allclose(law_signature(shifted).basis, law_signature(plain).basis, atol=1e-9)
    for name in ("mullins_softening", "warm_up", "rate_independent_hysteresis", "viscoelastic_relaxation"):
        one, other = signature_of(name, plain), signature_of(name, shifted)
        np.testing.assert_allclose(other.curves, one.curves, atol=1e-9)
        np.testing.assert_allclose(other.sizes, one.sizes, rtol=1e-9)


def test_a_part_that_is_stiffer_when_pressed_lies_in_the_span_of_its_signature() -> None:
    """What no factor on A x^B does that is the same both ways."""
    data = bushing()
    (e,) = data.experiments
    pressed = data.stacked([3e5 * np.maximum(e.deflection, 0.0) ** 2])
    assert left_by(law_signature(data).columns, pressed) < 0.02


def two_springs(x: np.ndarray) -> np.ndarray:
    """Return the force [N] at deflections [m]: from 12 mm on 9 kN/m, from 15 mm on 12 kN/m."""
    return 9e3 * np.maximum(x - 0.012, 0.0) + 3e3 * np.maximum(x - 0.015, 0.0)


def beyond_a_gap() -> Dataset:
    """The two springs pressed 20 mm; the part's law begins beyond their gap."""
    time = np.arange(0.0, 12.0, 0.01)
    x = 0.01 * (1.0 - np.cos(2.0 * np.pi * 0.5 * time))
    offset = ((CATALOGUE["deflection_offset"], (-0.012,)),)
    part = TireModel(PowerLaw(100.0, 1.1), effects=offset, inflated=False, tested_range=None)
    noisy = two_springs(x) + NOISE * np.random.default_rng(9).normal(size=time.size)
    return dataset_of([Recording("press", time, x, np.full(time.size, np.inf), noisy)], part)


def test_of_a_part_with_a_gap_it_is_a_law_over_the_deflection_beyond_it() -> None:
    """As above, but for the gap's own column; the kinks are spread over the 8 mm in contact, not over 20 mm."""
    data = beyond_a_gap()
    assert data.scales.travel == pytest.approx(0.008, rel=0.01)
    problem = problem_of(data, {LAW: law_start(data)}, plain=False)
    slopes = np.column_stack(slopes_of(problem)[:-1])
    basis = law_signature(data).basis[:, :-1]
    unit = size_of(slopes[:, 0]) / size_of(basis[:, 0])
    np.testing.assert_allclose(basis * unit, slopes, atol=5e-3 * unit)


def test_a_law_that_is_steeper_beyond_a_depth_lies_in_the_span_beyond_a_gap() -> None:
    data = beyond_a_gap()
    missed = data.stacked([two_springs(e.deflection) - e.baseline for e in data.experiments])
    assert left_by(law_signature(data).columns, missed) < 0.01


def test_a_law_that_waves_lies_in_the_span_of_its_signature(dataset: Dataset) -> None:
    """What no change of A and B follows: heights of opposite signs."""
    shape = (0.0, 0.0, reference_of(dataset))
    waves = arranged(dataset.tire, [(SHAPE, (*shape, *[0.02, -0.02] * 5))])
    assert left_by(law_signature(dataset).columns, dataset.response(waves)) < 0.01


def test_in_other_noise_a_signature_explains_the_same_newtons(dataset: Dataset) -> None:
    signature = signature_of("viscous_damping", dataset)
    louder = dataset.with_noise([Noise(2.0 * e.noise, 1) for e in dataset.experiments])
    other = in_other_noise(signature, dataset, louder)
    np.testing.assert_allclose(
        other.curves * other.sizes[:, None] * 2.0, signature.curves * signature.sizes[:, None], rtol=1e-6
    )


def driven(*corners: tuple[float, float], step: float = 0.01) -> Dataset:
    """A motion through corners of time [s] and deflection [m], and a law that is 5 % off, beside 2 N of noise."""
    time = np.arange(0.0, corners[-1][0], step)
    x = np.interp(time, *zip(*corners, strict=True))
    silent = Recording("corners", time, x, np.full(time.size, np.inf), np.zeros(time.size))
    force = 1.05 * simulate(TireModel(), silent) + NOISE * np.random.default_rng(5).normal(size=time.size)
    return dataset_of([replace(silent, force=force)], TireModel())


def damped_part() -> tuple[Dataset, Beside]:
    """A damper of 800 N s/m with 50 N of preload and no spring, read on a slow wave; the damper fitted."""
    time = np.arange(0.0, 20.0, 0.005)
    x = 0.02 * np.sin(2.0 * np.pi * 0.5 * time)
    silent = Recording("wave", time, x, np.full(time.size, np.inf), np.zeros(time.size))
    preloaded = TireModel(PowerLaw(1e-6, 1.0), two_sided=True, preload=50.0, tested_range=None)
    damped = arranged(preloaded, [("viscous_damping", (800.0, 1.0, 0.0, 0.0, 1.0, 0.0, 0.0))])
    force = simulate(damped, silent) + NOISE * np.random.default_rng(7).normal(size=time.size)
    data = dataset_of([replace(silent, force=force)], preloaded)
    response = data.response(damped)
    return data, Beside(damped, response, data.misfit - response)


def test_what_acts_on_a_signal_that_stands_still_is_silent_and_is_drawn_beside_what_moves_it() -> None:
    """A constant force that is read late is the same force; that of a damper lags by its own rate of change."""
    data, beside = damped_part()
    alone = signature_of("force_lag", data)
    assert alone.silent
    late = drawn_beside(alone, data, beside)
    assert not late.silent
    (e,) = data.experiments
    lagging = -data.stacked([np.gradient(800.0 * e.rate, e.time)])
    cosine = lagging @ late.curves.T / (size_of(lagging) * lagging.size)
    # The delays drawn are up to 0.1 s, a third of a radian of this wave.
    assert np.median(cosine) > 0.95


def test_a_response_that_is_the_same_beside_another_tire_is_not_drawn_again(dataset: Dataset) -> None:
    stiffer = TireModel(Recalibrated(TireModel().law, ((np.inf, 0.05, 0.0),)))
    response = dataset.response(stiffer)
    again = Beside(stiffer, response, dataset.misfit - response)
    own = signature_of("force_lag", dataset)
    assert drawn_beside(own, dataset, again) is own


LOOPS = ("rate_independent_hysteresis", "viscous_damping", "viscoelastic_relaxation")


@pytest.mark.parametrize(
    ("corners", "expected"),
    [
        # Each deflection is passed once: no loop can show.
        ([(0.0, 0.0), (20.0, 0.02)], set(LOOPS)),
        # A hold shows what decays and what falls to 0 in it; friction stays, and is a function of the way in.
        ([(0.0, 0.0), (10.0, 0.02), (40.0, 0.02)], {"rate_independent_hysteresis"}),
        ([(0.0, 0.0), (10.0, 0.02), (20.0, 0.0)], set()),
    ],
    ids=["a ramp", "a ramp and a hold", "a triangle"],
)
def test_an_effect_that_is_a_function_of_the_deflection_in_this_motion_is_like_a_law(
    corners: list[tuple[float, float]], expected: set[str]
) -> None:
    data = driven(*corners)
    assert single_valued(signatures_of(LOOPS, data), data) == expected


def test_in_few_long_blocks_a_loop_is_no_function_of_the_deflection() -> None:
    """A triangle in fewer blocks than twice the parts of the deflection: a line meets any two of them."""
    data = driven((0.0, 0.0), (20.0, 0.02), (40.0, 0.0), step=0.5)
    assert data.misfit.size < 2 * PARTS
    assert single_valued(signatures_of(LOOPS, data), data) == set()


def test_on_ground_of_ever_another_radius_a_loop_is_no_function_of_the_deflection() -> None:
    """No two blocks are on one surface there: taken one by one they would all lie on a line."""
    time = np.arange(0.0, 40.0, 0.01)
    x = 0.01 - 0.01 * np.cos(2.0 * np.pi * 0.25 * time)
    radius = 0.3 + 0.1 * np.sin(0.7 * time)
    silent = Recording("terrain", time, x, radius, np.zeros(time.size))
    force = simulate(TireModel(), silent) + NOISE * np.random.default_rng(6).normal(size=time.size)
    data = dataset_of([replace(silent, force=1.05 * force)], TireModel())
    assert single_valued(signatures_of(LOOPS, data), data) == set()


def test_on_a_motion_in_exact_steps_a_loop_is_no_function_of_the_deflection() -> None:
    """What is left of x in each part is the rounding of its numbers, over which a line would follow any two ways."""
    time = 0.05 * np.arange(1200)
    x = 1e-3 * np.round(2.0 * np.abs((time / 2.0 + 1.0) % 2.0 - 1.0), 5)
    spring = TireModel(PowerLaw(200.0, 1.0), two_sided=True, tested_range=None)
    loop = 3.0 * np.where(time % 4.0 < 2.0, 1.0, -1.0) * (1.0 - np.exp(-(time % 2.0) / 0.3))
    force = 2e4 * x + loop + 0.05 * np.random.default_rng(7).normal(size=time.size)
    data = dataset_of([Recording("steps", time, x, np.full(time.size, np.inf), force)], spring)
    assert single_valued(signatures_of(LOOPS, data), data) == set()
