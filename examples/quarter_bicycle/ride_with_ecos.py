"""A ride in ecos, a co-simulation master in C++: it runs the two FMUs side by side.

    python examples/quarter_bicycle/ride_with_ecos.py dist/QuarterBicycle.ssp --out ride.csv

writes a row per step. It needs ecospy alone (pip install ecospy; on Linux with oneTBB, as of pip install tbb,
in LD_LIBRARY_PATH).
"""

from __future__ import annotations

import argparse
import csv
import os

from ecospy import EcosSimulation

COLUMNS = {
    "QuarterBicycle": (
        "deflection",
        "surface_radius",
        "mass_height",
        "mass_velocity",
        "hub_height",
        "hub_velocity",
    ),
    "BicycleTire": ("radial_force",),
}


def main() -> None:
    """Run the ride and write it."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("ssp")
    parser.add_argument("--out", default="ride.csv", help="the CSV to write")
    parser.add_argument("--step", type=float, default=0.5, help="step [ms]")
    parser.add_argument("--duration", type=float, default=0.3, help="duration [s]")
    options = parser.parse_args()
    step = 1e-3 * options.step
    rows: list[list[object]] = [["time", *(column for columns in COLUMNS.values() for column in columns)]]
    with EcosSimulation(step_size=step, ssp_path=options.ssp) as simulation:
        simulation.init(
            parameter_set="coupling"
        )  # the archive's look-ahead: ecos takes a set only if it is named
        for _ in range(round(options.duration / step)):
            time = simulation.step()
            values = [
                simulation.get_real(f"{name}::{c}") for name, columns in COLUMNS.items() for c in columns
            ]
            rows.append([time, *values])
        simulation.terminate()
    with open(options.out, "w", newline="", encoding="utf-8") as file:
        csv.writer(file).writerows(rows)
    print(options.out, flush=True)


if __name__ == "__main__":
    main()
    # At the usual exit oneTBB may unload libtbbbind while it still frees what libhwloc told it: a crash at times.
    os._exit(0)
