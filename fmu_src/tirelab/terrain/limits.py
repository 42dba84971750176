"""Where on a ride a tire is used outside of its limits.

Each limit is a sentence of the article, or the range in which the tire was tested, made measurable:

- sharp edges, which the model "cannot predict": in contact the ground is convex with less than the smallest radius
  tested, or it turns by more than EDGE_TURN within the shortest length the data can show;
- discontinuous radius, likewise: the curvature jumps by more than half the effective curvature within that length;
- quickly changing radius, where "the greatest inaccuracies" occur: the spread

      q = (largest - smallest curvature in contact) / (mean curvature + 1 / R_w)

  is above 0.5. The denominator is the curvature of the gap between wheel and ground, which sets how long the contact
  is. At q = 0.5 the article's law (5a to 6b as printed), evaluated with the curvature at either end of such a contact,
  differs from its value with the mean by up to 13.2 %: as much as the article's own error bound, 13.5 %. (With the
  second reading of 5a, E0 = 0.02519 /cm, by up to 19 %.)
- concave radii near the wheel's own: the mean is tighter than the tightest dip tested;
- several contacts at once: more than one stretch of ground inside the wheel's circle, while the law was measured with
  one;
- deflection or force beyond those tested, or a mean curvature outside those tested that is none of the above;
- coarse ground, ours: the contact, or one of 1 mm of deflection on flat ground, is shorter than the data can show, so
  bumps of the tire's size are not in the file.

In the air the force is zero and certain: that fraction of the ride is stated beside the limits.

Reference: M. L. Hull, E. L. Wang, D. F. Moore, "An empirical model for determining the radial force-deflection behavior
of off-road bicycle tires", Cycling Science, Spring 1996.
"""

from __future__ import annotations

import enum
import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from radialtire import FLAT_RADIUS, TestedRange
from radialtire.hull1996 import WHEEL_RADIUS

from ..names import plain
from .contact import Contact
from .profile import Floats

EDGE_TURN = math.radians(15.0)
"""A circle drawn with fewer than 24 points per half turn cannot be distinguished from a corner."""

SPREAD_LIMIT = 0.5
"""Largest spread q of the curvature in contact, and largest jump in the same measure."""

LIGHT_DEFLECTION = 1e-3
"""Deflection [m] of a contact that is still worth resolving: 20 N by the article's law."""

FLATNESS = 0.01
"""Ground whose curvature is this share of the wheel's is flat for it: the gap between them is as much the same."""

ARTICLES = TestedRange()
"""Where the article's tire was tested; the limits of the model itself are known from there alone."""


class Limit(enum.IntFlag):
    """What is doubtful about one moment of a ride; the bits of `Ride.limits`."""

    SHARP_EDGE = enum.auto()
    DISCONTINUOUS_RADIUS = enum.auto()
    CHANGING_RADIUS = enum.auto()
    TIGHT_CONCAVE = enum.auto()
    SEVERAL_CONTACTS = enum.auto()
    DEFLECTION_UNTESTED = enum.auto()
    FORCE_UNTESTED = enum.auto()
    COARSE_GROUND = enum.auto()
    AIRBORNE = enum.auto()
    SURFACE_UNTESTED = enum.auto()


DOUBTS = Limit(sum(Limit)) & ~Limit.AIRBORNE
"""The limits beyond which the model is not to be trusted: all of them but the wheel in the air."""


def meanings(tested: TestedRange) -> dict[Limit, str]:
    """Return what is said of a ride beyond each limit of a tire with the range `tested`."""
    convex, concave = 100.0 / _sharpest(tested), -100.0 / _tightest(tested)
    deepest, strongest = f"{plain(100.0 * tested.deflection_max, 4)} cm", f"{tested.force_max:.0f} N"
    return {
        Limit.SHARP_EDGE: f"sharp edge in contact (radius below {plain(convex, 3)} cm, or a corner)",
        Limit.DISCONTINUOUS_RADIUS: "radius of curvature jumps within the contact",
        Limit.CHANGING_RADIUS: "radius of curvature changes quickly within the contact",
        Limit.TIGHT_CONCAVE: f"concave radius tighter than the {plain(concave, 3)} cm tested, near the wheel's own",
        Limit.SEVERAL_CONTACTS: "several contacts at once",
        Limit.DEFLECTION_UNTESTED: f"deflection beyond the {deepest} tested",
        Limit.FORCE_UNTESTED: f"force beyond the {strongest} tested",
        Limit.COARSE_GROUND: "ground data coarser than the contact is long",
        Limit.AIRBORNE: "wheel off the ground (force zero)",
        Limit.SURFACE_UNTESTED: f"ground of other curvature than that tested, {_surfaces(tested)}",
    }


