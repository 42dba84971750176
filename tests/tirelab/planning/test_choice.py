"""The choice of motions, on menus so small that the answer is known."""

import numpy as np
from numpy.typing import NDArray
from radialtire import CATALOGUE
from tirelab.planning.choice import TOLD, Menu, chosen_of
from tirelab.planning.responses import PRIOR_OF_LAW
from tirelab.planning.separation import Question
from tirelab.regressors.signature import LAW

PLACES = {
    "inertia": slice(0, 1),
    "force_drift": slice(1, 2),
    LAW: slice(2, 3),
    PRIOR_OF_LAW: slice(3, 4),
}
QUESTIONS = (
    Question("inertia", frozenset({LAW}), 1.0, nested=True),
    Question("force_drift", frozenset({LAW}), 1.0, nested=True),
)


def shows(*powers: float) -> NDArray[np.float64]:
    """Return the products of a motion that shows inertia and drift so loudly."""
    return np.diag([*powers, 1.0, 1.0])


def menu(grams: list[NDArray[np.float64]], seconds: list[float]) -> Menu:
    return Menu(tuple(grams), tuple(seconds), PLACES, QUESTIONS, np.zeros((4, 4)), (False,) * len(grams))


def silent(sentence: str) -> None:
    pass


def test_one_motion_that_shows_both_is_enough() -> None:
    choice = chosen_of(
        menu([shows(400.0, 0.0), shows(0.0, 400.0), shows(400.0, 400.0)], [10.0, 10.0, 12.0]), 60.0, silent
    )
    assert choice.chosen == (2,)
    assert choice.possible.all()
    assert (choice.answers >= TOLD).all()


def test_each_effect_gets_the_shorter_motion_that_shows_it() -> None:
    grams = [shows(400.0, 0.0), shows(400.0, 0.0), shows(0.0, 400.0)]
    assert set(chosen_of(menu(grams, [20.0, 10.0, 10.0]), 60.0, silent).chosen) == {1, 2}


def test_what_became_needless_is_left_out() -> None:
    """The quick motion shows inertia alone and is taken first; the long one then shows both."""
    grams = [shows(400.0, 0.0), shows(400.0, 400.0)]
    assert chosen_of(menu(grams, [5.0, 40.0]), 60.0, silent).chosen == (1,)


def test_a_motion_is_driven_again_where_once_is_not_enough() -> None:
    choice = chosen_of(menu([shows(15.0, 15.0)] * 4, [10.0] * 4), 100.0, silent)
    assert 2 <= len(choice.chosen) <= 4
    assert (choice.answers >= TOLD).all()


def test_the_time_is_kept() -> None:
    choice = chosen_of(menu([shows(400.0, 0.0), shows(0.0, 400.0)], [10.0, 10.0]), 15.0, silent)
    assert len(choice.chosen) == 1
    assert choice.possible.all()
    assert np.count_nonzero(choice.answers >= TOLD) == 1


def test_what_no_motion_shows_is_not_driven_for() -> None:
    choice = chosen_of(menu([shows(400.0, 0.0)], [10.0]), 60.0, silent)
    assert choice.chosen == (0,)
    assert choice.possible.tolist() == [True, False]


def test_what_was_recorded_already_counts() -> None:
    recorded = Menu((shows(400.0, 0.0),), (10.0,), PLACES, QUESTIONS[:1], shows(400.0, 0.0), (False,))
    assert chosen_of(recorded, 60.0, silent).chosen == ()


def test_loops_are_not_told_apart_at_one_speed() -> None:
    """A motion at one speed may show both loudly; a diagnosis does not decide between them from it."""
    places = {"viscous_damping": PLACES["inertia"], "rate_independent_hysteresis": PLACES["force_drift"]}
    question = Question("viscous_damping", frozenset({"rate_independent_hysteresis"}), 1.0, nested=False)
    one = Menu((shows(400.0, 400.0),) * 2, (10.0, 30.0), places, (question,), np.zeros((4, 4)), (False, True))
    assert one.answers([0]).tolist() == [0.5]
    assert one.answers([1])[0] > TOLD
    assert chosen_of(one, 60.0, silent).chosen == (1,)


def test_no_motion_is_driven_that_shows_only_what_stands_beside() -> None:
    """A drift is asked for beside a louder inertia. What shows the inertia as loudly again makes its form's error
    larger and the drift no clearer, so it is possible by one motion and not by all of them together.
    """
    error = CATALOGUE["inertia"].form_error
    quiet = shows(0.0, 60.0)
    # (2.5 error)^2 power / 30 = 25 is added to the variance, which leaves the drift a noncentrality of 60 / 26.
    loud = shows(25.0 * 30.0 / (2.5 * error) ** 2, 0.0)
    question = Question("force_drift", frozenset({LAW, "inertia"}), 1.0, nested=True, beside="inertia")
    both = Menu((quiet, loud), (10.0, 1.0), PLACES, (question,), np.zeros((4, 4)), (False, False))
    choice = chosen_of(both, 60.0, silent)
    assert choice.chosen == (0,)
    assert choice.possible.all()
    assert both.answers([0, 1])[0] < 0.5
