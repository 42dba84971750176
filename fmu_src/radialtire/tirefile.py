"""A tire as a file: JSON that says law, effects, tested range and where the numbers come from.

    {"schema": 1, "name": "...", "source": "...",
     "law": {"name": "power_law", "parameters": {"coefficient": 718.5, "exponent": 1.4}},
     "effects": [{"name": "viscous_damping", "parameters": {"damping": 300.0}}],
     "reading_noise": 8e-6,
     "tested_range": {"curvature_min": -2.62, "curvature_max": 78.7, "deflection_max": 0.0318, "force_max": 2240.0}}

A parameter that is not given has its start value; an unknown name is an error, never passed over. `tested_range` may be
null: then it is not known. `reading_noise` [m], 0 where it is not given, is that of `TireModel`. A learned remainder,
where somebody asked for one, is under `learned_remainder` with `by`, `at`, `force` and, over the force, `law`. A
two-sided part may have a `curve` with `at` [m] and `force` [N].
"""

from __future__ import annotations

import json
import math
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import asdict, fields, replace
from pathlib import Path
from typing import Any

from .curvature_law import CurvatureLaw
from .effect import PLACES
from .effects import CATALOGUE
from .hull1996 import Hull1996
from .learned_remainder import LearnedRemainder
from .model import PRELOAD_FORCE, READING_NOISE, Law, TestedRange, TireModel
from .parameter import Parameter, ParameterError
from .part_curve import PartCurve
from .power_law import PowerLaw
from .recalibrated import Recalibrated

SCHEMA = 1

LAWS: dict[str, type[Hull1996] | type[PowerLaw] | type[CurvatureLaw]] = {
    law.name: law for law in (Hull1996, PowerLaw, CurvatureLaw)
}


class TireFileError(ValueError):
    """A tire file that cannot be used; the sentence says where and what to do."""


def read_tire(path: str | Path) -> TireModel:
    """Return the tire of the file at `path`, or raise TireFileError."""
    try:
        text = Path(path).read_text(encoding="utf-8")
    except OSError as error:
        raise TireFileError(f"{path}: {error.strerror or error}; name a tire file that can be read") from None
    except UnicodeDecodeError:
        raise TireFileError(f"{path}: not UTF-8 text; a tire file is JSON in UTF-8") from None
    try:
        return from_text(text)
    except TireFileError as error:
        raise TireFileError(f"{path}: {error}") from None


def write_tire(tire: TireModel, path: str | Path) -> None:
    """Write `tire` to the file at `path`; `read_tire` gives it back exactly.

    Raise TireFileError where its folder is not there.
    """
    try:
        Path(path).write_text(to_text(tire), encoding="utf-8")
    except FileNotFoundError:
        raise TireFileError(f"{path}: its folder is not there; make it, or name another") from None


def to_text(tire: TireModel) -> str:
    """Return `tire` as the text of a tire file."""
    effects = [
        {
            "name": effect.name,
            "parameters": {p.name: v for p, v in zip(effect.parameters, values, strict=True)},
        }
        for effect, values in tire.effects
    ]
    content = {
        "schema": SCHEMA,
        "name": tire.name,
        "source": tire.source,
        "law": _law_entry(tire.law),
        "effects": effects,
        "reading_noise": tire.reading_noise,
        "tested_range": None if tire.tested_range is None else asdict(tire.tested_range),
    }
    if tire.two_sided:
        content |= {"two_sided": True, "preload": tire.preload}
    if tire.curve is not None:
        content["curve"] = {"at": tire.curve.at, "force": tire.curve.force}
    if not tire.inflated:
        content |= {"inflated": False}
    if tire.remainder is not None:
        learned = tire.remainder
        law = {} if learned.law is None else {"law": _law_entry(learned.law)}
        content["learned_remainder"] = {"by": learned.by, "at": learned.at, "force": learned.force, **law}
    return json.dumps(content, indent=2, ensure_ascii=False) + "\n"


def from_text(text: str) -> TireModel:
    """Return the tire described by the text of a tire file, or raise TireFileError."""
    try:
        content = json.loads(text.removeprefix("\ufeff"), parse_int=_whole, object_pairs_hook=_once)
    except (json.JSONDecodeError, RecursionError) as error:
        raise TireFileError(f"not JSON ({error}); compare it with the tire files of the examples") from None
    known = {
        "schema",
        "name",
        "source",
        "law",
        "effects",
        "reading_noise",
        "tested_range",
        "two_sided",
        "preload",
        "inflated",
        "learned_remainder",
        "curve",
    }
    entry = _entry(content, "the tire", known, {"schema", "law"})
    if isinstance(entry["schema"], bool) or entry["schema"] != SCHEMA:
        raise TireFileError(
            f"schema {entry['schema']!r} is not {SCHEMA}; use the version that wrote the file"
        )
    try:
        tire = TireModel(
            law=_law(entry["law"]),
            effects=tuple(sorted(_effects(entry.get("effects", [])), key=lambda e: _order(e[0].name))),
            tested_range=_tested_range(entry.get("tested_range")),
            name=_text(entry, "name"),
            source=_text(entry, "source"),
            reading_noise=entry.get("reading_noise", 0.0),
            two_sided=_flag(entry, "two_sided", otherwise=False),
            inflated=_flag(entry, "inflated", otherwise=True),
            preload=entry.get("preload", 0.0),
            remainder=_remainder(entry.get("learned_remainder")),
            curve=_curve(entry.get("curve")),
        )
    except ParameterError as error:
        raise TireFileError(str(error)) from None
    _check_tested_range(tire)
    if tire.curve is not None and (giving := [e.name for e, _ in tire.effects if e.place == "series"]):
        raise TireFileError(
            f"{giving[0]} gives way to the force of the law, not to that of a curve: keep one of them"
        )
    return tire


