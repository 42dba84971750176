"""Run an FMU with PyFMI: argv = FMU, "CS" or "ME"; prints one force for each pair of inputs read from standard input.

In Model Exchange the inputs are those of a solver, in Continuous-Time Mode.
"""

import json
import sys

for name in ("radialtire", "tirelab", "bicycle_tire_fmu", "fmu_description", "concealed"):
    sys.modules[name] = None  # importing them from here on is an ImportError

import pyfmi

model = pyfmi.load_fmu(sys.argv[1], kind=sys.argv[2], log_level=2)
exchange = sys.argv[2] == "ME"
model.initialize(start_time=0.0)
if exchange:
    model.event_update()
    model.enter_continuous_time_mode()
forces, step = [], 0.01
for number, (deflection, radius) in enumerate(json.load(sys.stdin)):
    model.set(["deflection", "surface_radius"], [deflection, radius])
    if exchange:
        model.time = step * (number + 1)
        model.completed_integrator_step()
    else:
        assert model.do_step(step * number, step) == 0
    forces.append(float(model.get("radial_force")[0]))
print("forces", json.dumps(forces))
