"""The probability of the right answer, against a dense formulation and drawn recordings."""

import math

import numpy as np
import pytest
from numpy.typing import NDArray
from radialtire import CATALOGUE
from scipy.stats import norm
from tirelab.planning.responses import PRIOR_OF_LAW, SLOW_NOISE
from tirelab.planning.separation import LOUDER, Question, probabilities, questions_beside, questions_of
from tirelab.regressors.signature import LAW
from tirelab.selection.search import EFFECTIVE, PRIOR_ODDS, Discrepancy

PLACES = {
    "inertia": slice(0, 3),
    "force_drift": slice(3, 5),
    LAW: slice(5, 7),
    PRIOR_OF_LAW: slice(7, 10),
}


def columns(rows: int = 400, level: float = 1.0) -> NDArray[np.float64]:
    rng = np.random.default_rng(3)
    found = level * rng.standard_normal((rows, 10)) / math.sqrt(rows)
    found[:, 0:3] += 0.5 * found[:, [3]]  # alike in part
    return found


def variance(power: float, name: str) -> float:
    return 1.0 + CATALOGUE[name].form_error ** 2 * power / EFFECTIVE


def test_an_effect_in_anothers_place_as_the_whole_covariance_has_it() -> None:
    """S^2 = c' (V + W W')^-1 c, by inverting the covariance of all rows."""
    x, size = columns(level=300.0), 0.02
    question = Question("inertia", frozenset({LAW, "force_drift"}), size, nested=False)
    (found,) = probabilities(x.T @ x, PLACES, [question])
    w = np.column_stack([size * x[:, 3:5] / math.sqrt(2.0), x[:, 7:10]])
    for k in range(3):
        c = size * x[:, k]
        v = variance(float(c @ c), "inertia")
        distance = float(c @ np.linalg.solve(v * np.eye(400) + w @ w.T, c))
        assert found[k] == pytest.approx(norm.cdf(0.5 * math.sqrt(distance)), abs=1e-9)


def test_a_log_likelihood_ratio_of_two_known_responses_is_right_so_often() -> None:
    """Two orthogonal responses without a common part, drawn with noise: Phi(S/2), S their distance."""
    gram = np.diag([3.0**2, 1e-12, 1e-12, 1e-12, 1e-12, 1.0, 1.0, 1e-12, 1e-12, 1e-12])
    question = Question("inertia", frozenset({"force_drift"}), 1.0, nested=False)
    (found,) = probabilities(gram, PLACES, [question])
    noise = math.sqrt(variance(9.0, "inertia")) * np.random.default_rng(1).standard_normal(200_000)
    right = np.mean(noise**2 < (3.0 + noise) ** 2)
    assert found[0] == pytest.approx(right, abs=0.005)


def test_an_effect_that_another_follows_exactly_is_hardly_told() -> None:
    gram = np.ones((10, 10)) * 1e-18
    gram[:5, :5] = 1e6
    question = Question("inertia", frozenset({"force_drift"}), 1.0, nested=False)
    (found,) = probabilities(gram, PLACES, [question])
    assert found == pytest.approx(
        norm.cdf(0.5), abs=0.01
    )  # S = 1: a prior of its own size follows it to one sigma


def test_one_form_beside_the_law_is_found_as_drawn_recordings_have_it() -> None:
    """Orthogonal to the law and of one form: named where its log evidence gain exceeds the prior odds."""
    strong = 4.5
    gram = np.zeros((10, 10))
    gram[:3, :3] = strong**2
    gram[3:, 3:] = np.eye(7) * 1e-9
    question = Question("inertia", frozenset({LAW}), 1.0, nested=True)
    (found,) = probabilities(gram, PLACES, [question])
    v = variance(strong**2, "inertia")
    ratio = strong**2 / v
    y = strong / math.sqrt(v) + np.random.default_rng(2).standard_normal(200_000)
    gain = 0.5 * y**2 * ratio / (1.0 + ratio) - 0.5 * math.log1p(ratio)
    assert found[0] == pytest.approx(np.mean(gain > PRIOR_ODDS), abs=0.03)


def test_what_is_not_there_is_not_found_and_what_is_loud_is() -> None:
    quiet, loud = (level**2 * np.eye(10) for level in (1e-3, 1e3))
    question = Question("inertia", frozenset({LAW}), 1.0, nested=True)
    assert probabilities(quiet, PLACES, [question])[0].max() < 0.01
    assert probabilities(loud, PLACES, [question])[0].min() > 0.99


