"""What holds for every form of every effect, named or not."""

import math

import numpy as np
import pytest
from concealed.bench import Bench
from concealed.effects import FORMS, Effect, Scene
from concealed.excitation import EXCITATIONS, Reach
from concealed.open_world import OPEN_WORLD
from concealed.scenario import TELLING
from concealed.sizing import resized
from concealed.tires import article_tire

ALL = (*FORMS, *OPEN_WORLD)
NOISE = 6.0


@pytest.fixture(scope="module")
def scenes() -> dict[str, Scene]:
    """One recording for each kind of test, on the article's tire."""
    bare = Bench(article_tire())
    result = {}
    for name, make in EXCITATIONS.items():
        motion = make(np.random.default_rng(8), Reach((math.inf, 0.1016), (0.0255, 0.026)))
        result[name] = Scene((motion,), (bare.force(motion),), bare.tire, NOISE)
    return result


@pytest.fixture(params=ALL, ids=[form.__name__ for form in ALL])
def case(request: pytest.FixtureRequest, scenes: dict[str, Scene]) -> tuple[Effect, Scene]:
    form: type[Effect] = request.param
    scene = scenes[TELLING.get(form.name, ("many_rates_triangle",))[0]]
    return form.drawn(np.random.default_rng(3), scene), scene


def added(effect: Effect, scene: Scene) -> np.ndarray:
    bench = Bench(scene.tire, (effect,))
    return bench.force(scene.motions[0]) - scene.elastic[0]


def test_it_changes_the_force_and_stays_finite_up_to_its_limit(case: tuple[Effect, Scene]) -> None:
    effect, scene = case
    for strength in (effect.strength, math.copysign(effect.limit, effect.strength)):
        difference = added(effect.with_strength(strength), scene)
        assert np.all(np.isfinite(difference))
        assert np.max(np.abs(difference)) > 0.1


def test_it_grows_with_its_strength(case: tuple[Effect, Scene]) -> None:
    effect, scene = case
    sizes = [
        float(np.sqrt(np.mean(added(effect.with_strength(f * effect.strength), scene) ** 2)))
        for f in (0.5, 1.0, 1.5)
    ]
    assert sizes[0] < sizes[1] < sizes[2]


def test_it_vanishes_with_its_strength(case: tuple[Effect, Scene]) -> None:
    """A ten-thousandth of the strength leaves next to nothing."""
    effect, scene = case
    if effect.name == "saturation":
        pytest.skip("a ceiling has no strength at which it is nowhere")
    difference = added(effect.with_strength(1e-4 * effect.strength), scene)
    assert np.sqrt(np.mean(difference**2)) < 0.05


def test_a_size_can_be_asked_for(case: tuple[Effect, Scene]) -> None:
    """Three times the noise, or its limit."""
    effect, scene = case
    if effect.name == "stuck_channel":
        pytest.skip("it hangs for whole samples, so its sizes are far apart")
    bench = Bench(scene.tire, (effect,))
    sized = resized(bench, effect, scene.motions, NOISE, 3.0)
    contact = Bench(scene.tire, (sized,)).contact(scene.motions[0])
    inside = sized.active(contact, contact.elastic)
    values = scene.motions[0].recorded(added(sized, scene))
    if inside is not None:
        values = values[scene.motions[0].recorded(inside)]
    raw = float(np.sqrt(np.mean(values**2))) / NOISE
    assert raw == pytest.approx(3.0, rel=0.05) or abs(sized.strength) == sized.limit


def test_its_parameters_can_be_told(case: tuple[Effect, Scene]) -> None:
    effect, _ = case
    parameters = effect.parameters()
    assert parameters["strength"] == effect.strength
    assert parameters["form"] == type(effect).__name__
    assert parameters["unit_of_strength"]
    assert (type(effect).__doc__ or "").strip()


def test_a_confined_effect_is_where_it_says(case: tuple[Effect, Scene]) -> None:
    """Nine tenths of what a confined effect adds, squared, lie in the samples that it names."""
    effect, scene = case
    contact = Bench(scene.tire, (effect,)).contact(scene.motions[0])
    inside = effect.active(contact, contact.elastic)
    if inside is None:
        assert not effect.places(scene.motions[0])
        return
    squares = added(effect, scene) ** 2
    assert np.sum(squares[inside]) > 0.9 * np.sum(squares)
