"""The engine on cases of which the truth is exact: python tests/benchmarks/bench_cases.py [NAME...] [--seed 11]

NAME: a case, or a part of the names of several; without one, all cases of `made_cases`. One line for each: what is
true, what is named with the probability of each effect, the error that the corrected tire leaves over the noise [N],
and the CPU seconds. It is "right" where exactly a true set is named and no recording is said to contradict, or where
the one that does is said to; "open" where a true set is an alternative of the verdict; else "no".
"""

from __future__ import annotations

import argparse
import sys
import time

from made_cases import CASES, Case
from tirelab.diagnosis.diagnose import diagnose
from tirelab.diagnosis.verdict import Verdict
from tirelab.names import UNKNOWN

RIGHT, OPEN, NO = "right", "open", "no"


def marked(case: Case, found: Verdict) -> str:
    """Return whether a verdict is the truth of its case."""
    odd = () if found.contradiction is None else found.contradiction.names
    if case.odd:
        return RIGHT if case.odd in odd else NO
    if frozenset(found.names) in case.truth and not odd:
        return RIGHT
    others = {frozenset(other.names) for other in found.alternatives}
    return OPEN if others & set(case.truth) and not odd else NO


def named(found: Verdict) -> str:
    """Return what a verdict says, each effect with its probability."""
    words = [f"{effect.name} {effect.probability:.2f}" for effect in found.effects]
    said = " + ".join([*words, *([UNKNOWN] if found.unexplained else [])]) or "nothing"
    odd = found.contradiction
    return f"{said} ({found.confidence:.2f} sure)" + (
        f"; {' and '.join(odd.names)} contradict" if odd else ""
    )


def main() -> int:
    """Diagnose each."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("names", nargs="*", metavar="NAME")
    parser.add_argument("--seed", type=int, default=11)
    given = parser.parse_args()
    asked = [case for case in CASES.values() if not given.names or any(n in case.name for n in given.names)]
    if not asked:
        parser.error(f"no case has {' or '.join(given.names)} in its name; there are {', '.join(CASES)}")
    width = max(len(case.name) for case in asked)
    marks, spent = [], 0.0
    for case in asked:
        drawn = case.draw(given.seed)
        began = time.process_time()
        found = diagnose(drawn.recordings, drawn.tire)
        seconds = time.process_time() - began
        mark = marked(case, found)
        print(
            f"{case.name:{width}s} | {mark:5s} | true: {case} | named: {named(found)} | "
            f"left {found.fit.left:.3g} / noise {found.fit.noise:.3g} N | {seconds:.1f} s",
            flush=True,
        )
        marks.append(mark)
        spent += seconds
    print(
        f"{marks.count(RIGHT)} of {len(marks)} right, {marks.count(OPEN)} more with a true set among the alternatives; "
        f"seed {given.seed}, {spent:.0f} s of CPU"
    )
    return 0


if __name__ == "__main__":
    sys.exit(main())
