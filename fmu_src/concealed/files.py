"""A trial on disk: the recordings alone in one folder, the baseline tire and the answer elsewhere."""

import hashlib
import json
import math
from collections.abc import Mapping
from dataclasses import asdict
from pathlib import Path

import numpy as np

from .trial import Record, Trial

HEADER = "time [s],deflection [cm],radius [cm],force [N]"


def write(trial: Trial, folder: Path) -> None:
    """Write train_0.csv, ..., heldout_0.csv, ... and nothing else into a folder.

    Errors: FileExistsError where the folder holds anything else.
    """
    records = (*trial.train, *trial.heldout)
    folder.mkdir(parents=True, exist_ok=True)
    foreign = sorted({path.name for path in folder.iterdir()} - {record.name for record in records})
    if foreign:
        raise FileExistsError(
            f"{folder} holds {foreign[0]}, which is no recording of this trial: give an empty folder"
        )
    for record in records:
        (folder / record.name).write_text(_csv(record), encoding="ascii")


def answer_json(trial: Trial) -> str:
    """The answer as JSON text; lengths in metres, times in seconds, forces in newtons, infinity as "inf"."""
    answer = {"seed": trial.seed, **asdict(trial.answer), "believed": baseline_table(trial)}
    return json.dumps(_plain(answer), indent=1, allow_nan=False) + "\n"


def write_answer(trial: Trial, path: Path) -> str:
    """Write the answer, and return the SHA-256 of its bytes: its commitment hash.

    Errors: ValueError for a path in a folder that holds recordings: a diagnosis could read the answer there.
    """
    if path.parent.is_dir() and any(path.parent.glob("train_*.csv")):
        raise ValueError(f"{path.parent} holds recordings: the answer belongs elsewhere")
    text = answer_json(trial)
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(text, encoding="ascii")
    return hashlib.sha256(text.encode("ascii")).hexdigest()


def baseline_table(trial: Trial) -> Mapping[str, object]:
    """The baseline tire: F = A x^B with x in cm and F in N, surface by surface.

    `law` is "hull1996" where these are the values of the article's equations, "table" where they are not;
    every radius of the article and every one that is recorded is listed, in cm, with "inf" for the flat.
    """
    radii = {s.radius for s in trial.baseline.surfaces}
    for record in (*trial.train, *trial.heldout):
        radii |= {float(r) for r in np.unique(record.radius)}
    surfaces = [trial.baseline.at(radius) for radius in sorted(radii, key=lambda r: 1.0 / r)]
    return {
        "law": trial.baseline_source,
        "surfaces": [{"radius [cm]": _centimetres(s.radius), "A": s.a, "B": s.b} for s in surfaces],
    }


def write_baseline(trial: Trial, path: Path) -> None:
    """Write the baseline tire, which a user has beside the recordings."""
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(json.dumps(baseline_table(trial), indent=1) + "\n", encoding="ascii")


def _csv(record: Record) -> str:
    radii = {float(r): format(100.0 * r, ".6g") for r in np.unique(record.radius)}
    columns = zip(
        record.time.tolist(),
        (100.0 * record.deflection).tolist(),
        record.radius.tolist(),
        record.force.tolist(),
        strict=True,
    )
    lines = [f"{t:.6f},{x:.5f},{radii[r]},{f:.3f}" for t, x, r, f in columns]
    if record.pressure is None:
        return "\n".join([HEADER, *lines, ""])
    pressures = (1e-3 * record.pressure).tolist()
    lines = [f"{line},{p:.1f}" for line, p in zip(lines, pressures, strict=True)]
    return "\n".join([f"{HEADER},pressure [kPa]", *lines, ""])


def _centimetres(radius: float) -> float | str:
    return "inf" if math.isinf(radius) else round(100.0 * radius, 6)


def _plain(value: object) -> object:
    """The same value in what JSON knows."""
    if isinstance(value, Mapping):
        return {str(key): _plain(item) for key, item in value.items()}
    if isinstance(value, (list, tuple)):
        return [_plain(item) for item in value]
    if isinstance(value, np.generic):
        return _plain(value.item())
    if isinstance(value, float):
        if not math.isfinite(value):
            return "inf" if value > 0.0 else "-inf"
        # nine digits: the last ones of a sum depend on how many threads a linear algebra library uses
        return float(f"{value:.9g}")
    return value
