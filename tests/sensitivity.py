"""What happens to verdicts when a number of constants.md is halved or doubled.

Run: python tests/sensitivity.py --seed S --trials N --each M [--only NAME ...] --out sensitivity.json

N blind trials of all kinds are drawn and diagnosed as the numbers stand. Then each number that is set by hand is halved
and doubled, one at a time, and M of the trials are diagnosed again: which ones goes round, so that all numbers together
are tried on all trials. The bounds of the effort are halved and doubled all together, on all trials. Counted are the
verdicts that name another set of effects. Counts of whole things are rounded and at least one. Of a number between a
half and two that is compared with a ratio (0.9, 1.01), the distance from one is halved and doubled: twice 0.9 is no
share. The number is changed in the module's source as it is imported, in a process of its own, so whatever is made of
it follows. What a trial was is not asked for: this is about how firm a verdict stands, not how right it is.

A run that was stopped goes on where FILE ends, if it was asked for the same.
"""

from __future__ import annotations

import ast
import json
import subprocess
import sys
import tempfile
from collections.abc import Iterator, Sequence
from concurrent.futures import ThreadPoolExecutor
from importlib.abc import MetaPathFinder
from importlib.machinery import ModuleSpec, PathFinder, SourceFileLoader
from pathlib import Path
from types import CodeType, ModuleType
from typing import Any

import click
from constant_kinds import BOUNDS
from constants import TOGETHER, constants

FACTORS = (0.5, 2.0)
SCALED = "_scaled_by_the_sensitivity"


class Changed(SourceFileLoader):
    """Loads a module with some of its numbers multiplied."""

    def __init__(self, fullname: str, path: str, names: Sequence[str], factor: float) -> None:
        super().__init__(fullname, path)
        self._names, self._factor = names, factor

    def get_code(self, fullname: str) -> CodeType:
        """Return the changed module."""
        path = self.get_filename(fullname)
        tree = ast.parse(self.get_data(path))
        for name in self._names:
            tree = changed(tree, name, self._factor)
        return compile(tree, path, "exec")

    def exec_module(self, module: ModuleType) -> None:
        """Run the changed module."""
        module.__dict__[SCALED] = scaled
        super().exec_module(module)


class Changing(MetaPathFinder):
    """Finds the modules of some numbers ("room/module.NAME"), to load them changed."""

    def __init__(self, places: Sequence[str], factor: float) -> None:
        self._factor = factor
        self._names: dict[str, list[str]] = {}
        for place in places:
            module, name = place.rsplit(".", 1)
            self._names.setdefault(f"tirelab.{module.replace('/', '.')}", []).append(name)

    def find_spec(
        self, fullname: str, path: Sequence[str] | None, target: ModuleType | None = None
    ) -> ModuleSpec | None:
        """Return the module's place with the loader that changes it."""
        if fullname not in self._names:
            return None
        spec = PathFinder.find_spec(fullname, path, target)
        assert spec is not None
        assert spec.origin is not None
        spec.loader = Changed(fullname, spec.origin, self._names[fullname], self._factor)
        return spec


def changed(tree: ast.Module, name: str, factor: float) -> ast.Module:
    """Return a module in which the value of `name` is multiplied."""
    found = 0
    for statement in tree.body:
        if not isinstance(statement, ast.Assign):
            continue
        target, value = statement.targets[0], statement.value
        if isinstance(target, ast.Tuple) and isinstance(value, ast.Tuple):
            for i, one in enumerate(target.elts):
                if isinstance(one, ast.Name) and one.id == name:
                    value.elts[i] = _call(value.elts[i], factor)
                    found += 1
        elif isinstance(target, ast.Name) and target.id == name:
            statement.value = _call(value, factor)
            found += 1
    if found != 1:
        raise ValueError(f"{found} numbers are named {name}")
    return ast.fix_missing_locations(tree)


def _call(value: ast.expr, factor: float) -> ast.expr:
    return ast.Call(ast.Name(SCALED, ast.Load()), [value, ast.Constant(factor)], [])


def scaled(value: Any, factor: float) -> Any:
    """Return a number, or each of several, times a factor: whole ones rounded and at least one, the distance from one
    of those near it."""
    if isinstance(value, tuple):
        return tuple(scaled(v, factor) for v in value)
    if isinstance(value, int):
        return max(1, round(value * factor))
    near_one = isinstance(value, float) and 0.5 < value < 2.0 and value != 1.0
    return 1.0 + (value - 1.0) * factor if near_one else value * factor


