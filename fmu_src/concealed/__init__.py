"""An independent test rig: recordings of a tire in which something is hidden, and the answer.

It shares no equation and no code with the tire model or the diagnosis; every effect is written in another
formulation than theirs. `draw` a Trial from a seed, `write` its recordings, `write_answer` elsewhere; `rerun`
makes another test on the same rig.
"""

from .files import answer_json, baseline_table, write, write_answer, write_baseline
from .kinds import derived_right, draw
from .scenario import KINDS
from .trial import Answer, FileTruth, Record, Trial, rerun
from .wide.drawing import IN_TURN, WIDE_KINDS

__all__ = [
    "IN_TURN",
    "KINDS",
    "WIDE_KINDS",
    "Answer",
    "FileTruth",
    "Record",
    "Trial",
    "answer_json",
    "baseline_table",
    "derived_right",
    "draw",
    "rerun",
    "write",
    "write_answer",
    "write_baseline",
]
