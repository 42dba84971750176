"""What is outside the catalogue and leaves the same in a recording as an effect that was named, and what tells it."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from radialtire import CATALOGUE
from radialtire.effect import LookAlike

from ..names import REFITTED_LAW
from . import titles

OF_LAW = LookAlike(
    "a load cell or a gauge with another gain", "hang a known weight on it, measure a known travel"
)


def look_alike_of(name: str) -> LookAlike | None:
    """Return what looks like an effect or the refitted law and is in no catalogue; None where nothing is known."""
    if name == REFITTED_LAW:
        return OF_LAW
    return CATALOGUE[name].look_alike if name in CATALOGUE else None


def look_alikes(verdict: Mapping[str, Any]) -> list[tuple[str, str, str]]:
    """Return of each effect of a verdict its title, what looks like it outside the catalogue, and what tells it.

    verdict: of diagnosis.json
    """
    names = [effect["name"] for effect in verdict["effects"]]
    known = [(name, other) for name in names if (other := look_alike_of(name)) is not None]
    return [(titles.short_title(name), other.what, other.check) for name, other in known]
