"""An independent test rig: recordings of a tire in which something is hidden, and the sealed answer.

It shares no equation and no code with the tire model or the diagnosis; every effect is written in another
formulation than theirs. `draw` a Trial from a seed, `write` its recordings, `write_answer` elsewhere; `rerun`
makes another test on the same rig.
"""

from concealed.drawing import draw
from concealed.files import answer_json, believed, write, write_answer, write_believed
from concealed.scenario import KINDS
from concealed.trial import Answer, FileTruth, Record, Trial, rerun

__all__ = [
    "KINDS",
    "Answer",
    "FileTruth",
    "Record",
    "Trial",
    "answer_json",
    "believed",
    "draw",
    "rerun",
    "write",
    "write_answer",
    "write_believed",
]
