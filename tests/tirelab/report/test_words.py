"""Names, numbers and spans as a reader is told them."""

from __future__ import annotations

from typing import Any

import pytest
from fits import fit_of
from tirelab.estimation.findings import estimates_of
from tirelab.report import titles, words


@pytest.mark.parametrize(
    ("value", "std", "unit", "told"),
    [
        (301.4, 3.77, "N.s/m", "301.4 ± 3.8 N·s/m"),
        (-7.9894e-4, 4.7e-7, "m", "−0.79894 ± 0.00047 mm"),
        (0.0199, 0.0008, "1", "0.01990 ± 0.00080"),
        (1234567.0, 45678.0, "N/m", "1234567 ± 45678 N/m"),
        (2e-6, None, "m/N", "2.000 mm/kN"),
        (5.0, float("nan"), "s", "5.000 s"),
        (0.0, 0.0018, "1", "0 ± 0.0018"),
        (-4e-6, 0.0019, "1", "0 ± 0.0019"),
    ],
)
def test_estimates_have_two_digits_of_their_deviation(
    value: float, std: float | None, unit: str, told: str
) -> None:
    assert words.estimate(value, std, unit) == told


@pytest.mark.parametrize(
    ("value", "told"),
    [
        (6.0, "6.00"),
        (-30844.4, "−30844"),
        (0.0, "0"),
        (-0.0, "0"),
        (None, "–"),
        (float("nan"), "–"),
        (1.5e-7, "1.50·10⁻⁷"),
        (999.7, "1000"),
    ],
)
def test_numbers_have_three_digits(value: float | None, told: str) -> None:
    assert words.number(value) == told.replace("-", "−")


def place(by: str, start: Any, stop: Any, unit: str, **more: Any) -> dict[str, Any]:
    return {"by": by, "from": start, "to": stop, "unit": unit, **more}


@pytest.mark.parametrize(
    ("entry", "told"),
    [
        (place("deflection", 0.012, 0.015, "m"), "12.0 to 15.0 mm"),
        (place("deflection", 0.00084, 0.00799, "m"), "0.84 to 7.99 mm"),
        (place("rate", -0.0937, -0.00139, "m/s"), "−93.7 to −1.4 mm/s"),
        (place("rate", -1e-6, 0.5, "m/s"), "0 to 500 mm/s"),
        (place("deflection", 1.2e-9, 3.45e-9, "m"), "1.20·10⁻⁶ to 3.45·10⁻⁶ mm"),
        (place("rate", 0.0240, 0.024003, "m/s"), "24.000 to 24.003 mm/s"),
        (place("rate", 0.0599999999, 0.06, "m/s"), "60.000 mm/s"),
        (place("direction", -1.5, 0.0, "1"), "unloading"),
        (place("direction", 0.0, 1.5, "1"), "loading"),
        (place("radius", "inf", "inf", "m"), "flat ground"),
        (place("radius", -0.381, -0.381, "m"), "concave, radius 38.1 cm"),
        (place("radius", 0.127, "inf", "m"), "127 to ∞ mm"),
        (place("cycle", 0.5, 7.5, "1", label="later cycles"), "later cycles"),
        (place("recording", 2, 2, "1"), "2.00"),
    ],
)
def test_spans_are_told_in_the_readers_units(entry: dict[str, Any], told: str) -> None:
    assert words.span(entry) == told


@pytest.mark.parametrize(
    ("entry", "told"),
    [
        (place("deflection", 0.012, 0.015, "m"), "deflection 12.0 to 15.0 mm"),
        (place("direction", 0.0, 1.5, "1"), "while loading"),
        (place("radius", "inf", "inf", "m"), "on flat ground"),
    ],
)
def test_a_place_is_told_in_a_sentence(entry: dict[str, Any], told: str) -> None:
    assert words.where_phrase(entry) == told
    assert words.where_phrase(entry, coordinate_too=False) == words.span(entry)


def test_a_surface_follows_on() -> None:
    assert words.on_surface("inf") == "flat ground"
    assert words.on_surface(-0.6) == "a concave surface of radius 60 cm"
    assert words.on_surface(0.127) == "a convex surface of radius 12.7 cm"


@pytest.mark.parametrize(
    ("confidence", "word"),
    [
        (0.896, "sure"),
        (0.894, "fairly sure"),
        (0.697, "fairly sure"),
        (0.494, "one of several possibilities"),
    ],
)
def test_the_word_for_a_confidence_agrees_with_the_number_that_is_told(confidence: float, word: str) -> None:
    assert words.confidence_word(confidence) == word


def test_the_foremost_places_do_not_crowd_each_other_out() -> None:
    where = [place("time", i, i + 1, "s") for i in range(5)] + [place("rate", 0, 1, "m/s")]
    assert [p["by"] for p in words.foremost(where, 3)] == ["time", "time", "rate"]
    assert [p["by"] for p in words.foremost(where, 4)] == ["time", "time", "time", "rate"]
    assert len(words.foremost(where, 1)) == 1
    bands = [place("force", i, i + 1, "N") for i in range(2)] + [place("deflection", 0, 1, "m")]
    assert [p["by"] for p in words.foremost(bands, 12)] == ["deflection"]


