"""The verdict in a few sentences, for a reader who reads nothing else: what, how much better, how sure, what else."""

from __future__ import annotations

import math
from collections.abc import Sequence

from radialtire import CATALOGUE

from ..engine.findings import Alternative, NamedEffect
from ..names import REFITTED_LAW
from ..report.titles import dependence, headline, listed, newtons, set_title, sure
from .discriminating_test import DiscriminatingTest
from .verdict import Fit, ResidualModel

REPEATS = 0.1
"""Part of what is left that a learned curve explains on time not seen, from which it is worth telling."""


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
    said = [headline(names, bool(regressions), bool(alternatives))]
    said += [_capital(CATALOGUE[name].statement) + "." for name in names if name != REFITTED_LAW]
    said += _errors(bool(names), bool(regressions), fit)
    if regressions:
        said.append(_learned(regressions))
    said.append(sure(confidence))
    if alternatives:
        said += _alternatives(names, alternatives)
    if test is not None and not test.sufficient:
        said.append(test.sentence)
    return " ".join(said)


PASSED_ON = 1.1
"""The noise of the deflection's reading is spoken of where it raises the error by more than this factor."""


def _errors(corrected: bool, unexplained: bool, fit: Fit) -> list[str]:
    """Return what the correction did to the error; nothing is said to fall that nothing was fitted to."""
    noise = f"the noise is {newtons(fit.noise)}"
    if not corrected:
        stays = " and stays there" if unexplained else ""
        return [f"The error is {newtons(fit.before)}{stays}; {noise}."]
    told = f"Corrected, the error falls from {newtons(fit.before)} to {newtons(fit.after)}; {noise}."
    if not math.isfinite(fit.held_out_after):
        return [told]
    better = "falls" if fit.held_out_after < fit.held_out_before else "does not fall, it goes"
    unseen = f"{better} from {newtons(fit.held_out_before)} to {newtons(fit.held_out_after)}"
    found = [told, f"On what the fit has not seen it {unseen}."]
    if fit.held_out_after > PASSED_ON * fit.held_out_noise_free:
        cleared = newtons(fit.held_out_noise_free)
        found.append(
            f"Told the motion without the noise of its reading, as a simulation tells it, {cleared}: the rest is that "
            "noise, passed on by a rate or an acceleration."
        )
    return found


def _learned(regressions: Sequence[ResidualModel]) -> str:
    """Return what something unknown depends on, and what the best curve that was learned of it brings."""
    by = listed([dependence(c.by) for c in regressions])
    best = max(regressions, key=lambda c: c.r2)
    if best.r2 < REPEATS:
        return f"What is left depends on {by}, but no curve learned from the recordings repeats on time not seen."
    over = "it" if len(regressions) == 1 else dependence(best.by)
    told = (
        f"What is left depends on {by}: a force learned over {over} brings the error to {newtons(best.after)}"
    )
    unseen = f", and to {newtons(best.held_out_after)} on what it has not seen"
    return f"{told}{unseen if math.isfinite(best.held_out_after) else ''}; it is a description, not physics."


def _alternatives(names: Sequence[str], alternatives: Sequence[Alternative]) -> list[str]:
    """Return what else it could be: sets in the place of the verdict's `names`, and what may be there beside them."""
    beside = [
        r for r in alternatives if names and len(r.names) == len(names) + 1 and set(r.names) > set(names)
    ]
    if len(beside) < 2:
        return [_told("It could also be", alternatives, [set_title(r.names) for r in alternatives])]
    instead = [r for r in alternatives if r not in beside]
    more = [set_title([n for n in r.names if n not in names]) for r in beside]
    found = [_told("It could also be", instead, [set_title(r.names) for r in instead])] if instead else []
    return [*found, _told("Beside what was found there may be, unseen,", beside, more)]


def _told(start: str, alternatives: Sequence[Alternative], titles: Sequence[str]) -> str:
    """Return a sentence that lists `titles` of alternatives, the reason said once where it is one."""
    if len({r.reason for r in alternatives}) == 1:
        return f"{start} {listed(titles, 'or')}: {alternatives[0].reason}."
    told = listed([f"{t} ({r.reason})" for t, r in zip(titles, alternatives, strict=True)], "or")
    return f"{start} {told}."


def _capital(text: str) -> str:
    return text[:1].upper() + text[1:]