def with_parameters(tire: TireModel, values: dict[str, float]) -> TireModel:
    """Return `tire` with the parameters of `values`, named as `parameters_of` names them, in place of its own.

    Raises ParameterError where one is not allowed, KeyError where there is none of that name.
    """
    of_law: dict[str, float] = {}
    of_effect: dict[str, dict[str, float]] = {}
    known = parameters_of(tire)
    own: dict[str, float] = {}
    for key, value in values.items():
        if key in (READING_NOISE.name, PRELOAD_FORCE.name):
            own[key] = known[key][0].checked(value)
            continue
        owner, name = key.split(".")
        with _owned_by(owner):
            known[key][0].checked(value)
        (of_law if owner == "law" else of_effect.setdefault(owner, {}))[name] = value
    effects = tuple(
        (e, tuple(of_effect.get(e.name, {}).get(p.name, v) for p, v in zip(e.parameters, old, strict=True)))
        for e, old in tire.effects
    )
    with _owned_by("law"):
        law = replace(tire.law, **of_law)  # type: ignore[type-var]
    return replace(tire, law=law, effects=effects, **own)  # type: ignore[arg-type]


def parameters_of(tire: TireModel) -> dict[str, tuple[Parameter, float]]:
    """Return every parameter of `tire` with its value, by the name `law.NAME` or `EFFECT.NAME`.

    Where an effect looks at rate or acceleration, `reading_noise` is one too: who knows the motion exactly sets 0.
    A two-sided part has its `preload`.
    """
    found = {f"law.{p.name}": (p, float(getattr(tire.law, p.name))) for p in tire.law.parameters}
    for effect, values in tire.effects:
        found |= {f"{effect.name}.{p.name}": (p, v) for p, v in zip(effect.parameters, values, strict=True)}
    if tire.differentiates:
        found[READING_NOISE.name] = (READING_NOISE, tire.reading_noise)
    if tire.two_sided:
        found[PRELOAD_FORCE.name] = (PRELOAD_FORCE, tire.preload)
    return found


@contextmanager
def _owned_by(owner: str) -> Iterator[None]:
    """Name the parameter in a ParameterError in full."""
    try:
        yield
    except ParameterError as error:
        raise ParameterError(f"{owner}.{error}") from None


def _whole(digits: str) -> float:
    """Return an integer of a file; one beyond every double is infinite, as 1e400 is, and so refused by its key."""
    number = float(digits)
    return int(digits) if math.isfinite(number) else number


def _once(pairs: list[tuple[str, Any]]) -> dict[str, Any]:
    """Return an object of a file whose entries are all named once."""
    found: dict[str, Any] = {}
    for key, value in pairs:
        if key in found:
            raise TireFileError(f"the entry {key!r} stands twice in one object; keep one of the two")
        found[key] = value
    return found


def _order(name: str) -> tuple[int, int]:
    return PLACES.index(CATALOGUE[name].place), list(CATALOGUE).index(name)


def _entry(value: Any, what: str, known: set[str], needed: set[str]) -> dict[str, Any]:
    if not isinstance(value, dict):
        raise TireFileError(f"{what} must be an object with {', '.join(sorted(needed))}, not {value!r}")
    for key in sorted(value.keys() - known):
        raise TireFileError(f"unknown entry {key!r} in {what}; known are {', '.join(sorted(known))}")
    for key in sorted(needed - value.keys()):
        raise TireFileError(f"no entry {key!r} in {what}; add it")
    return value


def _text(entry: dict[str, Any], key: str) -> str:
    value = entry.get(key, "")
    if not isinstance(value, str):
        raise TireFileError(f"{key} must be text, not {value!r}")
    return value


def _flag(entry: dict[str, Any], key: str, *, otherwise: bool) -> bool:
    value = entry.get(key, otherwise)
    if not isinstance(value, bool):
        raise TireFileError(f"{key} must be true or false, not {value!r}")
    return value


def _law_entry(law: Law) -> dict[str, Any]:
    if isinstance(law, Recalibrated):
        surfaces = [
            {
                "radius": radius if math.isfinite(radius) else "inf",
                "change": change,
                "exponent_change": exponent,
            }
            for radius, change, exponent in law.surfaces
        ]
        return {"name": law.name, "base": _law_entry(law.base), "surfaces": surfaces}
    return {"name": law.name, "parameters": {p.name: getattr(law, p.name) for p in law.parameters}}


