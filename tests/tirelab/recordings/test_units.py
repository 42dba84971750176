"""Units against their definitions (SI Brochure, NIST SP 811), and against text of any kind."""

import math
import re

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from tirelab.recordings.sampling import sampling_said
from tirelab.recordings.units import (
    QUANTITIES,
    STANDARD_ATMOSPHERE,
    UnitError,
    are_apart,
    conversion,
    given_conversion,
    is_unit,
    meant_unit,
    measures,
    parse_radius,
    split_header,
)


def in_si(value: float, unit: str, si: str) -> float:
    return float(conversion(unit, si).to_si(np.array([value]))[0])


@pytest.mark.parametrize(
    ("value", "unit", "si", "expected"),
    [
        (1.0, "mm", "m", 0.001),
        (1.0, "cm", "m", 0.01),
        (1.0, "µm", "m", 1e-6),
        (1.0, "\N{GREEK SMALL LETTER MU}m", "m", 1e-6),
        (1.0, "in", "m", 0.0254),
        (1.0, "ft", "m", 0.3048),
        (1.0, "mil", "m", 2.54e-5),
        (1.0, "thou", "m", 2.54e-5),
        (1.0, "kN", "N", 1000.0),
        (1.0, "lbf", "N", 4.4482216152605),
        (1.0, "kgf", "N", 9.80665),
        (1.0, "Newton", "N", 1.0),
        (1.0, "Sekunden", "s", 1.0),
        (1.0, "Sek.", "s", 1.0),
        (1.0, "segundos", "s", 1.0),
        (1.0, "Minuten", "s", 60.0),
        (1.0, "milímetros", "m", 1e-3),
        (1.0, "Zoll", "m", 0.0254),
        (1.0, "kPa", "Pa", 1000.0),
        (1.0, "bar", "Pa", 1e5),
        (1.0, "N/mm^2", "Pa", 1e6),
        (1.0, "N/mm²", "Pa", 1e6),
        (1.0, "ms", "s", 0.001),
        (1.0, "min", "s", 60.0),
        (1.0, "km/h", "m/s", 1.0 / 3.6),
        (1.0, "mm/s", "m/s", 0.001),
        (0.0, "degC", "K", 273.15),
        (20.0, "°C", "K", 293.15),
        (20.0, "C", "K", 293.15),
        (32.0, "degF", "K", 273.15),
        (212.0, "F", "K", 373.15),
        (300.0, "K", "K", 300.0),
    ],
)
def test_a_unit_is_worth_what_its_definition_says(value: float, unit: str, si: str, expected: float) -> None:
    # Two roundings of a double: what degF, divided and shifted, may lose.
    assert in_si(value, unit, si) == pytest.approx(expected, rel=5e-16)


def test_fifty_psi_is_the_pressure_the_article_should_have_printed() -> None:
    # The article prints "34.7 kPa (50 psi)"; 50 lbf on a square inch are 344.7 kPa.
    assert in_si(50.0, "psi", "Pa") == pytest.approx(344.7e3, abs=0.05e3)


@pytest.mark.parametrize("radius", [1.27, 1.905, 2.54, 5.08, 12.7, 25.4, 38.1, 50.8, 58.4])
def test_centimetres_become_the_double_nearest_to_the_metres_a_person_would_write(radius: float) -> None:
    assert in_si(radius, "cm", "m") == float(f"{radius * 10:.4g}e-3")


@pytest.mark.parametrize("unit", ["psi", "psig", "psi g", "psi(g)", "psi gauge"])
def test_a_pressure_is_gauge_unless_it_says_absolute(unit: str) -> None:
    assert in_si(0.0, unit, "Pa") == 0.0
    assert not conversion(unit, "Pa").absolute_pressure


@pytest.mark.parametrize(("value", "unit"), [(1.01325, "bara"), (101.325, "kPa abs"), (1.0, "atm(a)")])
def test_an_absolute_pressure_loses_the_standard_atmosphere(value: float, unit: str) -> None:
    assert conversion(unit, "Pa").absolute_pressure
    assert in_si(value, unit, "Pa") == pytest.approx(0.0, abs=1e-15 * STANDARD_ATMOSPHERE * 4)


