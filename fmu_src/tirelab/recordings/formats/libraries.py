"""The libraries behind the rarer formats: what to install for them, and what they log while they read."""

import gc
import importlib
import logging
import sys
import traceback
import warnings
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from types import ModuleType

from ...errors import TirelabError, missing_library
from .table import RecordingError


def load_library(path: Path, module: str, package: str, instead: str = "") -> ModuleType:
    """A library that the base installation may lack; RecordingError says which package brings it.

    instead: what else can be done, at the end of that sentence
    """
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            return importlib.import_module(module)
    except ImportError:
        purpose = f"{path.name}: reading {path.suffix}"
        raise RecordingError(missing_library(purpose, module, package) + instead) from None


@contextmanager
def reading_with(path: Path, kind: str, logger: str = "tirelab") -> Iterator[list[str]]:
    """Read with a library: its warnings are collected, what it raises on a damaged file becomes one sentence."""
    warned = _Warnings()
    known = [name for name in logging.root.manager.loggerDict if name.split(".")[0] == logger]
    kept = [(log, log.handlers, log.propagate) for log in map(logging.getLogger, known)]
    for log, _, _ in kept:
        log.handlers, log.propagate = [warned], False
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            yield warned.messages
    except TirelabError:
        raise
    except MemoryError:
        raise RecordingError(
            f"{path.name}: does not fit into memory; cut it into shorter recordings"
        ) from None
    except Exception as error:  # the libraries raise anything from struct.error to AttributeError
        reason = " ".join(f"{type(error).__name__}: {error}".split())[:120]
        _discard(error)
        raise RecordingError(
            f"{path.name}: cannot be read as {kind} ({reason}); it may be damaged or cut short: save it anew"
        ) from None
    finally:
        for log, handlers, propagate in kept:
            log.handlers, log.propagate = handlers, propagate


class _Warnings(logging.Handler):
    """The warnings that a library logs, as texts."""

    def __init__(self) -> None:
        super().__init__(logging.WARNING)
        self.messages: list[str] = []

    def emit(self, record: logging.LogRecord) -> None:
        self.messages.append(" ".join(record.getMessage().split()))


def _discard(error: Exception) -> None:
    """Drop the objects of a failed library without the messages of their destructors on the terminal."""
    hook, sys.unraisablehook = sys.unraisablehook, lambda _: None
    try:
        traceback.clear_frames(error.__traceback__)
        gc.collect()
    finally:
        sys.unraisablehook = hook
