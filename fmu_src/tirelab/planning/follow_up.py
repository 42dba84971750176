"""After a diagnosis: what to record so that its verdict is told from its alternatives.

For each alternative, every effect that it has and the verdict has not is asked for against the verdict's set, and every
effect that only the verdict has against the alternative's. What was recorded already counts: its motions stand in
plots.csv beside the diagnosis.
"""

from __future__ import annotations

import json
from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
import polars as pl
from numpy.typing import NDArray
from radialtire import TireFileError, TireModel
from radialtire.tirefile import from_text

from ..errors import TirelabError, what_is_wrong
from ..names import UNKNOWN
from ..regressors.signature import LAW
from .menu import FEWEST, Drive
from .plan import Progress, RecordingPlan, motions_within, offered, planned
from .responses import responses_of, within_force
from .rig import Rig
from .separation import Question

FloatArray = NDArray[np.float64]

MOST_SURFACES = 3
"""Recorded surfaces that are taken for those that can be mounted, the flattest first."""

MOST_SAMPLES = 20_000
"""Samples of each recorded motion that are simulated."""


@dataclass(frozen=True)
class Diagnosed:
    """What a diagnosis.json states: the verdict's names, its alternatives, the noise [N], the recorded motions, and the
    tire that was believed, None in a file that does not hold it.
    """

    names: frozenset[str]
    alternatives: tuple[frozenset[str], ...]
    noise: float
    recorded: tuple[Drive, ...]
    tire: TireModel | None = None

    @property
    def rig(self) -> Rig:
        """What is known of the rig that recorded: its noise, and the surfaces and the stroke that it reached."""
        rig = replace(Rig(), noise=self.noise)
        if not self.recorded:
            return rig
        radii = np.unique(np.concatenate([d.surface_radius for d in self.recorded]))
        surfaces = sorted((float(r) for r in radii), key=lambda r: abs(1.0 / r))[:MOST_SURFACES]
        least = min(float(d.deflection.min()) for d in self.recorded)
        start = least if self.tire is not None and self.tire.is_part else 0.0
        stroke = max(float(np.abs(d.deflection - start).max()) for d in self.recorded)
        return replace(rig, surfaces=tuple(surfaces), stroke=stroke, start=start)


def read_diagnosed(path: Path) -> Diagnosed:
    """Return what the diagnosis.json at `path`, or in that folder, states; raises TirelabError if it is none."""
    file = path / "diagnosis.json" if path.is_dir() else path
    try:
        content = json.loads(file.read_text(encoding="utf-8"))
        verdict = content["verdict"]
        names = frozenset(str(e["name"]) for e in verdict["effects"]) - {UNKNOWN}
        others = tuple(frozenset(map(str, other)) - {UNKNOWN} for other in verdict["alternatives"])
        noise = float(content["fit"]["noise"])
        data = content.get("data")
        # Beside somebody else's simulation the believed tire has no force of its own.
        held = None if "correction" in content else content.get("baseline_tire")
        tire = None if held is None else from_text(json.dumps(held))
    except OSError as error:
        raise TirelabError(f"{file}: {error.strerror or error}; check the path") from None
    except TireFileError as error:
        raise TirelabError(f"{file}: the believed tire cannot be read: {error}") from None
    except (KeyError, TypeError, ValueError, AttributeError, OverflowError, RecursionError) as error:
        raise TirelabError(f"{file} is no diagnosis ({what_is_wrong(error)}); diagnose again") from None
    table = None if data is None else file.parent / str(data)
    return Diagnosed(
        names,
        tuple(dict.fromkeys(o for o in others if o != names)),
        noise,
        () if table is None or not table.is_file() else _recorded(table),
        tire,
    )


def _recorded(file: Path) -> tuple[Drive, ...]:
    try:
        table = pl.read_csv(file).filter(pl.col("used") == "fitted")
        drives = []
        for (name,), part in table.group_by("recording", maintain_order=True):
            rows = part[:: max(1, len(part) // MOST_SAMPLES)]
            time, mm, cm = (
                rows[c].cast(pl.Float64).to_numpy() for c in ("time [s]", "deflection [mm]", "radius [cm]")
            )
            if time.size >= FEWEST:
                drives.append(Drive(str(name), time, mm / 1e3, cm / 100.0))
    except (OSError, pl.exceptions.PolarsError) as error:
        raise TirelabError(f"{file}: no motion can be read from it ({error}); diagnose again") from None
    return tuple(drives)


def follow_up(
    diagnosed: Diagnosed,
    tire: TireModel,
    rig: Rig,
    size: float = 0.02,
    progress: Progress = lambda sentence: None,
) -> RecordingPlan:
    """Return the shortest set of recordings that tells a verdict from its alternatives.

    tire: the baseline; size: of an effect that an alternative adds, largest response over the peak force
    Raises TirelabError where there are no alternatives, or none of an effect that responds within the limits.
    """
    if not diagnosed.alternatives:
        raise TirelabError("the diagnosis has no alternatives: nothing is left to tell apart")
    rig = within_force(rig, tire)
    possible = motions_within(rig)
    responses = responses_of((*possible, *diagnosed.recorded), tire, rig, progress)
    questions = alternatives_asked(diagnosed, responses.names, size)
    if not questions:
        raise TirelabError(
            "no effect of the alternatives responds within these limits; give a larger --stroke or a faster --speed"
        )
    return planned(tire, rig, responses, offered(responses, questions, len(possible)), progress)


def alternatives_asked(diagnosed: Diagnosed, heard: Sequence[str], size: float) -> tuple[Question, ...]:
    """Return the questions between a verdict and its alternatives, of effects that respond."""
    verdict, found = diagnosed.names, list[Question]()
    for other in diagnosed.alternatives:
        for one, alternative in ((verdict, other), (other, verdict)):
            rest = (alternative & frozenset(heard)) | (alternative & {LAW})
            found += [
                Question(name, rest, size, nested=alternative < one)
                for name in sorted(one - alternative)
                if name in heard
            ]
    return tuple(dict.fromkeys(found))