@pytest.mark.parametrize(
    ("unit", "si", "advice"),
    [
        ("lb", "N", "lbf"),
        ("kg", "N", "kgf"),
        ("KN", "N", "kN"),
        ("PSI", "Pa", "psi"),
        ("MM", "m", "mm"),
        ("wibble", "m", "write m, cm, mm, in or ft"),
        ("V", "Pa", "write the pressure of 1 V, the calibration, as its unit: 250 Pa"),
        ("V", "m", "write the length of 1 V, the calibration, as its unit: 250 mm"),
        ("A", "Pa", "write Pa"),
        ("9**9**9", "m", "unknown"),
        ("", "s", "unknown"),
        ("%", "N", "not a unit of force"),
        ("delta_degC", "K", "degC"),
    ],
)
def test_a_wrong_unit_is_refused_with_the_likely_one(unit: str, si: str, advice: str) -> None:
    with pytest.raises(UnitError, match=advice.replace("*", r"\*")):
        conversion(unit, si)


@given(st.text(max_size=60), st.sampled_from(sorted(QUANTITIES)))
def test_any_text_is_a_unit_or_one_sentence(text: str, si: str) -> None:
    try:
        found = conversion(text, si)
    except UnitError as error:
        message = str(error)
    else:
        message = ""
        assert math.isfinite(found.multiply * found.divide * found.offset)
    assert "\n" not in message


def test_nothing_is_worked_out_that_a_header_says() -> None:
    assert not measures("__import__('os').getcwd()", "m")
    assert not measures("2 mm", "m")


@pytest.mark.parametrize(
    ("text", "name", "unit"),
    [
        ("force [N]", "force", "N"),
        ("Load cell (kN)", "Load cell", "kN"),
        ("Force (cell 2) (N)", "Force (cell 2)", "N"),
        ("pressure [bar(g)]", "pressure", "bar(g)"),
        ("pressure (bar(g))", "pressure", "bar(g)"),
        ("speed[ m/s ]", "speed", "m/s"),
        ("time [s] raw", "time", "s"),
        ("Load(kN)_Filtered", "Load Filtered", "kN"),
        ("Displ (mm) raw", "Displ raw", "mm"),
        ("Force (N) (sum)", "Force (sum)", "N"),
        ("Force (cell) (lbs)", "Force (cell)", "lbs"),
        ("Force (left) raw", "Force (left) raw", None),
        ("Force (min) raw", "Force (min) raw", None),
        ("x", "x", None),
        ("F [-]", "F", None),
        ("  load   cell ", "load cell", None),
        ("[N]", "[N]", None),
    ],
)
def test_a_header_is_a_name_and_a_unit(text: str, name: str, unit: str | None) -> None:
    assert split_header(text) == (name, unit)


@pytest.mark.parametrize(
    ("text", "metres"),
    [
        ("flat", math.inf),
        (" Flat", math.inf),
        ("-inf", math.inf),
        (math.inf, math.inf),
        ("25.4cm", 0.254),
        ("-50.8 cm", -0.508),
        ("\N{MINUS SIGN}50.8 cm", -0.508),
        ("10 in", 0.254),
        (-0.381, -0.381),
    ],
)
def test_a_radius_is_flat_or_a_length(text: str | float, metres: float) -> None:
    assert parse_radius(text) == pytest.approx(metres, rel=3e-16)


@pytest.mark.parametrize(
    "text", ["25.4", "0 cm", 0.0, True, 10**400, math.nan, "nan cm", "wide", "", "25.4 kg", "cm"]
)
def test_what_is_no_radius_is_refused(text: str | float) -> None:
    with pytest.raises(UnitError, match=r"radius|not a unit of length"):
        parse_radius(text)


@pytest.mark.parametrize(
    ("unit", "si", "advice"),
    [
        ("%", "m", "a strain times the length of the specimen"),
        ("mm/mm", "m", "a strain times the length of the specimen"),
        ("N/mm^2", "N", "a stress times the cross-section of the specimen"),
        ("kg", "m", "write m, cm, mm, in or ft"),
    ],
)
def test_what_is_measured_of_a_specimen_is_told_how_to_become_a_length_or_a_force(
    unit: str, si: str, advice: str
) -> None:
    with pytest.raises(UnitError, match=advice):
        conversion(unit, si)


