"""Run an FMU with ecospy: argv = FMU (or a proxyfmu URI); prints a force for each pair of inputs on standard input."""

import json
import os
import sys

from ecospy import EcosSimulation, EcosSimulationStructure

forces = []
with EcosSimulationStructure() as structure:
    structure.add_model("tire", sys.argv[1])
    with EcosSimulation(structure=structure, step_size=0.01) as simulation:
        simulation.init()
        for deflection, surface_radius in json.load(sys.stdin):
            simulation.set_real("tire::deflection", deflection)
            simulation.set_real("tire::surface_radius", surface_radius)
            simulation.step()
            forces.append(simulation.get_real("tire::radial_force"))
        simulation.terminate()
print("forces", json.dumps(forces), flush=True)
os._exit(0)  # see examples/quarter_bicycle/ride_with_ecos.py
