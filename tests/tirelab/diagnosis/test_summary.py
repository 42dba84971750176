"""What is said in the verdict's sentences, and what is not."""

from dataclasses import replace

import numpy as np
import pytest
from tirelab.diagnosis.alternatives import Alternative
from tirelab.diagnosis.discriminating_test import DiscriminatingTest, Test
from tirelab.diagnosis.residual_model import ResidualModel
from tirelab.diagnosis.summary import (
    QUICK,
    in_few_samples,
    law_of_first_loading,
    less_than_noise,
    not_seen,
    other_law,
    pressed_only,
    slow_noise,
    summarise,
)
from tirelab.diagnosis.verdict import FitErrors, NotNamed
from tirelab.estimation.findings import NamedEffect
from tirelab.preprocessing.noise import Noise
from tirelab.recordings.recording import Recording

NAN = float("nan")
FELL = FitErrors(6.0, 26.4, 6.1, 26.5, 6.2, "recordings given")
STAYED = FitErrors(6.0, 32.5, 32.5, 32.4, 32.4, "recordings given")
FRICTION = NamedEffect("rate_independent_hysteresis", {}, 1.0, 0.9)


def regressed(by, repeats, after=6.4, held_out_after=6.5):
    return ResidualModel(by, "m", np.arange(3.0), np.arange(3.0), repeats, after, held_out_after)


def test_nothing_missing_does_not_fall():
    fit = FitErrors(5.0, 5.1, 5.1, NAN, NAN, "recordings given")
    told = summarise((), (), (), 0.7, fit)
    assert told == "Nothing is missing. The RMS error is 5.10 N; the noise is 5.00 N. Confidence 70 %."


def test_an_effect_is_stated_with_the_improvement_on_held_out_data():
    told = summarise((FRICTION,), (), (), 0.85, FELL)
    assert told.startswith(
        "Left out: friction loop (rate-independent hysteresis). Friction: loading and unloading differ"
    )
    assert "The correction reduces the RMS error from 26.4 N to 6.10 N; the noise is 6.00 N." in told
    assert "On held-out data it falls from 26.5 N to 6.20 N." in told


def test_amplified_reading_noise_is_separated_from_the_error_of_the_tire():
    fit = FitErrors(6.0, 26.4, 9.1, 26.5, 9.2, "recordings given", 6.2)
    assert "With the noise-free deflection as input it is 6.20 N; the rest comes of the noise" in summarise(
        (FRICTION,), (), (), 0.85, fit
    )
    assert "noise-free" not in summarise(
        (FRICTION,), (), (), 0.85, FitErrors(6.0, 26.4, 6.1, 26.5, 6.2, "by", 6.1)
    )


def test_a_held_out_error_that_grows_is_not_said_to_fall():
    told = summarise((FRICTION,), (), (), 0.85, FitErrors(6.0, 26.4, 6.1, 26.5, 31.0, "recordings given"))
    assert "On held-out data it does not fall: it goes from 26.5 N to 31.0 N." in told


@pytest.mark.parametrize(
    ("law", "kept", "said"), [(1.5e4, 0.8, True), (1.5e4, 0.2, False), (2e4, 0.8, False)]
)
def test_a_law_amid_a_first_loading_and_softened_cycles_is_told(law: float, kept: float, said: bool):
    """One triangle to 2 mm, two to 20 mm; half of 20 N/mm is lost, and the law of 15 N/mm lies amid both; that of 20
    N/mm is the one of the first loading already."""
    time = np.arange(0.0, 50.0, 0.02)
    large = 0.02 * (1.0 - np.abs(1.0 - 2.0 * (time[:2000] / 20.0 % 1.0)))
    x = np.concatenate([0.1 * large[:1000:2], large])
    stiffness = np.where(x < np.maximum.accumulate(x), 1e4, 2e4)
    foam = Recording("foam", time, x, np.full(x.size, np.inf), stiffness * x)
    before = (stiffness - law) * x
    told = law_of_first_loading([foam], [before], [kept * before])
    assert bool(told) == said
    if said:
        assert told[0].startswith("Of the first loading in foam, from 10 s to 20 s, 9")
        assert "Identify the law of the first loading" in told[0]


