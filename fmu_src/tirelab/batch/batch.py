"""Batch diagnosis: one verdict for every recording or folder of recordings, and a summary of all.

    OUT/verdicts/NAME/      what the diagnosis writes for one of them (a/b as a~b)
    OUT/outcomes/NAME.json  how the diagnosis ended
    OUT/summary.csv, OUT/summary.html

A second run diagnoses only what is new, changed or crashed.
"""

from __future__ import annotations

import hashlib
import json
import shutil
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Any

from ..computing.staging import staged
from ..computing.workers import Cores, work
from ..diagnosis.diagnosis_file import DiagnosisFileError, read_stated
from ..diagnosis.diagnosis_run import Diagnoser, run_diagnosis
from ..errors import TirelabError, unwritable_folder
from ..recordings.files import folder_recordings
from ..recordings.formats import LOADERS
from ..recordings.metadata import FOLDER_SIDECAR
from ..recordings.reading import Reading
from .summary import BatchResult, Item, Row, summary_csv, summary_html, verdict_text

OUTCOME_SCHEMA = 1


@dataclass(frozen=True)
class Batch:
    """What is diagnosed, and how.

    paths: a file gets a verdict of its own; so does every recording that lies directly in a folder given; the
    recordings of each folder below are diagnosed together
    out: folder of all results; tire: file of the baseline tire, None for the article's; reading: how the recordings
    are read; diagnoser: diagnoses one item, None for `run_diagnosis`
    """

    paths: tuple[Path, ...]
    out: Path
    tire: Path | None = None
    reading: Reading = Reading()  # noqa: RUF009
    diagnoser: Diagnoser | None = None


def diagnose_batch(batch: Batch, cores: Cores, show: Callable[[str], None]) -> BatchResult:
    """Diagnose every item of a batch that is not done yet, and write the summary of all.

    show: called with one line for each item that is done

    A recording that cannot be read or diagnosed becomes a line of the summary; the others go on.
    Raises TirelabError where there is nothing to diagnose or `out` cannot be written.
    """
    out = batch.out
    items, skipped = find_items(batch.paths, out, batch.reading.columns)
    settings_hash = _settings_hash(batch)
    try:
        out.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise unwritable_folder(out, error) from None
    diagnoser = batch.diagnoser or partial(_diagnosed, batch.reading)
    tasks = {
        item.name: (diagnoser, item.recordings, batch.tire, _verdict_folder(out, item))
        for item in items
        if not _is_done(out, item, settings_hash)
    }
    by_name = {item.name: item for item in items}
    for done in work(diagnose_one, tasks, cores, "diagnosing"):
        outcome = done.value or {"error": done.error, "settled": False}
        item = by_name[done.key]
        content = {
            "schema": OUTCOME_SCHEMA,
            **outcome,
            "fingerprint": _fingerprint(item.recordings, settings_hash),
        }
        path = _outcome_file(out, item)
        with staged(path.parent) as folder:
            (folder / path.name).write_text(json.dumps(content, indent=1) + "\n", encoding="utf-8")
        show(f"{done.key}: {outcome['error'] or verdict_text(read_stated(_verdict_folder(out, item)))}")
    result = BatchResult(tuple(_row(out, item) for item in items), skipped)
    with staged(out) as folder:
        # with a byte order mark, or Excel reads it in another encoding
        (folder / "summary.csv").write_text(summary_csv(result, out), encoding="utf-8-sig", newline="")
        (folder / "summary.html").write_text(summary_html(result, out), encoding="utf-8")
    return result


