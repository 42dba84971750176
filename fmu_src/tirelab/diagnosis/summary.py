"""The verdict in a few sentences: what is missing, how much the correction helps, the confidence, the alternatives."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray
from radialtire import CATALOGUE
from scipy.stats import chi2

from ..estimation.findings import NamedEffect
from ..identification.first_loading import first_loading
from ..identification.lift_off import lifts_off
from ..names import REFITTED_LAW, UNKNOWN, plain
from ..preprocessing.data_checks import MAJORITY
from ..preprocessing.levels import white_level
from ..preprocessing.noise import NEGLIGIBLE, Noise
from ..preprocessing.samples import Recorded, is_timed
from ..report.titles import (
    dependence,
    headline,
    listed,
    more_than_noise,
    newtons,
    replaced,
    set_title,
    short_title,
    sure,
)
from ..report.words import (
    LIKELIEST,
    OTHER_LIKELIER,
    SURE,
    beside_alternatives,
    confidence_word,
    is_undecided,
    percent,
)
from ..selection.search import EFFECTIVE, FEWEST_EACH, slow_variance
from ..simulation.simulate import upstream_names
from .alternatives import Alternative
from .discriminating_test import DiscriminatingTest
from .residual_model import ResidualModel
from .verdict import FitErrors

FloatArray = NDArray[np.float64]

MOST_NAMED = 3
"""Alternatives that are named in the sentences; all stand in `alternative_details` of diagnosis.json."""

REPEATS = 0.1
"""Cross-validated R^2 from which a regression is worth a sentence."""


def summarise(
    effects: Sequence[NamedEffect],
    alternatives: Sequence[Alternative],
    regressions: Sequence[ResidualModel],
    confidence: float,
    fit: FitErrors,
    test: DiscriminatingTest | None = None,
) -> str:
    """Return the verdict in sentences, the first of them `titles.headline`.

    regressions: of something unknown, none where nothing is; test: the best one against the alternatives
    """
    names = [e.name for e in effects]
    left = more_than_noise(fit.left, fit.noise)
    undecided = bool(alternatives) and is_undecided(
        confidence, [a.probability for a in alternatives if a.same]
    )
    doubted = bool(alternatives) and not undecided and confidence_word(confidence) != SURE
    said = [_undecided(effects, alternatives, confidence)] if undecided else []
    if undecided and not regressions and not (names and left) and set(names) <= {REFITTED_LAW}:
        said.append("The elastic law has other coefficients." if names else "No effect is named.")
    else:
        changed = [e.name for e in effects if e.in_baseline]
        said.append(headline(names, bool(regressions), doubted, left, changed))
    said += [_capital(CATALOGUE[name].statement) + "." for name in names if name != REFITTED_LAW]
    said.append(errors_told(bool(names), bool(regressions), fit))
    if regressions:
        said.append(_remainder(regressions, fit))
    said.append(sure(confidence))
    if alternatives:
        said.append(_alternatives([*names, *([UNKNOWN] if regressions else [])], alternatives))
    if test is not None and not test.sufficient:
        said.append(test.sentence)
    return " ".join(said)


def together(question: str, confidence: float, fit: FitErrors) -> str:
    """Return the verdict on recordings that contradict each other, where it names nothing; question: see
    `Contradiction`.
    """
    error, noise = newtons(fit.before), newtons(fit.noise)
    return (
        f"Of all together the RMS error is {error}; the noise is {noise}. {question}: {percent(confidence)}."
    )


def _undecided(effects: Sequence[NamedEffect], alternatives: Sequence[Alternative], confidence: float) -> str:
    """Return what is sure all the same, or else how the verdict stands beside the alternatives."""
    sure_ones = [e.name for e in effects if confidence_word(e.probability) == SURE]
    others = [a.probability for a in alternatives if math.isfinite(a.probability)]
    shown = beside_alternatives(confidence, others)
    if sure_ones:
        verb = "is" if len(sure_ones) == 1 else "are"
        likelier = f", and {shown}" if shown == OTHER_LIKELIER else ""
        return f"{_capital(set_title(sure_ones))} {verb} sure; what else acts is undecided{likelier}."
    return f"Undecided; {'this is the likeliest explanation' if shown == LIKELIEST else shown}."


QUICK = (
    "Most of it lies in sharp turns of the motion or in changes quicker than what is compared: drive round corners, "
    "sample faster, or look for what disturbs the force."
)


def not_seen(uncompared: float, regressions: Sequence[ResidualModel]) -> list[str]:
    """Return the sentence that most of a remainder lies in samples by which the sets are not compared, if so.

    uncompared: their share of its power. Where a regression explains most of it in other blocks of time, it is a shape
    over that coordinate, however quickly it is passed.
    """
    repeats = any(c.r2 > MAJORITY for c in regressions)
    return [QUICK] if uncompared > MAJORITY and not repeats else []


def slow_noise(
    recordings: Sequence[Recorded], left: Sequence[FloatArray], noises: Sequence[Noise]
) -> list[str]:
    """Return a sentence on each recording most of whose noise does not change from one reading to the next, as behind a
    filter: what a motion that was not recorded makes looks alike.

    left [N]: of each recording; noises: of its samples
    """
    told = []
    for recording, own, noise in zip(recordings, left, noises, strict=True):
        quick = white_level(own)
        if noise.memory == 1 or quick**2 > (1.0 - MAJORITY) * noise.level**2:
            continue
        lasts = f"{noise.memory} samples"
        if is_timed([recording]):
            lasts = f"{plain(noise.memory * float(np.median(np.diff(recording.time))), 2)} s"
        told.append(
            f"Of the noise of {newtons(noise.level)} in {recording.name} only {newtons(quick)} change from one reading "
            f"to the next; the rest lasts for {lasts} and follows no motion: record at rest. If the force is quieter "
            "there, something acts that was not recorded."
        )
    return told


MOST_BY_CHANCE = 1e-3
"""Probability with which white noise alone has so much of it in its slow sums."""


def less_than_noise(left: Sequence[FloatArray], noise: float) -> list[str]:
    """Return a sentence where what is left without any effect is slow to a part that white noise does not have, though
    it is less than the noise.

    left: of the samples of each recording, in units of their noise, which has no memory, 0 where they are not compared;
    noise [N]: of all
    """
    slow = slow_variance(left, EFFECTIVE, 0.0)
    samples = sum(own.size for own in left)
    if samples < FEWEST_EACH * EFFECTIVE or slow * EFFECTIVE < chi2.isf(MOST_BY_CHANCE, EFFECTIVE):
        return []
    size = noise * math.sqrt((slow - 1.0) * EFFECTIVE / samples)
    return [
        f"What is left changes slowly by {newtons(size)}, as white noise does not: a noise that lasts, or something "
        "smaller than the noise, for which no effect is named. If it matters, record more readings, and some at rest."
    ]


FEW = 0.02
"""Part of the samples in which most of what is left may lie by itself: then it is an event, not physics of the part."""


def in_few_samples(recordings: Sequence[Recorded], left: Sequence[FloatArray]) -> list[str]:
    """Return a sentence where most of what is left beyond the noise lies in one run of FEW of the samples.

    left (n,): of all samples of each recording, in units of their noise, 0 where they are not compared
    """
    beyond = [np.maximum(own**2 - 1.0, 0.0) for own in left]
    whole, samples = sum(float(own.sum()) for own in beyond), sum(own.size for own in beyond)
    length = int(FEW * samples)
    if length < 1:
        return []
    for recording, own in zip(recordings, beyond, strict=True):
        sums = np.concatenate([[0.0], np.cumsum(own)])
        windows = sums[length:] - sums[:-length]
        if not windows.size or windows.max() <= MAJORITY * whole:
            continue
        begin = int(np.argmax(windows))
        parts = (sums[begin + 1 : begin + length + 1] - sums[begin]) / windows[begin]
        ends = np.searchsorted(parts, (0.5 * NEGLIGIBLE, 1.0 - 0.5 * NEGLIGIBLE))
        first, last = (begin + int(end) for end in ends)
        bounds = [f"{i + 1}" for i in (first, last)]
        if is_timed([recording]):
            bounds = [f"{plain(float(recording.time[i]), 5)}s" for i in (first, last)]
        ranges = [f"FILE@:{bounds[0]}"] * (first > length) + [f"FILE@{bounds[1]}:"] * (
            last < own.size - length
        )
        return [
            f"{100.0 * windows.max() / whole:.0f} % of what is left beyond the noise lie in {last - first + 1} of "
            f"{samples} samples, from {bounds[0]} to {bounds[1]} of {recording.name}: if something happened there, as "
            f"a jolt or a break, diagnose what is beside it, {listed(ranges, 'and')}."
        ]
    return []


def before_simulation(left: float, tried: bool) -> list[str]:
    """Return the sentence that an effect before a simulation may be what is missing.

    left [N]: what the law that stands for the simulation leaves of it. Such an effect changes the deflection that the
    simulation is given, and what it makes of that is known for the law alone; tried: unless it was replayed
    """
    names = listed([short_title(name) for name in upstream_names()], "or")
    told = f"Its law leaves {newtons(left)} of the simulation, more than is left here: an effect before the simulation"
    capped = "That nothing else is missing is stated at 50 % at most"
    if tried:
        return [
            f"{told} ({names}) was tried with the simulation itself, and none explains what is left; but a series "
            f"spring gave way by the force of that law alone. {capped}."
        ]
    return [
        f"{told} ({names}) is judged by that law alone, and may be what is missing. {capped}: give the simulation the "
        "other deflection yourself, and compare."
    ]


def other_law(left: float, regressions: Sequence[ResidualModel]) -> list[str]:
    """Return the advice to believe another law of a part, where a curve of the deflection explains most of a remainder.

    left [N]: what the corrected part leaves. A law of few constants may be too far from the part's for a refitted one.
    A curve that does not repeat is none of the deflection.
    """
    curve = next((c for c in regressions if c.by == "deflection" and not c.r2 <= 0.0), None)
    if curve is None or curve.after**2 > (1.0 - MAJORITY) * left**2:
        return []
    return [
        f"A curve of the force over the deflection leaves {newtons(curve.after)} of it: beside the law of "
        "`tirelab identify --part piecewise` more may be told."
    ]


def pressed_only(fitted: Sequence[Recorded]) -> list[str]:
    """Return the advice to believe that a part is only pressed, where a recording shows what presses it lift off."""
    found = [r.name for r in fitted if lifts_off([r])]
    if not found:
        return []
    return [
        f"In {found[0]} the force rests on a way back where the part was loaded before: what presses it lifts off, and "
        "the tire file says that the part is held at both ends. Identify it with `--part power` or `--part power_gap`, "
        "and diagnose beside that."
    ]


def law_of_first_loading(
    fitted: Sequence[Recorded], before: Sequence[FloatArray], left: Sequence[FloatArray]
) -> list[str]:
    """Return the advice to believe the law of the first loading of a part, where most of what the believed law leaves
    there more than in the later ones is left by the correction too.

    before, left [N]: residuals of each recording. Beside a law amid the cycles of a part softening may not be found. A
    law that leaves less of the first loading than a quarter of what parts it from the later ones is its own already.
    """
    found = {}
    for recording, missed, kept in zip(fitted, before, left, strict=True):
        all_of_it, rest = (first_loading(recording, own) for own in (missed, kept))
        if all_of_it is None or rest is None or rest.above <= MAJORITY * all_of_it.above:
            continue
        there = (recording.time >= rest.begins) & (recording.time <= rest.ends)
        if float(np.sqrt(np.mean(missed[there] ** 2))) > MAJORITY**2 * all_of_it.above:
            found[recording.name] = rest
    if not found:
        return []
    name, first = max(found.items(), key=lambda pair: pair[1].above)
    return [
        f"Of the first loading in {name}, from {plain(first.begins, 4)} s to {plain(first.ends, 4)} s, "
        f"{newtons(first.above)} more are left than of the later ones at the same deflection: the part softens or "
        "takes a set, and the believed law is amid both. Identify the law of the first loading, and diagnose beside it."
    ]


AMPLIFIED = 1.1
"""The noise of the deflection is mentioned where it raises the held-out error by more than this factor."""


def errors_told(corrected: bool, unexplained: bool, fit: FitErrors) -> str:
    """Return what the correction does to the error, or what would reduce it and is not named."""
    noise = f"the noise is {newtons(fit.noise)}"
    if not corrected:
        stays = ", and no known effect was found to reduce it" if unexplained else ""
        if unexplained and (other := fit.not_named) is not None:
            refused, unlikely = "held-out data refuse", "no known effect is likely enough to be named"
            why = f"{refused} what reduces it" if other.refused else unlikely
            there = f", and of the held-out data {newtons(other.held_out)} in place of {newtons(other.held_out_before)}"
            stays = f", and {why}; {set_title(other.names)} would leave {newtons(other.left)}"
            stays += there if other.refused else ""
        return f"The RMS error is {newtons(fit.before)}{stays}; {noise}."
    verb = "reduces" if fit.after < fit.before else "does not reduce, it changes"
    found = [
        f"The correction {verb} the RMS error from {newtons(fit.before)} to {newtons(fit.after)}; {noise}."
    ]
    if not math.isfinite(fit.held_out_after):
        return " ".join(found)
    verb = "falls" if fit.held_out_after < fit.held_out_before else "does not fall: it goes"
    change = f"{verb} from {newtons(fit.held_out_before)} to {newtons(fit.held_out_after)}"
    found.append(f"On held-out data it {change}.")
    if fit.held_out_after > AMPLIFIED * fit.held_out_noise_free:
        found.append(
            f"With the noise-free deflection as input it is {newtons(fit.held_out_noise_free)}; the rest "
            "comes of the noise of its readings, and of rates, where an effect needs them: they are tracked as the "
            "readings come, with a delay."
        )
    return " ".join(found)


def _remainder(regressions: Sequence[ResidualModel], fit: FitErrors) -> str:
    """Return what the unexplained remainder depends on, and how far its best regression reduces the error.

    What repeats within the recordings need not hold in others: a regression that raises their error is no description.
    """
    by = listed([dependence(c.by) for c in regressions])
    asked = [c for c in regressions if math.isfinite(c.r2)]
    if not asked:
        return f"The remainder depends on {by}. Whether it repeats is not known: drive the motion twice."
    repeating = [c for c in asked if c.r2 >= REPEATS]
    if not repeating:
        return (
            f"The remainder depends on {by}, but no regression of it repeats on held-out blocks of time. "
            "Noise that is as slow as the motion leaves this as well: record for as long at rest."
        )
    holding = [c for c in repeating if not c.held_out_after > fit.held_out_after]
    if not holding:
        return (
            f"The remainder depends on {by}. Regressions of it repeat on blocks of time of the fitted recordings, but "
            "raise the error on held-out data: they are of use nowhere else."
        )
    best = max(holding, key=lambda c: c.r2)
    over = "it" if len(regressions) == 1 else dependence(best.by)
    held_out = math.isfinite(best.held_out_after)
    also = f", and to {newtons(best.held_out_after)} on held-out data" if held_out else ""
    after = f"{newtons(best.after)}{also}"
    return (
        f"The remainder depends on {by}. A regression over {over} reduces the RMS error to {after}; it is a "
        "description, not physics."
    )


def _alternatives(names: Sequence[str], alternatives: Sequence[Alternative]) -> str:
    """Return the sets that the recordings cannot rule out, as differences from the verdict's `names`.

    Something unknown in the verdict belongs to every alternative too. Each reason is given once, with all sets to which
    it applies; of sets beyond the MOST_NAMED likeliest only the number is given.
    """
    by_reason: dict[str, dict[str, list[str]]] = {}
    likeliest = sorted(
        alternatives, key=lambda a: -a.probability if math.isfinite(a.probability) else math.inf
    )
    for alternative in likeliest[:MOST_NAMED]:
        what, how = replaced(names, [*alternative.names, *(n for n in names if n == UNKNOWN)])
        by_reason.setdefault(alternative.reason, {}).setdefault(how, []).append(what)
    cannot, others = "These recordings cannot rule out", len(alternatives) - MOST_NAMED
    more = f" {others} more {'are' if others > 1 else 'is'} listed below." if others > 0 else ""
    sets_of = {
        reason: listed([f"{listed(what, 'or')} {how}".strip() for how, what in by_how.items()], "or")
        for reason, by_how in by_reason.items()
    }
    if len(sets_of) == 1:
        ((reason, sets),) = sets_of.items()
        return f"{cannot} {sets}. {_capital(reason)}.{more}"
    return f"{cannot} {_either([f'{sets} ({reason})' for reason, sets in sets_of.items()])}.{more}"


def _either(groups: Sequence[str]) -> str:
    """Return groups that have commas of their own, between semicolons."""
    return f"{'; '.join(groups[:-1])}; or {groups[-1]}"


def _capital(text: str) -> str:
    return text[:1].upper() + text[1:]