@pytest.mark.parametrize(
    ("unit", "si", "how"),
    [
        ("rad", "m", "an angle may stand for a deflection, 1 rad as 1 mm"),
        ("deg", "m", "an angle may stand for a deflection, 1 deg as 1 mm"),
        ("mN*m", "N", "a torque may stand for a force, 1 mN*m as 1 N"),
        ("N*m", "N", "a torque may stand for a force"),
    ],
)
def test_a_test_of_torsion_is_told_what_stands_for_what(unit: str, si: str, how: str) -> None:
    with pytest.raises(UnitError, match=re.escape(how)):
        conversion(unit, si)


@pytest.mark.parametrize(
    ("text", "value", "newtons"),
    [("500mN", 3.0, 1.5), ("12.5 N", 2.0, 25.0), ("0.1kgf", 10.0, 9.80665), ("kN", 2.0, 2000.0)],
)
def test_a_unit_that_is_given_may_be_a_calibration(text: str, value: float, newtons: float) -> None:
    found = given_conversion(text, "N")
    assert float(found.to_si(np.array([value]))[0]) == pytest.approx(newtons, rel=1e-15)
    assert found.unit == text


@pytest.mark.parametrize(("text", "si"), [("-5 N", "N"), ("0 N", "N"), ("2 bar abs", "Pa"), ("2 degC", "K")])
def test_what_is_no_calibration_is_refused(text: str, si: str) -> None:
    with pytest.raises(UnitError, match="is no calibration"):
        given_conversion(text, si)


@pytest.mark.parametrize(
    ("line", "rate"),
    [
        ("Sample Frequency (Hz): 10000", "10000Hz"),
        ("Sampling rate: 2.5 kHz", "2.5kHz"),
        ("sample_rate;50;Hz", "50Hz"),
        ("Samp Rate (Hz): 3000", "3000Hz"),
        ("Delta_X 0.001000 0.001000 0.001000", "0.001s"),
        ("Delta_X\t1.0000000000000000E-2", "0.01s"),
        ("Delta_X 0.0", ""),
        ("Sample rate: 100", ""),
        ("Resampled at 5 Hz", ""),
        ("Sample height (mm): 20", ""),
    ],
)
def test_a_line_may_state_the_sampling(line: str, rate: str) -> None:
    assert sampling_said(("Operator: A", line)) == rate


@pytest.mark.parametrize("degree", ["°", "\N{RING ABOVE}", "\N{MASCULINE ORDINAL INDICATOR}"])
def test_a_degree_is_one_however_an_export_writes_it(degree: str) -> None:
    assert conversion(f"{degree}C", "K").to_si(np.array([20.0])) == pytest.approx([293.15])


@pytest.mark.parametrize("unit", ["N.m", "\N{GREEK SMALL LETTER MU}N.m", "kgf.cm", "lbf.in"])
def test_a_dot_joins_a_torque(unit: str) -> None:
    assert is_unit(unit)
    assert meant_unit(unit, "N") == "N"


def test_a_dot_within_words_joins_nothing() -> None:
    assert not is_unit("a.u.")
    assert not is_unit("S.D")
    assert conversion("mm.", "m").divide == 1000.0


@pytest.mark.parametrize(
    ("unit", "si", "offered", "one"),
    [
        ("DaN", "N", "daN", 10.0),
        ("10 ms", "s", "10 ms", 0.01),
        ("ms/10", "s", "0.1 ms", 1e-4),
        ("1/100 mm", "m", "0.01 mm", 1e-5),
        ("0.01 mm", "m", "0.01 mm", 1e-5),
        ("x10 N", "N", "10 N", 10.0),
    ],
)
def test_the_unit_that_is_offered_is_as_large_as_the_one_that_is_written(
    unit: str, si: str, offered: str, one: float
) -> None:
    """Ten milliseconds are not a millisecond: who copies what is offered must not be wrong by a factor."""
    with pytest.raises(UnitError) as caught:
        conversion(unit, si)
    assert caught.value.likely == offered
    assert offered in str(caught.value)
    assert float(given_conversion(offered, si).to_si(np.array([1.0]))[0]) == pytest.approx(one, rel=1e-12)


@pytest.mark.parametrize(("unit", "si"), [("10 apples", "m"), ("1/0 mm", "m"), ("7", "m"), ("500 N", "N")])
def test_no_unit_is_offered_for_what_counts_nothing_or_what_a_load_cell_bears(unit: str, si: str) -> None:
    with pytest.raises(UnitError) as caught:
        conversion(unit, si)
    assert caught.value.likely == ""


