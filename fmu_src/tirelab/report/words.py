"""The names, numbers and spans of diagnosis.json as a report prints them."""

from __future__ import annotations

import math
import re
from collections import Counter
from collections.abc import Iterable, Mapping, Sequence
from typing import Any

from radialtire import CATALOGUE, FLAT_RADIUS

from ..names import REFITTED_LAW, plain, with_power

LAW_STATEMENT = (
    "the elastic law has other coefficients than in the baseline; a refitted law is not missing physics"
)

SHAPE = "elastic_shape"
"""The effect that holds the shape of a refitted law."""

NORMAL_95 = 1.96
"""Standard deviations of a 95 % interval of a normal distribution."""

_SCALES = {
    "m": (1e3, "mm"),
    "m/s": (1e3, "mm/s"),
    "m/N": (1e6, "mm/kN"),
    "N.s/m": (1.0, "N·s/m"),
    "m/s^2": (1.0, "m/s²"),
    "1": (1.0, ""),
}
"""Units of diagnosis.json that a report replaces: factor and name of the unit in the report."""

_COORDINATES = {
    "history": "largest deflection so far",
    "radius": "surface",
    "rate": "rate of deflection",
}


_OF_A_SURFACE = {
    "log factor on A": "natural logarithm of the factor on the coefficient A of F = A x^B",
    "change of B": "added to the exponent B of F = A x^B",
}
"""Parameters of a refitted law on each surface."""

OF_A_PART = {
    "preload": "added to the force of the part without a deflection",
    "gap": "added to the deflection at which the force of the part begins",
}
"""Constants of a part's law."""

_OF_THE_LAW = {
    **_OF_A_SURFACE,
    **OF_A_PART,
    "kink": "change of the slope of ln F at that tenth of the span",
    "slope change": "change of the slope of the force at that ninth of the span, by what it adds over all of it",
}


def meaning(effect: str, parameter: str) -> str:
    """Return the meaning of a parameter from the catalogue; empty where the catalogue has none."""
    if effect == REFITTED_LAW and (kind := _kind_of(parameter)) in _OF_THE_LAW:
        return _OF_THE_LAW[kind]
    owner = CATALOGUE.get(SHAPE if effect == REFITTED_LAW else effect)
    name = parameter.replace(" ", "_")
    found = [p.meaning for p in owner.parameters if p.name == name] if owner else []
    return found[0] if found else ""


def _kind_of(parameter: str) -> str:
    """Return a law's parameter without its surface or its number."""
    return parameter.partition(",")[0].rstrip("0123456789 ")


def scaled(unit: str) -> tuple[float, str]:
    """Return the factor and the name of the unit in which a report gives values of `unit`."""
    return _SCALES.get(unit, (1.0, unit))


def with_unit(text: str, unit: str) -> str:
    """Return a number with its unit, if it has one."""
    return f"{text} {unit}" if unit else text


def unbroken(sentence: str) -> str:
    """Return a sentence in which no line ends between a number and its unit."""
    return re.sub(r"(?<=\d) (?=%|[µmk]?[mNsW]\b|mm/s)", "\N{NO-BREAK SPACE}", sentence)


def number(value: Any, digits: int = 3) -> str:
    """Return `value` with so many significant digits; a dash where there is none."""
    if value is None or isinstance(value, str) or not math.isfinite(value):
        return str(value) if isinstance(value, str) else "–"
    return rounded(value, digits).replace("-", "−")


def rounded(value: float, digits: int) -> str:
    """Return a value with so many significant digits, all those before the point, and a power of ten where it is small.

    Its minus sign is that of the keyboard, as in sentences on a terminal.
    """
    small = 0.0 < abs(value) < 10**digits - 0.5
    return with_power(f"{value:#.{digits}g}".rstrip(".") if small else f"{value + 0.0:.0f}")


MOST_DECIMALS = 6
"""A figure that needs more decimals is written with a power of ten."""


def residual(value: float, noise: float) -> str:
    """Return a mean residual [N] to the tenth of the noise [N]."""
    decimals = max(1 - math.floor(math.log10(noise)), 0) if noise > 0.0 else 3
    if decimals > MOST_DECIMALS:
        return number(value)
    return f"{value + 0.0:.{decimals}f}".replace("-", "−")


def estimate(value: float, std: float | None, unit: str) -> str:
    """Return value ± standard deviation with its unit, both to the second digit of the deviation."""
    factor, name = scaled(unit)
    if std is None or not math.isfinite(std) or std <= 0.0:
        return with_unit(number(factor * value, 4), name)
    decimals = 1 - math.floor(math.log10(factor * std))
    if not 0 <= decimals <= MOST_DECIMALS or abs(factor * value) >= 1e6:
        return with_unit(f"{number(factor * value, 4)} ± {number(factor * std, 2)}", name)
    return with_unit(f"{fixed(factor * value, decimals)} ± {fixed(factor * std, decimals)}", name)


def fixed(value: float, decimals: int) -> str:
    """Return a value with so many decimals; plain 0 where they are all zeros."""
    text = f"{value:.{decimals}f}"
    return text.replace("-", "−") if text.strip("-0.") else "0"