@pytest.mark.parametrize(("slope", "told"), [(0.0, False), (0.02, False), (1.5, True)])
def test_what_is_slow_and_less_than_the_noise_is_told_where_nothing_is_named(slope: float, told: bool):
    """A slope from -1 to 1 has the root mean square 1 / sqrt(3); 4000 samples know it to 1 / sqrt(4000)."""
    white = np.random.default_rng(4).standard_normal(4000)
    left = white + slope / 2.0 * np.linspace(-1.0, 1.0, 4000)
    said = less_than_noise([left[:1500], left[1500:]], 0.02)
    assert bool(said) == told
    if told:
        size = float(said[0].split(" N, as white noise does not")[0].rpartition(" ")[2])
        assert size == pytest.approx(0.02 * slope / 2.0 / np.sqrt(3.0), rel=0.15)
    assert less_than_noise([left[:60]], 0.02) == []


@pytest.mark.parametrize(
    ("jolt", "ranges"),
    [((3, 9), "FILE@0.18s:."), ((990, 999), "FILE@:19.8s."), ((500, 505), "FILE@:10s and FILE@10.1s:.")],
)
def test_what_lies_in_few_samples_is_told_with_the_ranges_beside_it(jolt: tuple[int, int], ranges: str):
    """Of 1000 samples ten at most are off, by twenty times the noise; the others are white, a fifth above it."""
    time = np.arange(1000) * 0.02
    left = 1.2 * np.random.default_rng(6).standard_normal(1000)
    own = slice(jolt[0], jolt[1] + 1)
    pulled = Recording("fibre", time, 1e-3 * time, np.full(1000, np.inf), time)
    assert in_few_samples([pulled], [left]) == []
    (told,) = in_few_samples([pulled], [left + _at(own, 20.0)])
    assert f"lie in {jolt[1] - jolt[0] + 1} of 1000 samples" in told
    assert told.endswith(ranges)


def _at(own: slice, size: float) -> np.ndarray:
    off = np.zeros(1000)
    off[own] = size
    return off


def test_a_part_that_the_press_lifts_off_is_said_to_be_only_pressed():
    """Food that keeps 6 of its 10 mm: no force on the way back below them."""
    time = np.arange(0.0, 20.0, 0.02)
    x = 0.01 * (1.0 - np.abs(1.0 - time / 10.0))
    force = 1e4 * np.where(time < 10.0, x, np.maximum(2.5 * (x - 0.006), 0.0))
    spring = Recording("spring", time, x, np.full(x.size, np.inf), 1e4 * x)
    food = Recording("food", time, x, np.full(x.size, np.inf), force)
    (told,) = pressed_only([spring, food])
    assert told.startswith("In food the force rests on a way back")
    assert "`--part power`" in told
    assert pressed_only([spring]) == []


def test_where_no_effect_helps_the_error_stays_and_the_regression_is_stated():
    told = summarise((), (), (regressed("deflection", 0.95),), 0.85, STAYED)
    assert "falls from" not in told
    assert "The RMS error is 32.5 N, and no known effect was found to reduce it; the noise is 6.00 N." in told
    assert "A regression over it reduces the RMS error to 6.40 N, and to 6.50 N on held-out data" in told
    assert "the deflection" in told


@pytest.mark.parametrize(
    ("refused", "why"),
    [(False, "no known effect is likely enough to be named"), (True, "held-out data refuse what reduces it")],
)
def test_what_would_reduce_the_error_is_told_where_nothing_is_named(refused: bool, why: str):
    """A connection that wears: friction follows what is fitted, and not the loops after it."""
    fit = replace(STAYED, not_named=NotNamed(("bottoming", "mullins_softening"), 10.5, 44.0, 31.0, refused))
    # What was held out of the other set need not be what was held out of nothing.
    held_out = ", and of the held-out data 44.0 N in place of 31.0 N" if refused else ""
    told = summarise((), (), (regressed("deflection", 0.95),), 0.9, fit)
    assert (
        f"The RMS error is 32.5 N, and {why}; bottoming and Mullins softening would leave 10.5 N{held_out}; "
        "the noise is 6.00 N." in told
    )
    assert "was found to reduce it" not in told
    assert "no known effect was found to reduce it" in summarise(
        (), (), (regressed("deflection", 0.95),), 0.9, STAYED
    )


