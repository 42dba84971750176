"""What a rig can do, from a file rig.toml and from options that go over it.

stroke = "20 mm"          largest deflection
speed = "100 mm/s"        fastest motion
surfaces = "flat, 25.4 cm, -50.8 cm"
pressures = "2 bar, 3 bar"
time = "5 min"            of driving, all recordings together
sampling = "200 Hz"
noise = "5 N"             standard deviation of one sample of the force
force = "2 kN"            largest that the press and its load cell take
"""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Mapping
from dataclasses import dataclass, fields, replace
from pathlib import Path
from typing import Any

import numpy as np

from ..errors import TirelabError
from ..names import plain
from ..recordings.sampling import parse_interval
from ..recordings.toml_text import parse_toml
from ..recordings.units import UnitError, conversion, parse_radius
from .waveforms import Limits

NUMBER = re.compile(r"\s*([+-]?(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?)\s*(.*?)\s*")

FEWEST = 100
"""Samples that a plan needs at least in its whole time."""


@dataclass(frozen=True)
class Rig:
    """The limits of a rig.

    stroke [m]: largest deflection; speed [m/s]: fastest motion; surfaces [m]: radii that can be mounted, flat infinite;
    pressures [Pa]: gauge pressures that can be held, none: as it is; time [s]: of driving, all recordings together;
    sampling [s]: between samples; noise [N]: standard deviation of one sample of the force
    force [N]: largest that the press and its load cell take
    start [m]: deflection from which a motion goes; of a part what was recorded says it, and no file of a rig
    """

    stroke: float = 0.02
    speed: float = 0.1
    surfaces: tuple[float, ...] = (math.inf,)
    pressures: tuple[float, ...] = ()
    time: float = 300.0
    sampling: float = 0.005
    noise: float = 5.0
    force: float = math.inf
    start: float = 0.0

    def limits(self, duration: float) -> Limits:
        """Return the limits of one motion of this duration [s]."""
        held = self.surfaces, self.pressures
        return Limits(self.stroke, self.speed, self.sampling, duration, *held, self.start, self.force)

    @property
    def test_limits(self) -> Limits:
        """The limits of one test that is driven after a diagnosis, of a minute at most."""
        return self.limits(min(self.time, Limits().longest))


KEYS = tuple(field.name for field in fields(Rig) if field.name != "start")

_EXAMPLES = {
    "stroke": "20mm",
    "speed": "100mm/s",
    "surfaces": "flat,25.4cm",
    "pressures": "2bar,3bar",
    "time": "5min",
    "sampling": "200Hz",
    "noise": "5N",
    "force": "2kN",
}


def read_rig(
    file: Path | None,
    given: Mapping[str, str | None],
    defaults: Rig = Rig(),
) -> Rig:
    """Return the rig of a file (None: of the defaults), with what is `given`, key by key, over it.

    Raises TirelabError, one sentence, for a file that cannot be read, an unknown key, or a value without its unit.
    """
    texts: dict[str, tuple[str, Any]] = {}
    if file is not None:
        texts |= {key: (f"{file}: {key}", value) for key, value in _content(file).items()}
    texts |= {key: (f"--{key}", value) for key, value in given.items() if value is not None}
    rig = replace(defaults, **{key: _READERS[key](where, value) for key, (where, value) in texts.items()})
    if rig.time / rig.sampling < FEWEST:
        raise TirelabError(
            f"{rig.time:g} s at {1.0 / rig.sampling:g} Hz are {int(rig.time / rig.sampling)} samples, and a plan needs "
            f"{FEWEST}; give more --time or a faster --sampling"
        )
    if rig.time * rig.speed < 32.0 * rig.stroke:
        raise TirelabError(
            f"in {rig.time:g} s at {1e3 * rig.speed:g} mm/s the rig moves {plain(1e3 * rig.time * rig.speed, 3)} mm, "
            f"less than 16 cycles of {1e3 * rig.stroke:g} mm; give more --time, a smaller --stroke or a faster --speed"
        )
    return rig


def _content(file: Path) -> dict[str, Any]:
    try:
        content = parse_toml(file.read_text(encoding="utf-8"))
    except OSError as error:
        raise TirelabError(f"{file}: {error.strerror or error}; check the path") from None
    except (ValueError, RecursionError) as error:
        raise TirelabError(f'{file} is not TOML ({error}); write for instance stroke = "20 mm"') from None
    for key in content:
        if key not in KEYS:
            raise TirelabError(f"{file}: {key!r} is not known here; the keys are {', '.join(KEYS)}")
    return content


def _example(where: str) -> str:
    return _EXAMPLES[where.rpartition(" ")[2].removeprefix("--")]


def _quantity(unit: str) -> Callable[[str, Any], float]:
    def read(where: str, text: Any) -> float:
        example = _example(where).partition(",")[0]
        found = NUMBER.fullmatch(text) if isinstance(text, str) else None
        if found is None or not found[2]:
            raise TirelabError(f"{where}: {text!r} is not a number with a unit; write for instance {example}")
        try:
            value = float(conversion(found[2], unit).to_si(np.array([float(found[1])]))[0])
        except UnitError as error:
            raise TirelabError(f"{where}: {text!r}: {error}") from None
        if not 0.0 < value < math.inf:
            raise TirelabError(f"{where}: {text!r} is not positive; write for instance {example}")
        return value

    return read


def _several(one: Callable[[str, Any], float]) -> Callable[[str, Any], tuple[float, ...]]:
    def read(where: str, given: Any) -> tuple[float, ...]:
        values = given.split(",") if isinstance(given, str) else given
        if not isinstance(values, list) or not values:
            raise TirelabError(f"{where}: {given!r} is no list; write for instance {_example(where)}")
        return tuple(dict.fromkeys(one(where, value) for value in values))

    return read


def _radius(where: str, text: Any) -> float:
    try:
        return parse_radius(text.strip() if isinstance(text, str) else text)
    except (UnitError, TypeError, AttributeError) as error:
        raise TirelabError(f"{where}: {error}") from None


def _interval(where: str, text: Any) -> float:
    try:
        return parse_interval(text)
    except UnitError as error:
        raise TirelabError(f"{where}: {error}") from None


_READERS: dict[str, Callable[[str, Any], Any]] = {
    "stroke": _quantity("m"),
    "speed": _quantity("m/s"),
    "surfaces": _several(_radius),
    "pressures": _several(_quantity("Pa")),
    "time": _quantity("s"),
    "sampling": _interval,
    "noise": _quantity("N"),
    "force": _quantity("N"),
}
