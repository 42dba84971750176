"""The names of effects, sets of effects and coordinates in a sentence."""

from __future__ import annotations

from collections.abc import Collection, Sequence

from radialtire import CATALOGUE

from ..names import REFITTED_LAW, UNKNOWN
from .words import rounded

DEPENDENCE = {
    "deflection": "the deflection",
    "rate": "the rate of deflection",
    "acceleration": "the acceleration",
    "force": "the force",
    "time": "time",
}
"""Names for a reader of the coordinates of something unknown; a coordinate that is not here keeps its name."""


def effect_title(name: str) -> str:
    """Return the name of an effect, or of one of its parameters, for a reader."""
    if name == UNKNOWN:
        return "something unknown"
    if name == REFITTED_LAW:
        return "refitted law"
    return (
        name.replace("_", " ").replace("rate independent", "rate-independent").replace("mullins", "Mullins")
    )


_SHORT = {
    "rate_independent_hysteresis": "friction loop",
    "series_compliance": "series spring",
    "viscoelastic_relaxation": "relaxation",
}
"""Names for headlines, sentences and lists of effects whose own name is long: `full_title` says both."""


def short_title(name: str) -> str:
    """Return the name of an effect where there is little room."""
    return _SHORT.get(name) or effect_title(name)


def full_title(name: str) -> str:
    """Return the short name of an effect, and its own in brackets, for where it is first told of."""
    short, own = short_title(name), effect_title(name)
    return short if short == own else f"{short} ({own})"


def short_set(names: Sequence[str]) -> str:
    """Return the name of a set of effects where there is little room."""
    return " + ".join(short_title(name) for name in names) or "nothing missing"


def difference(names: Sequence[str], other: Sequence[str]) -> str:
    """Return how another set differs from `names`: "+ series spring", "− refitted law", "B instead of A"."""
    added = [short_title(name) for name in other if name not in names]
    removed = [short_title(name) for name in names if name not in other]
    if len(added) == len(removed) == 1:
        return f"{added[0]} instead of {removed[0]}"
    return " ".join([*(f"+ {title}" for title in added), *(f"− {title}" for title in removed)]) or "the same"


def replaced(names: Sequence[str], other: Sequence[str]) -> tuple[str, str]:
    """Return what another set has and `names` have not, and in place of what: ("series spring", "in addition")."""
    added, removed = [n for n in other if n not in names], [n for n in names if n not in other]
    if not names or not removed:
        return short_set(added), "in addition" if names else ""
    return (
        (short_set(added), f"instead of {short_set(removed)}")
        if added
        else ("", f"the same without {short_set(removed)}")
    )


def question(first: Sequence[str], second: Sequence[str], more: str = "") -> str:
    """Return what decides between two sets: "whether the series spring acts", "between inertia and force lag".

    more: said at the end where one set has all effects of the other; empty is returned where both are the same
    """
    gone = [name for name in first if name not in second]
    new = [name for name in second if name not in first]
    if gone and new:
        return f"between {short_set(gone)} and {short_set(new)}"
    acting = gone or new
    if not acting:
        return ""
    if acting == [REFITTED_LAW]:
        return "whether the law has other coefficients"
    with_articles = [short_title(n) if n == UNKNOWN else f"the {short_title(n)}" for n in acting]
    return f"whether {listed(with_articles)} {'acts' if len(acting) == 1 else 'act'}{more}"


def set_title(names: Sequence[str]) -> str:
    """Return the name of a set of effects; a name that is no effect's is a coordinate of something unknown."""
    known = {*CATALOGUE, REFITTED_LAW, UNKNOWN}
    titles = [short_title(n) if n in known else f"something unknown over {dependence(n)}" for n in names]
    return listed(titles) or "nothing missing"


def dependence(by: str) -> str:
    """Return the name of a coordinate of something unknown for a reader."""
    return DEPENDENCE.get(by, by)


def listed(words: Sequence[str], last: str = "and") -> str:
    """Return "a", "a and b", "a, b and c"."""
    if len(words) < 2:
        return "".join(words)
    return f"{', '.join(words[:-1])} {last} {words[-1]}"


AT_THE_FLOOR = 1.5
"""An error of more than this many noises is more than the noise."""


def more_than_noise(error: float, noise: float) -> bool:
    """Return whether an error [N] is more than the noise [N]."""
    return error > AT_THE_FLOOR * max(noise, 1e-12)


def headline(
    names: Sequence[str],
    unexplained: bool,
    alternatives: bool,
    left: bool = False,
    changed: Collection[str] = (),
) -> str:
    """Return the verdict in one line.

    names: of its effects; unexplained: whether something unknown acts; alternatives: whether there are any; left:
    whether the correction leaves more than the noise; changed: those of the effects that the baseline has too, with
    other values
    """
    physics = [name for name in names if name != REFITTED_LAW]
    if names and left and not physics and not unexplained:
        text = "The elastic law has other coefficients, and more than the noise is left"
    elif not physics and not unexplained:
        text = (
            "No other physics shows: the elastic law has other coefficients"
            if names
            else "Nothing is missing"
        )
    elif not names:
        text = "Something is missing that no known effect explains"
    else:
        parts = [full_title(name) for name in physics if name not in changed]
        if unexplained:
            parts.append("something that no known effect explains")
        said = [f"Left out: {listed(parts)}"] if parts else []
        if others := [full_title(name) for name in physics if name in changed]:
            said.append(
                f"{listed(others)} {'has' if len(others) == 1 else 'have'} other values than simulated"
            )
        text = "; ".join(said)
        text = f"{text[0].upper()}{text[1:]}"
        if REFITTED_LAW in names:
            text += ", and the elastic law has other coefficients"
    if alternatives:
        text += " – but these recordings cannot rule out alternatives"
    return f"{text}."


def sure(confidence: float) -> str:
    """Return the sentence on a confidence, 0 to 1."""
    return f"Confidence {100.0 * confidence:.0f} %."


def newtons(force: float) -> str:
    """Return a force [N] to three digits with its unit."""
    return f"{rounded(force, 3)} N"
