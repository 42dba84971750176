"""From recordings of a tire to a model of it, an FMU, and the physics that a simulation left out."""

from .diagnosis import diagnose
from .errors import TirelabError
from .recording import Recording, read_recording
from .verdict import Verdict

__all__ = ["Recording", "TirelabError", "Verdict", "diagnose", "read_recording"]
