"""What is found beside a law of the same recordings: python tests/benchmarks/bench_identified.py PROOF [--jobs N]

PROOF is the folder of `tirelab prove --out PROOF`, whose diagnoses have a believed tire that knows nothing of what is
hidden. An engineer often has none, identifies the law from the recordings (`tirelab identify`) and diagnoses the same
ones: the law lies amid what the effects do. Each trial that hides known effects alone is diagnosed so. Printed are the
trials whose verdict is another one, whether or not the law is refitted, and how many hold exactly the hidden effects.
"""

from __future__ import annotations

from functools import partial
from multiprocessing import get_context
from pathlib import Path

from proofs import asked_for
from tirelab import identify
from tirelab.diagnosis.diagnose import diagnose
from tirelab.names import REFITTED_LAW, UNKNOWN
from tirelab.recordings.recording import read_recording
from tirelab.validation.folders import Folders, read_json
from tirelab.validation.score import NOTHING, Names, Score

SURE = 0.9


def physics(names: Names) -> Names:
    """Return the effects of a set: a law that was identified amid them may have to be refitted."""
    return names - {REFITTED_LAW, UNKNOWN} - NOTHING


def beside_own_law(root: Path, key: str) -> tuple[Score, Names, float] | None:
    """Return the score of a trial, and the effects and the confidence of the verdict beside the law of its own
    recordings; None where what it hides is not known effects alone.
    """
    folders = Folders(root)
    score = Score.from_json(read_json(folders.score(key)))
    if score.verdict is None or score.beyond_catalogue or not all(map(physics, score.right)):
        return None
    recordings = [read_recording(path) for path in folders.recordings(key, "train")]
    found = diagnose(recordings, identify(recordings).tire)
    return score, frozenset(found.names), found.confidence


def main() -> None:
    """Diagnose the trials of a proof beside the laws of their own recordings."""
    proof, jobs, keys = asked_for(__doc__ or "")
    believed, by_own, sure = [], [], []
    with get_context("spawn").Pool(jobs) as pool:
        for result in pool.imap(partial(beside_own_law, proof), keys):
            if result is None:
                continue
            score, names, confidence = result
            right, before = {physics(each) for each in score.right}, physics(score.verdict or frozenset())
            believed.append(before in right)
            by_own.append(physics(names) in right)
            if confidence >= SURE:
                sure.append(by_own[-1])
            if physics(names) != before:
                pair = (
                    f"{', '.join(sorted(each)) or 'nothing'} ({'right' if each in right else 'wrong'})"
                    for each in (before, physics(names))
                )
                print(f"{score.trial} {score.kind}: {' -> '.join(pair)}, {confidence:.2f}", flush=True)
    print(
        f"exactly the hidden effects: {sum(believed)} of {len(believed)} beside the believed tire, {sum(by_own)} "
        f"beside the law of the same recordings; {sum(sure)} of the {len(sure)} of these stated at {SURE:.0%} and more"
    )


if __name__ == "__main__":
    main()
