"""Units as engineers write them, read with pint and turned into SI."""

import difflib
import math
import re
from collections.abc import Iterable
from dataclasses import dataclass, replace
from functools import cache, lru_cache
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from ..errors import TirelabError
from .other_columns import is_measured
from .unit_words import CASED, COMMON, LIKELY, LOOKALIKES, MICRO_LOST, POWER, SPELLINGS, USUAL, so_many

if TYPE_CHECKING:
    import pint

MOST_TEXTS = 4096
"""Most texts that are remembered as units or none: the tables of a workbook ask for the same ones many times."""

SHORTEST_WORD = 3
"""Letters of a unit of which a large first one says nothing: Kgf, not Mm, which may have a prefix."""

STANDARD_ATMOSPHERE = 101_325.0
"""Ambient pressure [Pa] taken off an absolute pressure (ISO 2533:1975, sea level)."""

QUANTITIES = {"s": "time", "m": "length", "N": "force", "Pa": "pressure", "K": "temperature", "m/s": "speed"}
"""The SI units the tool works in, and what each one measures."""

OF_A_SPECIMEN = {
    "m": ("percent", "a strain times the length of the specimen is one"),
    "N": ("Pa", "a stress times the cross-section of the specimen is one"),
}
"""What a test of a material states in place of a length and of a force: a unit of it, and how one becomes the other."""

ANGLES = frozenset({"rad", "mrad", "radian", "radians", "deg", "degree", "degrees", "°", "rev", "turn"})
"""Units of the angle that a test of torsion states in place of a length."""

NO_UNITS = frozenset(
    {
        *("rod", "pole", "perch", "link", "chain", "hand", "league", "fathom", "shake", "rd", "li", "fur"),
        *("point", "pica", "cicero", "didot", "px", "pp", "bp", "pc", "au", "ly", "parsec", "th"),
    }
)
"""Lengths and times of surveyors, printers, screens and astronomers, in pint's names: at the end of the name of a
column they are a part of a machine, `position_link`, or what was asked for, `set_point`; a pixel has any size."""

# Names and small exponents only: pint would also work out 9**9**9 for us.
_WORD = r"[^\W\d_]+(?:_[^\W\d_]+)*"
_UNIT = re.compile(rf"[°Δ%]?{_WORD}(?:(?:\^|\*\*)?-?[1-4]|[²³])?")
_JOINT = re.compile(r"\s*[*/·⋅]\s*|\s+")
_DOT = re.compile(r"(?<=[Nf])\.(?=(?:[cm]?m|s|in|ft)\b)")
"""The dot of a product as in N.m and N.s/m."""
_GAUGE = re.compile(
    r"^(?P<unit>psi|bar|mbar|Pa|hPa|kPa|MPa|atm)[\s_]*(?:\(?(?P<kind>g|ga|gauge|a|abs|absolute)\)?)$"
)
_FACTOR = re.compile(r"[\[(]?\s*(?:[x*/\N{MULTIPLICATION SIGN}\N{MIDDLE DOT}]\s*\d|10(?:\^|\*\*|e)).*")
"""What stands behind a unit that is not that of the numbers: x10, *1000, (x10), /10, 10^3."""
_SCALED = re.compile(r"(?P<name>.*\w)(?:\s+x|\s*[*\N{MULTIPLICATION SIGN}])\s*(?P<by>10+)")
"""A name with a factor: Force x10."""
MAGNITUDE = re.compile(r"^(?P<value>[+-]?(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?)\s*(?P<unit>.*)$")
_IN_BRACKETS = re.compile(r"(?P<name>[^\[\]]*)\[(?P<unit>[^\[\]]*)\](?P<more>.*)")
_IN_PARENTHESES = re.compile(r"(?P<name>.*)\((?P<unit>[^()]*(?:\([^()]*\))?)\)")
_WITHIN_A_NAME = re.compile(r"(?P<name>[^()]*)\((?P<unit>[^()]*)\)(?P<more>[^()]+)")
_FULL_WIDTH = str.maketrans("（）［］【】", "()[][]")
FLAT_WORDS = frozenset({"flat", "inf", "+inf", "-inf", "infinity", "+infinity", "-infinity", "infinite", "∞"})
"""What a radius may say instead of a number."""