def test_an_undecided_verdict_is_not_called_the_likeliest_beside_a_likelier_one():
    others = [Alternative(("inertia",), -3.0, "one speed", 0.14)]
    unsure = replace(FRICTION, probability=0.6)
    assert summarise((unsure,), others, (), 0.06, STAYED).startswith(
        "Undecided; no set of effects is likely. "
    )
    assert summarise((unsure,), others, (), 0.3, STAYED).startswith("Undecided; this is the likeliest ")
    nothing = [replace(others[0], probability=0.0)]
    assert summarise((unsure,), nothing, (), 0.004, STAYED).startswith(
        "Undecided; no set of effects is likely. "
    )
    likely = [replace(others[0], probability=0.53)]
    assert summarise((unsure,), likely, (), 0.06, STAYED).startswith(
        "Undecided; an alternative is likelier. "
    )


def test_what_is_sure_is_said_where_what_acts_beside_it_is_undecided():
    others = [Alternative(("rate_independent_hysteresis", "force_lag"), -3.0, "one speed", 0.14)]
    unsure = replace(FRICTION, name="inertia", probability=0.6)
    told = summarise((FRICTION, unsure), others, (), 0.09, STAYED)
    assert told.startswith("Friction loop is sure; what else acts is undecided. Left out: friction loop ")
    both = (FRICTION, replace(unsure, probability=0.95))
    assert summarise(both, others, (), 0.09, STAYED).startswith("Friction loop and inertia are sure; what ")


def test_a_remainder_that_repeats_over_a_coordinate_is_not_called_too_quick():
    """A ripple over the angle of a joint is passed within a few samples, in each cycle at the same angles."""
    assert not_seen(0.8, (regressed("deflection", 0.3),)) == [QUICK]
    assert not_seen(0.8, (regressed("deflection", NAN),)) == [QUICK]
    assert not_seen(0.8, ()) == [QUICK]
    assert not_seen(0.8, (regressed("time", 0.1), regressed("deflection", 0.82))) == []
    assert not_seen(0.4, ()) == []


def test_another_law_is_proposed_where_a_curve_of_the_deflection_explains_most():
    (said,) = other_law(20.1, (regressed("time", NAN, 1.2), regressed("deflection", NAN, 1.43)))
    assert said == (
        "A curve of the force over the deflection leaves 1.43 N of it: beside the law of "
        "`tirelab identify --part piecewise` more may be told."
    )
    assert other_law(20.1, (regressed("time", 0.9, 1.2), regressed("deflection", 0.3, 15.0))) == []
    assert other_law(20.1, (regressed("time", 0.9, 1.2),)) == []
    assert other_law(20.1, (regressed("deflection", -0.1, 1.43),)) == []


def test_beside_a_likelier_alternative_a_refitted_law_does_not_say_that_nothing_is_missing():
    law = replace(FRICTION, name="recalibration", probability=0.99)
    others = [Alternative(("recalibration", "series_compliance"), 2.0, "", 0.8)]
    told = summarise((law,), others, (), 0.2, replace(STAYED, noise=STAYED.after))
    assert told.startswith(
        "Refitted law is sure; what else acts is undecided, and an alternative is likelier. "
    )
    assert "The elastic law has other coefficients. " in told
    assert "missing" not in told
    assert summarise((), others, (), 0.2, STAYED).startswith(
        "Undecided; an alternative is likelier. No effect is named."
    )


def test_a_curve_that_does_not_repeat_is_not_offered():
    told = summarise((), (), (regressed("time", -0.2),), 0.85, STAYED)
    assert "no regression of it repeats on held-out blocks of time" in told
    assert "Noise that is as slow as the motion leaves this as well: record for as long at rest." in told
    assert "6.40 N" not in told