def bounds(effect: str, parameter: str) -> tuple[float, float]:
    """Return the values that the catalogue allows a parameter; all of them where it does not know it."""
    owner = CATALOGUE.get(SHAPE if effect == REFITTED_LAW else effect)
    found = [(p.minimum, p.maximum) for p in owner.parameters if p.name == parameter] if owner else []
    return found[0] if found else (-math.inf, math.inf)


def interval(
    value: float, std: float | None, unit: str, allowed: tuple[float, float] = (-math.inf, math.inf)
) -> str:
    """Return the 95 % interval of a value with its unit, inside what is `allowed`; a dash where it is not known."""
    if std is None or not math.isfinite(std) or std <= 0.0:
        return "–"
    factor, name = scaled(unit)
    wide = NORMAL_95 * std
    decimals = min(max(1 - math.floor(math.log10(factor * std)), 0), 6)
    least, most = max(value - wide, allowed[0]), min(value + wide, allowed[1])
    return with_unit(" to ".join(fixed(factor * end, decimals) for end in (least, most)), name)


def is_of_a_surface(parameter: str) -> bool:
    """Return whether a parameter of a refitted law belongs to one surface."""
    return parameter.partition(",")[0] in _OF_A_SURFACE


def law_row(row: Mapping[str, Any], kind: str = "tire") -> dict[str, str]:
    """Return an entry of `law` in words: surface, and A and B before and after; kind: "tire" or "part"."""

    def after(entry: Mapping[str, Any]) -> str:
        return estimate(entry["after"], entry["std"], "1")

    told = {"surface": "the part" if kind == "part" else surface(row["radius"])}
    for key in ("A", "B"):
        told |= {f"{key}_before": number(row[key]["before"], 4), f"{key}_after": after(row[key])}
    return told


def sentence(text: str) -> str:
    """Return a text as a sentence; empty where it is."""
    return f"{text[:1].upper()}{text[1:]}." if text else ""


def percent(share: float) -> str:
    """Return a share as percent; less than half a percent is shown as "< 1 %"."""
    if 0.0 < share < 0.005:
        return "< 1 %"
    return f"{100.0 * share:.0f} %".replace("-", "−")


def of_load(size: float | None, load: float | None) -> str:
    """Return a force's size as a part of the load, both root mean squares [N]; empty where one is not known.

    More than the whole load is empty too: it says what a refitted law has given up, not how large an effect is.
    """
    if size is None or not load or size > load:
        return ""
    share = size / load
    return f"{100.0 * share:.1f} %" if 0.005 <= share < 0.0095 else percent(share)


def likeliest(details: Iterable[Mapping[str, Any]]) -> list[Mapping[str, Any]]:
    """Return alternatives with the likeliest first, those without a probability last."""
    return sorted(details, key=lambda d: math.inf if d["probability"] is None else -float(d["probability"]))


def whole_percent(confidence: float) -> float:
    """Return a confidence rounded to whole percents, as it is shown, so that words and decisions agree with it."""
    return round(100.0 * confidence) / 100.0


DECIDED = 0.5
"""Below this confidence, and with alternatives, the recordings do not decide: that is the headline."""


LIKELIEST = "the likeliest one is shown"
OTHER_LIKELIER = "an alternative is likelier"
NONE_LIKELY = "no set of effects is likely"


NEAR = 0.5
"""Probability of an alternative, over that of the verdict, from which both have to be tried."""


def is_undecided(confidence: float, same: Iterable[float]) -> bool:
    """Return whether a verdict does not decide: it is more probably wrong, or an explanation that leaves the same of
    the recordings is half as likely at least; same: probabilities of those.
    """
    return whole_percent(confidence) < DECIDED or any(p >= NEAR * confidence for p in same)


def beside_alternatives(confidence: float, others: Iterable[float]) -> str:
    """Return how an undecided verdict stands beside its alternatives, of the known probabilities `others`."""
    most = whole_percent(max(others, default=0.0))
    if most >= DECIDED:
        return OTHER_LIKELIER
    shown = whole_percent(confidence)
    return LIKELIEST if shown > 0.0 and shown >= most else NONE_LIKELY


SURE = "sure"
"""The word for a confidence from 0.9 on."""


LIKELIER = 0.5
"""From this confidence on, the word is "more likely than not"."""


def confidence_word(confidence: float) -> str:
    """Return how sure that is, in words."""
    for limit, word in ((0.9, SURE), (0.7, "fairly sure"), (LIKELIER, "more likely than not")):
        if whole_percent(confidence) >= limit:
            return word
    return "one of several possibilities"


def coordinate(by: str) -> str:
    """Return the name of a coordinate of the misfit for a reader."""
    return _COORDINATES.get(by, by)


def law_apart(verdict: Mapping[str, Any]) -> bool:
    """Return whether the places of a verdict are those of the residual with the law refitted."""
    names = [effect["name"] for effect in verdict["effects"]]
    return REFITTED_LAW in names and len(names) > 1


