"""Time fmpy's low-level calls on two unpacked FMUs in turns: argv = FMU, reference; prints the ratio of the best."""

import sys
from time import perf_counter

for name in ("radialtire", "tirelab", "bicycle_tire_fmu"):
    sys.modules[name] = None  # importing them from here on is an ImportError

from fmpy.fmi2 import FMU2Slave


def opened(folder):
    slave = FMU2Slave(guid="", unzipDirectory=folder, modelIdentifier="BicycleTire", instanceName="tire")
    slave.instantiate()
    slave.setupExperiment()
    slave.enterInitializationMode()
    slave.exitInitializationMode()
    return slave


def seconds(slave, count=400):
    start = perf_counter()
    for i in range(count):
        slave.setReal([0, 1], [0.01, 0.254])
        slave.doStep(0.01 * i, 0.01)
        slave.getReal([2])
    return perf_counter() - start


tire, reference = opened(sys.argv[1]), opened(sys.argv[2])
turns = [
    (seconds(tire), seconds(reference)) for _ in range(40)
]  # the best: a busy machine only adds to a time
print(min(t for t, _ in turns) / min(r for _, r in turns))
