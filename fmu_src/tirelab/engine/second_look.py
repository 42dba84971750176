"""A second look for lines and spans of time, at what the best set leaves.

The first look goes by what all families together leave, and together they can follow a jump, or a line that swells with
the load. The best set of the search follows what belongs to it alone.
"""

from __future__ import annotations

from collections.abc import Sequence

from ..preprocessing.kinematics import FloatArray
from ..preprocessing.lines_and_segments import LinesAndSegments
from ..preprocessing.noise_model import Noise
from .background import noises_beside, standing_out
from .families import Family
from .place import Point
from .plainer import left_by
from .scene import Scene
from .search import Settled

SAME_LINE = 1.0
"""Lines within so many turns of each other in a recording are one."""


def second_look(
    best: Settled, scene: Scene, families: Sequence[Family], point: Point
) -> tuple[Noise, ...] | None:
    """Return the noises beside what stands out of what the best set leaves, None where nothing new does.

    Nor is it asked where something unknown has been found already: the verdict would be the same.
    families: all of them, those of lines and spans too; what is new is added to what is known of each recording
    """
    if any(best.layout.families[n].agnostic for n in best.names):
        return None
    found = False
    for record, left in zip(scene.records, left_by(best, scene), strict=True):
        whole = _together(record.outstanding, standing_out(record, left), record.thin.time)
        if whole != record.outstanding:
            found = True
            record.standing[:] = [whole]
    return noises_beside(scene, families, point) if found else None


def _together(first: LinesAndSegments, second: LinesAndSegments, time: FloatArray) -> LinesAndSegments:
    """Return both; of the second what is new, and no span at an end, where slow noise has half waves."""
    turn = SAME_LINE / float(time[-1] - time[0])
    lines = [x for x in second.lines if all(abs(x - y) > turn for y in first.lines)]
    inside = [s for s in second.segments if s[0] > 0 and s[1] < time.size]
    spans = [s for s in inside if not any(s[0] < end and begin < s[1] for begin, end in first.segments)]
    return LinesAndSegments((*first.lines, *lines), (*first.segments, *spans))