def _recalibrated(value: Any) -> Recalibrated:
    entry = _entry(value, "the law", {"name", "base", "surfaces"}, {"name", "base", "surfaces"})
    if not isinstance(entry["surfaces"], list):
        raise TireFileError(f"surfaces must be a list, not {entry['surfaces']!r}")
    known = {"radius", "change", "exponent_change"}
    rows = []
    for item in entry["surfaces"]:
        row = dict(_entry(item, "a surface", known, known))
        row["radius"] = math.inf if row["radius"] == "inf" else row["radius"]
        for name, number in row.items():
            if isinstance(number, bool) or not isinstance(number, (int, float)) or number != number:
                raise TireFileError(f"{name} = {number!r} of a surface is not a number")
        if row["radius"] == 0:
            raise TireFileError("radius = 0 of a surface is not allowed; flat ground is inf")
        rows.append((float(row["radius"]), float(row["change"]), float(row["exponent_change"])))
    return Recalibrated(_law(entry["base"]), tuple(rows))


def _law(value: Any) -> Law:
    if isinstance(value, dict) and value.get("name") == Recalibrated.name:
        return _recalibrated(value)
    entry = _entry(value, "the law", {"name", "parameters"}, {"name"})
    if not isinstance(entry["name"], str) or entry["name"] not in LAWS:
        raise TireFileError(f"unknown law {entry['name']!r}; known are {', '.join(LAWS)}")
    law = LAWS[entry["name"]]
    return law(**_values(entry, law.name, law.parameters))


def _effects(value: Any) -> list[tuple[Any, tuple[float, ...]]]:
    if not isinstance(value, list):
        raise TireFileError(f"effects must be a list, not {value!r}")
    found = []
    for item in value:
        entry = _entry(item, "an effect", {"name", "parameters"}, {"name"})
        if not isinstance(entry["name"], str) or entry["name"] not in CATALOGUE:
            raise TireFileError(f"unknown effect {entry['name']!r}; known are {', '.join(CATALOGUE)}")
        effect = CATALOGUE[entry["name"]]
        values = _values(entry, effect.name, effect.parameters)
        found.append((effect, tuple(values[p.name] for p in effect.parameters)))
    return found


def _values(entry: dict[str, Any], owner: str, parameters: tuple[Parameter, ...]) -> dict[str, float]:
    given = entry.get("parameters", {})
    known = {p.name: p for p in parameters}
    given = _entry(given, f"the parameters of {owner}", set(known), set())
    return {name: p.checked(given.get(name, p.start)) for name, p in known.items()}


def _remainder(value: Any) -> LearnedRemainder | None:
    if value is None:
        return None
    needed = {"by", "at", "force"}
    entry = _entry(value, "learned_remainder", {*needed, "law"}, needed)
    rows = _points(entry, "learned_remainder")
    law: Any = None if entry.get("law") is None else _law(entry["law"])
    return LearnedRemainder(str(entry["by"]), rows[0], rows[1], law)


def _curve(value: Any) -> PartCurve | None:
    if value is None:
        return None
    needed = {"at", "force"}
    return PartCurve(*_points(_entry(value, "curve", needed, needed), "curve"))


def _points(entry: dict[str, Any], owner: str) -> tuple[tuple[float, ...], tuple[float, ...]]:
    rows = []
    for name in ("at", "force"):
        numbers = entry[name]
        if not isinstance(numbers, list) or any(
            isinstance(n, bool) or not isinstance(n, (int, float)) for n in numbers
        ):
            raise TireFileError(f"{name} of {owner} must be a list of numbers")
        rows.append(tuple(map(float, numbers)))
    return rows[0], rows[1]


def _tested_range(value: Any) -> TestedRange | None:
    if value is None:
        return None
    names = {field.name for field in fields(TestedRange)}
    entry = _entry(value, "tested_range", names, names)
    for name, number in entry.items():
        if isinstance(number, bool) or not isinstance(number, (int, float)) or not math.isfinite(number):
            raise TireFileError(f"tested_range {name} = {number!r} is not a finite number")
    return TestedRange(**{name: float(number) for name, number in entry.items()})


def _check_tested_range(tire: TireModel) -> None:
    """Raise TireFileError where nothing, or nothing that can be, lies in the tested range of a file."""
    tested = tire.tested_range
    if tested is None:
        return
    if tested.curvature_min > tested.curvature_max:
        raise TireFileError(
            f"tested_range curvature_min = {tested.curvature_min:g} is more than curvature_max = "
            f"{tested.curvature_max:g}; exchange the two"
        )
    if not tire.is_part:  # a part may have been pulled alone
        for name, number in (("deflection_max", tested.deflection_max), ("force_max", tested.force_max)):
            if number <= 0.0:
                raise TireFileError(f"tested_range {name} = {number:g} is not allowed; it must be above 0")
    if tested.deflection_max > tire.deflection_highest:
        raise TireFileError(
            f"tested_range deflection_max = {tested.deflection_max:g} m is not allowed; it must be at most "
            f"{tire.deflection_highest:g} m: is it in mm?"
        )