class UnitError(TirelabError):
    """A unit or a length that cannot be read; likely: the unit that was meant, "" where none is near."""

    def __init__(self, what: str, likely: str = "") -> None:
        super().__init__(what)
        self.likely = likely


@dataclass(frozen=True)
class Conversion:
    """The way from a unit to SI: value * multiply / divide + offset.

    A divisor is kept apart because 1.27 / 100 is the double nearest to 0.0127 and 1.27 * 0.01 need not be.
    """

    unit: str
    si: str
    multiply: float = 1.0
    divide: float = 1.0
    offset: float = 0.0
    absolute_pressure: bool = False

    @property
    def multiplied(self) -> float:
        """One of the unit in SI, without an offset."""
        return self.multiply / self.divide

    def to_si(self, values: NDArray[np.float64]) -> NDArray[np.float64]:
        """The values in SI, NaN and infinities passed on; worked out in place if the array may be written."""
        if (self.multiply, self.divide, self.offset) == (1.0, 1.0, 0.0):
            return values
        si = values if values.flags.writeable else values.copy()
        if self.multiply != 1.0:
            si *= self.multiply
        if self.divide != 1.0:
            si /= self.divide
        if self.offset != 0.0:
            si += self.offset
        return si


@cache
def _registry() -> "pint.UnitRegistry[float]":
    # Imported here because it takes half a second that only readers of recordings need.
    import pint

    return pint.UnitRegistry()


@cache
def conversion(unit: str, si: str) -> Conversion:
    """The conversion from a unit, as a header or an engineer writes it, to an SI unit.

    si_value = value * multiply / divide + offset; degC and degF with their offset; a pressure is gauge unless
    the unit says absolute (psia, bara, "bar abs", kPa(a)): then the standard atmosphere is taken off.

    Parameters: `unit`, any that pint knows of the right dimension; `si`, a key of `QUANTITIES`.
    Errors: UnitError with the likely spelling when pint does not know the unit or it measures something else.
    Source: pint's default registry (definitions of NIST SP 811).
    """
    text = _DOT.sub("*", " ".join(unit.translate(LOOKALIKES).split()).removesuffix("."))
    quantity = QUANTITIES[si]
    gauge = _GAUGE.match(text) if si == "Pa" else None
    absolute = gauge is not None and gauge["kind"].startswith("a")
    spelled = gauge["unit"] if gauge else SPELLINGS.get((si, text), text)
    spelled = "percent" if spelled == "%" else spelled
    registry = _registry()
    parsed = _parsed(spelled)
    if parsed is None or parsed.dimensionality != registry.Unit(si).dimensionality:
        parsed = _parsed(_in_small_letters(spelled, si)) or parsed
    if parsed is None:
        what = f"unknown unit {unit[:40]!r} of {quantity}; {_advice(text, si)}"
        raise UnitError(what, _likely(text, si))
    known = parsed.dimensionality
    if known != registry.Unit(si).dimensionality or "delta_" in spelled:
        measured, becomes = OF_A_SPECIMEN.get(si, ("", ""))
        # an angle has no dimension either
        of_specimen = known == registry.Unit(measured).dimensionality and (
            known or text == "%" or "/" in text
        )
        advice = becomes if measured and of_specimen else _advice(text, si, known=True)
        advice = _of_torsion(text, si) or advice
        if known == registry.Unit("V").dimensionality:
            usual = "mm" if si == "m" else COMMON[si][0]
            advice = f"write the {quantity} of 1 {text}, the calibration, as its unit: 250 {usual}"
        what = f"{unit[:40]!r} is not a unit of {quantity}; {advice}"
        raise UnitError(what, _likely(text, si, known=True))
    zero, one = registry.Quantity(0.0, parsed), registry.Quantity(1.0, parsed)
    factor = float((one - zero).to(si).magnitude)
    divisor = round(1.0 / factor) if factor < 1.0 else 1
    if not math.isclose(divisor * factor, 1.0, rel_tol=1e-14):
        divisor = 1
    offset = -STANDARD_ATMOSPHERE if absolute else float(zero.to(si).magnitude)
    return Conversion(unit, si, 1.0 if divisor > 1 else factor, float(divisor), offset, absolute)