def verdicts(folder: Path, keys: Sequence[str]) -> Iterator[tuple[str, list[str]]]:
    """Diagnose trials; return of each the names of its verdict, or of what went wrong."""
    from radialtire import read_tire
    from tirelab.diagnosis.diagnose import diagnose
    from tirelab.recordings.recording import read_recording
    from tirelab.validation.folders import Folders

    folders = Folders(folder)
    for key in keys:
        recordings = [read_recording(path) for path in folders.recordings(key, "train")]
        try:
            yield key, sorted(diagnose(recordings, read_tire(folders.tire(key))).names)
        except Exception as error:  # a number that breaks the engine is a finding
            yield key, [f"failed: {error}"]


def _asked(
    folder: Path, keys: Sequence[str], change: tuple[Sequence[str], float] | None
) -> dict[str, list[str]]:
    """Diagnose trials in a process of its own."""
    given = json.dumps({"folder": str(folder), "keys": list(keys), "change": change})
    done = subprocess.run(
        [sys.executable, __file__, "--child"], input=given, capture_output=True, text=True, check=False
    )
    if done.returncode:
        return {key: [f"failed: {done.stderr.strip().splitlines()[-1]}"] for key in keys}
    answer: dict[str, list[str]] = json.loads(done.stdout.splitlines()[-1])
    return answer


def _child() -> None:
    given = json.loads(sys.stdin.read())
    if given["change"]:
        sys.meta_path.insert(0, Changing(*given["change"]))
    print(json.dumps(dict(verdicts(Path(given["folder"]), given["keys"]))))


def _drawn(folder: Path, seed: int, trials: int) -> list[str]:
    from tirelab.validation.blind_trials import ALL_KINDS, BlindTrials
    from tirelab.validation.commitment import draw_and_commit
    from tirelab.validation.folders import Folders

    kinds = BlindTrials(Folders(folder), seed, trials, ALL_KINDS)
    keys: list[str] = []
    for n in range(trials):
        found = draw_and_commit(Folders(folder), seed, n, kinds.kind_of(n))
        keys += [key for key in found if not key.endswith(".derived")]
    return keys


def tried(numbers: Sequence[str], keys: Sequence[str], each: int) -> list[tuple[str, list[str]]]:
    """Return of every number the trials that it is tried on, going round."""
    return [
        (number, [keys[(i * each + k) % len(keys)] for k in range(min(each, len(keys)))])
        for i, number in enumerate(numbers)
    ]


def _counts(place: str, before: dict[str, list[str]], after: dict[str, list[str]]) -> dict[str, Any]:
    other = {key: names for key, names in after.items() if names != before[key]}
    return {"number": place, "trials": len(after), "other": len(other), "verdicts": other}


@click.command()
@click.option("--seed", type=int, default=0)
@click.option("--trials", type=click.IntRange(min=1), default=200, show_default=True)
@click.option(
    "--each", type=click.IntRange(min=1), default=200, show_default=True, help="Trials of a number."
)
@click.option(
    "--only", multiple=True, help="Numbers by the ends of their places; all that are set by hand if left out."
)
@click.option("--out", type=click.Path(path_type=Path), default=Path("sensitivity.json"))
@click.option("--jobs", type=click.IntRange(min=1), default=2, show_default=True)
@click.option("--child", is_flag=True, hidden=True)
def main(seed: int, trials: int, each: int, only: tuple[str, ...], out: Path, jobs: int, child: bool) -> None:
    """Halve and double every number that is set by hand, and the effort."""
    if child:
        _child()
        return
    numbers = [c.place for c in constants() if c.kind == "chosen" and not c.beside]
    content: dict[str, Any] = {
        "seed": seed,
        "trials": trials,
        "each": each,
        "only": list(only),
        "numbers": [],
    }
    if out.exists():
        kept = json.loads(out.read_text(encoding="utf-8"))
        if {**kept, "numbers": []} == content:
            content = kept
    done = {(row["number"], row["factor"]) for row in content["numbers"]}
    with tempfile.TemporaryDirectory() as name, ThreadPoolExecutor(jobs) as workers:
        folder = Path(name)
        keys = _drawn(folder, seed, trials)
        before: dict[str, list[str]] = {}
        for found in workers.map(
            lambda part: _asked(folder, part, None), [keys[i::jobs] for i in range(jobs)]
        ):
            before |= found
        pieces = [(place, (place,), own) for place, own in tried(numbers, keys, each)]
        pieces += [(TOGETHER, BOUNDS, keys)]
        changes = [
            (*piece, factor)
            for piece in pieces
            for factor in FACTORS
            if piece[0].endswith(only or "") and (piece[0], factor) not in done
        ]
        answers = workers.map(lambda c: _asked(folder, c[2], (c[1], c[3])), changes)
        for (place, _, _, factor), after in zip(changes, answers, strict=True):
            row = {"factor": factor, **_counts(place, before, after)}
            content["numbers"].append(row)
            click.echo(f"{place} x {factor}: {row['other']} of {row['trials']} verdicts are others")
            out.write_text(json.dumps(content, indent=1) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
