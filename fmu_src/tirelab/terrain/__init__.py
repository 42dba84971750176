"""Terrain to tire: a ground profile becomes deflection and average surface radius at every moment of a ride.

    Profile -> ground_from -> Ground -> ride (or rolling_path, contact) -> Ride with its limits -> draw_ride

A profile comes from a file (`read_profile`), from ISO 8608 (`iso8608`), from functions (`flat`, `sine`,
`from_function`), with obstacles put on it (`place`).
"""

from .curvature import Ground, ground_from
from .iso8608 import iso8608
from .obstacles import OBSTACLES, Obstacle, kerb, log, place, root, rut, stick, whoops
from .profile import Profile, flat, from_function, sine
from .profile_file import add_roughness, read_gpx, read_profile, read_profile_csv

__all__ = [
    "OBSTACLES",
    "Ground",
    "Obstacle",
    "Profile",
    "add_roughness",
    "flat",
    "from_function",
    "ground_from",
    "iso8608",
    "kerb",
    "log",
    "place",
    "read_gpx",
    "read_profile",
    "read_profile_csv",
    "root",
    "rut",
    "sine",
    "stick",
    "whoops",
]
