"""Recordings to which nothing is fitted, which judge what is."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

from radialtire import TireModel

from ..preprocessing.samples import Recorded
from ..regressors.dataset import Dataset, dataset_of, samples_of
from ..selection.search import Discrepancy, discrepancy_of, usual_form_error
from ..simulation.simulate import SmoothedMotion, simulate
from .fit import Fit


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


def held_out_of(recordings: Sequence[Recorded], baseline: TireModel) -> HeldOutRecordings | None:
    """Return the held-out recordings with what the predictive likelihood needs; None where there are none."""
    if not recordings:
        return None
    dataset = dataset_of(recordings, baseline)
    law = discrepancy_of(dataset.misfit, usual_form_error(baseline)).blurred(dataset.rounding_error)
    motions = samples_of([getattr(r, "whole", r) for r in recordings], baseline).motions
    return HeldOutRecordings(tuple(recordings), motions, dataset, law)


def predicted(held_out: HeldOutRecordings | None, fit: Fit) -> Fit:
    """Return a fit with its residual on held-out recordings, where there are any."""
    return fit if held_out is None else held_out.predicted(fit)
