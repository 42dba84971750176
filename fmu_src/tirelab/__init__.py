"""From recordings of a tire to a model of it, an FMU, and the physics that a simulation left out.

A name is imported when it is first used: `import tirelab` alone loads nothing.
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from .diagnosis.diagnose import diagnose as diagnose
    from .diagnosis.verdict import Verdict as Verdict
    from .errors import TirelabError as TirelabError
    from .fmu.build import build_fmu as build_fmu
    from .fmu.replay import replay as replay
    from .identification.identify import identify as identify
    from .planning.waveforms import Limits as Limits
    from .recordings.recording import Recording as Recording
    from .recordings.recording import read_recording as read_recording
    from .report.comparison import compare as compare
    from .terrain.ride import ride as ride

    __version__: str

_PUBLIC = {
    "Limits": "planning.waveforms",
    "Recording": "recordings.recording",
    "build_fmu": "fmu.build",
    "compare": "report.comparison",
    "diagnose": "diagnosis.diagnose",
    "identify": "identification.identify",
    "read_recording": "recordings.recording",
    "replay": "fmu.replay",
    "ride": "terrain.ride",
}
"""What the package offers, and the module that each name comes from."""

_BESIDE = {"TirelabError": "errors", "Verdict": "diagnosis.verdict"}
"""What can be imported too, for annotations and `except`, but is not listed."""

__all__ = [
    "Limits",
    "Recording",
    "__version__",
    "build_fmu",
    "compare",
    "diagnose",
    "identify",
    "read_recording",
    "replay",
    "ride",
]


def __getattr__(name: str) -> Any:
    if name == "__version__":
        from importlib.metadata import version

        found: Any = version("tirelab")
    else:
        module = _PUBLIC.get(name) or _BESIDE.get(name)
        if module is None:
            raise AttributeError(f"module 'tirelab' has no attribute {name!r}")
        found = getattr(import_module(f".{module}", __name__), name)
    globals()[name] = found
    return found


def __dir__() -> list[str]:
    return list(__all__)