def test_one_single_rate_is_told_as_the_direction() -> None:
    """A slow triangle has two rates: to call one of them a place says no more than loading or unloading."""
    one, several = place("rate", -1.4692e-3, -1.4664e-3, "m/s"), place("rate", -12e-3, -1e-3, "m/s")
    unloading = place("direction", -1.0, -1.0, "1")
    assert [p["by"] for p in words.foremost([one, unloading], 12)] == ["direction"]
    assert len(words.foremost([several, unloading], 12)) == 2
    assert len(words.foremost([one], 12)) == 1


def test_sets_are_named_whether_known_or_not() -> None:
    assert titles.set_title([]) == "nothing missing"
    assert titles.set_title(["recalibration"]) == "refitted law"
    assert titles.set_title(["unknown", "inertia"]) == "something unknown and inertia"
    assert titles.set_title(["rate"]) == "something unknown over the rate of deflection"


def test_every_parameter_of_a_refitted_law_has_a_meaning() -> None:
    """ "log factor on A" and "change of B", by which the law of each surface is fitted, had none."""
    law = {"bend": 0.01, "twist": 0.01, "kink 1": 0.01}
    labels = [e.name for e in estimates_of(fit_of({"recalibration": law}, (float("inf"), -0.381)))]
    assert len(labels) == 2 * 2 + len(law)
    for label in labels:
        assert words.meaning("recalibration", label), label
    assert "coefficient A" in words.meaning("recalibration", "log factor on A, flat")
    assert words.meaning("force_offset", "offset") == "added to the force"
    assert words.meaning("phlogiston", "mass") == ""
    assert "slope of ln F" in words.meaning("recalibration", "kink 9")


def test_residuals_are_told_to_a_tenth_of_the_noise() -> None:
    assert words.residual(-0.42, 6.0) == "−0.4"
    assert words.residual(0.00123, 0.0) == "0.001"
    assert words.residual(12.3456, 0.05) == "12.346"
    assert words.residual(-3.24e-9, 6e-11) == "−3.24·10⁻⁹"


@pytest.mark.parametrize(("share", "told"), [(0.0, "0 %"), (0.001, "< 1 %"), (0.424, "42 %"), (1.0, "100 %")])
def test_percent(share: float, told: str) -> None:
    assert words.percent(share) == told


@pytest.mark.parametrize(
    ("value", "std", "unit", "allowed", "told"),
    [
        (10.0, 1.0, "N", (-100.0, 100.0), "8.0 to 12.0 N"),
        (1e-3, 1e-4, "m", (0.0, 1.0), "0.80 to 1.20 mm"),
        (0.6, 0.4, "N", (0.0, 100.0), "0 to 1.38 N"),
        (-0.5, 0.1, "1", (-1.0, 1.0), "−0.70 to −0.30"),
        (3.0, None, "N", (0.0, 9.0), "–"),
    ],
)
def test_intervals_hold_95_percent_inside_the_bounds(
    value: float, std: float | None, unit: str, allowed: tuple[float, float], told: str
) -> None:
    assert words.interval(value, std, unit, allowed) == told


def test_bounds_are_those_of_the_catalogue() -> None:
    assert words.bounds("inertia", "mass")[0] == 0.0
    assert words.bounds("phlogiston", "mass") == (-float("inf"), float("inf"))


def test_no_line_ends_between_a_number_and_its_unit() -> None:
    said = words.unbroken(
        "It falls from 103 N to 13.2 N in 8 of 10 meters: 33 %, at 8.4 mm/s, 10 s at 32 mm."
    )
    assert (
        said.replace("\N{NO-BREAK SPACE}", "_")
        == "It falls from 103_N to 13.2_N in 8 of 10 meters: 33_%, at 8.4_mm/s, 10_s at 32_mm."
    )


def test_a_hold_is_told_as_rest_and_not_as_a_rate_and_an_acceleration_of_nothing() -> None:
    """Of a fascicle that was held for three minutes: what the gauge's noise makes of a rate that is none."""
    held = {"by": "rate", "from": -2.8e-8, "to": 1.5e-8, "unit": "m/s", "label": ""}
    still = {"by": "acceleration", "from": -1.6e-9, "to": 2.7e-8, "unit": "m/s^2", "label": ""}
    started = still | {"from": 0.4, "to": 1.2}
    assert words.where_phrase(held) == words.span(held) == "at rest"
    assert words.foremost([still, held, started], 3) == [held, started]
    assert words.foremost([still], 3) == [still]
    slow = held | {"from": -2.0e-6, "to": 0.0}
    assert words.where_phrase(slow) == "rate of deflection −0.00200 to 0 mm/s"


def test_what_a_smoothed_hold_still_moves_is_rest() -> None:
    held = {"by": "rate", "from": 2.8e-17, "to": 1.4e-13, "unit": "m/s"}
    still = {"by": "acceleration", "from": -2.1e-15, "to": -1.2e-18, "unit": "m/s^2"}
    assert words.span(held) == words.where_phrase(held) == "at rest"
    assert words.foremost([still, held], 3) == [held]
    assert "rest" not in words.span(held | {"to": 1.4e-3})


@pytest.mark.parametrize(
    ("size", "load", "shown"),
    [
        (12.0, 100.0, "12 %"),
        (0.7, 100.0, "0.7 %"),
        (0.1, 100.0, "< 1 %"),
        (331.0, 100.0, ""),
        (None, 100.0, ""),
        (1.0, 0.0, ""),
    ],
)
def test_a_size_is_a_part_of_the_load_and_none_that_is_more(
    size: float | None, load: float, shown: str
) -> None:
    assert words.of_load(size, load) == shown
