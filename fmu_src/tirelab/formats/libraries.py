"""The libraries behind the rarer formats: what to install for them, and what their failures say."""

import importlib
import warnings
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from types import ModuleType

from tirelab.errors import TirelabError
from tirelab.formats.table import RecordingError


def load_library(path: Path, module: str, extra: str) -> ModuleType:
    """A library that the base installation may lack; RecordingError says which extra brings it."""
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            return importlib.import_module(module)
    except ImportError:
        raise RecordingError(
            f"{path.name}: reading {path.suffix} needs {module}; install it: pip install 'tirelab[{extra}]'"
        ) from None


@contextmanager
def told_by(path: Path, kind: str) -> Iterator[None]:
    """Turn whatever a library raises on a damaged file into one sentence, and keep its warnings quiet."""
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            yield
    except (TirelabError, KeyboardInterrupt):
        raise
    except MemoryError:
        raise RecordingError(
            f"{path.name}: does not fit into memory; cut it into shorter recordings"
        ) from None
    except Exception as error:  # the libraries raise anything from struct.error to AttributeError
        reason = " ".join(f"{type(error).__name__}: {error}".split())[:120]
        raise RecordingError(
            f"{path.name}: cannot be read as {kind} ({reason}); it may be damaged or cut short: save it anew"
        ) from None
