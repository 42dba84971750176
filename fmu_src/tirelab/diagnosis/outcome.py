"""The content of diagnosis.json with the errors of the FMU itself, and what the report shows besides it.

Its provenance says what it was made of and with: its command, and the files that it depends on with their hashes.
"""

from __future__ import annotations

import hashlib
import math
import shlex
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..estimation.findings import Evidence
from ..fmu.foreign import Simulation
from ..preprocessing.data_checks import compared
from ..recordings.metadata import read_sidecar
from ..recordings.pieces import split_piece
from ..recordings.reading import Reading
from ..recordings.recording import Recording
from ..report.titles import difference, newtons
from .alternatives import Alternative
from .discriminating_test import DiscriminatingTest
from .residual_model import ResidualModel

FloatArray = NDArray[np.float64]


def command_line(
    recordings: Sequence[Path],
    out: Path,
    tire: Path | Simulation | None,
    held_out: Sequence[Path],
    reading: Reading,
    rig: Path | None = None,
) -> str:
    """Return the command that repeats a diagnosis."""
    words = ["tirelab", "diagnose", *map(str, recordings)]
    if isinstance(tire, Simulation):
        words += tire.words()
    elif tire is not None:
        words += ["--tire", str(tire)]
    words += [] if rig is None else ["--rig", str(rig)]
    words += ["--out", str(out), *reading.words()]
    words += [word for file in held_out for word in ("--held-out", str(file))]
    return shlex.join(words)


def files_read(recordings: Sequence[Path], settings: Path | None, beside: Sequence[Path]) -> list[Path]:
    """Return the files that a diagnosis depends on, each once: the recordings, their settings, and those `beside`.

    settings: the file that is named for all recordings, None where each has its own
    """
    parts = [split_piece(given) for given in recordings]
    found = [file for file, _ in parts]
    if settings is not None:
        found.append(settings)
    else:
        for file, piece in parts:
            found += [
                file.parent / name for name in read_sidecar(file, None, piece.trial, piece.sheet).sources
            ]
    return list(dict.fromkeys([*found, *beside]))


def sha256(file: Path) -> str:
    """Return the hash of a file's content, in hexadecimal."""
    with file.open("rb") as stream:
        digest = hashlib.sha256()
        while block := stream.read(1 << 20):
            digest.update(block)
    return digest.hexdigest()


TIRE, FMU, DIAGNOSIS, REPORT, TEST, DATA = (
    "tire.json",
    "BicycleTire.fmu",
    "diagnosis.json",
    "report.html",
    "separating_test.csv",
    "plots.csv",
)
"""The files of a diagnosis, in its folder."""


@dataclass(frozen=True)
class Replayed:
    """Recordings with the forces [N] of the simulated baseline and of the replayed corrected FMU; one array each."""

    recordings: tuple[Recording, ...]
    before: tuple[FloatArray, ...]
    after: tuple[FloatArray, ...]

    def rmse(self, forces: Sequence[FloatArray]) -> float | None:
        """Return the root mean square error [N] of `forces` over all recordings together; None without any.

        Samples at which the deflection's gauge does not follow are left out, as in the diagnosis.
        """
        if not self.recordings:
            return None
        followed = zip(self.recordings, forces, compared(self.recordings), strict=True)
        squares = [np.square(r.force - f)[seen] for r, f, seen in followed]
        return float(np.sqrt(np.mean(np.concatenate(squares))))


def content_of(verdict: Mapping[str, Any], fitted: Replayed, held_out: Replayed) -> dict[str, Any]:
    """Return the content of diagnosis.json with the errors of the corrected FMU and the names of the files.

    verdict: from `Verdict.to_dict`. The held-out errors are those of the held-out recordings; without any, those of the
    part of the recordings that the diagnosis held out (`held_out_by` says which). A number that is not known is null.
    """
    content = dict(verdict)
    content["fit"] = {
        **content["fit"],
        "before": fitted.rmse(fitted.before),
        "after": fitted.rmse(fitted.after),
    }
    if held_out.recordings:
        content["fit"] |= {
            "held_out_before": held_out.rmse(held_out.before),
            "held_out_after": held_out.rmse(held_out.after),
        }
    if content["verdict"]["separating_test"] is not None:
        test = {**content["verdict"]["separating_test"], "file": TEST}
        content["verdict"] = {**content["verdict"], "separating_test": test}
    return finite({**content, "tire": TIRE, "corrected_fmu": FMU, "report": REPORT, "data": DATA})


def page_content(
    evidence: Sequence[Evidence],
    alternatives: Sequence[Alternative],
    residual_models: Sequence[ResidualModel],
    test: DiscriminatingTest | None,
) -> dict[str, Any]:
    """Return what `write_report` can show besides the content of diagnosis.json (see there)."""
    return {
        "evidence": [
            {
                "effects": list(e.names),
                "log_evidence": e.log_evidence,
                "misfit": math.sqrt(max(e.chi_square, 0.0)),
                "remark": "the verdict" if number == 0 else "",
            }
            for number, e in enumerate(evidence)
        ],
        "reasons": [a.reason for a in alternatives],
        "correction": [_regression(m) for m in residual_models],
        "waveform": None
        if test is None
        else {"time": test.test.time.tolist(), "deflection": test.test.deflection.tolist()},
    }


def alternative_detail(names: Sequence[str], alternative: Alternative) -> dict[str, Any]:
    """Return an entry of `alternative_details` in diagnosis.json: how it differs from the verdict's `names`, why."""
    lacks, action = split_reason(alternative.reason)
    return {
        "difference": difference(names, alternative.names),
        "probability": alternative.probability,
        "same": alternative.same,
        "reason": lacks,
        "action": action,
    }


def split_reason(reason: str) -> tuple[str, str]:
    """Return what the recordings lack, and what to do about it, of sentences such as "no hold: hold 10 s at 15 mm"."""
    parts = [part.partition(": ") for part in reason.split("; ")]
    return "; ".join(lacks for lacks, _, _ in parts), "; ".join(action for _, _, action in parts if action)


def _regression(found: ResidualModel) -> dict[str, Any]:
    if math.isnan(found.r2):
        repeats = "Most of its values were there once: whether it repeats is not known."
    elif found.r2 > 0.0:
        repeats = (
            f"It repeats: it explains {100.0 * found.r2:.0f} % of the remainder on held-out blocks of time."
        )
    else:
        repeats = "It does not repeat on held-out blocks of time: do not use it."
    if math.isfinite(found.after):
        repeats += f" With it the RMS error is {newtons(found.after)}"
        held_out = math.isfinite(found.held_out_after)
        repeats += f", and {newtons(found.held_out_after)} on held-out data." if held_out else "."
    return {
        "by": found.by,
        "unit": found.unit,
        "x": found.at.tolist(),
        "force": found.force.tolist(),
        "std": None,
        "repeats": repeats,
    }


def finite(content: Mapping[str, Any]) -> dict[str, Any]:
    """Return `content` in plain Python values that JSON can hold: None for numbers that are not finite."""
    return {str(k): _plain(v) for k, v in content.items()}


def _plain(value: Any) -> Any:
    if isinstance(value, Mapping):
        return finite(value)
    if isinstance(value, (list, tuple)):
        return [_plain(v) for v in value]
    if isinstance(value, np.generic):
        value = value.item()
    if isinstance(value, float) and not math.isfinite(value):
        return None
    return value