def test_a_curve_that_raises_the_error_of_held_out_data_is_not_offered():
    """The best one of the fitted recordings, over the rate, makes 33 N of 32.4; that over the deflection does not."""
    rate = replace(regressed("rate", 0.95), after=2.04, held_out_after=33.0)
    other = replace(regressed("deflection", 0.5), held_out_after=6.5)
    told = summarise((), (), (rate,), 0.85, STAYED)
    assert "raise the error on held-out data" in told
    assert "2.04 N" not in told
    told = summarise((), (), (rate, other), 0.85, STAYED)
    assert (
        "A regression over the deflection reduces the RMS error to 6.40 N, and to 6.50 N on held-out" in told
    )


def test_whether_a_curve_repeats_is_not_known_of_what_was_driven_once():
    told = summarise((), (), (regressed("time", float("nan")),), 0.85, STAYED)
    assert "Whether it repeats is not known: drive the motion twice." in told
    told = summarise((), (), (regressed("time", float("nan")), regressed("rate", 0.9)), 0.85, STAYED)
    assert "A regression over the rate of deflection reduces" in told


def test_of_several_regressions_the_one_that_repeats_best_is_stated():
    found = (regressed("rate", 0.2, 20.0, 21.0), regressed("deflection", 0.9))
    told = summarise((), (), found, 0.85, STAYED)
    assert "the rate of deflection and the deflection. A regression over the deflection reduces" in told


def test_one_reason_is_said_once_and_several_each():
    same = [
        Alternative((n,), 1.0, "one surface", 0.2) for n in ("viscous_damping", "rate_independent_hysteresis")
    ]
    told = summarise((), same, (), 0.4, STAYED)
    assert "These recordings cannot rule out viscous damping or friction loop. One surface." in told
    told = summarise((), [same[0], Alternative(("force_lag",), 1.0, "one rate", 0.2)], (), 0.4, STAYED)
    assert "These recordings cannot rule out viscous damping (one surface); or force lag (one rate)." in told


def test_sets_of_several_effects_are_joined_by_plus_signs():
    """With commas nobody can tell where one set ends: friction, damping and lag may be one, two or three."""
    sets = (("viscous_damping", "force_lag"), ("inertia",), ("force_offset", "force_drift", "inertia"))
    same = [Alternative(names, 1.0, "one surface", 0.1) for names in sets]
    told = summarise((), same, (), 0.4, STAYED)
    either = "viscous damping + force lag, inertia or force offset + force drift + inertia"
    assert f"These recordings cannot rule out {either}. One surface." in told
    other = [*same[:2], Alternative(sets[2], 1.0, "one rate", 0.1)]
    told = summarise((), other, (), 0.4, STAYED)
    assert "viscous damping + force lag or inertia (one surface); or force offset + force drift" in told


def test_alternatives_are_told_as_differences_from_the_verdict():
    inertia = (NamedEffect("inertia", {}, 1.0, 0.9),)
    beside = [
        Alternative((n, "inertia"), 6.0, "one pressure", 0.05)
        for n in ("gas_compression", "series_compliance")
    ]
    assert "rule out" not in summarise(inertia, (), (), 0.8, FELL)
    told = summarise(inertia, beside, (), 0.8, FELL)
    assert told.startswith("Left out: inertia – but these recordings cannot rule out alternatives.")
    also = "gas compression or series spring in addition"
    assert told.endswith(f"These recordings cannot rule out {also}. One pressure.")
    instead = [
        *beside,
        Alternative(("force_lag",), 2.0, "one rate", 0.2),
        Alternative((), 2.0, "one cycle", 0.2),
    ]
    told = summarise(inertia, instead, (), 0.8, FELL)
    also = "the same without inertia (one cycle); or gas compression in addition (one pressure)"
    assert f"cannot rule out force lag instead of inertia (one rate); {also}." in told
    told = summarise((), beside[:1], (regressed("deflection", 0.95),), 0.8, FELL)
    assert told.endswith("cannot rule out gas compression + inertia in addition. One pressure.")


