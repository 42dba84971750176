"""Terrain to tire: a ground profile becomes deflection and average surface radius at every moment of a ride.

    Profile -> ground_from -> Ground -> ride (or rolling_path, contact) -> Ride with its limits -> draw_ride

A profile comes from a file (`read_profile`), from ISO 8608 (`iso8608`), from functions (`flat`, `sine`,
`from_function`), with obstacles put on it (`place`).
"""

from .curvature import Ground, ground_from
from .profile import Profile, flat, from_function, sine

__all__ = [
    "Ground",
    "Profile",
    "flat",
    "from_function",
    "ground_from",
    "sine",
]
