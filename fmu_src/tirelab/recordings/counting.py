"""How the gauges of a recording count: their zeros are subtracted, and signs that are the other way round turned."""

from __future__ import annotations

import shlex
from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from ..names import plain
from .asking import IncompleteRecording
from .choices import Choices
from .formats import RecordingError
from .matching import Match
from .metadata import Settings
from .origin import Origin
from .plausibility import PULLS, force_begins
from .sign_convention import Signs, compressive_signs, mass_alike, work_share
from .zero import ZEROED, Gauges, quantity_text, zero_in_si

FloatArray = NDArray[np.float64]

MOST_MOVED = 20.0
"""Largest mass [kg] that may move between a part and the cell that measures its force: a rod, clamps, a plate."""


@dataclass(frozen=True)
class Counted:
    """The gauges with what was turned, what there is to say of it, and the error where the signs are in doubt."""

    gauges: Gauges
    notes: tuple[str, ...]
    fault: RecordingError | None = None

    @property
    def turned(self) -> tuple[str, ...]:
        """The channels of which the sign was turned."""
        return tuple(sorted(self.gauges.turned))


def count_from_zero(
    values: dict[str, FloatArray],
    origin: Origin,
    matches: Mapping[str, Match],
    names: Mapping[str, str],
    settings: Settings,
) -> Counted:
    """Subtract the zeros that are given from channels [SI], and turn those that count the other way round, in place.

    A part may pull: where its force does not fall with the deflection, signs that leave a doubt are taken as they are,
    but for both being negative under load, as of a part that is loaded the other way and then relaxes or breaks: then
    nothing tells whether it is pressed or pulled.
    A part that is loaded both ways, as a damper is, shows by no sign how its rig counts: the larger of its forces is
    that of its stiffer way.
    Where a mass that moves may be why the force falls, nothing is turned without asking.
    Errors: RecordingError for a zero that is no quantity of its channel.
    """
    zeros = {name: zero_in_si(name, text, f"{origin}, zero") for name, text in settings.zero.items()}
    notes = []
    for name, zero in zeros.items():
        values[name] = values[name] - zero
        notes.append(f"{name} less {settings.zero[name]}, its zero as given")
    gauges = Gauges(origin, zeros, frozenset(), names)
    asked_for = [name for name, match in matches.items() if match.sign < 0 and name in values]
    for name in asked_for:
        values[name] = 0.0 - values[name]
        notes.append(f"{name} turned in sign, as asked")
    gauges = replace(gauges, turned=frozenset(asked_for))
    signs = compressive_signs(values["deflection"], values["force"])
    given = {name for name in ZEROED if matches[name].sign}
    turned = {name for name, sign in (("deflection", signs.deflection), ("force", signs.force)) if sign < 0}
    if settings.part and len(turned) == 2 and _both_ways(values["force"]):
        return Counted(gauges, tuple(notes))
    of_part = settings.part and bool(signs.doubt) and not signs.falls
    if len(given) == 2 or (of_part and not (signs.negative and not given)):
        return Counted(gauges, tuple(notes))
    mass = (
        mass_alike(values["time"], values["deflection"], values["force"]) if settings.part and turned else 0.0
    )
    if len(turned) == 1 and not given and 0.0 < mass < MOST_MOVED:
        # what little work is done tells which way round it is not put in
        likely = Signs(1, -1 if work_share(values["deflection"], values["force"]) < 0.0 else 1)
        why = (
            "the force falls as the deflection rises: a spring counted the other way has it so, and so has the mass "
            f"of a rod and clamps, {plain(mass, 2)} kg at this speed"
        )
        return Counted(gauges, tuple(notes), _asked(values, gauges, likely, why, settings))
    if (signs.doubt and not of_part) or turned & given:
        why = signs.doubt or f"{' and '.join(sorted(turned))} would have to be turned"
        # A sign that is given stays: then the other channel is the one to turn.
        likely = Signs(-signs.deflection, -signs.force) if turned & given else signs
        return Counted(gauges, tuple(notes), _asked(values, gauges, likely, why, settings))
    for name in sorted(turned):
        values[name] = 0.0 - values[name]
    if len(turned) == 2 and settings.part:
        notes.append("deflection and force are both negative under load: both turned in sign")
    elif turned:
        notes.append(f"the rig counts compression negative: {' and '.join(sorted(turned))} turned in sign")
    return Counted(replace(gauges, turned=gauges.turned ^ turned), tuple(notes))


def _both_ways(force: FloatArray) -> bool:
    ends = sorted((abs(float(force.min())), abs(float(force.max()))))
    return bool(force.min() < 0.0 < force.max()) and ends[0] > PULLS * ends[1]


def _asked(
    values: Mapping[str, FloatArray], gauges: Gauges, signs: Signs, why: str, settings: Settings
) -> RecordingError:
    """Return the error that asks for the signs, with likely ones, and with the zeros that belong to them."""
    origin = gauges.origin
    factors = {"deflection": signs.deflection, "force": signs.force}
    turned = gauges.turned ^ {name for name, factor in factors.items() if factor < 0}
    likely = replace(gauges, turned=frozenset(turned))
    more: Mapping[str, float] = {}
    if not settings.part:
        x, f = (factors[name] * values[name] for name in ZEROED)
        zero = force_begins(x, f, values["radius"])
        more = zero.readings() if zero is not None and zero.off else {}
    zeros = likely.at_zero(more)
    columns = likely.columns()
    what = f"{origin}: which way the rig counts cannot be determined ({why})"
    advice = "say it with a sign before each column, + to keep and - to turn it"
    advice += ", and what the gauge reads where the force begins" if more else ""
    whole = replace(settings, columns={**settings.columns, **columns}, zero=zeros)
    if origin.kind == "frame":
        given = [origin.columns(**columns), *([origin.zero(zeros)] if zeros else [])]
        return IncompleteRecording(what, f"{advice}: {', '.join(given)}", whole)
    if origin.kind == "arrays":
        subtracted = f" and {origin.zero({n: quantity_text(n, v) for n, v in more.items()})}" if more else ""
        return IncompleteRecording(what, f"{advice}: {origin.columns(**columns)}{subtracted}", whole)
    words = Choices(columns=columns, zero=zeros).words()
    return IncompleteRecording(what, f"{advice}: {shlex.join(words)}", whole)
