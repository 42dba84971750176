"""Whether what was read has the size of a tire: units, the zero of the gauge, the radius of the surface.

Nothing here is certain, so nothing is refused or changed: what is doubtful is said, with the value and what to write.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ..names import plain
from .clock_doubt import likely_clock
from .jumps import sudden_doubts
from .origin import Origin
from .other_columns import idle
from .samples import LARGEST_PLAUSIBLE
from .work_doubt import work_doubt
from .zero import Gauges, Zero, force_at_least

FloatArray = NDArray[np.float64]

LOOKED_AT = 20_000
"""Most samples that are checked, evenly spaced."""

USUAL = (550.9, 1.422)
"""Coefficient [N/cm^B] and exponent of the article's tire on flat ground (Hull, Wang, Moore 1996, eq. 5, 6)."""

FAR = 25.0
"""A force this many times larger or smaller than the article's tire has at that deflection is doubted: a
wrong thousand always is, another tire or pressure never."""

NEAR = 6.0
"""A unit is proposed where the force is within this factor of the article's tire in it."""

GROUND = 3.0
"""Convex or concave ground of a larger radius [m] is as good as flat: A of the article differs by less than 1e-10."""

LARGEST_RADIUS = 2.0
"""A curved rig has no larger radius [m]."""

PULLS = 0.2
"""What pulls with more than this part of its largest push is no tire, so that its force is not compared with one's."""

FORCES = (("kN", 1e3), ("lbf", 4.4482216152605), ("kgf", 9.80665), ("mN", 1e-3))
LENGTHS = (("mm", 1e-3), ("cm", 1e-2), ("in", 0.0254), ("m", 1.0))

PART_STROKES = (("m", 0.05), ("mm", 1e3), ("um", np.inf))
"""Units of the stroke of a part with the largest number that is likely in them: machines write millimetres."""

PRESSURES = (2e4, 1.5e6)
"""Gauge pressures [Pa] of bicycle tires: 0.3 bar of a fat one, 14 bar of a track racer's."""

TEMPERATURES = (233.15, 423.15)
"""Temperatures [K] at which rubber is used: -40 to 150 degrees Celsius."""

FLAT_BINS = 60

UNLOADED, AT_START = 0.03, 0.04
"""The force begins with the least deflection where it is below this part of the largest force there, and the law's own
beginning is within this part of the stroke."""

FOLLOWS = 0.9
"""A force follows the deflection where their correlation is above this."""

NO_FORCE = 0.01
"""Before the force begins it is below this part of the largest everywhere: a law that rises from zero is not."""


@dataclass(frozen=True)
class Doubts:
    """What is doubtful of a recording, in sentences; far_zero: why no effect holds its zero, "" where one does."""

    sentences: tuple[str, ...] = ()
    far_zero: str = ""


