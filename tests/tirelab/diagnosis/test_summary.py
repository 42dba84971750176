"""What is said in the verdict's sentences, and what is not."""

import numpy as np
from tirelab.diagnosis.discriminating_test import DiscriminatingTest, Test
from tirelab.diagnosis.summary import summarise
from tirelab.diagnosis.verdict import Fit, ResidualModel
from tirelab.engine.findings import Alternative, NamedEffect

NAN = float("nan")
FELL = Fit(6.0, 26.4, 6.1, 26.5, 6.2, "recordings given")
STAYED = Fit(6.0, 32.5, 32.5, 32.4, 32.4, "recordings given")
FRICTION = NamedEffect("rate_independent_hysteresis", {}, 1.0)


def learned(by, repeats, after=6.4, held_out_after=6.5):
    return ResidualModel(by, "m", np.arange(3.0), np.arange(3.0), repeats, after, held_out_after)


def test_nothing_missing_does_not_fall():
    fit = Fit(5.0, 5.1, 5.1, NAN, NAN, "recordings given")
    told = summarise((), (), (), 0.7, fit)
    assert told == "Nothing is missing. The error is 5.10 N; the noise is 5.00 N. Confidence 70 %."


def test_an_effect_is_told_with_the_improvement_on_what_was_not_fitted():
    told = summarise((FRICTION,), (), (), 0.85, FELL)
    assert told.startswith("Left out: rate-independent hysteresis. Friction: loading and unloading differ")
    assert "falls from 26.4 N to 6.10 N" in told
    assert "has not seen it falls from 26.5 N to 6.20 N" in told


def test_the_noise_of_the_reading_is_told_apart_from_what_the_tire_misses():
    fit = Fit(6.0, 26.4, 9.1, 26.5, 9.2, "recordings given", 6.2)
    assert "without the noise of its reading, as a simulation tells it, 6.20 N" in summarise(
        (FRICTION,), (), (), 0.85, fit
    )
    assert "without the noise" not in summarise(
        (FRICTION,), (), (), 0.85, Fit(6.0, 26.4, 6.1, 26.5, 6.2, "by", 6.1)
    )


def test_a_correction_that_does_worse_on_what_it_has_not_seen_is_not_said_to_fall():
    told = summarise((FRICTION,), (), (), 0.85, Fit(6.0, 26.4, 6.1, 26.5, 31.0, "recordings given"))
    assert "it does not fall, it goes from 26.5 N to 31.0 N" in told


def test_where_nothing_could_be_fitted_the_error_stays_and_the_curve_is_told():
    told = summarise((), (), (learned("deflection", 0.95),), 0.85, STAYED)
    assert "falls from" not in told
    assert "The error is 32.5 N and stays there; the noise is 6.00 N." in told
    assert "brings the error to 6.40 N, and to 6.50 N on what it has not seen" in told
    assert "the deflection" in told


def test_a_curve_that_does_not_repeat_is_not_offered():
    told = summarise((), (), (learned("time", -0.2),), 0.85, STAYED)
    assert "no curve learned from the recordings repeats" in told
    assert "6.40 N" not in told


def test_of_several_curves_the_one_that_repeats_best_is_told():
    found = (learned("rate", 0.2, 20.0, 21.0), learned("deflection", 0.9))
    told = summarise((), (), found, 0.85, STAYED)
    assert "the rate of deflection and the deflection: a force learned over the deflection brings" in told


def test_one_reason_is_said_once_and_several_each():
    same = [Alternative((n,), 1.0, "one surface") for n in ("viscous_damping", "rate_independent_hysteresis")]
    told = summarise((), same, (), 0.4, STAYED)
    assert "It could also be viscous damping or rate-independent hysteresis: one surface." in told
    told = summarise((), [same[0], Alternative(("force_lag",), 1.0, "one rate")], (), 0.4, STAYED)
    assert "It could also be viscous damping (one surface) or force lag (one rate)." in told


def test_what_may_be_there_beside_the_verdict_is_told_apart_from_what_may_be_in_its_place():
    reason = "one pressure"
    beside = [Alternative((n, "inertia"), 6.0, reason) for n in ("gas_compression", "series_compliance")]
    told = summarise((NamedEffect("inertia", {}, 1.0),), (), (), 0.9, FELL)
    assert "may" not in told
    told = summarise((NamedEffect("inertia", {}, 1.0),), beside, (), 0.9, FELL)
    assert told.endswith(
        "Beside what was found there may be, unseen, gas compression or series compliance: one pressure."
    )
    instead = Alternative(("force_lag",), 2.0, "one rate")
    told = summarise((NamedEffect("inertia", {}, 1.0),), [instead, *beside], (), 0.9, FELL)
    assert "It could also be force lag: one rate. Beside what was found there may be, unseen, gas" in told


def test_that_no_test_would_tell_is_said():
    motion = Test("sweep", np.arange(3.0), np.zeros(3), np.full(3, np.inf))
    between = (("recalibration",), ("series_compliance",))
    rivals = [Alternative(between[1], 1.0, "one surface")]
    worthless = DiscriminatingTest(motion, between, 0.3, 0.01, "No motion would tell.")
    assert summarise((), rivals, (), 0.4, STAYED, worthless).endswith("No motion would tell.")
    telling = DiscriminatingTest(motion, between, 30.0, 1.0, "Drive it.")
    assert "Drive it" not in summarise((), rivals, (), 0.4, STAYED, telling)
