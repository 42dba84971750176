"""Let the wheel hop over flat ground in Model Exchange: fmpy's CVode finds where contact ends and begins again."""

from pathlib import Path

import numpy as np
from fmpy import simulate_fmu
from radialtire import TireModel
from tirelab.fmu.native.pack import build_native_fmu

fmu = build_native_fmu(TireModel(), Path("dist/native")).path
columns = [("time", float), ("deflection", float), ("surface_radius", float)]
time = np.linspace(0.0, 1.0, 1001)
hop = np.rec.fromarrays([time, 0.01 * np.cos(2.0 * np.pi * time), np.full(time.size, 1e5)], dtype=columns)
rows = simulate_fmu(
    fmu,
    fmi_type="ModelExchange",
    input=hop,
    output=["deflection", "radial_force"],
    stop_time=1.0,
    output_interval=0.05,
)
for now, deflection, force in rows:
    contact = "contact begins or ends" if abs(deflection) < 1e-6 else ""
    print(f"{now:.4f} s: {1000.0 * deflection:6.2f} mm, {force:6.1f} N {contact}".rstrip())