@pytest.mark.parametrize(
    ("text", "name", "unit"),
    [
        ("Force [N] x10", "Force", "N x10"),
        ("Force [N]*10", "Force", "N *10"),
        ("Force [N] (x10)", "Force", "N (x10)"),
        ("Force (N) x10", "Force", "N x10"),
        ("Force [N] /10", "Force", "N /10"),
        ("Force x10 [N]", "Force", "N x10"),
        ("Force*1000 (N)", "Force", "N x1000"),
        ("Fmax10 [N]", "Fmax10", "N"),
        ("pos x1 [mm]", "pos x1", "mm"),
        ("Force [N] 10^3", "Force", "N 10^3"),
        ("Force [N] max", "Force max", "N"),
        ("Force [N] setpoint", "Force setpoint", "N"),
        ("Force [N]/Area [mm2]", "Force /Area [mm2]", "N"),
        ("Force [N] [filtered]", "Force", "N"),
        ("Force [N] 2", "Force", "N"),
        ("Force [N].1", "Force", "N"),
    ],
)
def test_what_stands_behind_the_brackets_of_a_unit(text: str, name: str, unit: str) -> None:
    assert split_header(text) == (name, unit)


@pytest.mark.parametrize(
    "unit", ["N x10", "N *10", "N (x10)", "N\N{MULTIPLICATION SIGN}10", "x10 N", "10^1 N"]
)
def test_a_factor_behind_a_unit_is_asked_about(unit: str) -> None:
    with pytest.raises(UnitError, match="does 1 in the column stand for 10 N") as caught:
        conversion(unit, "N")
    assert caught.value.likely == "10 N"


@pytest.mark.parametrize(
    ("unit", "other", "apart"),
    [
        ("N", "kN", True),
        ("mm", "in", True),
        ("bar", "bar abs", True),
        ("s", "sec", False),
        ("C", "degC", False),
        ("mm", "N", False),
        ("mm", "words", False),
    ],
)
def test_units_of_one_quantity_that_are_not_of_one_size(unit: str, other: str, apart: bool) -> None:
    assert are_apart(unit, other) is apart


@pytest.mark.parametrize(
    ("unit", "si", "one"),
    [
        ("Inch", "m", 0.0254),
        ('"', "m", 0.0254),
        ("Mils", "m", 2.54e-5),
        ("milli-inch", "m", 2.54e-5),
        ("Millimeter", "m", 1e-3),
        ("мкм", "m", 1e-6),
        ("Lbf", "N", 4.4482216152605),
        ("lb-f", "N", 4.4482216152605),
        ("pounds-force", "N", 4.4482216152605),
        ("Kgf", "N", 9.80665),
        ("kg-f", "N", 9.80665),
        ("gram-force", "N", 9.80665e-3),
        ("кН", "N", 1000.0),
        ("мин", "s", 60.0),
        ("초", "s", 1.0),
    ],
)
def test_units_in_other_words(unit: str, si: str, one: float) -> None:
    assert in_si(1.0, unit, si) == pytest.approx(one, rel=1e-15)


@pytest.mark.parametrize(
    ("unit", "si", "likely"),
    [
        ("DAN", "N", "daN"),
        ("LBF", "N", "lbf"),
        ("tonf", "N", "tf"),
        ("t", "N", "tf"),
        ("MM", "m", "mm"),
        ("M", "m", "m"),
        ("UM", "m", "um"),
        ("?m", "m", "um"),
        ("\N{LATIN CAPITAL LETTER A WITH CIRCUMFLEX}\N{MICRO SIGN}m", "m", "um"),
        ("\N{REPLACEMENT CHARACTER}s", "s", "us"),
        ("MPA", "Pa", "MPa"),
    ],
)
def test_a_unit_of_another_size_is_never_offered(unit: str, si: str, likely: str) -> None:
    with pytest.raises(UnitError) as caught:
        conversion(unit, si)
    assert caught.value.likely == likely


@pytest.mark.parametrize("word", ["rod", "link", "hands", "point", "chain", "px", "pc", "Pole"])
def test_words_of_machines_and_screens_are_no_units(word: str) -> None:
    """To pint a rod is 5.03 m, a hand 0.1 m, a point 1/72 in and a pixel 1/96 in."""
    assert not is_unit(word)
    with pytest.raises(UnitError, match="unknown unit"):
        conversion(word, "m")
