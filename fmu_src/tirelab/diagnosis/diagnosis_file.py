"""A diagnosis.json read back and checked."""

from __future__ import annotations

import json
import math
from collections.abc import Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

from radialtire import TireFileError, TireModel, read_tire
from radialtire.learned_remainder import COORDINATES, LearnedRemainder
from radialtire.tirefile import from_text

from ..errors import TirelabError, what_is_wrong
from ..fmu.build import Correction
from ..names import UNKNOWN

SCHEMAS = (1, 2)
"""Versions that are read. The second states a probability of every effect, and what remains unexplained."""

Names = frozenset[str]

NOTHING: Names = frozenset({"none"})
"""The set that stands for: nothing is missing."""


class DiagnosisFileError(TirelabError):
    """A diagnosis.json that cannot be used; the sentence says where and why."""


@dataclass(frozen=True)
class StatedPlace:
    """One place of the misfit: coordinate, span in `unit` (None: no end), share of the squared error, recording, and
    the name of the place where numbers do not say it."""

    by: str
    begin: float | str | None
    end: float | str | None
    unit: str
    share: float
    recording: str | None
    label: str = ""


@dataclass(frozen=True)
class Stated:
    """A verdict as its file states it.

    names: the effects, with "unknown" where something stays unexplained; {"none"} where nothing is missing
    alternatives: each a full set of names; confidence: 0 to 1
    separating_test: file of the test that separates the alternatives, or None
    fit: noise, before, after, held_out_before, held_out_after [N], None where not known
    tire, corrected_fmu, report: the files, None where there is none
    probabilities: of every named effect, that it is there; the confidence where the file states none (schema 1)
    remainder: size of what stays unexplained in units of the noise, None where the file does not state it
    same: probability of the alternatives that leave the same of the recordings, together
    """

    names: Names
    alternatives: tuple[Names, ...]
    confidence: float
    unexplained: bool
    summary: str
    places: tuple[StatedPlace, ...]
    separating_test: Path | None
    fit: Mapping[str, float | None]
    tire: Path | None
    corrected_fmu: Path | None
    report: Path | None
    probabilities: Mapping[str, float]
    remainder: float | None
    same: float = 0.0


def read_stated(folder: Path) -> Stated:
    """Return what `folder`/diagnosis.json states; raises DiagnosisFileError where it cannot be read."""
    path = folder / "diagnosis.json"
    try:
        content = json.loads(path.read_text(encoding="utf-8"))
        return _stated(content, folder)
    except OSError as error:
        raise DiagnosisFileError(f"{path}: {error.strerror or error}; diagnose again") from None
    except (KeyError, TypeError, ValueError, AttributeError, OverflowError, RecursionError) as error:
        raise DiagnosisFileError(f"{path} is no diagnosis ({what_is_wrong(error)}); diagnose again") from None


def read_corrected(path: Path, *, with_remainder: bool = False) -> TireModel | Correction:
    """Return what a diagnosis.json says to build: the corrected tire, or the correction of a simulation of others.

    path: the file, or its folder; with_remainder: with the learned remainder that repeats best
    Raises DiagnosisFileError where it cannot be read, or has no remainder that can be packed.
    """
    path = path / "diagnosis.json" if path.is_dir() else path
    try:
        content = json.loads(path.read_text(encoding="utf-8"))
        if content["schema"] not in SCHEMAS:
            raise ValueError(f"schema {content['schema']!r} is none of {', '.join(map(str, SCHEMAS))}")
        learned = _learned(path, content) if with_remainder else None
        if "correction" in content:
            entry = content["correction"]
            return Correction(
                from_text(json.dumps(entry["believed"])),
                replace(from_text(json.dumps(entry["corrected"])), remainder=learned),
                float(entry["surface_radius"]),
                bool(entry["moves"]),
            )
        if "corrected_tire" in content:
            tire = from_text(json.dumps(content["corrected_tire"]))
        else:  # written before the file held the tire
            tire = read_tire(path.parent / str(content["tire"]))
        return replace(tire, remainder=learned)
    except DiagnosisFileError:
        raise
    except OSError as error:
        raise DiagnosisFileError(f"{path}: {error.strerror or error}; diagnose again") from None
    except TireFileError as error:
        raise DiagnosisFileError(f"{path}: the corrected tire cannot be read: {error}") from None
    except (KeyError, TypeError, ValueError, AttributeError, OverflowError, RecursionError) as error:
        raise DiagnosisFileError(f"{path} is no diagnosis ({what_is_wrong(error)}); diagnose again") from None


