"""Results that are there whole or not at all: written aside, then moved into their folder."""

from __future__ import annotations

import errno
import os
import shutil
import signal
import tempfile
import threading
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import Any

from ..errors import unwritable_folder

PREFIX = ".tirelab-"
"""How a folder begins that is being written; one that a power cut leaves can be deleted."""

FULL = (errno.ENOSPC, errno.EDQUOT, errno.EFBIG)
"""Errors of a file that finds no more room."""


@contextmanager
def staged(folder: Path) -> Iterator[Path]:
    """Give a folder to write into; when the block ends its files stand in `folder`, when it is interrupted none does.

    Files of the same names are replaced, each at once; others stay, in subfolders too. A `folder` that was made for
    this goes again where nothing was written. Raises TirelabError where `folder` cannot be written or has no more room.
    """
    made = [path for path in (folder, *folder.parents) if not path.exists()]
    try:
        folder.mkdir(parents=True, exist_ok=True)
        aside = Path(tempfile.mkdtemp(prefix=PREFIX, dir=folder))
    except OSError as error:
        raise unwritable_folder(folder, error) from None
    try:
        try:
            yield aside
        except OSError as error:
            if error.errno in FULL:
                raise unwritable_folder(folder, error) from None
            raise
        with _ctrl_c_later():
            try:
                for file in sorted(path for path in aside.rglob("*") if path.is_file()):
                    target = folder / file.relative_to(aside)
                    target.parent.mkdir(parents=True, exist_ok=True)
                    os.replace(file, target)
            except OSError as error:
                raise unwritable_folder(Path(error.filename2 or folder), error) from None
    finally:
        shutil.rmtree(aside, ignore_errors=True)
        with suppress(OSError):  # where something was written, it is not empty
            for path in made:
                path.rmdir()


@contextmanager
def _ctrl_c_later() -> Iterator[None]:
    """Let Ctrl-C wait until the block has ended, so that of several files not only the first are there."""
    # only the main thread is interrupted, and only it may say so; None: somebody else's handler, which stays
    before = signal.getsignal(signal.SIGINT)
    if threading.current_thread() is not threading.main_thread() or before is None:
        yield
        return
    waiting: list[tuple[Any, ...]] = []
    signal.signal(signal.SIGINT, lambda *pressed: waiting.append(pressed))
    try:
        yield
    finally:
        signal.signal(signal.SIGINT, before)
    if waiting and callable(before):
        before(*waiting[0])
