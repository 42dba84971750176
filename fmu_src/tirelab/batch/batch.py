"""A whole shelf of recordings: one verdict for every recording or folder of them, and a summary of all.

    OUT/verdicts/NAME/      what `tirelab diagnose` writes for one of them (a/b as a~b)
    OUT/outcomes/NAME.json  how that ended
    OUT/summary.csv, OUT/summary.html

Started again, only what is new, changed or crashed is diagnosed.
"""

from __future__ import annotations

import hashlib
import json
import shutil
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

from ..diagnosis.diagnosis_file import DiagnosisFileError, read_stated
from ..diagnosis.diagnosis_run import Diagnoser, run_diagnosis
from ..errors import TirelabError
from ..recordings.formats import LOADERS
from ..recordings.metadata import FOLDER_SIDECAR
from ..recordings.reading import Reading
from .summary import EachResult, Item, Row, in_words, summary_csv, summary_html
from .workers import Cores, work

SCHEMA = 1


def diagnose_each(
    places: Sequence[Path],
    out: Path,
    *,
    tire: Path | None = None,
    cores: Cores | None = None,
    reading: Reading = Reading(),  # noqa: B008
    diagnoser: Diagnoser | None = None,
    tell: Callable[[str], None] = print,
) -> EachResult:
    """Diagnose everything in `places` and write the summary to `out`.

    places: a file gets a verdict of its own; so does every recording that lies directly in a folder given; the
    recordings of each folder below are diagnosed together
    tire: file of the baseline tire, None for the article's; reading: how the recordings are read
    diagnoser: what stands for that command; tell: is handed one line for each item that is done

    A recording that cannot be read or diagnosed is a line of the summary and stops nothing.
    Raises TirelabError where there is nothing to diagnose or `out` cannot be written.
    """
    items, passed_over = find_items(places, out)
    mark = _mark(tire, reading)
    try:
        out.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise TirelabError(f"{out}: cannot be written ({error.strerror}); name another with --out") from None
    tasks = {
        item.name: (diagnoser, item.recordings, tire, _verdict(out, item), reading)
        for item in items
        if not _is_done(out, item, mark)
    }
    by_name = {item.name: item for item in items}
    for done in work(diagnose_one, tasks, cores or Cores(), "diagnosing"):
        outcome = done.value or {"error": done.error, "settled": False}
        item = by_name[done.key]
        content = {"schema": SCHEMA, **outcome, "fingerprint": _fingerprint(item.recordings, mark)}
        path = _outcome(out, item)
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(json.dumps(content, indent=1) + "\n", encoding="utf-8")
        tell(f"{done.key}: {outcome['error'] or in_words(read_stated(_verdict(out, item)))}")
    result = EachResult(tuple(_row(out, item) for item in items), passed_over)
    # with a byte order mark, or Excel takes it for another alphabet
    (out / "summary.csv").write_text(summary_csv(result, out), encoding="utf-8-sig", newline="")
    (out / "summary.html").write_text(summary_html(result, out), encoding="utf-8")
    return result


def find_items(places: Sequence[Path], out: Path) -> tuple[tuple[Item, ...], tuple[Path, ...]]:
    """Return what gets a verdict, and the files that are no recordings by their suffix; what lies in `out` is left."""
    found: dict[str, Item] = {}
    passed_over: list[Path] = []

    def add(name: str, recordings: Sequence[Path]) -> None:
        unique, number = name, 2
        while (item := Item(unique, tuple(recordings))).folder in found:
            unique, number = f"{name}-{number}", number + 1
        found[item.folder] = item

    for place in places:
        if not place.exists():
            raise TirelabError(f"{place}: there is no such file or folder; check the path")
        if place.is_file():
            add(place.stem, [place])
            continue
        top = place.resolve().name or "recordings"
        for folder in sorted({place, *(p for p in place.rglob("*") if p.is_dir())}):
            if _is_hidden(folder, place) or out.resolve() in (folder.resolve(), *folder.resolve().parents):
                continue
            files = sorted(p for p in folder.iterdir() if p.is_file() and not p.name.startswith("."))
            recordings = [p for p in files if p.suffix.lower() in LOADERS]
            passed_over += [
                p for p in files if p not in recordings and p.name != FOLDER_SIDECAR and p.suffix != ".toml"
            ]
            if folder == place:
                for file in recordings:
                    add(f"{top}/{file.stem}", [file])
            elif recordings:
                add(f"{top}/{folder.relative_to(place).as_posix()}", recordings)
    if not found:
        named = ", ".join(str(place) for place in places)
        raise TirelabError(f"{named}: holds no recording; recordings end in {', '.join(LOADERS)}")
    return tuple(found.values()), tuple(passed_over)


def diagnose_one(
    diagnoser: Diagnoser | None,
    recordings: Sequence[Path],
    tire: Path | None,
    out: Path,
    reading: Reading,
) -> dict[str, Any]:
    """Diagnose one item, and return the sentence of its error or None, and whether trying again would change it."""
    shutil.rmtree(out, ignore_errors=True)
    out.mkdir(parents=True)
    try:
        if diagnoser is None:
            run_diagnosis(recordings, out, tire=tire, reading=reading)
        else:
            diagnoser(recordings, tire, out)
        read_stated(out)
    except DiagnosisFileError as error:
        return {"error": str(error), "settled": False}
    except TirelabError as error:
        return {"error": str(error), "settled": True}
    except Exception as error:
        return {"error": f"{type(error).__name__}: {error}", "settled": False}
    return {"error": None, "settled": True}


def _is_hidden(folder: Path, place: Path) -> bool:
    return any(part.startswith(".") for part in folder.relative_to(place).parts)


def _mark(tire: Path | None, reading: Reading) -> str:
    """What beside the recordings decides a verdict."""
    try:
        content = b"" if tire is None else tire.read_bytes()
    except OSError as error:
        raise TirelabError(f"{tire}: {error.strerror}; name a tire file that can be read") from None
    return hashlib.sha256(content + "\0".join(reading.words()).encode()).hexdigest()


def _fingerprint(recordings: Sequence[Path], mark: str) -> list[Any]:
    files = []
    settings = {
        p for r in recordings for p in (r.with_name(FOLDER_SIDECAR), r.with_suffix(".toml")) if p.exists()
    }
    for path in (*recordings, *sorted(settings)):
        at = path.stat()
        files.append([str(path.resolve()), at.st_size, at.st_mtime_ns])
    return [mark, files]


def _outcome(out: Path, item: Item) -> Path:
    return out / "outcomes" / f"{item.folder}.json"


def _verdict(out: Path, item: Item) -> Path:
    return out / "verdicts" / item.folder


def _is_done(out: Path, item: Item, mark: str) -> bool:
    try:
        content = json.loads(_outcome(out, item).read_text(encoding="utf-8"))
        same = bool(content["settled"] and content["fingerprint"] == _fingerprint(item.recordings, mark))
        if same and content["error"] is None:
            read_stated(_verdict(out, item))
    except (OSError, ValueError, KeyError, TypeError):
        return False
    return same


def _row(out: Path, item: Item) -> Row:
    error = json.loads(_outcome(out, item).read_text(encoding="utf-8"))["error"]
    return Row(item, None if error else read_stated(_verdict(out, item)), error)