def _repeats(r2: float | None) -> str:
    return "visited once" if r2 is None else f"repeats {r2:.2f}"


def _learned(path: Path, content: Mapping[str, Any]) -> LearnedRemainder:
    """Return the learned remainder that repeats best."""
    found = content["verdict"].get("corrections", [])
    if not found:
        raise DiagnosisFileError(
            f"{path}: nothing is unexplained, so no remainder was learned; leave out --with-remainder"
        )
    packed = [c for c in found if c["by"] in COORDINATES and (c["repeats"] or 0.0) > 0.0]
    if not packed:
        which = ", ".join(f"over the {c['by']}, {_repeats(c['repeats'])}" for c in found)
        raise DiagnosisFileError(
            f"{path}: the remainder ({which}) does not repeat, or depends on the time alone, so it holds for these "
            "recordings only; leave out --with-remainder"
        )
    # Of two that repeat alike, as over the deflection and over the law's force, the first one depends on it more.
    best = max(packed, key=lambda c: round(float(c["repeats"]), 2))
    if "at" not in best:
        raise DiagnosisFileError(
            f"{path}: was written before the remainder's curve was in it; diagnose again"
        )
    law: Any = from_text(json.dumps(content["baseline_tire"])).law if best["by"] == "force" else None
    return LearnedRemainder(best["by"], tuple(best["at"]), tuple(best["force"]), law)


def _stated(content: Mapping[str, Any], folder: Path) -> Stated:
    if content["schema"] not in SCHEMAS:
        raise ValueError(f"schema {content['schema']!r} is none of {', '.join(map(str, SCHEMAS))}")
    verdict = content["verdict"]
    confidence = float(verdict["confidence"])
    if not 0.0 <= confidence <= 1.0:
        raise ValueError(f"confidence {confidence!r} does not lie between 0 and 1")
    unexplained = bool(verdict["unexplained"])
    names = {str(effect["name"]) for effect in verdict["effects"]} | ({UNKNOWN} if unexplained else set())
    return Stated(
        names=frozenset(names) or NOTHING,
        alternatives=tuple(frozenset(map(str, names)) or NOTHING for names in verdict["alternatives"]),
        confidence=confidence,
        unexplained=unexplained,
        summary=str(verdict["summary"]),
        places=tuple(_place(place) for place in content["where"]),
        separating_test=_test_file(verdict.get("separating_test"), folder),
        fit={str(name): None if value is None else float(value) for name, value in content["fit"].items()},
        tire=_file(content.get("tire"), folder),
        corrected_fmu=_file(content.get("corrected_fmu"), folder),
        report=_file(content.get("report"), folder),
        probabilities={
            str(effect["name"]): _probability(effect.get("probability", confidence))
            for effect in verdict["effects"]
        },
        remainder=_remainder(verdict.get("remainder")),
        same=stated_of_same(verdict),
    )


def stated_of_same(verdict: Mapping[str, Any]) -> float:
    """Return the probability of all alternatives of a `verdict` of diagnosis.json that leave the same as it."""
    return sum(
        _probability(d["probability"]) for d in verdict.get("alternative_details", []) if d.get("same")
    )


def _probability(value: object) -> float:
    if not isinstance(value, (int, float)) or not 0.0 <= value <= 1.0:
        raise ValueError(f"probability {value!r} does not lie between 0 and 1")
    return float(value)


def _remainder(content: object) -> float | None:
    size = content.get("size") if isinstance(content, Mapping) else None
    return None if size is None else float(size)


def _place(place: Mapping[str, Any]) -> StatedPlace:
    recording = place.get("recording")
    return StatedPlace(
        by=str(place["by"]),
        begin=_end(place["from"]),
        end=_end(place["to"]),
        unit=str(place["unit"]),
        share=float(place["share"]),
        recording=None if recording is None else str(recording),
        label=str(place.get("label", "")),
    )


def _end(value: object) -> float | str | None:
    if isinstance(value, bool) or not isinstance(value, (int, float, str)):
        if value is None:
            return None
        raise ValueError(f"{value!r} is no end of a span")
    try:
        number = float(value)
    except ValueError:
        return str(value)
    return number if math.isfinite(number) else None


def _file(name: object, folder: Path) -> Path | None:
    return folder / str(name) if name else None


def _test_file(test: object, folder: Path) -> Path | None:
    """The file of the separating test: its entry that names a CSV file."""
    if not isinstance(test, Mapping):
        return None
    for value in test.values():
        if isinstance(value, str) and value.endswith(".csv") and "\n" not in value:
            return folder / value
    return None
