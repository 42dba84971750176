"""How large each effect of a corrected tire is in the force: the number that a reader compares with the load."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from radialtire import TireModel

from ..names import REFITTED_LAW
from ..preprocessing.dataset import Recorded
from ..simulation.simulate import simulate


def without(name: str, corrected: TireModel, baseline: TireModel) -> TireModel:
    """Return the `corrected` tire with one of its effects as the `baseline` has it: left out where it has none.

    name: of the effect; a refitted law takes the effects with it that are part of a law (its shape)
    """
    own = {effect.name: (effect, values) for effect, values in baseline.effects}
    kept = []
    for effect, values in corrected.effects:
        if effect.name == name or (name == REFITTED_LAW and "law" in effect.traits):
            kept += [own[effect.name]] if effect.name in own else []
        else:
            kept.append((effect, values))
    law = baseline.law if name == REFITTED_LAW else corrected.law
    return replace(corrected, law=law, effects=tuple(kept))


def effect_size(
    name: str, corrected: TireModel, baseline: TireModel, recordings: Sequence[Recorded]
) -> float | None:
    """Return the root mean square [N] of what an effect adds to the `corrected` tire's force; None without samples.

    size^2 = mean (F - F_without)^2   over all samples of the recordings
    """
    less = without(name, corrected, baseline)
    added = [simulate(corrected, r) - simulate(less, r) for r in recordings]
    return float(np.sqrt(np.mean(np.concatenate(added) ** 2))) if added else None


def load_of(recordings: Sequence[Recorded]) -> float | None:
    """Return the root mean square [N] of the recorded force, which sizes are compared with; None without samples."""
    if not recordings:
        return None
    return float(np.sqrt(np.mean(np.concatenate([r.force for r in recordings]) ** 2)))
