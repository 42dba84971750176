"""The diagnosis engine on many cases, scored: python tests/benchmarks/bench_engine.py CASES [--only TEXT] [--out FILE]

CASES is a folder with one folder for each case: train_*.csv, heldout_*.csv, tire.json (the baseline; without it the
article's), and key.json ({"right": [[names], ...], "noise": N}), which is read after the diagnosis for the score alone.
`noise` is what the best tire leaves of the training recordings [N]. The lines of one run are kept in FILE as JSON.
"""

from __future__ import annotations

import argparse
import json
import sys
import time
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from radialtire import TireModel, read_tire
from tirelab.estimation.diagnosis import Diagnosis, diagnose
from tirelab.recordings.recording import Recording, read_recording

NOBODY = {"none", "unknown"}


@dataclass(frozen=True)
class Case:
    """One case of a folder."""

    name: str
    recordings: list[Recording]
    held_out: list[Recording]
    tire: TireModel
    key: dict[str, Any]


def cases(root: Path, only: str) -> Iterator[Case]:
    """Yield the cases whose names hold a text."""
    for folder in sorted(p for p in root.iterdir() if p.is_dir() and (p / "key.json").exists()):
        if only in folder.name:
            tire = folder / "tire.json"
            yield Case(
                folder.name,
                [read_recording(p) for p in sorted(folder.glob("train_*.csv"))],
                [read_recording(p) for p in sorted(folder.glob("heldout_*.csv"))],
                read_tire(tire) if tire.exists() else TireModel(),
                json.loads((folder / "key.json").read_text()),
            )


def score(case: Case, found: Diagnosis, seconds: float) -> dict[str, Any]:
    """Return the line of a case."""
    said = {e.name for e in found.effects}
    right = [set(names) - NOBODY for names in case.key["right"]]
    unknown = any("unknown" in names for names in case.key["right"])
    listed = [said, *(set(a.names) for a in found.alternatives if a.probability > 0.01 or a.instead)]
    noise = float(case.key.get("noise") or found.figures.floor)
    f = found.figures
    return {
        "case": case.name,
        "said": sorted(said),
        "right": sorted(right[0]) + (["unknown"] if unknown else []),
        "exact": said in right,
        "all_named": any(r <= said for r in right),
        "listed": any(r in listed for r in right),
        "extra": sorted(said - right[0]),
        "extra_sure": sorted(e.name for e in found.effects if e.name not in right[0] and e.probability > 0.5),
        "missing": sorted(right[0] - said),
        "confidence": found.confidence,
        "inclusion": {n: round(p, 3) for n, p in found.inclusion.items() if p > 0.02},
        "shares": {e.name: round(e.share, 4) for e in found.effects},
        "remainder": found.remainder.size,
        "remainder_share": found.remainder.share,
        "depends": [d.coordinate for d in found.remainder.depends],
        "left": f.after / noise,
        "before": f.before / noise,
        "held_before": f.held_out_before / noise,
        "held_after": f.held_out_after / noise,
        "floor": f.floor / noise,
        "unknown": unknown,
        "unexplained": found.remainder.unexplained,
        "strict": (said | ({"unknown"} if found.remainder.unexplained else set()))
        in [set(n) - {"none"} for n in case.key["right"]],
        "kind": case.key.get("kind", ""),
        "quarter": f.held_out_after <= 0.25 * f.held_out_before + noise,
        "fits": len(found.ranking.fits),
        "alternatives": [
            [list(a.names), round(a.probability, 3), round(a.left, 3)] for a in found.alternatives[:4]
        ],
        "seconds": seconds,
    }


def told(line: dict[str, Any]) -> str:
    """Return a case in one row."""
    mark = "OK " if line["exact"] else ("in " if line["all_named"] else ("alt" if line["listed"] else "-- "))
    return (
        f"{mark} {line['case']:28.28s} {'+'.join(line['said']) or 'none':60.60s} p={line['confidence']:.2f} "
        f"left {line['left']:6.2f} of {line['before']:6.1f} held {line['held_after']:6.2f} "
        f"of {line['held_before']:6.1f} "
        f"rem {line['remainder']:6.2f} {100 * line['remainder_share']:5.1f}% floor {line['floor']:.2f} "
        f"{line['fits']:3d} fits {line['seconds']:5.1f} s"
        + ("" if line["exact"] else f"   truth {'+'.join(line['right'])}")
    )


def main() -> int:
    """Diagnose and score."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("root", type=Path)
    parser.add_argument("--only", default="")
    parser.add_argument("--out", type=Path)
    given = parser.parse_args()
    lines = []
    for case in cases(given.root, given.only):
        began = time.process_time()
        try:
            found = diagnose(case.recordings, case.tire, held_out=case.held_out)
        except Exception as error:
            print(f"ERR {case.name}: {type(error).__name__} {error}", flush=True)
            continue
        lines.append(score(case, found, time.process_time() - began))
        print(told(lines[-1]), flush=True)
        if given.out:
            given.out.write_text(json.dumps(lines, indent=1) + "\n")
    n = max(len(lines), 1)
    keys = ("exact", "strict", "all_named", "listed")
    exact, strict, named, listed = (sum(bool(x[k]) for x in lines) for k in keys)
    sure = sum(bool(x["extra_sure"]) for x in lines)
    brier = sum((float(x["confidence"]) - bool(x["exact"])) ** 2 for x in lines) / n
    rate = exact / n
    seconds = sorted(float(x["seconds"]) for x in lines) or [0.0]
    middle, most = seconds[len(seconds) // 2], seconds[-1]
    print(f"{len(lines)} cases: exact {exact} (with unknown {strict}), all named {named}", end=", ")
    print(f"verdict or listed {listed}, extra above half {sure}", end="; ")
    print(f"Brier {brier:.3f} against {rate * (1 - rate):.3f}; seconds median {middle:.1f}, most {most:.1f}")
    return 0


if __name__ == "__main__":
    sys.exit(main())
