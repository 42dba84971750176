"""The baseline tire: from the rig's table to a tire of the tool."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any

from radialtire import Hull1996, Recalibrated, TireModel

from ..errors import TirelabError

COEFFICIENT_TOLERANCE = 1e-9
"""Relative difference up to which the rig's A and B count as those of the article's law."""


def baseline_tire(content: Mapping[str, Any]) -> TireModel:
    """Return the tire of the rig's `{"law": ..., "surfaces": [{"radius [cm]", "A" [N/cm^B], "B" [1]}, ...]}`.

    "hull1996" is the article's tire. "table" is the article's law refitted on every surface of the table, so that
    A and B there are the table's own: a = ln(A / A0), b = B - B0 (see `radialtire.recalibrated`).
    Raises TirelabError for another law, and where the rig's article has other coefficients than ours.
    """
    article = Hull1996()
    rows = [(_radius(row["radius [cm]"]), float(row["A"]), float(row["B"])) for row in content["surfaces"]]
    if content["law"] == "hull1996":
        for radius, A, B in rows:
            ours = article.coefficients(radius)
            if not all(
                math.isclose(x, y, rel_tol=COEFFICIENT_TOLERANCE) for x, y in zip((A, B), ours, strict=True)
            ):
                raise TirelabError(
                    f"the rig's article has A = {A:g}, B = {B:g} at the radius {radius:g} m, ours {ours[0]:g} and "
                    f"{ours[1]:g}; one of the two has a wrong reading of the print"
                )
        return TireModel()
    if content["law"] != "table":
        raise TirelabError(
            f"the rig's baseline tire has the law {content['law']!r}; known are 'hull1996' and 'table'"
        )
    changes = []
    for radius, A, B in rows:
        A0, B0 = article.coefficients(radius)
        changes.append((radius, math.log(A / A0), B - B0))
    return TireModel(
        law=Recalibrated(article, tuple(changes)),
        tested_range=None,
        name="A and B surface by surface",
        source="identified on the rig of the proof, before anything was hidden",
    )


def _radius(centimetres: float | str) -> float:
    return math.inf if centimetres == "inf" else float(centimetres) / 100.0