def _parsed(text: str) -> "pint.Unit | None":
    """Return the unit that pint reads in a text; None where it knows none."""
    try:
        return _registry().Unit(text) if all(map(_is_word_of_unit, _JOINT.split(text))) else None
    except Exception:  # pint raises whatever its tokenizer meets: AttributeError, AssertionError, ...
        return None


def _in_usual_case(text: str, si: str) -> str:
    """Return the unit that one with other letters large, KN, MM or DAN, is in common use; "" where there is none."""
    words = [*(unit for unit in CASED if unit.lower() == text.lower()), _in_small_letters(text.title(), si)]
    size = _registry().Unit(si).dimensionality
    fits = [unit for unit in words if (parsed := _parsed(unit)) is not None and parsed.dimensionality == size]
    return fits[0] if fits else ""


def _in_small_letters(text: str, si: str) -> str:
    """Return a unit that begins like a sentence, Inch or Lbf, in small letters, in which its first is no prefix; any
    other text as it is."""
    small = text.lower()
    return SPELLINGS.get((si, small), small) if text == small.title() and len(text) >= SHORTEST_WORD else text


@cache
def given_conversion(text: str, si: str) -> Conversion:
    """Return the conversion from a unit that is given, or from so many of one, the calibration of a column: 500 mN.

    A header says how much a load cell bears in this form (`Load (500 N)`), so its unit is read by `conversion`.
    Errors: as `conversion`; UnitError for a calibration that is not positive, or in a unit with a zero of its own.
    """
    found = MAGNITUDE.match(text.strip())
    if found is None or not found["unit"].strip():
        return conversion(text, si)
    one, value = conversion(found["unit"].strip(), si), float(found["value"])
    if not 0.0 < value < math.inf or one.offset != 0.0:
        raise UnitError(
            f"{text[:40]!r} is no calibration; write one as 12.5 N, and the sign before the column"
        )
    return replace(one, unit=text, multiply=value * one.multiply)


def _of_torsion(unit: str, si: str) -> str:
    """Return how an angle stands for a deflection, or a torque for a force; "" where the unit is of neither."""
    stand_in = _stand_in(unit, si)
    what = {"mm": "an angle may stand for a deflection", "N": "a torque may stand for a force"}
    return f"{what[stand_in]}, 1 {unit} as 1 {stand_in}" if stand_in else ""


@lru_cache(maxsize=MOST_TEXTS)
def _stand_in(unit: str, si: str) -> str:
    """Return the unit of a length or a force as which an angle or a torque is read; "" for any other. J is energy."""
    if si == "m" and unit.casefold() in ANGLES:
        return "mm"
    spelled = SPELLINGS.get((si, unit), _DOT.sub("*", unit))
    if si != "N" or "j" in unit.casefold() or not is_unit(spelled) or unit.strip() in ("%", "-"):
        return ""
    torque = _registry().Unit("N*m").dimensionality
    return "N" if _registry().Unit(spelled).dimensionality == torque else ""


def _is_word_of_unit(word: str) -> bool:
    return bool(_UNIT.fullmatch(word)) and not {word.lower(), word.lower().removesuffix("s")} & NO_UNITS


