"""What a correction does on recordings that it was not fitted to.

Recordings kept from the fit are taken where they were given. Where none were, the chosen effects are fitted once more
without one part: the last recording whose surfaces the others drive too, or the end of each recording, a block of time
simulated from its true history. Which effects are chosen was seen on the whole; their parameters were not.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Protocol

import numpy as np
from radialtire import TireModel

from ..engine.refit import Case, Refit, again, smooth_of
from ..preprocessing.dataset import Record, Scene, scene_of
from ..preprocessing.kinematics import BoolArray, FloatArray, Motion
from ..simulation.simulate import Sampled, simulate

FITTED = 0.7
"""Part of each recording's time that is fitted where its end is held out."""


class Recorded(Sampled, Protocol):
    """What can be held out: a motion, its force and a name."""

    @property
    def name(self) -> str:
        """What the recording is called."""
        ...

    @property
    def force(self) -> FloatArray:
        """[N], compressive > 0."""
        ...


@dataclass(frozen=True)
class Part:
    """The samples `chosen` of one recording, and what the believed and the corrected tire leave of all of it [N].

    cleared [N]: what the corrected tire leaves where it is told the motion without the noise of its reading
    """

    record: Record
    before: FloatArray
    after: FloatArray
    cleared: FloatArray
    chosen: BoolArray


@dataclass(frozen=True)
class HeldOut:
    """What was fitted and what was not; by: "recordings given", "recording NAME" or "time block A-B s"."""

    by: str
    fitted: tuple[Part, ...]
    unseen: tuple[Part, ...]

    @property
    def before(self) -> float:
        """RMSE [N] of the believed tire on what was not fitted."""
        return rmse([p.before[p.chosen] for p in self.unseen])

    @property
    def after(self) -> float:
        """RMSE [N] of the corrected tire on what was not fitted."""
        return rmse([p.after[p.chosen] for p in self.unseen])

    @property
    def cleared(self) -> float:
        """The same where the tire is told the motion without the noise of its reading, as a simulation tells it."""
        return rmse([p.cleared[p.chosen] for p in self.unseen])


def rmse(parts: Sequence[FloatArray]) -> float:
    """Return the root mean square of all `parts` together."""
    return float(np.sqrt(np.mean(np.concatenate(parts) ** 2)))


def without_reading_noise(tire: TireModel, recording: Recorded, motion: Motion) -> FloatArray:
    """Return what `tire` leaves of a recording [N] where it is told the smoothed motion in place of the readings."""
    smooth = smooth_of(recording, motion)
    return recording.force - simulate(tire, smooth, smooth)


def given(
    held_out: Sequence[Recorded],
    recordings: Sequence[Recorded],
    scene: Scene,
    before: Sequence[FloatArray],
    fitted: Refit,
    tire: TireModel,
) -> HeldOut:
    """Return the errors on recordings that were kept from the fit; before [N]: residuals of the fitted ones."""
    others = scene_of([(r.time, r.deflection, r.surface_radius, r.force) for r in held_out], tire)
    return HeldOut(
        "recordings given",
        tuple(
            Part(
                record,
                b,
                a,
                without_reading_noise(fitted.tire, r, record.motion),
                np.ones(b.size, dtype=bool),
            )
            for record, r, b, a in zip(scene.records, recordings, before, fitted.residuals, strict=True)
        ),
        tuple(
            Part(
                record,
                r.force - simulate(tire, r),
                r.force - simulate(fitted.tire, r),
                without_reading_noise(fitted.tire, r, record.motion),
                np.ones(r.time.size, bool),
            )
            for record, r in zip(others.records, held_out, strict=True)
        ),
    )


def split(
    recordings: Sequence[Recorded],
    scene: Scene,
    before: Sequence[FloatArray],
    cases: Sequence[Case],
    fitted: Refit,
    believed: TireModel,
) -> HeldOut:
    """Return the errors on a part of the recordings after a fit to the rest.

    before [N]: residuals of the believed tire; cases, fitted: the fit to everything, with `believed` under it
    """
    kept, by = _parts(recordings)
    without = [
        replace(c, noise=replace(c.noise, weight=c.noise.weight * k[c.rows]))
        for c, k in zip(cases, kept, strict=True)
    ]
    refitted = again(believed, fitted, without, scene.radii)
    cleared = [
        without_reading_noise(refitted.tire, r, record.motion)
        for record, r in zip(scene.records, recordings, strict=True)
    ]
    parts = list(zip(scene.records, before, refitted.residuals, cleared, kept, strict=True))
    return HeldOut(
        by,
        tuple(Part(r, b, a, c, k) for r, b, a, c, k in parts if k.any()),
        tuple(Part(r, b, a, c, ~k) for r, b, a, c, k in parts if not k.all()),
    )


def _parts(recordings: Sequence[Recorded]) -> tuple[list[BoolArray], str]:
    """Return which samples stay fitted, and what the others are called."""
    surfaces = [set(np.unique(r.surface_radius).tolist()) for r in recordings]
    for number in reversed(range(len(recordings))):
        others = set().union(*(s for i, s in enumerate(surfaces) if i != number))
        if surfaces[number] <= others:
            kept = [np.full(r.time.size, i != number) for i, r in enumerate(recordings)]
            return kept, f"recording {recordings[number].name}"
    kept = [r.time < r.time[0] + FITTED * (r.time[-1] - r.time[0]) for r in recordings]
    r = recordings[0]
    start = float(r.time[kept[0].size - int(np.sum(~kept[0]))])
    more = " and the ends of the others" if len(recordings) > 1 else ""
    return kept, f"time block {start:.4g}-{float(r.time[-1]):.4g} s{more}"