def find_items(
    paths: Sequence[Path], out: Path, columns: Mapping[str, str] | None = None
) -> tuple[tuple[Item, ...], tuple[Path, ...]]:
    """Return the items that get a verdict, and the files that are no recordings; what lies in `out` is ignored.

    columns: channel -> column, as the user names them
    """
    found: dict[str, Item] = {}
    skipped: list[Path] = []

    def add(name: str, recordings: Sequence[Path]) -> None:
        unique, number = name, 2
        while (item := Item(unique, tuple(recordings))).folder in found:
            unique, number = f"{name}-{number}", number + 1
        found[item.folder] = item

    for path in paths:
        if not path.exists():
            raise TirelabError(f"{path}: there is no such file or folder; check the path")
        if path.is_file():
            add(path.stem, [path])
            continue
        top = path.resolve().name or "recordings"
        for folder in sorted({path, *(p for p in path.rglob("*") if p.is_dir())}):
            if _is_hidden(folder, path) or out.resolve() in (folder.resolve(), *folder.resolve().parents):
                continue
            files = sorted(p for p in folder.iterdir() if p.is_file() and not p.name.startswith("."))
            recordings = folder_recordings(folder, columns)[0]
            skipped += [
                p for p in files if p not in recordings and p.name != FOLDER_SIDECAR and p.suffix != ".toml"
            ]
            if folder == path:
                for file in recordings:
                    add(f"{top}/{file.stem}", [file])
            elif recordings:
                add(f"{top}/{folder.relative_to(path).as_posix()}", recordings)
    if not found:
        named = ", ".join(str(path) for path in paths)
        raise TirelabError(f"{named}: holds no recording; recordings end in {', '.join(LOADERS)}")
    return tuple(found.values()), tuple(skipped)


def diagnose_one(
    diagnoser: Diagnoser, recordings: Sequence[Path], tire: Path | None, out: Path
) -> dict[str, Any]:
    """Diagnose one item, and return the sentence of its error or None, and whether the outcome is final.

    An outcome is not final where the program itself failed: the next run tries again.
    """
    shutil.rmtree(out, ignore_errors=True)
    out.mkdir(parents=True)
    try:
        diagnoser(recordings, tire, out)
        read_stated(out)
    except DiagnosisFileError as error:
        return {"error": str(error), "settled": False}
    except TirelabError as error:
        return {"error": str(error), "settled": True}
    except Exception as error:
        return {"error": f"{type(error).__name__}: {error}", "settled": False}
    return {"error": None, "settled": True}


def _diagnosed(reading: Reading, recordings: Sequence[Path], tire: Path | None, out: Path) -> None:
    run_diagnosis(recordings, out, tire=tire, reading=reading)


def _is_hidden(folder: Path, path: Path) -> bool:
    return any(part.startswith(".") for part in folder.relative_to(path).parts)


def _settings_hash(batch: Batch) -> str:
    """SHA-256 of what decides a verdict beside the recordings: the baseline tire and how recordings are read."""
    try:
        content = b"" if batch.tire is None else batch.tire.read_bytes()
    except OSError as error:
        raise TirelabError(f"{batch.tire}: {error.strerror}; name a tire file that can be read") from None
    return hashlib.sha256(content + "\0".join(batch.reading.words()).encode()).hexdigest()


def _fingerprint(recordings: Sequence[Path], settings_hash: str) -> list[Any]:
    files = []
    sidecars = {
        p for r in recordings for p in (r.with_name(FOLDER_SIDECAR), r.with_suffix(".toml")) if p.exists()
    }
    for path in (*recordings, *sorted(sidecars)):
        at = path.stat()
        files.append([str(path.resolve()), at.st_size, at.st_mtime_ns])
    return [settings_hash, files]


def _outcome_file(out: Path, item: Item) -> Path:
    return out / "outcomes" / f"{item.folder}.json"


def _verdict_folder(out: Path, item: Item) -> Path:
    return out / "verdicts" / item.folder


def _is_done(out: Path, item: Item, settings_hash: str) -> bool:
    try:
        content = json.loads(_outcome_file(out, item).read_text(encoding="utf-8"))
        same = bool(
            content["settled"] and content["fingerprint"] == _fingerprint(item.recordings, settings_hash)
        )
        if same and content["error"] is None:
            read_stated(_verdict_folder(out, item))
    except (OSError, ValueError, KeyError, TypeError):
        return False
    return same


def _row(out: Path, item: Item) -> Row:
    error = json.loads(_outcome_file(out, item).read_text(encoding="utf-8"))["error"]
    return Row(item, None if error else read_stated(_verdict_folder(out, item)), error)
