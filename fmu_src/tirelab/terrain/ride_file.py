"""A ride as a CSV file."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from ..errors import TirelabError
from .ride import Ride


def write_ride(result: Ride, path: str | Path) -> None:
    """Write `result` to `path` as CSV, units in the header, `limits` as the bits of `Limit`."""
    columns = {
        "time [s]": result.time,
        "position [m]": result.contact.position,
        "hub_height [m]": result.contact.hub_height,
        "deflection [m]": result.contact.deflection,
        "surface_radius [m]": result.contact.surface_radius,
        "radial_force [N]": result.radial_force,
        "vertical_force [N]": result.vertical_force,
        "limits": result.limits.astype(np.float64),
    }
    try:
        np.savetxt(
            path, np.column_stack(list(columns.values())), "%.9g", ",", header=",".join(columns), comments=""
        )
    except OSError as error:
        raise TirelabError(f"{path}: {error.strerror or error}; name a file that can be written") from None
