"""Draw a trial of any kind."""

from . import drawing
from .alternatives import Names
from .equivalence import Hidden, equivalent, linearized
from .scenario import KINDS
from .trial import Trial
from .wide import drawing as wide
from .wide.drawing import WIDE_KINDS

REFIT = "recalibration"


def draw(seed: int, *, kind: str | None = None) -> Trial:
    """Draw one trial from a seed; the same seed gives the same trial.

    kind: one of `KINDS`, or of `WIDE_KINDS`, which are drawn only if they are asked for; None draws one of `KINDS`.
    Errors: ValueError for another kind or a negative seed; Undrawable where a seed gives no fair trial.
    """
    if kind is not None and kind not in KINDS and kind not in WIDE_KINDS:
        raise ValueError(f"kind is {kind!r}, but a trial is one of {', '.join((*KINDS, *WIDE_KINDS))}")
    if seed < 0:
        raise ValueError(f"seed is {seed}, but seeds are not negative")
    return wide.draw(seed, kind) if kind in WIDE_KINDS else drawing.draw(seed, kind=kind)


def derived_right(trial: Trial) -> tuple[tuple[str, ...], ...]:
    """The sets that count as right in a trial by the rig's own simulations, the true one first.

    The answers of the wide kinds hold these sets. Those of the other kinds hold sets by a rule (`alternatives`): the
    bytes of their answers, and so their commitment hashes, depend on it. There both are counted.
    """
    answer = trial.answer
    if answer.kind in WIDE_KINDS or answer.kind in ("none", "open"):
        return answer.right
    truth: Names = frozenset(answer.effects)
    law = trial.baseline if REFIT in truth else trial.bench.tire
    hidden = Hidden.of(trial.bench, law, trial.motions, trial.instrument)
    found = equivalent(hidden, linearized(hidden), truth, len(truth))
    sets = [truth, *found.sets]
    # the rig could not say whether the baseline's law is this tire's: then both answers stay right
    if tuple(sorted(truth | {REFIT})) in answer.right:
        sets += [names | {REFIT} for names in sets]
    return tuple(tuple(sorted(s)) or ("none",) for s in dict.fromkeys(sets))
