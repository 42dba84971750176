"""Let a mass ring on an unpacked native FMU in CasADi, in Model Exchange with the FMU's own derivatives.

Argument: the folder; standard input: {"mass": kg, "weight": N, "start": m, "times": [s]}. Prints CasADi's version, the
force and its derivative by the deflection at the start, and the deflections at the times.
"""

import json
import sys

for name in ("radialtire", "tirelab", "bicycle_tire_fmu", "fmu_description", "concealed"):
    sys.modules[name] = None  # importing them from here on is an ImportError

import casadi

job = json.load(sys.stdin)
unit = casadi.DaeBuilder("tire", sys.argv[1], {"debug": False})
unit.set_causality("in_tested_range", "local")  # CasADi reads outputs as Reals
law = unit.create("law", ["u", "p"], ["y"])
parameters = [unit.attribute("start", name) for name in unit.p()]
inputs = [job["start"], 1e5]
force = float(law(inputs, parameters)[0])
slope = float(law.jacobian()(inputs, parameters, 0)[0][0, 0])
by_coefficient = float(law.jacobian()(inputs, parameters, 0)[1][0, 0])

state = casadi.MX.sym("state", 2)
pushed = law(casadi.vertcat(state[0], 1e5), parameters)[0]
motion = {"x": state, "ode": casadi.vertcat(state[1], (job["weight"] - pushed) / job["mass"])}
accuracy = {"abstol": 1e-12, "reltol": 1e-12}
ring = casadi.integrator("ring", "cvodes", motion, 0, job["times"], accuracy)
deflections = ring(x0=[job["start"], 0])["xf"][0, :].full().ravel().tolist()
print(
    json.dumps(
        {
            "version": casadi.__version__,
            "force": force,
            "slope": slope,
            "by_coefficient": by_coefficient,
            "deflections": deflections,
        }
    )
)
