"""Recompute the confidences of proofs with the present weights, to judge a calibration on trials that it did not use.

Run: python -m tirelab.validation.restate DIR...

Each DIR is the folder of a finished `tirelab prove`; the trials of all of them are taken together. The verdicts stay as
they were. From their grounds and those of their effects in each diagnosis.json, `diagnosis.confidence` recomputes the
probabilities; an effect without grounds, as older versions wrote those that they left out, keeps its own. It prints the
Brier skill and how often verdicts of each class held (`wide_kinds.holds`).
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

import click

from ..diagnosis.confidence import confidence_of, probability_of_effect
from ..diagnosis.diagnosis_file import stated_of_same
from .calibration import confidence_pairs, reliability, skill
from .folders import Folders, read_json
from .score import Score

FOLDER = click.Path(file_okay=False, path_type=Path)
"""Type of an argument that names a proof."""


def restated(verdict: Mapping[str, Any]) -> float:
    """Return the confidence of a `verdict` of diagnosis.json by the present weights."""
    named, doubted = ([_of_effect(e) for e in verdict[own]] for own in ("effects", "doubted"))
    same = stated_of_same(verdict)
    share = verdict["confidence"] / (verdict["confidence"] + same) if same else 1.0
    return confidence_of(verdict["grounds"], named, doubted, share)


def _of_effect(effect: Mapping[str, Any]) -> float:
    if "grounds" in effect:
        return probability_of_effect(effect["name"], effect["grounds"])
    return float(effect["probability"])


def restated_scores(folders: Folders) -> list[Score]:
    """Return the scores of a proof with the confidences by the present weights."""
    found = []
    for path in sorted((folders.root / "scores").glob("*.json")):
        score = Score.from_json(read_json(path))
        if score.verdict is not None:
            verdict = read_json(folders.verdict(path.stem) / "diagnosis.json")["verdict"]
            score = replace(score, confidence=restated(verdict))
        found.append(score)
    return found


@click.command()
@click.argument("folders", metavar="DIR...", nargs=-1, required=True, type=FOLDER)
def main(folders: Sequence[Path]) -> None:
    """Recompute the confidences of the proofs in the folders DIR with the present weights."""
    scores: list[Score] = []
    for folder in folders:
        own = restated_scores(Folders(folder))
        if not own:
            raise click.ClickException(f"{folder} holds no scores; finish `tirelab prove` there first")
        scores += own
    found = skill(confidence_pairs(scores))
    low, high = found.interval
    click.echo(
        f"Brier skill of the confidence: {found.value:.2f} ({low:.2f} to {high:.2f}), {len(scores)} trials"
    )
    for point in reliability(scores):
        click.echo(f"stated {point.at:.3f}: {point.rate.hits} of {point.rate.trials} held")


if __name__ == "__main__":
    main()
