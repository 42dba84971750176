"""A plan: what to record within a rig's limits, and what can be told from it."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray
from radialtire import TireModel

from ..errors import TirelabError
from ..regressors.signature import LAW
from .choice import TOLD, Choice, Menu, chosen_of
from .menu import LENGTHS, SLOW, Drive, drive_of, menu
from .responses import Responses, responses_of, within_force
from .rig import Rig
from .separation import Question, probabilities, questions_beside, questions_of

FloatArray = NDArray[np.float64]

SIZES = (0.01, 0.02, 0.05)
"""Sizes of an effect in the table: its largest response over the peak force."""

Progress = Callable[[str], None]


@dataclass(frozen=True)
class Row:
    """What is told of one effect.

    named: with which probability it is named and nothing else, at each of the sizes; confused: names that it is not
    told from in nineteen of twenty recordings at the size of the plan ("" for nothing at all), a refitted law alone
    where that can follow it; hopeless: those of them from which no motion of the menu tells it
    """

    effect: str
    named: tuple[float, ...]
    confused: tuple[str, ...]
    hopeless: tuple[str, ...]


@dataclass(frozen=True)
class Answer:
    """What was asked, the probability of the right answer after the plan, and whether the whole menu answers it."""

    question: Question
    probability: float
    possible: bool


@dataclass(frozen=True)
class RecordingPlan:
    """Drives in the order in which they were chosen, and what is told after them.

    answers: of each effect by itself; beside: of each effect beside another one
    size: for which the drives were chosen; peak [N]: the tire's largest force within the limits
    """

    rig: Rig
    tire: str
    size: float
    drives: tuple[Drive, ...]
    rows: tuple[Row, ...]
    answers: tuple[Answer, ...]
    silent: tuple[str, ...]
    peak: float
    beside: tuple[Answer, ...] = ()

    @property
    def seconds(self) -> float:
        """Time [s] of all drives."""
        return sum(d.duration for d in self.drives)

    @property
    def told(self) -> tuple[int, int, int]:
        """How many of the questions are answered, how many the whole menu would answer, how many there are."""
        return _told(self.answers)

    @property
    def told_beside(self) -> tuple[int, int, int]:
        """The same of the questions for an effect beside another one; three zeros where none was asked."""
        return _told(self.beside)

    def to_dict(self) -> dict[str, Any]:
        """Return the content of plan.json."""
        return {
            "tire": self.tire,
            "rig": {
                "stroke": self.rig.stroke,
                "speed": self.rig.speed,
                "surfaces": ["inf" if np.isinf(r) else r for r in self.rig.surfaces],
                "pressures": list(self.rig.pressures),
                "time": self.rig.time,
                "sampling": self.rig.sampling,
                "noise": self.rig.noise,
                "force": None if np.isinf(self.rig.force) else self.rig.force,
            },
            "size": self.size,
            "peak_force": self.peak,
            "seconds": self.seconds,
            "recordings": [
                {
                    "file": file_name(number, drive),
                    "motion": drive.name,
                    "surface_radius": "inf"
                    if np.isinf(drive.surface_radius[0])
                    else float(drive.surface_radius[0]),
                    "pressure": drive.pressure,
                    "duration": drive.duration,
                    "deflection_max": float(drive.deflection.max()),
                    "rate_max": drive.fastest,
                }
                for number, drive in enumerate(self.drives, 1)
            ],
            "sizes": list(SIZES),
            "effects": [
                {
                    "name": row.effect,
                    "named": list(row.named),
                    "confused_with": [name or "nothing" for name in row.confused],
                    "whatever_is_driven": [name or "nothing" for name in row.hopeless],
                }
                for row in self.rows
            ],
            "no_response": list(self.silent),
            "pairs": [
                {
                    "true": a.question.truth,
                    "against": sorted(a.question.alternative),
                    "probability": a.probability,
                    "possible": a.possible,
                }
                for a in self.answers
            ],
            "beside": [
                {
                    "true": a.question.truth,
                    "beside": a.question.beside,
                    "probability": a.probability,
                    "possible": a.possible,
                }
                for a in self.beside
            ],
        }


def _told(answers: Sequence[Answer]) -> tuple[int, int, int]:
    return sum(a.probability >= TOLD for a in answers), sum(a.possible for a in answers), len(answers)


def file_name(number: int, drive: Drive) -> str:
    """Return the name of a drive's file: 01_slow_triangles_flat.csv."""
    words = [drive.name, drive.surface.replace("radius ", ""), _pressure(drive)]
    text = "_".join(word for word in words if word).replace(",", "").replace(" ", "_")
    return f"{number:02d}_{text}.csv"


