"""A ride in libcosim, the Open Simulation Platform's master: it runs the two FMUs side by side.

    python examples/quarter_bicycle/ride_with_libcosim.py dist/QuarterBicycle.ssp --out ride.csv

writes a row per step. It needs libcosimpy alone (pip install libcosimpy).
"""

from __future__ import annotations

import argparse
import csv
import sys

from libcosimpy.CosimExecution import CosimExecution
from libcosimpy.CosimLogging import CosimLogLevel, log_output_level
from libcosimpy.CosimObserver import CosimObserver

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
    log_output_level(CosimLogLevel.WARNING)
    nanoseconds = round(1e6 * options.step)
    execution = CosimExecution.from_ssp_file(options.ssp, nanoseconds)
    observer = CosimObserver.create_last_value()
    execution.add_observer(observer)
    wanted = []
    for name, columns in COLUMNS.items():
        slave = execution.slave_index_from_instance_name(name)
        references = {v.name.decode(): v.reference for v in execution.slave_variables(slave)}
        wanted.append((slave, [references[column] for column in columns]))
    rows: list[list[object]] = [["time", *(column for columns in COLUMNS.values() for column in columns)]]
    for i in range(1, round(1e9 * options.duration / nanoseconds) + 1):
        execution.step()  # up to libcosimpy 0.0.4, the last for Python 3.10, this always returns False
        if execution.status().current_time != i * nanoseconds:
            sys.exit(f"libcosim could not step beyond {(i - 1) * nanoseconds * 1e-9:g} s")
        values = [
            value for slave, references in wanted for value in observer.last_real_values(slave, references)
        ]
        rows.append([i * nanoseconds / 1e9, *values])
    with open(options.out, "w", newline="", encoding="utf-8") as file:
        csv.writer(file).writerows(rows)
    print(options.out)


if __name__ == "__main__":
    main()
