"""Recompute the confidences of a proof with the present weights, to judge a calibration on trials that it did not use.

Run: python -m tirelab.validation.restate DIR

DIR is the folder of a finished `tirelab prove`. The verdicts stay as they were. From the grounds of each in its
diagnosis.json, `diagnosis.confidence` recomputes the probability, limited by the probabilities of its effects as they
were stated then. It prints the Brier skill and how often verdicts of each class held (`wide_kinds.holds`).
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any

import click

from ..diagnosis.confidence import confidence_of
from .calibration import confidence_pairs, reliability, skill
from .folders import Folders, read_json
from .score import Score


def restated(verdict: Mapping[str, Any]) -> float:
    """Return the confidence of a `verdict` of diagnosis.json by the present weights."""
    named, doubted = ([e["probability"] for e in verdict[own]] for own in ("effects", "doubted"))
    return confidence_of(verdict["grounds"], named, doubted)


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
@click.argument("folder", metavar="DIR", type=click.Path(file_okay=False, path_type=Path))
def main(folder: Path) -> None:
    """Recompute the confidences of the proof in DIR with the present weights."""
    scores = restated_scores(Folders(folder))
    if not scores:
        raise click.ClickException(f"{folder} holds no scores; finish `tirelab prove` there first")
    found = skill(confidence_pairs(scores))
    low, high = found.interval
    click.echo(f"Brier skill of the confidence: {found.value:.2f} ({low:.2f} to {high:.2f})")
    for point in reliability(scores):
        click.echo(f"stated {point.at:.3f}: {point.rate.hits} of {point.rate.trials} held")


if __name__ == "__main__":
    main()
