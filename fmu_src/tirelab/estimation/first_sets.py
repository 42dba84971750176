"""From recordings in blocks to the sets of effects that are fitted first.

The noise of the misfit is estimated from the residual of the saturated model, which has the signatures of all effects
at once. The sets that the signatures find likely are fitted, and what the blocks leave out of the likeliest one is
subtracted.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import partial

import numpy as np
from numpy.typing import NDArray

from ..preprocessing.driven import Driven
from ..preprocessing.levels import NoiseProfile, levels_by_load, levels_by_state, white_level
from ..preprocessing.noise import Noise, noise_of, resting, white_noise_of
from ..preprocessing.samples import Recorded, surface_numbers
from ..regressors.dataset import STEPS_LEFT, Dataset, Experiment, Samples, dataset_of
from ..regressors.signature import (
    LAW,
    Signature,
    candidates,
    in_other_noise,
    law_signature,
    signatures_of,
    size_of,
)
from ..selection.search import (
    LIKE_NOISE,
    NormalEquations,
    discrepancy_of,
    normal_equations,
    parts_of,
    search,
    usual_form_error,
)
from .fit import Fit
from .held_out import HeldOutRecordings
from .ranking import FittedSets, begun

FloatArray = NDArray[np.float64]


BEGUN = 3
"""Number of the likeliest sets of the search that are fitted first, in addition to the best one of each size."""

LEAST_LEFT = 1e-3
"""Least noise of what the saturated model leaves, over that of the readings: it may follow forces that rest on a step
to the last digit."""


def with_signatures(
    dataset: Dataset, recordings: Sequence[Recorded], shown: Sequence[str], catalogue: Sequence[str]
) -> tuple[Dataset, tuple[Signature, ...], Dataset]:
    """Return the dataset in blocks at least as long as the noise is correlated, its signatures, and the dataset in
    units of the noise that the saturated model leaves.
    """
    raw = _raw(dataset, shown, catalogue)
    quiet = _in_saturated_noise(dataset, raw)
    if any(e.reading.memory > e.size for e in quiet.experiments):
        dataset = dataset_of(recordings, dataset.tire, [e.reading for e in quiet.experiments])
        raw = _raw(dataset, shown, catalogue)
        quiet = _in_saturated_noise(dataset, raw)
    return dataset, raw, quiet


@dataclass(frozen=True)
class FirstSets:
    """What sets are fitted to: the dataset in blocks and its signatures, as first read; the samples of the blocks; the
    held-out recordings; and the budget of simulated blocks.
    """

    dataset: Dataset
    signatures: tuple[Signature, ...]
    samples: Samples
    held_out: HeldOutRecordings | None
    most_work: float

    def begun(self, quiet: Dataset) -> FittedSets:
        """Return the sets that the signatures find likely, fitted; quiet: the dataset in units of another noise."""
        signatures = tuple(in_other_noise(s, self.dataset, quiet) for s in self.signatures)
        rough = discrepancy_of(quiet.misfit, usual_form_error(quiet.tire))
        equations = normal_equations([s for s in signatures if not s.silent], quiet.misfit)
        likely = search(equations, rough).starts(BEGUN)
        starts = [(e.variance, parts_of(e, equations, rough)) for e in likely]
        return begun(quiet, signatures, rough, starts, self.held_out, self.most_work)

    def less_distorted(self, sets: FittedSets, fit: Fit) -> FittedSets:
        """Return the sets begun anew without what blocks leave out of a fit's response, that fit among them; the same
        ones where it is no more than noise.

        It passed for noise, or for something that another effect is. Begun anew, the search may not find that set.
        """
        left_out = self.samples.left_out(sets.dataset, fit.tire)
        more = [new - e.left_out for new, e in zip(left_out, sets.dataset.experiments, strict=True)]
        if size_of(sets.dataset.stacked(more)) <= LIKE_NOISE:
            return sets
        found = self.begun(_in_saturated_noise(self.dataset.corrected(left_out), self.signatures))
        found.fit([fit.values], fit.variance)
        return found


def _raw(dataset: Dataset, shown: Sequence[str], catalogue: Sequence[str]) -> tuple[Signature, ...]:
    return (*((law_signature(dataset),) if LAW in catalogue else ()), *signatures_of(shown, dataset))


def in_quiet_units(dataset: Dataset) -> Dataset:
    """Return a dataset in units of the noise that the saturated model leaves."""
    raw = (law_signature(dataset), *signatures_of(candidates(), dataset))
    return _in_saturated_noise(dataset, raw)


def _in_saturated_noise(dataset: Dataset, signatures: Sequence[Signature]) -> Dataset:
    """Return the dataset with the noise of the blocks that the saturated model leaves.

    By how much that is more than the noise of the readings is no noise but what the recordings contradict each other,
    or what no effect explains: it counts alike in all of them, or the one that is fitted best would count most. Within
    a recording the noise may be another one while the tire rests; then the model is fitted again with that, since it
    followed most of all what is loud.
    """
    quiet = _left_by_saturated(dataset, signatures)
    if all(
        e.profile == before.profile for e, before in zip(quiet.experiments, dataset.experiments, strict=True)
    ):
        return quiet
    return _left_by_saturated(quiet, [in_other_noise(s, dataset, quiet) for s in signatures], white=True)


def _left_by_saturated(dataset: Dataset, signatures: Sequence[Signature], *, white: bool = False) -> Dataset:
    """The same after one fit of the saturated model; white: whether the noise is known to have no memory."""
    equations = normal_equations(signatures, dataset.misfit)
    left = dataset.apart(_left_by_all(equations, dataset.misfit))
    noise_left = partial(_noise_left, dataset, equations, left)
    noises = [noise_left(number, white=white) for number in range(len(left))]
    series = [e for e in dataset.with_noise(noises).experiments if e.reading.told_by_series]
    if series and not white:
        noises = [n if n.memory > 1 else noise_left(i, series) for i, n in enumerate(noises)]
    found, states = [], []
    for e, own, noise in zip(dataset.experiments, left, noises, strict=True):
        level, profile, louder = _profiled(e, own, noise)
        found.append(replace(noise, level=level))
        states.append((profile, replace(e.floor, amplifier=louder * e.floor.amplifier)))
    read, levels = np.array([e.noise for e in dataset.experiments]), np.array([n.level for n in found])
    more = np.average(np.maximum(levels**2 - read**2, 0.0), weights=[own.size for own in left])
    shared = np.sqrt(np.minimum(levels, read) ** 2 + more)
    quiet = dataset.with_noise([replace(n, level=float(s)) for n, s in zip(found, shared, strict=True)])
    pairs = zip(quiet.experiments, states, strict=True)
    return replace(
        quiet, experiments=tuple(replace(e, profile=own, floor=floor) for e, (own, floor) in pairs)
    )


def _noise_left(
    dataset: Dataset,
    equations: NormalEquations,
    left: Sequence[FloatArray],
    number: int,
    series: Sequence[Experiment] = (),
    *,
    white: bool = False,
) -> Noise:
    """Return the noise [N] of what the saturated model left of one experiment, with its memory in blocks.

    left: of each experiment, in units of its noise; series: those whose noise has a memory; white: known to have none
    """
    e, own = dataset.experiments[number], left[number]
    x, rate, acceleration = (v[e.counts] for v in (e.deflection, e.rate, e.acceleration))
    (surface,) = surface_numbers([e.surface_radius[e.counts]])
    driven = Driven(e.interval, x, rate, acceleration, surface)
    over = [noise for other in series for noise in other.noises_over(e.interval, e.size)]
    known = [replace(n, level=n.level / e.noise, hum=n.hum / e.noise) for n in (*over, e.reading.of_mains)]
    others = partial(_left_in_one, equations, [r.size for r in left], number)
    noise = white_noise_of(own, driven, known) if white else noise_of(own, driven, others, known)
    return replace(noise, level=e.noise * max(noise.level, LEAST_LEFT), hum=e.noise * noise.hum)


def _profiled(experiment: Experiment, left: FloatArray, noise: Noise) -> tuple[float, NoiseProfile, float]:
    """Return the noise [N] of all counted blocks, that of each over it, and by how much all samples are louder than
    most of them.

    left (m,): what is left of the counted blocks, in units of the noise; noise [N]: of most of it; only of a white one
    differences between neighbours show the parts. At rest the steps of gauge and force err alike in neighbouring
    blocks, which no difference shows.
    """
    e, before = experiment, experiment.profile
    if noise.memory > 1:
        return noise.level, before, 1.0
    rests, load = resting(e.rate)[e.counts], e.baseline[e.counts]
    loaded = levels_by_load(left, load, LEAST_LEFT, before)
    by_load = loaded.of_load(load)
    even = left * before.of_load(load) / by_load
    parts = levels_by_state(even, rests, LEAST_LEFT, differ=before.at_rest != before.moving)
    if parts == (1.0, 1.0) and loaded == before:
        return noise.level, before, 1.0
    own = [part * known for part, known in zip(parts, (before.at_rest, before.moving), strict=True)]
    lasting = np.gradient(e.time)[e.counts]  # a long rest has few blocks for its samples
    usual = float(np.average((by_load * np.where(rests, *own)) ** 2, weights=lasting))
    white, of_sample = e.noise * white_level(even), e.noise * math.sqrt(e.size)
    louder = white * math.sqrt(usual * e.size) / max(e.reading.level, of_sample, e.floor.amplifier)
    at_rest, moving = (white * part for part in own)
    if at_rest < moving:
        at_rest = max(at_rest, math.hypot(STEPS_LEFT * e.floor.steps, e.resting))
    whole = size_of(by_load * np.where(rests, at_rest, moving))
    profile = replace(loaded, at_rest=float(at_rest / whole), moving=float(moving / whole))
    return whole, profile, max(louder, 1.0)


def _left_by_all(equations: NormalEquations, values: FloatArray) -> FloatArray:
    """Return what the saturated model leaves of values (m,) or (m, k): all columns, each with a weak prior of the
    misfit's size.
    """
    columns, size = equations.columns, equations.power / equations.columns.shape[0]
    gram = equations.gram + np.eye(equations.gram.shape[0]) / max(size, 1.0)
    return np.asarray(values - columns @ np.linalg.solve(gram, columns.T @ values))


def _left_in_one(
    equations: NormalEquations, sizes: Sequence[int], number: int, signals: FloatArray
) -> FloatArray:
    """Return what the saturated model leaves of signals (n, k) in one experiment, where the others have none of them.

    sizes: of all experiments
    """
    begin = sum(sizes[:number])
    whole = np.zeros((sum(sizes), signals.shape[1]))
    whole[begin : begin + sizes[number]] = signals
    return _left_by_all(equations, whole)[begin : begin + sizes[number]]
