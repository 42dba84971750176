"""Replacements of the diagnosis, and verdicts written by hand."""

from __future__ import annotations

import json
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

import pytest
from tirelab.validation.score import Score


def write_diagnosis(out: Path, names: Sequence[str], **more: Any) -> None:
    """Write a diagnosis.json that names a set ("none", "unknown" and effects) as the contract has it."""
    effects = [name for name in names if name not in ("none", "unknown")]
    stated = more.get("probabilities", {})
    content = {
        "schema": 2 if stated else 1,
        "verdict": {
            "effects": [
                {"name": name, "parameters": {}, "share": 0.5}
                | ({"probability": stated[name]} if name in stated else {})
                for name in effects
            ],
            "confidence": more.get("confidence", 0.9),
            "alternatives": more.get("alternatives", []),
            "unexplained": "unknown" in names,
            "summary": "A stand-in says so.",
            **({"remainder": {"share": 0.02, "size": more["remainder"]}} if "remainder" in more else {}),
            "separating_test": more.get("separating_test"),
        },
        "where": more.get("where", []),
        "fit": {"noise": 1.0, "before": 2.0, "after": 1.0, "held_out_before": None, "held_out_after": None},
        "tire": more.get("tire"),
        "corrected_fmu": None,
        "report": more.get("report"),
    }
    out.mkdir(parents=True, exist_ok=True)
    (out / "diagnosis.json").write_text(json.dumps(content), encoding="utf-8")


@pytest.fixture(scope="session")
def diagnosis() -> Callable[..., None]:
    """Writes a diagnosis.json: folder, names, and what else it says."""
    return write_diagnosis


class Oracle:
    """Reads the answer, as no diagnosis can, and names the true set; keeps the names of the recordings it got."""

    def __init__(self) -> None:
        self.recordings: list[list[str]] = []

    def __call__(self, recordings: Sequence[Path], tire: Path | None, out: Path) -> None:
        """Diagnose."""
        self.recordings.append([path.name for path in recordings])
        answer = json.loads((out.parents[1] / "sealed" / f"{out.name}.json").read_text())
        write_diagnosis(out, answer["right"][0])


@pytest.fixture(scope="session", name="Oracle")
def oracle_type() -> type[Oracle]:
    """The class of a diagnosis that always names the truth."""
    return Oracle


@pytest.fixture
def oracle() -> Oracle:
    """A diagnosis that always names the truth."""
    return Oracle()


@pytest.fixture(scope="session")
def score() -> Callable[..., Score]:
    """Makes a score: kind, the true set, the verdict; other right sets and the rest by name."""

    def make(kind: str, true: str, named: str | None, **more: Any) -> Score:
        return Score(
            trial=more.get("trial", "0000"),
            kind=kind,
            right=(frozenset(true.split()), *(frozenset(s.split()) for s in more.get("also_right", ()))),
            verdict=None if named is None else frozenset(named.split()),
            alternatives=tuple(frozenset(s.split()) for s in more.get("alternatives", ())),
            confidence=None if named is None else more.get("confidence", 0.9),
            error=None if named is not None else "it failed",
            sizes=more.get("sizes", {}),
            regions=more.get("regions", ()),
            held_out=more.get("held_out"),
            discrimination=more.get("discrimination"),
            seconds=1.0,
            derived=tuple(frozenset(s.split()) for s in more.get("derived", ())),
            probabilities=more.get("probabilities", {}),
            remainder=more.get("remainder"),
            fitted=more.get("fitted"),
            same=more.get("same", 0.0),
        )

    return make
