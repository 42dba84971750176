"""Run an FMU with libcosimpy: argv = FMU; prints one force for each pair of inputs read from standard input."""

import json
import sys

from libcosimpy.CosimExecution import CosimExecution
from libcosimpy.CosimManipulator import CosimManipulator
from libcosimpy.CosimObserver import CosimObserver
from libcosimpy.CosimSlave import CosimLocalSlave

execution = CosimExecution.from_step_size(step_size=int(1e7))
slave = execution.add_local_slave(CosimLocalSlave(fmu_path=sys.argv[1], instance_name="tire"))
manipulator, observer = CosimManipulator.create_override(), CosimObserver.create_last_value()
execution.add_manipulator(manipulator)
execution.add_observer(observer)
references = {v.name.decode(): v.reference for v in execution.slave_variables(slave)}
inputs = [references["deflection"], references["surface_radius"]]
forces = []
for pair in json.load(sys.stdin):
    manipulator.slave_real_values(slave, inputs, pair)
    execution.step()
    forces.append(observer.last_real_values(slave, [references["radial_force"]])[0])
print("forces", json.dumps(forces))