def foremost(where: Sequence[Mapping[str, Any]], most: int, of_one: int = 2) -> list[Mapping[str, Any]]:
    """Return the first `most` entries of `where`; more than `of_one` over one coordinate only to fill up.

    Dropped is what shows the same as another place: the elastic force beside the deflection, one single rate beside the
    direction, no acceleration beside rest.
    """
    by = {place["by"] for place in where}
    held = any(map(is_at_rest, where))
    shown = [
        place
        for place in where
        if not (place["by"] == "force" and "deflection" in by)
        and not (is_one_rate(place) and "direction" in by)
        and not (held and place["by"] == "acceleration" and _near_nothing(place))
    ]
    counts: Counter[str] = Counter()
    first: list[int] = []
    spare: list[int] = []
    for number, place in enumerate(shown):
        counts[place["by"]] += 1
        (first if counts[place["by"]] <= of_one else spare).append(number)
    return [shown[number] for number in sorted([*first, *spare][:most])]


ONE_RATE = 0.01
"""Rates that differ by less than this part are one: a triangle's, as it is read."""


def is_one_rate(place: Mapping[str, Any]) -> bool:
    """Return whether a place over the rate holds one rate only."""
    start, stop = place["from"], place["to"]
    if place["by"] != "rate" or isinstance(start, str) or isinstance(stop, str):
        return False
    return bool(abs(stop - start) < ONE_RATE * max(abs(start), abs(stop)))


REST = 1e-7
"""Up to this rate [m/s], or acceleration [m/s^2], nothing moves: what is read of it is the gauge's noise."""


def is_at_rest(place: Mapping[str, Any]) -> bool:
    """Return whether a place over the rate is where the deflection is held."""
    start, stop = place["from"], place["to"]
    if place["by"] != "rate" or isinstance(start, str) or isinstance(stop, str):
        return False
    return bool(max(abs(start), abs(stop)) < REST)


def _near_nothing(place: Mapping[str, Any]) -> bool:
    """Return whether a place over the acceleration lies about none, or so near it that nothing moves."""
    start, stop = place["from"], place["to"]
    return bool(start <= 0.0 <= stop or max(abs(start), abs(stop)) < REST)


def span(place: Mapping[str, Any]) -> str:
    """Return the span of an entry of `where` in words."""
    by, start, stop, unit = (place[key] for key in ("by", "from", "to", "unit"))
    if is_at_rest(place):
        return "at rest"
    if by == "radius" and start == stop:
        return surface(start)
    if place.get("label"):
        return str(place["label"])
    if place.get("recording"):
        return f"{span({**place, 'recording': None})} of {place['recording']}"
    if by == "direction" and not isinstance(start, str) and not isinstance(stop, str):
        return "loading" if start + stop > 0.0 else "unloading"
    factor, name = scaled(str(unit))
    if start == stop:
        return with_unit(_edge(start, factor), name)
    first, last = edges(start, stop, factor)
    return with_unit(first if first == last else f"{first} to {last}", name)


def where_phrase(place: Mapping[str, Any], *, coordinate_too: bool = True) -> str:
    """Return an entry of `where` for a sentence: "deflection 14.1 to 31.0 mm", "while loading", "on flat ground"."""
    lead = {"direction": "while", "radius": "on"}.get(place["by"], coordinate(place["by"]))
    return f"{lead} {span(place)}" if coordinate_too and not is_at_rest(place) else span(place)


def edges(start: float | str, stop: float | str, factor: float) -> tuple[str, str]:
    """Return both ends of a span with the decimals of the larger one's third digit; two more where they are alike."""
    if isinstance(start, str) or isinstance(stop, str):
        return _edge(start, factor), _edge(stop, factor)
    ends = (factor * start, factor * stop)
    largest = max(map(abs, ends))
    if not 1e-2 <= largest < 1e6:
        digits = 3 if number(ends[0]) != number(ends[1]) else 5
        return number(ends[0], digits), number(ends[1], digits)
    decimals = max(2 - math.floor(math.log10(largest)), 0)
    if fixed(ends[0], decimals) == fixed(ends[1], decimals):
        decimals += 2
    return fixed(ends[0], decimals), fixed(ends[1], decimals)


def _edge(value: float | str, factor: float) -> str:
    if isinstance(value, str):
        return {"inf": "∞", "-inf": "−∞"}.get(value, value)
    return number(factor * value)


def surface(radius: float | str) -> str:
    """Return a surface by its radius [m]."""
    size = float(radius)
    if abs(size) >= FLAT_RADIUS:
        return "flat ground"
    return f"{'convex' if size > 0.0 else 'concave'}, radius {number(100.0 * abs(size))} cm"


def on_surface(radius: float | str) -> str:
    """Return a surface by its radius [m] as what follows "on"."""
    size = float(radius)
    if abs(size) >= FLAT_RADIUS:
        return "flat ground"
    return f"a {'convex' if size > 0.0 else 'concave'} surface of radius {plain(100.0 * abs(size), 4)} cm"


def held_out_part(by: str) -> str:
    """Return in brackets which part of the recordings was held out; empty where whole recordings were."""
    return f" ({by})" if by and by != "recordings given" else ""