def doubts_of(
    gauges: Gauges,
    values: Mapping[str, FloatArray],
    units: Mapping[str, str],
    where: Callable[[str, int | None], str],
    part: bool = False,
) -> Doubts:
    """Return what is doubtful of the channels in SI, each in one sentence with its row and column.

    gauges: by which the advice names columns and zeros; units: of each channel as it was read
    where: returns the place of a sample of a channel, of None its column alone
    part: of which nothing is known but that it gives out no energy
    """
    for name in ("deflection", "force"):
        largest = max(abs(float(values[name].min())), abs(float(values[name].max())))
        if not largest <= LARGEST_PLAUSIBLE[name]:
            return Doubts()  # the recording refuses it
    origin = gauges.origin
    backwards = work_doubt(gauges, values["time"], values["deflection"], values["force"], part)
    loops: tuple[str, ...] = (_placed(where("force", None), backwards),) if backwards else ()
    loops += tuple(_placed(where(name, None), said) for name, said in _state_doubts(values, units, part))
    for name, at, said in sudden_doubts(values["deflection"], values["force"]):
        loops += (_placed(where(name, at), said),)
    if idle(moved := values["deflection"]):
        levels = len(np.unique(moved))
        rests = f"takes {levels} values in {len(moved)} readings: is it the gauge that followed the motion?"
        loops += (_placed(where("deflection", None), rests),)
    step = max(1, len(values["force"]) // LOOKED_AT)
    x, f = values["deflection"][::step], values["force"][::step]
    radius = values["radius"][::step]
    zero = force_begins(x, f, radius)
    if part:
        # what is slack or centred elsewhere is the part's own; farther than any slack it is likely the gauge's
        off = zero is not None and zero.far and zero.seen
        begun: tuple[str, ...] = ()
        if zero is not None and off:
            begun = (_placed(where("deflection", None), gauges.doubt(zero)),)
        pulls = _pull_doubt(gauges, x, f)
        begun += (_placed(where("force", None), pulls),) if pulls else ()
        return Doubts((*begun, *loops))
    found = [
        _placed(where("radius", step * at), sentence)
        for at, sentence in _radius_doubts(origin, radius, units.get("radius", ""))
    ]
    size = _size_doubt(origin, x, f, units)
    if size:
        found.append(_placed(where("force", step * int(np.argmax(f))), size))
    far = ""
    if zero is not None and zero.off:
        found.append(_placed(where("deflection", None), gauges.doubt(zero)))
        far = gauges.refusal(zero)
    return Doubts((*found, *loops), far)


def _state_doubts(
    values: Mapping[str, FloatArray], units: Mapping[str, str], part: bool
) -> list[tuple[str, str]]:
    """Return the channels of the tire's state that have a size which no tire has, and the sentence."""
    found = []
    if "pressure" in values:
        low, high = float(values["pressure"].min()), float(values["pressure"].max())
        least, most = (-101_325.0, np.inf) if part else PRESSURES
        if low < min(least, 0.0) or high > most or high < least:
            found.append(
                (
                    "pressure",
                    f"goes from {plain(low / 1e5, 3)} to {plain(high / 1e5, 3)} bar of gauge pressure, which no "
                    f"{'gauge reads' if part else 'bicycle tire has'}; {_unit_asked('pressure', units)}",
                )
            )
    if "temperature" in values:
        low, high = float(values["temperature"].min()), float(values["temperature"].max())
        if low < TEMPERATURES[0] or high > TEMPERATURES[1]:
            found.append(
                (
                    "temperature",
                    f"goes from {plain(low - 273.15, 3)} to {plain(high - 273.15, 3)} degC, at which no rubber is "
                    f"tested; {_unit_asked('temperature', units)}",
                )
            )
    return found


def _unit_asked(name: str, units: Mapping[str, str]) -> str:
    unit = units.get(name, "")
    return f"check its unit ({unit})" if unit else "check its unit"


def _placed(place: str, sentence: str) -> str:
    return f"{place}: {sentence}" if place else sentence


def too_deep(origin: Origin, deepest: float, unit: str) -> str:
    """Return what to write where a deflection [m] read in a unit is deeper than a wheel, "" where no unit helps."""
    factor = dict(LENGTHS).get(unit)
    fits = [] if factor is None else [(name, deepest / factor * f) for name, f in LENGTHS if f < factor]
    fits = [(name, length) for name, length in fits if 2e-3 <= length <= 0.12]
    if not fits:
        return ""
    name, length = fits[0]
    return f"in {name} it would be {plain(1e3 * length, 3)} mm: {origin.units(deflection=name)}"


def force_begins(deflection: FloatArray, force: FloatArray, radius: FloatArray) -> Zero | None:
    """Return where the force begins, by the power law that fits the medians of the force over the deflection best.

    F = A max(x - x0, 0)^B with x0 and B on a grid, A by least squares, on the surface with the most samples. Where no
    such law fits, as of a part that snaps through, it is the end of what is driven without force; None where there is
    neither, or the force is not that of a spring that is pressed once over most of its stroke.
    """
    surface = _commonest(radius)
    x, f = deflection[surface], force[surface]
    low, high = float(x.min()), float(x.max())
    if not high > low or len(x) < 2 * FLAT_BINS:
        return None
    edges = np.linspace(low, high, FLAT_BINS + 1)
    place = np.clip(np.searchsorted(edges, x, "right") - 1, 0, FLAT_BINS - 1)
    filled = [b for b in range(FLAT_BINS) if np.count_nonzero(place == b)]
    if len(filled) < FLAT_BINS // 2:
        return None
    centre = np.array([float(np.mean(x[place == b])) for b in filled])
    level = np.array([float(np.median(f[place == b])) for b in filled])
    stroke = high - low
    # where the force begins shows where it is small: a bin counts by its force and a twentieth of the largest
    weight = 1.0 / (np.abs(level) + 0.05 * float(np.abs(level).max()))
    target = weight * level
    tried = np.linspace(low - 0.5 * stroke, low + 0.7 * stroke, 241)
    missed = [_missed(np.maximum(centre - begins, 0.0), weight, target) for begins in tried]
    begins, fits = float(tried[np.argmin(missed)]), 2e-2 * float(np.sum(target**2))
    largest = float(level.max())
    least, uncertain = force_at_least(x, f)
    if not min(missed) <= fits:
        free = _without_force([f[place == b] for b in filled])
        end = float(edges[filled[free]])
        return Zero(end, high - end, low, least) if free else None
    if abs(float(level[0])) < UNLOADED * largest and abs(begins - low) < AT_START * stroke:
        return Zero(low, stroke, low, least)
    if begins < low and abs(least) <= uncertain < NO_FORCE * largest:
        # No power of the deflection rises as this does, but from no force.
        return Zero(low, stroke, low, least)
    below = level[centre < begins]
    if below.size and float(np.abs(below).max()) > NO_FORCE * largest:
        return None
    found = Zero(begins, high - begins, low, least)
    # a tire that is loaded all the time shows no zero: one at 0 is as good as any
    if not found.seen and low > 0.0 and _missed(centre, weight, target) <= fits:
        return None
    return found


def _without_force(by_place: Sequence[FloatArray]) -> int:
    """Return how many of the first places, in the order of the deflection, have no force whatever law follows: as many
    as are AT_START of the stroke at least; else 0.
    """
    sizes = [float(np.quantile(np.abs(forces), 0.95)) for forces in by_place]
    loaded = np.flatnonzero(np.array(sizes) > NO_FORCE * max(sizes))
    return int(loaded[0]) if loaded[0] >= AT_START * len(by_place) else 0


def _missed(beyond: FloatArray, weight: FloatArray, target: FloatArray) -> float:
    """Return the least sum of squares that a law of the deflection beyond a zero leaves, infinite where none rises."""
    least = np.inf
    for exponent in (1.0, 1.15, 1.3, 1.45, 1.6, 1.8, 2.0):
        weighted = weight * beyond**exponent
        scale = float(weighted @ target) / max(float(weighted @ weighted), 1e-300)
        if scale > 0.0:
            least = min(least, float(np.sum((target - scale * weighted) ** 2)))
    return least


def _commonest(radius: FloatArray) -> NDArray[np.bool_]:
    found, counts = np.unique(radius, return_counts=True)
    return np.asarray(radius == found[np.argmax(counts)])


def _radius_doubts(origin: Origin, radius: FloatArray, unit: str) -> list[tuple[int, str]]:
    """Return a sentence for a radius that is as good as flat, with the first sample that has one."""
    sizes = np.unique(np.abs(radius[np.isfinite(radius)]))
    large = sizes[sizes > GROUND]
    if not len(large):
        return []
    shown = f"{plain(large[0], 4)} m"
    at = int(np.argmax(np.abs(radius) == large[0]))
    factor = dict(LENGTHS).get(unit)
    finer = [
        (name, large[0] / factor * f)
        for name, f in LENGTHS
        if factor is not None and f < factor and 5e-3 <= large[0] / factor * f <= LARGEST_RADIUS
    ]
    if not finer:
        return [(at, f"a surface radius of {shown} is as good as flat: say so with {origin.radius('flat')}")]
    name, length = finer[0]
    sentence = (
        f"a surface radius of {shown} is as good as flat: {name}? Then it is {plain(100.0 * length, 4)} cm, "
        f"{origin.units(radius=name)}; if the ground is flat, {origin.radius('flat')}"
    )
    return [(at, sentence)]


def _size_doubt(origin: Origin, x: FloatArray, f: FloatArray, units: Mapping[str, str]) -> str:
    """Return a sentence where the force is far from a tire's at that deflection, "" where it is not."""
    stroke, load = (
        float(x.max() - x.min()),
        float(np.quantile(f, 0.999) - np.median(f[x <= x.min() + 0.05 * np.ptp(x)])),
    )
    if not (stroke > 0.0 and load > 0.0) or f.min() < -PULLS * f.max():
        return ""
    usual = USUAL[0] * (100.0 * stroke) ** USUAL[1]
    ratio = load / usual if usual > 0.0 else np.inf
    if 1.0 / FAR < ratio < FAR or not 0.0 < ratio < np.inf:
        return ""
    far = f"{1.0 / ratio:.0f} times too small" if ratio < 1.0 else f"{ratio:.0f} times too large"
    rounded = 10.0 ** round(np.log10(ratio))
    # within a factor of three of a power of ten a round figure says it better
    if 1 / 3.2 < ratio / rounded < 3.2:
        far = f"{max(rounded, 1.0 / rounded):.0f} times too {'small' if ratio < 1.0 else 'large'}"
    what = (
        f"the force, up to {plain(load, 3)} N, is about {far} for a tire at {plain(1e3 * stroke, 3)} mm of "
        f"deflection"
    )
    guess = _unit_guess(stroke, load, units)
    other = "" if origin.kind != "file" else "; if this is no tire, write part = true into recording.toml"
    return (
        f"{what}: {guess[1]}? Then {origin.units(**{guess[0]: guess[1]})}{other}"
        if guess
        else f"{what}: check both units{other}"
    )


def _pull_doubt(gauges: Gauges, x: FloatArray, f: FloatArray) -> str:
    """Return a sentence where a part pulls all the time, the less the more it is deflected, "" where it does not.

    A part that is stretched further pulls more, so that what is read may be a load cell that was not zeroed; one that
    is deflected below zero rather than above is stretched.
    """
    least, most = float(f.min()), float(f.max())
    if not (most < 0.0 and x.max() > -x.min() and np.ptp(x) > 0.0 and np.corrcoef(x, f)[0, 1] > FOLLOWS):
        return ""
    given = gauges.origin.zero(gauges.at_zero({"force": float(f"{least:.3g}")}))
    return (
        f"the force is {plain(least, 3)} to {plain(most, 3)} N: it pulls all the time, the least where the "
        f"deflection is largest; if the load cell was not zeroed, give what it reads without load, such as {given}"
    )


def _unit_guess(stroke: float, load: float, units: Mapping[str, str]) -> tuple[str, str] | None:
    """Return the channel and the unit in which the force is nearest to a tire's; None where none is near."""
    fits: list[tuple[float, str, str]] = []
    for channel, table in (("force", FORCES), ("deflection", LENGTHS)):
        given = {"N": 1.0, **dict(table)}.get(units.get(channel, ""))
        if given is None:
            continue
        for unit, factor in (("N", 1.0), *table) if channel == "force" else table:
            if unit == units.get(channel):
                continue
            other_load = load / given * factor if channel == "force" else load
            other_stroke = stroke / given * factor if channel == "deflection" else stroke
            ratio = other_load / (USUAL[0] * (100.0 * other_stroke) ** USUAL[1])
            if 2e-3 <= other_stroke <= 0.12 and 1.0 / NEAR < ratio < NEAR:
                # a wrong thousand is commoner than pounds
                rare = 1.0 if unit in ("kN", "N", "mm", "m", "cm") else 2.0
                fits.append((abs(float(np.log(ratio))) + rare, channel, unit))
    return min(fits)[1:] if fits else None


def guessed_units(
    columns: Mapping[str, FloatArray], part: bool = False, metres: float | None = None
) -> dict[str, str]:
    """Return the likeliest unit of each of the channels time, deflection, radius and force, from their sizes alone.

    part: not of a tire, so that the size of the force says nothing and that of the deflection little
    metres: the unit of the deflection where it is known
    """
    guesses: dict[str, str] = {}
    if "time" in columns:
        guesses["time"] = likely_clock(columns["time"])
    moved = columns.get("deflection", np.zeros(1))
    stroke = float(np.nanmax(moved) - np.nanmin(moved))
    if metres is not None:
        stroke *= metres
    elif part and stroke > 0.0:
        guesses["deflection"] = next(unit for unit, most in PART_STROKES if stroke <= most)
    elif stroke > 0.0:
        stroke = min(max(stroke, 1e-12), 1e12)  # a damaged number is no length, and its powers are no numbers
        sized = [(abs(float(np.log(stroke * f / 0.02))), name) for name, f in LENGTHS if name != "in"]
        guesses["deflection"] = min(sized)[1]
        stroke *= dict(LENGTHS)[guesses["deflection"]]
    if "force" in columns and part:
        guesses["force"] = "N"
    elif "force" in columns and stroke > 0.0:
        usual = USUAL[0] * (100.0 * stroke) ** USUAL[1]
        load = min(max(float(np.nanmax(np.abs(columns["force"]))), 1e-300), 1e300)
        guesses["force"] = min(
            (abs(float(np.log(load * f / usual))), u) for u, f in (("N", 1.0), ("kN", 1e3))
        )[1]
    if "radius" in columns:
        sizes = np.abs(columns["radius"][np.isfinite(columns["radius"])])
        size = float(np.median(sizes)) if len(sizes) else 25.0
        guesses["radius"] = min(
            (abs(float(np.log(max(size, 1e-9) * f / 0.25))), u) for u, f in LENGTHS if u != "in"
        )[1]
    return guesses
