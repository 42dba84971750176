"""What held-out recordings change of verdicts: python tests/benchmarks/bench_held_out.py PROOF [--jobs N]

PROOF is the folder of `tirelab prove --out PROOF`, whose diagnoses are given no held-out recordings. Each of its trials
is diagnosed anew with the held-out recordings of the rig, as by `tirelab diagnose --held-out`. Printed are the trials
whose verdict changes, and of both runs how many verdicts hold, how many of those stated at 95 % and more, and the skill
of the confidence.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from functools import partial
from multiprocessing import get_context
from pathlib import Path

from proofs import asked_for
from radialtire import read_tire
from tirelab.diagnosis.diagnose import diagnose
from tirelab.names import UNKNOWN
from tirelab.recordings.recording import read_recording
from tirelab.validation.calibration import confidence_pairs, skill
from tirelab.validation.folders import Folders, read_json
from tirelab.validation.score import NOTHING, Score
from tirelab.validation.wide_kinds import holds

SURE = 0.95


def given(root: Path, key: str) -> tuple[Score, Score]:
    """Return the score of a trial as it is, and that of its verdict with held-out recordings."""
    folders = Folders(root)
    score = Score.from_json(read_json(folders.score(key)))
    fitted, kept = (
        [read_recording(p) for p in folders.recordings(key, group)] for group in ("train", "heldout")
    )
    found = diagnose(fitted, read_tire(folders.tire(key)), held_out=kept)
    names = frozenset(found.names) | (frozenset({UNKNOWN}) if found.unexplained else frozenset())
    same = sum(a.probability for a in found.alternatives if a.same)
    probabilities = {e.name: e.probability for e in found.effects}
    verdict = {"verdict": names or NOTHING, "confidence": found.confidence, "same": same}
    return score, replace(score, **verdict, probabilities=probabilities)


def told(scores: Sequence[Score]) -> str:
    """Return what became of the verdicts in words."""
    pairs = [pair for own in confidence_pairs(scores) for pair in own]
    sure = [hit for probability, hit in pairs if probability >= SURE]
    return (
        f"{sum(hit for _, hit in pairs)} of {len(pairs)} hold, {sum(sure)} of {len(sure)} stated at 95 % and more; "
        f"skill of the confidence {skill(confidence_pairs(scores)).value:.2f}"
    )


def main() -> None:
    """Diagnose all trials of a proof with their held-out recordings."""
    proof, jobs, keys = asked_for(__doc__ or "")
    scores: list[tuple[Score, Score]] = []
    with get_context("spawn").Pool(jobs) as pool:
        for key, (before, after) in zip(keys, pool.imap(partial(given, proof), keys), strict=True):
            scores.append((before, after))
            if before.verdict != after.verdict:
                stated = ((s, "holds" if holds(s) else "does not") for s in (before, after))
                each = [
                    f"{', '.join(sorted(s.verdict or ()))}: {s.confidence:.2f}, {what}" for s, what in stated
                ]
                print(f"{key} {before.kind}: {each[0]} -> {each[1]}", flush=True)
    before, after = (told(side) for side in zip(*scores, strict=True))
    print(f"without held-out recordings: {before}\nwith them: {after}")


if __name__ == "__main__":
    main()
