#!/bin/sh
# Installs the hosts of the slow tests that Debian has: Wine for the DLL, qemu-user for aarch64. As root.
#
#     sh tests/tirelab/fmu/hosts/install.sh && pytest -m slow -n 0 tests/tirelab/fmu/native/test_equality.py
#
# The hosts in Python (fmpy, CasADi, libcosimpy, ecospy, fmutool) come with the extra `test`. Those of no registry (fmusim,
# the FMU Compliance Checker, FMI4cpp, OMSimulator, PyFMI with the FMI Library) have to be built from their repositories.
set -eu
if ! command -v apt-get >/dev/null; then
    echo "no apt-get here: install wine, qemu-user and the C library of aarch64 yourself" >&2
    exit 1
fi
apt-get update
apt-get install -y --no-install-recommends wine wine64 qemu-user libc6-arm64-cross
