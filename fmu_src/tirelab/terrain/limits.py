"""Where on a ride the article's tire is used outside of its limits.

Each limit is a sentence of the article, or the range it tested, made measurable:

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
- deflection or force beyond those tested;
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
from radialtire.hull1996 import (
    CONCAVE_RADIUS_RANGE,
    CONVEX_RADIUS_RANGE,
    DEFLECTION_MAX,
    FORCE_MAX,
    WHEEL_RADIUS,
)

from .contact import Contact
from .profile import Floats

EDGE_TURN = math.radians(15.0)
"""A circle drawn with fewer than 24 points per half turn cannot be distinguished from a corner."""

SPREAD_LIMIT = 0.5
"""Largest spread q of the curvature in contact, and largest jump in the same measure."""

LIGHT_DEFLECTION = 1e-3
"""Deflection [m] of a contact that is still worth resolving: 20 N by the article's law."""


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


DOUBTS = Limit(sum(Limit)) & ~Limit.AIRBORNE
"""The limits beyond which the model is not to be trusted: all of them but the wheel in the air."""

MEANING = {
    Limit.SHARP_EDGE: "sharp edge in contact (radius below 1.27 cm, or a corner)",
    Limit.DISCONTINUOUS_RADIUS: "radius of curvature jumps within the contact",
    Limit.CHANGING_RADIUS: "radius of curvature changes quickly within the contact",
    Limit.TIGHT_CONCAVE: "concave radius tighter than the 38.1 cm tested, near the wheel's own",
    Limit.SEVERAL_CONTACTS: "several contacts at once",
    Limit.DEFLECTION_UNTESTED: "deflection beyond the 3.175 cm tested",
    Limit.FORCE_UNTESTED: "force beyond the 2240 N tested",
    Limit.COARSE_GROUND: "ground data coarser than the contact is long",
    Limit.AIRBORNE: "wheel off the ground (force zero)",
}


def limits(touch: Contact, radial_force: Floats, wheel_radius: float = WHEEL_RADIUS) -> NDArray[np.uint16]:
    """Return the bits of `Limit` at every moment of `touch` with its `radial_force` [N]; shape (n,)."""
    loaded = touch.deflection > 0.0
    effective = touch.curvature + 1.0 / wheel_radius
    light_contact = 2.0 * math.sqrt(2.0 * wheel_radius * LIGHT_DEFLECTION)
    room = SPREAD_LIMIT * np.maximum(effective, 0.0)
    tests = {
        Limit.SHARP_EDGE: (touch.curvature_max > 1.0 / CONVEX_RADIUS_RANGE[0]) | (touch.turn > EDGE_TURN),
        Limit.DISCONTINUOUS_RADIUS: touch.curvature_jump > room,
        Limit.CHANGING_RADIUS: touch.curvature_max - touch.curvature_min > room,
        Limit.TIGHT_CONCAVE: touch.curvature < 1.0 / CONCAVE_RADIUS_RANGE[1],
        Limit.SEVERAL_CONTACTS: touch.zones > 1,
        Limit.DEFLECTION_UNTESTED: touch.deflection > DEFLECTION_MAX,
        Limit.FORCE_UNTESTED: radial_force > FORCE_MAX,
        Limit.COARSE_GROUND: touch.resolution > np.maximum(touch.section_length, light_contact),
    }
    bits = np.where(loaded, 0, Limit.AIRBORNE.value).astype(np.uint16)
    for limit, met in tests.items():
        bits |= np.where(loaded & met, limit.value, 0).astype(np.uint16)
    return bits


@dataclass(frozen=True)
class LimitReport:
    """How much of a ride lay beyond each limit: shares of its moments, 0 to 1."""

    shares: tuple[tuple[Limit, float], ...]
    doubtful: float
    length: float

    def share(self, limit: Limit) -> float:
        """Return the share of the ride beyond `limit`."""
        return dict(self.shares)[limit]

    def sentences(self) -> tuple[str, ...]:
        """Return the sentences for the user, the most frequent limit first; one sentence where there is none."""
        met = sorted((s for s in self.shares if s[1] > 0.0), key=lambda s: -s[1])
        if not met:
            return (f"The article's model holds along all of the {self.length:.1f} m ridden.",)
        head = (
            f"The article's model cannot be trusted along {percent(self.doubtful)} of the {self.length:.1f} m ridden:"
            if self.doubtful > 0.0
            else f"The article's model holds along all of the {self.length:.1f} m ridden."
        )
        return (head, *(f"{percent(share)} {MEANING[limit]}" for limit, share in met))


def limit_report(bits: NDArray[np.uint16], length: float) -> LimitReport:
    """Return the report of a ride of `length` [m] whose moments carry `bits`."""
    shares = tuple((limit, float(np.mean((bits & limit.value) != 0))) for limit in Limit)
    return LimitReport(shares, float(np.mean((bits & DOUBTS.value) != 0)), length)


def percent(share: float) -> str:
    """Return `share` (0 to 1) as a percentage that never rounds a little to nothing."""
    if 0.0 < share < 0.0005:
        return "less than 0.1 %"
    return f"{100.0 * share:.1f} %"