def test_more_recordings_never_make_it_harder() -> None:
    x = columns(level=200.0)
    asked = questions_of(("inertia", "force_drift", LAW), 0.02)
    once, twice = (probabilities(n * x.T @ x, PLACES, asked) for n in (1.0, 2.0))
    assert all(np.all(b >= a - 1e-9) for q, a, b in zip(asked, once, twice, strict=True) if not q.nested)


def test_every_effect_is_asked_for_against_every_other() -> None:
    asked = questions_of(("inertia", "force_drift", LAW), 0.02)
    pairs = {(q.truth, q.alternative) for q in asked}
    assert pairs == {
        ("inertia", frozenset({LAW})),
        ("inertia", frozenset({LAW, "force_drift"})),
        ("force_drift", frozenset({LAW})),
        ("force_drift", frozenset({LAW, "inertia"})),
        (LAW, frozenset()),
        (LAW, frozenset({"inertia"})),
        (LAW, frozenset({"force_drift"})),
    }


def test_the_variance_is_the_usual_one_under_which_a_diagnosis_judges_all_sets() -> None:
    """What `Discrepancy.above` makes of the best set's form error, a root mean square over n blocks."""
    n, size, strong = 900, 0.02, 4000.0
    usual = Discrepancy(n, EFFECTIVE, 1.0, 2.0).above(
        CATALOGUE["inertia"].form_error * size * strong / math.sqrt(n)
    )
    assert usual.usual == pytest.approx(variance((size * strong) ** 2, "inertia"), rel=1e-12)


def test_a_loud_response_is_told_up_to_what_its_own_form_may_miss() -> None:
    """Orthogonal to the other response: S^2 tends to e / f^2 as it grows."""
    gram = np.diag([1e12, 1e-12, 1e-12, 1e-12, 1e-12, 1e-12, 1e-12, 1e-12, 1e-12, 1e-12])
    question = Question("inertia", frozenset({"force_drift"}), 1.0, nested=False)
    (found,) = probabilities(gram, PLACES, [question])
    most = math.sqrt(EFFECTIVE) / CATALOGUE["inertia"].form_error
    assert found[0] == pytest.approx(norm.cdf(0.5 * most), abs=1e-6)


def test_every_effect_is_asked_for_beside_every_other() -> None:
    asked = questions_beside(("inertia", "force_drift", LAW), 0.02)
    assert {(q.truth, q.beside, q.alternative, q.nested) for q in asked} == {
        ("inertia", "force_drift", frozenset({LAW, "force_drift"}), True),
        ("force_drift", "inertia", frozenset({LAW, "inertia"}), True),
    }


def test_beside_another_effect_it_is_as_the_whole_covariance_has_it() -> None:
    """The other one is LOUDER times as large in the alternative, and its form may miss its part too."""
    x, size = columns(level=300.0), 0.02
    loud = LOUDER * size
    question = Question("inertia", frozenset({LAW, "force_drift"}), size, nested=False, beside="force_drift")
    (found,) = probabilities(x.T @ x, PLACES, [question])
    w = np.column_stack([loud * x[:, 3:5] / math.sqrt(2.0), x[:, 7:10]])
    missed = variance(loud**2 * float(np.mean(np.sum(x[:, 3:5] ** 2, axis=0))), "force_drift") - 1.0
    for k in range(3):
        c = size * x[:, k]
        v = variance(float(c @ c), "inertia") + missed
        distance = float(c @ np.linalg.solve(v * np.eye(400) + w @ w.T, c))
        assert found[k] == pytest.approx(norm.cdf(0.5 * math.sqrt(distance)), abs=1e-9)


def test_slow_noise_keeps_what_is_told_below_its_own_size() -> None:
    """Over e effective samples slow noise of the sum of squares n has the variance n / e. As both grow with the time of
    the recordings, S^2 tends to e |c|^2 / n: here 30 x 9 / 120 = 2.25.
    """
    places = {**PLACES, SLOW_NOISE: slice(10, 11)}
    for time in (1e3, 1e5):
        gram = time * np.diag([9.0, *[1e-12] * 9, 120.0])
        question = Question("inertia", frozenset({"force_drift"}), 1.0, nested=False)
        (found,) = probabilities(gram, places, [question])
        missed = CATALOGUE["inertia"].form_error ** 2 * 9.0
        assert found[0] == pytest.approx(
            norm.cdf(0.5 * math.sqrt(9.0 * EFFECTIVE / (120.0 + missed))), abs=1e-3
        )