def test_where_the_recordings_do_not_decide_that_is_said_first():
    other = [Alternative(("force_lag",), 2.0, "one rate", 0.3)]
    told = summarise((NamedEffect("inertia", {}, 1.0, 0.6),), other, (), 0.43, FELL)
    assert told.startswith("Undecided; this is the likeliest explanation. Left out: inertia. ")
    assert "Undecided" not in summarise((NamedEffect("inertia", {}, 1.0, 0.9),), other, (), 0.496, FELL)


def test_three_alternatives_are_named_and_the_others_counted():
    names = ("gas_compression", "series_compliance", "bottoming", "deflection_offset", "force_offset")
    unseen = [Alternative((names[0],), 1.0, "one pressure", NAN)]
    likely = [Alternative((n,), 1.0, "one pressure", 0.01 * k) for k, n in enumerate(names[1:], 1)]
    told = summarise((), [*unseen, *likely], (), 0.4, STAYED)
    assert (
        "rule out force offset, deflection offset or bottoming. One pressure. 2 more are listed below."
        in told
    )
    assert "listed below" not in summarise((), likely[:3], (), 0.4, STAYED)


def test_a_sure_verdict_is_not_opened_with_its_alternatives():
    unlikely = [Alternative(("series_compliance", "inertia"), 6.0, "one pressure", 0.02)]
    told = summarise((NamedEffect("inertia", {}, 1.0, 0.9),), unlikely, (), 0.96, FELL)
    assert told.startswith("Left out: inertia. ")
    assert told.endswith("These recordings cannot rule out series spring in addition. One pressure.")


def test_that_no_motion_separates_the_alternatives_is_said():
    motion = Test("sweep", np.arange(3.0), np.array([0.0, 0.01, 0.0]), np.full(3, np.inf))
    between = (("recalibration",), ("series_compliance",))
    alternatives = [Alternative(between[1], 1.0, "one surface", 0.2)]
    worthless = DiscriminatingTest(motion, between, gain=0.3, separation=9.0, typical=0.1, missed=0.5)
    assert summarise((), alternatives, (), 0.4, STAYED, worthless).endswith(
        "decides between refitted law and series spring: the forces would differ by at most 0.1 times the noise in a "
        "typical sample, 0.2 times what the forms of the effects may miss (sweep on flat ground)."
    )
    telling = DiscriminatingTest(motion, between, gain=30.0, separation=99.0, typical=1.0, missed=0.0)
    assert telling.sentence.startswith("Drive sweep ")
    assert "Drive sweep" not in summarise((), alternatives, (), 0.4, STAYED, telling)


def noisy(white: float, slow: float) -> tuple[Recording, np.ndarray]:
    """A hold of 20 s with white noise and a mean of 40 white samples [N]."""
    drawn = np.random.default_rng(4)
    mean = np.convolve(drawn.normal(size=2039), np.ones(40) / np.sqrt(40.0), mode="valid")
    noise = white * drawn.normal(size=2000) + slow * mean
    time = 0.01 * np.arange(2000.0)
    return Recording("hold", time, np.full(2000, 0.01), np.full(2000, np.inf), 500.0 + noise), noise


def test_a_noise_that_hardly_changes_from_reading_to_reading_is_told() -> None:
    recording, noise = noisy(2.0, 10.0)
    (told,) = slow_noise([recording], [noise], [Noise(10.2, 32)])
    assert told.startswith("Of the noise of 10.2 N in hold only ")
    # third differences over one sample have 2 N of white noise, and next to nothing of the mean
    assert 1.8 < float(told.split("only ")[1].split(" N")[0]) < 2.8
    assert "lasts for 0.32 s and follows no motion: record at rest" in told
    untimed = slow_noise([replace(recording, timed=False)], [noise], [Noise(10.2, 32)])
    assert "lasts for 32 samples" in untimed[0]


@pytest.mark.parametrize(("white", "slow", "noise"), [(5.0, 0.0, Noise(5.0, 1)), (8.0, 6.0, Noise(10.0, 32))])
def test_white_noise_and_a_slow_part_of_it_are_not(white: float, slow: float, noise: Noise) -> None:
    recording, left = noisy(white, slow)
    assert not slow_noise([recording], [left], [noise])