def limits(
    touch: Contact,
    radial_force: Floats,
    wheel_radius: float = WHEEL_RADIUS,
    tested: TestedRange | None = ARTICLES,
) -> NDArray[np.uint16]:
    """Return the bits of `Limit` at every moment of `touch` with its `radial_force` [N]; shape (n,).

    tested: where the tire was measured; where that is not known (None) the article's range counts
    """
    tested = ARTICLES if tested is None else tested
    loaded = touch.deflection > 0.0
    effective = touch.curvature + 1.0 / wheel_radius
    light_contact = 2.0 * math.sqrt(2.0 * wheel_radius * LIGHT_DEFLECTION)
    room = SPREAD_LIMIT * np.maximum(effective, 0.0)
    sharp = (touch.curvature_max > _sharpest(tested)) | (touch.turn > EDGE_TURN)
    tight = touch.curvature < _tightest(tested)
    mean = np.where(np.abs(touch.curvature) < FLATNESS / wheel_radius, 0.0, touch.curvature)
    untested = (mean < tested.curvature_min) | (mean > tested.curvature_max)
    tests = {
        Limit.SHARP_EDGE: sharp,
        Limit.DISCONTINUOUS_RADIUS: touch.curvature_jump > room,
        Limit.CHANGING_RADIUS: touch.curvature_max - touch.curvature_min > room,
        Limit.TIGHT_CONCAVE: tight,
        Limit.SEVERAL_CONTACTS: touch.zones > 1,
        Limit.DEFLECTION_UNTESTED: touch.deflection > tested.deflection_max,
        Limit.FORCE_UNTESTED: radial_force > tested.force_max,
        Limit.COARSE_GROUND: touch.resolution > np.maximum(touch.section_length, light_contact),
        Limit.SURFACE_UNTESTED: untested & ~sharp & ~tight,
    }
    bits = np.where(loaded, 0, Limit.AIRBORNE.value).astype(np.uint16)
    for limit, met in tests.items():
        bits |= np.where(loaded & met, limit.value, 0).astype(np.uint16)
    return bits


def _sharpest(tested: TestedRange) -> float:
    """Return the convex curvature [1/m] beyond which the ground is an edge: the article's, or one tested beyond it."""
    return max(tested.curvature_max, ARTICLES.curvature_max)


def _tightest(tested: TestedRange) -> float:
    """Return the concave curvature [1/m] beyond which a dip is tight: the article's, or one tested beyond it."""
    return min(tested.curvature_min, ARTICLES.curvature_min)


def _surfaces(tested: TestedRange) -> str:
    """Return on which surfaces a tire was tested: "flat", "flat to 25.4 cm convex"."""
    ends = []
    for curvature in (tested.curvature_min, tested.curvature_max):
        flat = abs(curvature) * FLAT_RADIUS <= 1.0 + 1e-6
        side = "convex" if curvature > 0.0 else "concave"
        ends.append("flat" if flat else f"{plain(100.0 / abs(curvature), 4)} cm {side}")
    return " to ".join(dict.fromkeys(ends))


@dataclass(frozen=True)
class LimitReport:
    """How much of a ride lay beyond each limit: shares of its moments, 0 to 1.

    tested: where the tire was measured, None where that is not known: then the article's range counts
    """

    shares: tuple[tuple[Limit, float], ...]
    doubtful: float
    length: float
    tested: TestedRange | None = ARTICLES

    def share(self, limit: Limit) -> float:
        """Return the share of the ride beyond `limit`."""
        return dict(self.shares)[limit]

    def sentences(self) -> tuple[str, ...]:
        """Return the sentences for the user, the most frequent limit first; one sentence where there is none."""
        met = sorted((s for s in self.shares if s[1] > 0.0), key=lambda s: -s[1])
        beyond = (
            f"cannot be trusted along {percent(self.doubtful)}" if self.doubtful > 0.0 else "holds along all"
        )
        end = ":" if self.doubtful > 0.0 else "."
        told = meanings(ARTICLES if self.tested is None else self.tested)
        head = f"{self._model()} {beyond} of the {self.length:.1f} m ridden{end}"
        return (head, *(f"{percent(share)} {told[limit]}" for limit, share in met))

    def _model(self) -> str:
        """Return what is trusted or not, with where it was measured if that is not the article's range."""
        if self.tested is None:
            return "Where this tire was measured is not known; by the article's limits its model"
        if self.tested == ARTICLES:
            return "The article's model"
        to = f"{plain(100.0 * self.tested.deflection_max, 4)} cm and {self.tested.force_max:.0f} N"
        return f"This tire was measured to {to} on ground that is {_surfaces(self.tested)}; its model"


def limit_report(
    bits: NDArray[np.uint16], length: float, tested: TestedRange | None = ARTICLES
) -> LimitReport:
    """Return the report of a ride of `length` [m] whose moments carry `bits`; tested: as for `limits`."""
    shares = tuple((limit, float(np.mean((bits & limit.value) != 0))) for limit in Limit)
    return LimitReport(shares, float(np.mean((bits & DOUBTS.value) != 0)), length, tested)


def percent(share: float) -> str:
    """Return `share` (0 to 1) as a percentage that never rounds a little to nothing."""
    if 0.0 < share < 0.0005:
        return "less than 0.1 %"
    return f"{100.0 * share:.1f} %"
