"""Recordings to which nothing is fitted, which judge what is, as far as they move within what is fitted.

A bend of the law beyond that, which no recording showed, would count for any effect that happens to bend as well.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray
from radialtire import TireModel

from ..preprocessing.samples import Recorded, surface_numbers, within
from ..regressors.dataset import Dataset, Samples, dataset_of, samples_of
from ..selection.search import Discrepancy, discrepancy_of, usual_form_error
from ..simulation.simulate import SmoothedMotion, simulate
from .fit import Fit

BoolArray = NDArray[np.bool_]


@dataclass(frozen=True)
class HeldOutRecordings:
    """Recordings to which nothing is fitted, which take part in the posterior of each set.

    log p(all) = log p(fitted) + log p(held out | fitted), the latter at the fitted parameters.
    motions: from where each recording begins; dataset: of the recordings; law: of the discrepancy that forms usually
    leave of their misfit
    """

    recordings: tuple[Recorded, ...]
    motions: tuple[SmoothedMotion, ...]
    dataset: Dataset
    law: Discrepancy

    def predicted(self, fit: Fit) -> Fit:
        """Return a fit with its residual on these recordings and the log likelihood of that at the best V."""
        pairs = zip(self.recordings, self.motions, strict=True)
        left = [r.force - simulate(fit.tire, m, m)[-r.force.size :] for r, m in pairs]
        residual = self.dataset.stacked(self.dataset.averaged(left))
        likelihood, _ = self.law.profile(float(residual @ residual))
        return replace(fit, held_out_residual=residual, log_predictive=likelihood)


def held_out_of(
    recordings: Sequence[Recorded], baseline: TireModel, fitted: Samples
) -> HeldOutRecordings | None:
    """Return the held-out recordings with what the predictive likelihood needs; None where there are none, or none that
    moves within the deflections of those that are fitted.
    """
    if not recordings:
        return None
    motions = samples_of([getattr(r, "whole", r) for r in recordings], baseline).motions
    dataset = dataset_of(recordings, baseline).counting(_within(fitted.motions, recordings, motions))
    if not dataset.misfit.size:
        return None
    law = discrepancy_of(dataset.misfit, usual_form_error(baseline)).blurred(dataset.rounding_error)
    return HeldOutRecordings(tuple(recordings), motions, dataset, law)


def _within(
    fitted: Sequence[SmoothedMotion], recordings: Sequence[Recorded], motions: Sequence[SmoothedMotion]
) -> list[BoolArray]:
    """Return which samples of recordings are `within` the fitted ones; motions: of the recordings, with what was before
    each.
    """
    surfaces = surface_numbers([m.surface_radius for m in fitted] + [r.surface_radius for r in recordings])
    moved = [m.deflection for m in fitted]
    moved += [m.deflection[-r.force.size :] for m, r in zip(motions, recordings, strict=True)]
    placed = list(zip(moved, surfaces, strict=True))
    return within(placed[: len(fitted)], placed[len(fitted) :])


def predicted(held_out: HeldOutRecordings | None, fit: Fit) -> Fit:
    """Return a fit with its residual on held-out recordings, where there are any."""
    return fit if held_out is None else held_out.predicted(fit)
