"""The proof: blind trials on an independent rig, scored.

The only part of the tool that knows the rig; what diagnoses never sees it.
"""

from .blind_trials import Series, prove
from .folders import Folders
from .page import Proof

__all__ = ["Folders", "Proof", "Series", "prove"]
