"""Write the tire as an FMU: python build_fmu.py [--tire TIRE.json] [--out DIR] -> DIR/BicycleTire.fmu."""

from __future__ import annotations

import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent / "fmu_src"))

try:
    import tirelab.fmu.build  # noqa: F401 - what the command loads when it is used
    from tirelab.cli.build import command
except ModuleNotFoundError as error:
    sys.exit(
        f"Error: the package {error.name} is missing; install what tirelab needs: python -m pip install -e ."
    )

if __name__ == "__main__":
    command()
