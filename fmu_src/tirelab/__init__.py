"""From recordings of a tire to a model of it, an FMU, and the physics that a simulation left out."""

from .diagnosis.diagnose import diagnose
from .diagnosis.verdict import Verdict
from .errors import TirelabError
from .recordings.recording import Recording, read_recording

__all__ = ["Recording", "TirelabError", "Verdict", "diagnose", "read_recording"]
