"""Check an FMU with fmutool: argv = FMU; prints what the toolbox says of it."""

import sys

from fmutool.checker import OperationGenericCheck
from fmutool.fmu_operations import FMU, OperationSummary

fmu = FMU(sys.argv[1])
fmu.apply_operation(OperationGenericCheck())
fmu.apply_operation(OperationSummary())
