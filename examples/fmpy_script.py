"""Press the tire FMU 2 cm onto flat ground within a second, and print its force; built first where it is not there."""

from pathlib import Path

import numpy as np
from fmpy import simulate_fmu
from radialtire import TireModel
from tirelab.fmu.build import build_fmu

fmu = Path("dist/BicycleTire.fmu")
if not fmu.exists():
    build_fmu(TireModel(), fmu.parent)
columns = [("time", float), ("deflection", float), ("surface_radius", float)]
press = np.array([(0.0, 0.0, 1e5), (1.0, 0.02, 1e5)], dtype=columns)
names = ["deflection", "radial_force"]
STEP = 0.1
# fmpy sets an input where a step begins and holds it to the step's end: each row shows the input of one step before.
rows = simulate_fmu(fmu, input=press, output=names, stop_time=1.0 + STEP, output_interval=STEP)
for time, deflection, force in rows[1:]:
    print(f"{time - STEP:.1f} s: {100.0 * deflection:.2f} cm, {force:.1f} N")
