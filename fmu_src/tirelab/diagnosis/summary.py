"""The verdict in a few sentences: what is missing, how much the correction helps, the confidence, the alternatives."""

from __future__ import annotations

import math
from collections.abc import Sequence

from radialtire import CATALOGUE

from ..estimation.findings import NamedEffect
from ..names import REFITTED_LAW
from ..report.titles import dependence, headline, listed, more_than_noise, newtons, set_title, sure
from .confidence import Alternative
from .discriminating_test import DiscriminatingTest
from .residual_model import ResidualModel
from .verdict import Fit

REPEATS = 0.1
"""Cross-validated R^2 from which a regression is worth a sentence."""


def summarise(
    effects: Sequence[NamedEffect],
    alternatives: Sequence[Alternative],
    regressions: Sequence[ResidualModel],
    confidence: float,
    fit: Fit,
    test: DiscriminatingTest | None = None,
) -> str:
    """Return the verdict in sentences, the first of them `titles.headline`.

    regressions: of something unknown, none where nothing is; test: the best one against the alternatives
    """
    names = [e.name for e in effects]
    left = more_than_noise(fit.left, fit.noise)
    said = [headline(names, bool(regressions), bool(alternatives), left)]
    said += [_capital(CATALOGUE[name].statement) + "." for name in names if name != REFITTED_LAW]
    said += _errors(bool(names), bool(regressions), fit)
    if regressions:
        said.append(_remainder(regressions))
    said.append(sure(confidence))
    if alternatives:
        said += _alternatives(names, alternatives)
    if test is not None and not test.sufficient:
        said.append(test.sentence)
    return " ".join(said)


AMPLIFIED = 1.1
"""The noise of the deflection is mentioned where it raises the held-out error by more than this factor."""


def _errors(corrected: bool, unexplained: bool, fit: Fit) -> list[str]:
    """Return what the correction does to the error."""
    noise = f"the noise is {newtons(fit.noise)}"
    if not corrected:
        stays = ", and no known effect reduces it" if unexplained else ""
        return [f"The RMS error is {newtons(fit.before)}{stays}; {noise}."]
    verb = "reduces" if fit.after < fit.before else "does not reduce, it changes"
    found = [
        f"The correction {verb} the RMS error from {newtons(fit.before)} to {newtons(fit.after)}; {noise}."
    ]
    if not math.isfinite(fit.held_out_after):
        return found
    verb = "falls" if fit.held_out_after < fit.held_out_before else "does not fall: it goes"
    change = f"{verb} from {newtons(fit.held_out_before)} to {newtons(fit.held_out_after)}"
    found.append(f"On held-out data it {change}.")
    if fit.held_out_after > AMPLIFIED * fit.held_out_noise_free:
        found.append(
            f"With the noise-free deflection as input it is {newtons(fit.held_out_noise_free)}; the remainder is "
            "reading noise amplified by differentiation."
        )
    return found


def _remainder(regressions: Sequence[ResidualModel]) -> str:
    """Return what the unexplained remainder depends on, and how far its best regression reduces the error."""
    by = listed([dependence(c.by) for c in regressions])
    best = max(regressions, key=lambda c: c.r2)
    if best.r2 < REPEATS:
        return f"The remainder depends on {by}, but no regression of it repeats on held-out blocks of time."
    over = "it" if len(regressions) == 1 else dependence(best.by)
    held_out = math.isfinite(best.held_out_after)
    also = f", and to {newtons(best.held_out_after)} on held-out data" if held_out else ""
    after = f"{newtons(best.after)}{also}"
    return (
        f"The remainder depends on {by}. A regression over {over} reduces the RMS error to {after}; it is a "
        "description, not physics."
    )


def _alternatives(names: Sequence[str], alternatives: Sequence[Alternative]) -> list[str]:
    """Return the sets that may replace the verdict's `names`, and the effects that may act in addition to them."""
    added = [
        r for r in alternatives if names and len(r.names) == len(names) + 1 and set(r.names) > set(names)
    ]
    if len(added) < 2:
        return _listed("These recordings cannot rule out {}", alternatives, [r.names for r in alternatives])
    instead = [r for r in alternatives if r not in added]
    more = [[n for n in r.names if n not in names] for r in added]
    found = _listed("These recordings cannot rule out {}", instead, [r.names for r in instead])
    return [*found, *_listed("In addition, {} may act without being seen", added, more)]


def _listed(sentence: str, alternatives: Sequence[Alternative], sets: Sequence[Sequence[str]]) -> list[str]:
    """Return `sentence` about the alternatives' `sets`, with the reason said once where it is one."""
    if not alternatives:
        return []
    titles = [set_title(names) for names in sets]
    if len({r.reason for r in alternatives}) == 1:
        return [f"{sentence.format(_either(titles, sets))}.", f"{_capital(alternatives[0].reason)}."]
    by_reason: dict[str, list[str]] = {}
    for title, alternative in zip(titles, alternatives, strict=True):
        by_reason.setdefault(alternative.reason, []).append(title)
    reasoned = [f"{_either(group, sets)} ({reason})" for reason, group in by_reason.items()]
    return [f"{sentence.format(_either(reasoned, sets))}."]


def _either(titles: Sequence[str], sets: Sequence[Sequence[str]]) -> str:
    """Return "a, b or c"; with semicolons where a title names several effects and has commas of its own."""
    if len(titles) < 2 or not any(len(names) > 1 for names in sets):
        return listed(titles, "or")
    return f"{'; '.join(titles[:-1])}; or {titles[-1]}"


def _capital(text: str) -> str:
    return text[:1].upper() + text[1:]
