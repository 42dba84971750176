"""Terrain to tire: a ground profile becomes deflection and average surface radius at every moment of a ride.

    Profile -> ground_from -> Ground -> ride (or rolling_path, contact) -> Ride with its limits -> draw_ride

A profile comes from a file (`read_profile`), from ISO 8608 (`iso8608`), from functions (`flat`, `sine`,
`from_function`), with obstacles put on it (`place`).
"""

from radialtire.hull1996 import WHEEL_RADIUS

from .contact import Contact, contact, hub_positions, reach, rolling_path
from .curvature import Ground, ground_from
from .iso8608 import iso8608
from .limits import DOUBTS, Limit, LimitReport
from .obstacles import OBSTACLES, Obstacle, kerb, log, place, root, rut, stick, whoops
from .picture import animate_ride, draw_ride
from .profile import Profile, flat, from_function, sine
from .profile_file import ProfileColumns, add_roughness, read_gpx, read_profile, read_profile_csv
from .ride import HubPath, Ride, TireForce, constant_load_path, force_at, law_force, ride
from .ride_file import write_ride

__all__ = [
    "DOUBTS",
    "OBSTACLES",
    "WHEEL_RADIUS",
    "Contact",
    "Ground",
    "HubPath",
    "Limit",
    "LimitReport",
    "Obstacle",
    "Profile",
    "ProfileColumns",
    "Ride",
    "TireForce",
    "add_roughness",
    "animate_ride",
    "constant_load_path",
    "contact",
    "draw_ride",
    "flat",
    "force_at",
    "from_function",
    "ground_from",
    "hub_positions",
    "iso8608",
    "kerb",
    "law_force",
    "log",
    "place",
    "reach",
    "read_gpx",
    "read_profile",
    "read_profile_csv",
    "ride",
    "rolling_path",
    "root",
    "rut",
    "sine",
    "stick",
    "whoops",
    "write_ride",
]
