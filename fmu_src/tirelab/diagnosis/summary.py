"""The verdict in a few sentences, for a reader who reads nothing else: what, how much better, how sure, what else."""

from __future__ import annotations

import math
from collections.abc import Sequence

from radialtire import CATALOGUE

from .discriminating_test import SeparatingTest
from .titles import RECALIBRATION, dependence, headline, listed, newtons, set_title, sure
from .verdict import Correction, Fit, NamedEffect, Rival

REPEATS = 0.1
"""Part of what is left that a learned curve explains on time not seen, from which it is worth telling."""


def summarise(
    effects: Sequence[NamedEffect],
    rivals: Sequence[Rival],
    corrections: Sequence[Correction],
    confidence: float,
    fit: Fit,
    test: SeparatingTest | None = None,
) -> str:
    """Return the verdict in sentences, the first of them `titles.headline`.

    corrections: what was learned of something unknown, none where nothing is; test: the best one against the rivals
    """
    names = [e.name for e in effects]
    said = [headline(names, bool(corrections), bool(rivals))]
    said += [_capital(CATALOGUE[name].statement) + "." for name in names if name != RECALIBRATION]
    said += _errors(bool(names), bool(corrections), fit)
    if corrections:
        said.append(_learned(corrections))
    said.append(sure(confidence))
    if rivals:
        said += _rivalled(names, rivals)
    if test is not None and not test.tells:
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
    if fit.held_out_after > PASSED_ON * fit.held_out_cleared:
        cleared = newtons(fit.held_out_cleared)
        found.append(
            f"Told the motion without the noise of its reading, as a simulation tells it, {cleared}: the rest is that "
            "noise, passed on by a rate or an acceleration."
        )
    return found


def _learned(corrections: Sequence[Correction]) -> str:
    """Return what something unknown depends on, and what the best curve that was learned of it brings."""
    by = listed([dependence(c.by) for c in corrections])
    best = max(corrections, key=lambda c: c.repeats)
    if best.repeats < REPEATS:
        return f"What is left depends on {by}, but no curve learned from the recordings repeats on time not seen."
    over = "it" if len(corrections) == 1 else dependence(best.by)
    told = (
        f"What is left depends on {by}: a force learned over {over} brings the error to {newtons(best.after)}"
    )
    unseen = f", and to {newtons(best.held_out_after)} on what it has not seen"
    return f"{told}{unseen if math.isfinite(best.held_out_after) else ''}; it is a description, not physics."


def _rivalled(names: Sequence[str], rivals: Sequence[Rival]) -> list[str]:
    """Return what else it could be: sets in the place of the verdict's `names`, and what may be there beside them."""
    beside = [r for r in rivals if names and len(r.names) == len(names) + 1 and set(r.names) > set(names)]
    if len(beside) < 2:
        return [_told("It could also be", rivals, [set_title(r.names) for r in rivals])]
    instead = [r for r in rivals if r not in beside]
    more = [set_title([n for n in r.names if n not in names]) for r in beside]
    found = [_told("It could also be", instead, [set_title(r.names) for r in instead])] if instead else []
    return [*found, _told("Beside what was found there may be, unseen,", beside, more)]


def _told(start: str, rivals: Sequence[Rival], titles: Sequence[str]) -> str:
    """Return a sentence that lists `titles` of rivals, the reason said once where it is one."""
    if len({r.reason for r in rivals}) == 1:
        return f"{start} {listed(titles, 'or')}: {rivals[0].reason}."
    told = listed([f"{t} ({r.reason})" for t, r in zip(titles, rivals, strict=True)], "or")
    return f"{start} {told}."


def _capital(text: str) -> str:
    return text[:1].upper() + text[1:]
