"""The files that a diagnosis writes: the corrected tire, diagnosis.json, the proposed test and all samples."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
import polars as pl
from radialtire import write_tire

from ..errors import unwritable_folder
from .outcome import DATA, DIAGNOSIS, TEST, TIRE, Replayed
from .verdict import Verdict


def write_verdict(out: Path, content: Mapping[str, Any], verdict: Verdict) -> None:
    """Write all but the FMU and the report."""
    try:
        write_tire(verdict.tire, out / TIRE)
        (out / DIAGNOSIS).write_text(json.dumps(content, indent=2, allow_nan=False) + "\n", encoding="utf-8")
        if verdict.test is not None:
            motion = verdict.test.test
            pl.DataFrame(
                {
                    "time [s]": np.round(motion.time, 9),
                    "deflection [cm]": np.round(100.0 * motion.deflection, 9),
                    "radius [cm]": np.round(100.0 * motion.surface_radius, 9),
                }
            ).write_csv(out / TEST)
    except OSError as error:
        raise unwritable_folder(out, error) from None


def write_samples(out: Path, groups: Sequence[tuple[str, Replayed]]) -> None:
    """Write every sample of every recording with the forces before and after: the data behind the plots."""
    tables = [
        pl.DataFrame(
            {
                "recording": [recording.name] * len(recording),
                "used": [used] * len(recording),
                "time [s]": recording.time,
                "deflection [mm]": 1e3 * recording.deflection,
                "radius [cm]": 100.0 * recording.surface_radius,
                "force [N]": recording.force,
                "force before [N]": before,
                "force after [N]": after,
            }
        )
        for used, replayed in groups
        for recording, before, after in zip(replayed.recordings, replayed.before, replayed.after, strict=True)
    ]
    try:
        pl.concat(tables).write_csv(out / DATA, float_precision=6)
    except OSError as error:
        raise unwritable_folder(out, error) from None
