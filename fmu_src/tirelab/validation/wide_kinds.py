"""Figures of the wide kinds of trial (loud, press, foreign, outside, beside, pressure), with intervals and limits.

A verdict may state a remainder beside its names in all of these kinds: "unknown" is left out of every comparison.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence

from concealed import WIDE_KINDS

from ..diagnosis.diagnosis_file import NOTHING, Names
from ..names import REFITTED_LAW, UNKNOWN
from .acceptance_criteria import NOISE_FLOOR_MARGIN, Criterion
from .metrics import Rate
from .score import Score

HALF = 0.5
"""A name above this probability is a claim."""

FLOOR_FACTOR = 1.15
"""A written tire may leave this many noise floors on a press's first file."""

QUARTER = 0.25
"""Part of the misfit before that a correction of a foreign form may leave on held-out recordings."""

WIDEST_INTERVAL = 0.2
"""A rate whose 95 % interval is wider is not judged: too few trials."""


def is_wide(score: Score) -> bool:
    """Whether a trial is of a wide kind."""
    return score.kind in WIDE_KINDS


def named(score: Score) -> Names:
    """The effects that the verdict names, without the remainder; empty where it names none or failed."""
    return (score.verdict or frozenset()) - NOTHING - {UNKNOWN}


def claimed(score: Score) -> Names:
    """The effects that the verdict names with a probability above a half."""
    return frozenset(name for name in named(score) if score.probabilities.get(name, 0.0) > HALF)


def sound(score: Score) -> bool:
    """Whether the verdict is right in the sense of its kind.

    loud, pressure: the named effects are a right set; press: they are, whether or not the law is refitted; foreign,
    beside: they hold a right set, and nothing else is above a half; outside: nothing that is not there is above a half;
    else: exact
    """
    if score.verdict is None:
        return False
    if score.kind in ("foreign", "beside"):
        return any(right <= named(score) and claimed(score) <= right for right in _plain(score.right))
    if score.kind == "outside":
        return claimed(score) <= frozenset().union(*_plain(score.right))
    if is_wide(score):
        return named(score) in _plain(score.right)
    return score.exact


def holds(score: Score) -> bool:
    """Whether the verdict is sound and every effect that it names is there, however unlikely it calls that one.

    This is what its confidence is compared with: it is a statement on all that the verdict names.
    """
    return sound(score) and named(score) <= frozenset().union(*_plain(score.right))


def sound_alternative(score: Score) -> bool:
    """Whether the verdict or a stated alternative is a right set, in a wide kind with a remainder left out."""
    if not is_wide(score):
        return score.among
    right = _plain(score.right)
    return sound(score) or any(names - NOTHING - {UNKNOWN} in right for names in score.alternatives)


def several_answers(score: Score) -> bool:
    """Whether more than one set counts as right; for a press the refitted law, a matter of taste, does not count."""
    if score.kind == "press":
        return len({names - {REFITTED_LAW} for names in _plain(score.right)}) > 1
    if score.beyond_catalogue:
        return False
    return not score.single_answer


def at_floor(score: Score) -> bool:
    """Whether the written tire leaves at most `FLOOR_FACTOR` noise floors on the diagnosed recordings."""
    return score.fitted is not None and score.fitted.near(FLOOR_FACTOR - 1.0)


def wrong_names_unlikely(score: Score) -> bool:
    """Whether every name that is in no right set has less than a half."""
    there = frozenset().union(*_plain(score.right))
    return score.verdict is not None and all(
        score.probabilities.get(name, 1.0) < HALF for name in named(score) - there
    )


def corrected(score: Score) -> bool:
    """Whether the correction leaves at most a quarter of the misfit on held-out recordings of both groups.

    Misfit: what an error is above the noise floor, (e^2 - floor^2)^(1/2). An error at the noise floor (within 10 %)
    is a full correction.
    """
    if score.held_out is None:
        return False
    for errors in (score.held_out.alike, score.held_out.other):
        floor = errors.reading_noise_floor
        before, after = (math.sqrt(max(e**2 - floor**2, 0.0)) for e in (errors.before, errors.after))
        if not errors.near(NOISE_FLOOR_MARGIN) and after > QUARTER * before:
            return False
    return True


Requirement = tuple[str, str, Callable[[Score], bool], float]

REQUIREMENTS: tuple[Requirement, ...] = (
    ("loud", "all hidden effects named and nothing else but a remainder", sound, 0.95),
    ("press", f"written tire within {FLOOR_FACTOR:g} times the noise floor", at_floor, 0.95),
    ("press", "truth is the verdict or a stated alternative", sound_alternative, 0.97),
    ("press", "a wrong name has less than a half", wrong_names_unlikely, 0.97),
    (
        "foreign",
        "effect named, nothing else above a half, held-out misfit at most a quarter",
        lambda score: sound(score) and corrected(score),
        0.90,
    ),
    (
        "outside",
        "no effect above a half that is not there",
        lambda score: bool(score.verdict) and sound(score),
        0.95,
    ),
    ("beside", "the known effects named, nothing else above a half", sound, 0.90),
    ("pressure", "all hidden effects named and nothing else but a remainder", sound, 0.90),
    ("pressure", "held-out misfit at most a quarter", corrected, 0.90),
    ("set", "all hidden effects named and nothing else but a remainder", sound, 0.90),
    ("set", "held-out misfit at most a quarter", corrected, 0.90),
    ("drift", "all hidden effects named and nothing else but a remainder", sound, 0.90),
    ("drift", "held-out misfit at most a quarter", corrected, 0.90),
)
"""Kind, figure, what a trial has to meet, and the least rate."""

PARTS: tuple[Requirement, ...] = (
    ("foreign", "effect named, nothing else above a half", sound, 0.90),
    ("foreign", "held-out misfit at most a quarter", corrected, 0.90),
)
"""The two parts of the requirement on foreign forms; shown, and no criteria of their own."""


def right_verdicts(scores: Sequence[Score]) -> Rate:
    """How often the verdict was right in the sense of its kind."""
    return Rate.of(sound(score) for score in scores)


def kind_criteria(
    scores: Sequence[Score], requirements: Sequence[Requirement] = REQUIREMENTS
) -> tuple[Criterion, ...]:
    """Return the criteria of the wide kinds that were drawn."""
    drawn = {score.kind for score in scores}
    return tuple(
        Criterion(
            f"{kind}: {figure}",
            Rate.of(meets(score) for score in scores if score.kind == kind),
            limit,
            at_least=True,
            widest=WIDEST_INTERVAL,
        )
        for kind, figure, meets, limit in requirements
        if kind in drawn
    )


def _plain(sets: Sequence[Names]) -> tuple[Names, ...]:
    """The sets without what is no effect."""
    return tuple(names - NOTHING - {UNKNOWN} for names in sets)