def _pressure(drive: Drive) -> str:
    return "" if drive.pressure is None else f"{drive.pressure / 1e5:.3g}bar"


def plan_recordings(
    tire: TireModel, rig: Rig, size: float = 0.02, progress: Progress = lambda sentence: None
) -> RecordingPlan:
    """Return the shortest set of recordings that tells the catalogue's effects apart on a believed tire.

    size: of the effects, largest response over the peak force; progress: called with a sentence for each stage
    The stroke of the rig ends where the tire reaches the rig's largest force (`within_force`).
    Raises TirelabError where no motion fits into the rig's limits.
    """
    rig = within_force(rig, tire)
    responses = responses_of(motions_within(rig), tire, rig, progress)
    questions = (*questions_of(responses.names, size), *questions_beside(responses.names, size))
    return planned(tire, rig, responses, offered(responses, questions, len(responses.drives)), progress)


def motions_within(rig: Rig) -> tuple[Drive, ...]:
    """Return the menu of a rig; raises TirelabError where it is empty."""
    drives = menu(rig)
    if not drives:
        raise TirelabError("no motion fits into these limits; give more --time or a faster --speed")
    return drives


def offered(responses: Responses, questions: Sequence[Question], count: int) -> Menu:
    """Return the first drives to choose from, where all others were recorded already."""
    return Menu(
        responses.grams[:count],
        tuple(d.duration for d in responses.drives[:count]),
        responses.places,
        tuple(questions),
        sum(responses.grams[count:], start=np.zeros_like(responses.grams[0])),
        responses.mixed[:count],
        any(responses.mixed[count:]),
    )


def planned(
    tire: TireModel, rig: Rig, responses: Responses, options: Menu, progress: Progress
) -> RecordingPlan:
    """Return the plan that answers the questions of the options."""
    drives, questions = responses.drives, options.questions
    others = _at_other_pressures(rig)
    seconds = rig.time - sum(d.duration for d in others)
    choice = chosen_of(options, seconds, progress)
    held = {drives[i].pressure for i in choice.chosen}
    missing = [d for d in others if d.pressure not in held]
    progress("working out what is told")
    gram = options.gram(choice.chosen)
    pairs = zip(questions, choice.answers.tolist(), choice.possible.tolist(), strict=True)
    answers = tuple(Answer(*pair) for pair in pairs)
    return RecordingPlan(
        rig,
        tire.name,
        max(q.size for q in questions),
        (*(drives[i] for i in choice.chosen), *missing),
        _rows(questions, choice, gram, responses),
        tuple(a for a in answers if not a.question.beside),
        responses.silent,
        responses.peak,
        tuple(a for a in answers if a.question.beside),
    )


def _at_other_pressures(rig: Rig) -> tuple[Drive, ...]:
    """Return the shortest slow triangles at every pressure but the first: where nothing else asks for a pressure, the
    force's own gain with it does.
    """
    part = min(LENGTHS)
    return tuple(drive_of(SLOW, part, rig.surfaces[0], rig, p) for p in rig.pressures[1:])


def _rows(
    questions: Sequence[Question], choice: Choice, gram: FloatArray, responses: Responses
) -> tuple[Row, ...]:
    named: dict[str, list[float]] = {}
    asked = zip(questions, choice.answers.tolist(), choice.possible.tolist(), strict=True)
    alone = [own for own in asked if not own[0].beside]
    questions = [q for q, _, _ in alone]
    for size in SIZES:
        resized = [replace(q, size=size) for q in questions]
        found = probabilities(gram, responses.places, resized)
        for truth in dict.fromkeys(q.truth for q in questions):
            own = [p for q, p in zip(questions, found, strict=True) if q.truth == truth]
            named.setdefault(truth, []).append(float(np.mean(np.prod(own, axis=0))))
    rows = []
    for truth, values in named.items():
        missed = [(_against(q), bool(possible)) for q, p, possible in alone if q.truth == truth and p < TOLD]
        if (LAW, False) in missed:  # a refitted law follows it, so it does beside every other effect too
            missed = [(LAW, False)]
        confused = tuple(dict.fromkeys(name for name, _ in missed))
        hopeless = tuple(dict.fromkeys(name for name, possible in missed if not possible))
        rows.append(Row(truth, tuple(values), confused, hopeless))
    return tuple(rows)


def _against(question: Question) -> str:
    """Return the name that stands for an alternative: the other effect, else the law, else "" for nothing."""
    effects = sorted(question.alternative - {LAW})
    return " + ".join(effects) if effects else next(iter(question.alternative), "")
