"""Blind trials of the diagnosis on an independent rig.

The only part of the tool that imports the rig; the diagnosis never sees it.
"""

from .blind_trials import BlindTrials, prove
from .folders import Folders
from .page import Proof

__all__ = ["BlindTrials", "Folders", "Proof", "prove"]
