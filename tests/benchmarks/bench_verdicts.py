"""What every verdict is and costs, kept, and compared byte for byte with what was kept before.

    python tests/benchmarks/bench_verdicts.py DIR [--as KEPT] [--program TIRELAB] [--trials 40] [--seed 1] [--only TEXT]

DIR gets one folder for each case, with all that `tirelab diagnose` writes, and `times.json`: wall and CPU seconds of
the whole command. The cases are the shared concealed folders (with their held-out file), the press sets (each with the
tire that `tirelab identify` makes of it), and blind trials of one seed: the rig draws them into DIR, with --as those of
KEPT are read. With --as every diagnosis.json is compared with that of KEPT, and the CPU times too: "same" means the
same bytes, "same but for sentences" that only sentences and labels for a reader differ. The exit status is 1 where
more differs.
"""

from __future__ import annotations

import argparse
import json
import os
import resource
import shutil
import statistics
import subprocess
import sys
import time
from collections.abc import Iterator
from pathlib import Path
from typing import Any

SHARED = Path(os.environ.get("TIRELAB_SHARED", Path(__file__).resolve().parents[2].parent / "shared"))

PRESS = {
    "press_flat_slow": ["flat_slow"],
    "press_one_cycle_a": ["one_cycle_a"],
    "press_three_cycles": ["three_cycles"],
    "press_all": ["flat_slow", "flat_fast", "R127", "R25", "concave"],
}


def cases(program: Path, out: Path, trials: Path) -> Iterator[tuple[str, list[str]]]:
    """Yield the name of each case and the arguments of its diagnosis."""
    concealed = SHARED / "recordings" / "concealed"
    for key in sorted((concealed / "keys").glob("*.json")):
        folder = concealed / key.stem
        train = [str(p) for p in sorted(folder.glob("train_*.csv"))]
        kept = [word for p in sorted(folder.glob("heldout_*.csv")) for word in ("--held-out", str(p))]
        yield key.stem, [*train, *kept]
    for name, stems in PRESS.items():
        files = [str(SHARED / "recordings" / "press" / f"{stem}.csv") for stem in stems]
        tire = out / f"{name}.tire.json"
        if not tire.exists():
            run([str(program), "identify", *files, "--out", str(tire)])
        yield name, [*files, "--tire", str(tire)]
    for folder in sorted(trials.glob("trials/*")):
        files = sorted(folder.glob("train_*.csv"), key=lambda p: int(p.stem.rpartition("_")[2]))
        yield (
            f"trial_{folder.name}",
            [*map(str, files), "--tire", str(trials / "tires" / f"{folder.name}.json")],
        )


def without_sentences(content: dict[str, Any]) -> dict[str, Any]:
    """Return a diagnosis without what is written for a reader: summary, sentence of the test, labels of places."""
    verdict = {k: v for k, v in content["verdict"].items() if k != "summary"}
    if verdict["separating_test"] is not None:
        verdict["separating_test"] = {k: v for k, v in verdict["separating_test"].items() if k != "sentence"}
    where = [{k: v for k, v in place.items() if k != "label"} for place in content["where"]]
    return {**content, "verdict": verdict, "where": where}


def compared(before: bytes, after: bytes) -> str:
    """Return "same", "same but for sentences" or "DIFFERS" for the contents of two diagnosis.json."""
    if before == after:
        return "same"
    old, new = (json.dumps(without_sentences(json.loads(content))) for content in (before, after))
    return "same but for sentences" if old == new else "DIFFERS"


def run(words: list[str]) -> tuple[float, float]:
    """Run a command and return its wall and CPU seconds; its error is this program's."""
    before, began = resource.getrusage(resource.RUSAGE_CHILDREN), time.perf_counter()
    done = subprocess.run(words, capture_output=True, text=True)
    wall, after = time.perf_counter() - began, resource.getrusage(resource.RUSAGE_CHILDREN)
    if done.returncode:
        sys.exit(f"{' '.join(words)} ended with {done.returncode}: {done.stderr[-500:]}")
    return wall, after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime


def draw(program: Path, out: Path, seed: int, trials: int) -> None:
    """Write trials and their baseline tires as the blind trials do; the answers are removed."""
    code = (
        "import sys; from pathlib import Path; from tirelab.validation.folders import Folders;"
        "from tirelab.validation.commitment import draw_and_commit;"
        "[draw_and_commit(Folders(Path(sys.argv[1])), int(sys.argv[2]), n, None) for n in range(int(sys.argv[3]))]"
    )
    run([str(program.with_name("python")), "-c", code, str(out), str(seed), str(trials)])
    shutil.rmtree(out / "sealed")


def main() -> int:
    """Diagnose every case, keep and compare."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("out", type=Path)
    parser.add_argument("--as", dest="kept", type=Path)
    parser.add_argument("--program", type=Path, default=Path(sys.executable).with_name("tirelab"))
    parser.add_argument("--trials", type=int, default=40)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--only", default="", help="cases with this text in their names alone")
    given = parser.parse_args()
    if next(given.out.glob("*/train_*.csv"), None) is not None:
        parser.error(f"{given.out} holds recordings; give a folder of its own for what is written")
    given.out.mkdir(parents=True, exist_ok=True)
    if given.kept is None and not (given.out / "trials").exists():
        draw(given.program, given.out, given.seed, given.trials)
    times_file = given.out / "times.json"
    times: dict[str, list[float]] = json.loads(times_file.read_text()) if times_file.exists() else {}
    differ = []
    for name, arguments in cases(given.program, given.out, given.kept or given.out):
        if given.only not in name:
            continue
        if name not in times:
            times[name] = list(
                run([str(given.program), "diagnose", *arguments, "--out", str(given.out / name), "--quiet"])
            )
            times_file.write_text(json.dumps(times, indent=1) + "\n")
        same = ""
        if given.kept is not None:
            before, after = ((d / name / "diagnosis.json").read_bytes() for d in (given.kept, given.out))
            same = compared(before, after)
            if same == "DIFFERS":
                differ.append(name)
        print(f"{name:28s} {times[name][0]:7.1f} s wall {times[name][1]:7.1f} s CPU {same}", flush=True)
    if given.kept is not None:
        old = json.loads((given.kept / "times.json").read_text())
        ratios = [times[name][1] / old[name][1] for name in times if name in old]
        print(f"CPU, this over kept: median {statistics.median(ratios):.2f}, most {max(ratios):.2f}")
        print(f"{len(differ)} of {len(times)} diagnoses differ: {', '.join(differ) or 'none'}")
    return 1 if differ else 0


if __name__ == "__main__":
    sys.exit(main())