@lru_cache(maxsize=MOST_TEXTS)
def is_unit(text: str) -> bool:
    """Whether a text is a unit of anything that pint knows, or of a share: V, deg, N/mm, %."""
    text = _DOT.sub("*", text.replace("\N{GREEK SMALL LETTER MU}", "\N{MICRO SIGN}"))
    words = _JOINT.split(text.strip())
    if text.strip() in ("%", "-"):
        return True
    if not all(map(_is_word_of_unit, words)):
        return False
    try:
        _registry().Unit(text)
    except Exception:  # as in conversion
        return False
    return True


@lru_cache(maxsize=MOST_TEXTS)
def measures(unit: str, si: str) -> bool:
    """Whether a text is a unit of what the SI unit measures."""
    try:
        conversion(unit, si)
    except UnitError:
        return False
    return True


def are_apart(unit: str, other: str) -> bool:
    """Whether two texts are units of one quantity, and not of one size: N and kN."""
    both = [si for si in QUANTITIES if measures(unit, si) and measures(other, si)]
    return any(replace(conversion(unit, si), unit=other) != conversion(other, si) for si in both)


def is_no_unit(text: str, kinds: Iterable[str] = QUANTITIES) -> bool:
    """Whether a text is a word, or several, and neither a unit nor one by which another unit is meant: Absolute, sum,
    Digital Strain 1.

    kinds: the SI units of what it might be a unit of
    """
    several = [own for own in text.split() if own.isalnum()]
    words = " ".join(several) == text and any(own.isalpha() and len(own) > 3 for own in several)
    word = (text.isalpha() or (words and len(several) > 1)) and len(text) > 1 and not is_unit(text)
    return word and not any(meant_unit(text, si) or _likely(text, si) for si in kinds)


def meant_unit(unit: str, si: str) -> str:
    """Return the unit that is meant by one of something else, the force by the mass of a scale or a torque, the
    deflection by an angle; "" where none is.
    """
    if measures(unit, si):
        return ""
    return _likely(unit.strip(), si, known=True) or _stand_in(unit.strip(), si)


def split_header(text: str) -> tuple[str, str | None]:
    """The name and the unit of a column header such as "force [N]" or "Load cell (kN)"; no unit is None."""
    plain = " ".join(text.translate(_FULL_WIDTH).split())
    for pattern in (_IN_BRACKETS, _IN_PARENTHESES):
        found = pattern.fullmatch(plain)
        if found and found["name"]:
            more = found["more"] if pattern is _IN_BRACKETS else ""
            name, unit = found["name"].strip(), found["unit"].strip()
            if name.endswith(")") and unit.isalpha() and not is_unit(unit):  # Force (N) (sum)
                inner, known = split_header(name)
                name, unit = (f"{inner} ({unit})", known) if known in USUAL else (name, unit)
            return _with_what_follows(name, unit, more.strip())
    within = _WITHIN_A_NAME.fullmatch(plain)
    # Other words in parentheses within a name belong to it: Force (left) filtered.
    if within and within["name"] and within["unit"] in USUAL:
        name, more = within["name"].strip(" _"), within["more"].strip(" _")
        if _FACTOR.fullmatch(more):
            return _with_what_follows(name, within["unit"], more)
        return f"{name} {more}".strip(), within["unit"]
    return plain, None


def _with_what_follows(name: str, unit: str, more: str) -> tuple[str, str | None]:
    """Return a name and a unit with what stands behind the brackets: a factor belongs to the unit, `[N] x10`; a word
    for what is no reading, `[N] max`, and a quotient, `[N]/Area [mm2]`, to the name. Any other text says nothing.
    """
    if _FACTOR.fullmatch(more):
        return name, f"{unit} {more}"
    if scaled := _SCALED.fullmatch(name):
        return scaled["name"], f"{unit} x{scaled['by']}"
    if more.startswith("/") or not is_measured(more):
        name = f"{name} {more}"
    return name, unit if unit.strip("-") else None


