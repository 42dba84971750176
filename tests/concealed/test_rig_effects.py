"""What holds for every form of every effect, named or not."""

import json
import math

import numpy as np
import pytest
from concealed.bench import Bench
from concealed.effects import FORMS, Conditions, Effect
from concealed.excitation import EXCITATIONS, DepthLimits
from concealed.open_world import OPEN_WORLD
from concealed.scenario import INFORMATIVE_TESTS
from concealed.sizing import resized
from concealed.tires import article_tire

ALL = (*FORMS, *OPEN_WORLD)
NOISE = 6.0


@pytest.fixture(scope="module")
def conditions_by_test() -> dict[str, Conditions]:
    """One recording for each kind of test, on the article's tire."""
    bare = Bench(article_tire())
    result = {}
    for name, make in EXCITATIONS.items():
        motion = make(np.random.default_rng(8), DepthLimits((math.inf, 0.1016), (0.0255, 0.026)))
        result[name] = Conditions((motion,), (bare.force(motion),), bare.tire, NOISE)
    return result


@pytest.fixture(params=ALL, ids=[form.__name__ for form in ALL])
def case(
    request: pytest.FixtureRequest, conditions_by_test: dict[str, Conditions]
) -> tuple[Effect, Conditions]:
    form: type[Effect] = request.param
    conditions = conditions_by_test[INFORMATIVE_TESTS.get(form.name, ("many_rates_triangle",))[0]]
    return form.drawn(np.random.default_rng(3), conditions), conditions


def added(effect: Effect, conditions: Conditions) -> np.ndarray:
    bench = Bench(conditions.tire, (effect,))
    return bench.force(conditions.motions[0]) - conditions.elastic[0]


def test_it_changes_the_force_and_stays_finite_up_to_its_limit(case: tuple[Effect, Conditions]) -> None:
    effect, conditions = case
    for strength in (effect.strength, math.copysign(effect.limit, effect.strength)):
        difference = added(effect.with_strength(strength), conditions)
        assert np.all(np.isfinite(difference))
        assert np.max(np.abs(difference)) > 0.1


def test_it_grows_with_its_strength(case: tuple[Effect, Conditions]) -> None:
    effect, conditions = case
    sizes = [
        float(np.sqrt(np.mean(added(effect.with_strength(f * effect.strength), conditions) ** 2)))
        for f in (0.5, 1.0, 1.5)
    ]
    assert sizes[0] < sizes[1] < sizes[2]


def test_it_vanishes_with_its_strength(case: tuple[Effect, Conditions]) -> None:
    """A ten-thousandth of the strength leaves next to nothing."""
    effect, conditions = case
    if effect.name == "saturation":
        pytest.skip("a ceiling has no strength at which it is nowhere")
    difference = added(effect.with_strength(1e-4 * effect.strength), conditions)
    assert np.sqrt(np.mean(difference**2)) < 0.05


def test_a_size_can_be_asked_for(case: tuple[Effect, Conditions]) -> None:
    """Three times the noise, or its limit."""
    effect, conditions = case
    if effect.name == "stuck_channel":
        pytest.skip("it hangs for whole samples, so its sizes are far apart")
    bench = Bench(conditions.tire, (effect,))
    sized = resized(bench, effect, conditions.motions, NOISE, 3.0)
    contact = Bench(conditions.tire, (sized,)).contact(conditions.motions[0])
    inside = sized.active(contact)
    values = conditions.motions[0].recorded(added(sized, conditions))
    if inside is not None:
        values = values[conditions.motions[0].recorded(inside)]
    raw = float(np.sqrt(np.mean(values**2))) / NOISE
    assert raw == pytest.approx(3.0, rel=0.05) or abs(sized.strength) == sized.limit


def test_the_answer_tells_enough_to_make_it_again(case: tuple[Effect, Conditions]) -> None:
    effect, _ = case
    constants = json.loads(json.dumps(effect.parameters()))
    assert constants.pop("form") == type(effect).__name__
    assert constants.pop("unit_of_strength") == effect.unit
    again = {name: tuple(value) if isinstance(value, list) else value for name, value in constants.items()}
    assert type(effect)(**again) == effect


def test_a_localized_effect_is_where_it_says(case: tuple[Effect, Conditions]) -> None:
    """Nine tenths of what a localized effect adds, squared, lie in the samples that it names."""
    effect, conditions = case
    contact = Bench(conditions.tire, (effect,)).contact(conditions.motions[0])
    inside = effect.active(contact)
    if inside is None:
        assert not effect.regions(conditions.motions[0])
        return
    squares = added(effect, conditions) ** 2
    assert np.sum(squares[inside]) > 0.9 * np.sum(squares)


def test_the_regions_of_a_localized_effect_hold_its_samples(case: tuple[Effect, Conditions]) -> None:
    """Nine tenths of the samples in which it is active lie in its spans, along every coordinate that it states."""
    effect, conditions = case
    motion, bench = conditions.motions[0], Bench(conditions.tire, (effect,))
    inside = effect.active(bench.contact(motion))
    coordinates = {
        "time": motion.time,
        "deflection": motion.deflection,
        "rate": motion.rate,
        "force": bench.contact(motion).elastic,
        "direction": np.sign(motion.rate),
    }
    spans: dict[str, np.ndarray] = {}
    for region in effect.regions(motion):
        low, high = (
            (-1.0, -1.0)
            if region.begin == "unloading"
            else (
                -math.inf if region.begin is None else float(region.begin),
                math.inf if region.end is None else float(region.end),
            )
        )
        values = coordinates[region.by]
        spans[region.by] = spans.get(region.by, False) | ((low <= values) & (values <= high))
    assert (inside is None) == (not spans) or effect.name == "mullins_softening"
    for held in spans.values():
        assert np.mean(held[inside]) > 0.9
        assert np.mean(held) < 0.9, "a span that holds nearly everything says nothing"
    if "time" in spans:
        assert np.sum(spans["time"] & inside) > 0.9 * np.sum(spans["time"] | inside)