def parse_radius(text: str | float) -> float:
    """A surface radius [m] from "flat", "25.4 cm", "-50.8cm" or a number in metres; flat is inf.

    Valid range: any length but zero, convex > 0, concave < 0.
    Errors: UnitError for zero, NaN, a missing unit or a unit that is not a length.
    """
    if isinstance(text, (int, float)):
        # A truth value is a number in Python, and an integer may be beyond every double.
        known = not isinstance(text, bool) and (isinstance(text, float) or abs(text) < 10**300)
        radius = float(text) if known else math.nan
    elif text.strip().lower() in FLAT_WORDS:
        return math.inf
    else:
        found = MAGNITUDE.match(text.strip().replace("\N{MINUS SIGN}", "-"))
        if found is None:
            raise UnitError(
                f"radius {text[:40]!r} cannot be read; write flat, 25.4cm (convex) or -50.8cm (concave)"
            )
        value = float(found["value"])
        if value and not found["unit"]:
            raise UnitError(f"radius {text[:40]!r} has no unit; write for instance {found['value']}cm")
        radius = float(conversion(found["unit"], "m").to_si(np.array([value]))[0]) if value else 0.0
    if math.isnan(radius) or radius == 0.0:
        raise UnitError(
            f"radius {str(text)[:40]!r} is no radius; write flat, 25.4cm (convex) or -50.8cm (concave)"
        )
    return math.inf if math.isinf(radius) else radius


def parse_quantity(text: str, si: str) -> float:
    """Return a value in SI from a number and a unit: "2.5 bar", "21 degC"; a pressure is gauge unless it says absolute.

    Errors: UnitError for what has no number, no unit, or a unit of something else.
    """
    found = MAGNITUDE.match(text.strip().replace("\N{MINUS SIGN}", "-"))
    if found is None or not found["unit"].strip():
        raise UnitError(f"{text[:40]!r} is no {QUANTITIES[si]}; write a number and {_advice('', si)[6:]}")
    return float(conversion(found["unit"].strip(), si).to_si(np.array([float(found["value"])]))[0])


def with_likely_unit(value: float, usual: str, si: str) -> str:
    """Return a number that was written without a unit with the one in which it is nearest to a usual quantity."""
    size, units = parse_quantity(usual, si), [conversion(unit, si) for unit in COMMON[si]]
    in_unit = {c.unit: (size - c.offset) / c.multiplied for c in units}
    far = {unit: abs(math.log(abs(value) / number)) for unit, number in in_unit.items()}
    return f"{value:.15g} {min(far, key=far.__getitem__)}"


def _likely(unit: str, si: str, known: bool = False) -> str:
    """Return the unit that was likely meant, "" where none is near; known: it is a unit, but of something else."""
    hint = LIKELY.get((si, unit.lower()), "")
    lost = MICRO_LOST.fullmatch(unit)
    if lost and lost["unit"] == si:
        return f"u{si}"
    usual = _in_usual_case(unit, si)
    if usual:
        return usual
    if hint or known:
        return hint if hint and measures(hint, si) else ""
    if any(map(str.isdigit, unit)):
        # Behind a force it may be what the load cell bears: Load (500 N).
        many = (
            so_many(unit)
            if si != "N" or POWER.match(unit) or unit.startswith("x") or not unit[0].isdigit()
            else ""
        )
        return many if many and measures(many.split(" ", 1)[1], si) else ""
    names = {name.lower(): name for name in COMMON[si]}
    near = difflib.get_close_matches(unit.lower(), names, n=1, cutoff=0.5)
    return names[near[0]] if near else ""


def _advice(unit: str, si: str, known: bool = False) -> str:
    meant = LIKELY.get((si, unit.lower())) or _likely(unit, si, known)
    if meant and meant == so_many(unit):
        return f"does 1 in the column stand for {meant}?"
    if meant:
        return f"did you mean {meant}?"
    return f"write {', '.join(COMMON[si][:-1])} or {COMMON[si][-1]}"
