#!/bin/sh
# Installs what the hosts need that Debian has: Wine for the DLL, qemu-user for aarch64; compilers; unzip, which ecos
# calls. As root.
#
#     sh tests/tirelab/fmu/hosts/install.sh && pytest -m slow -n 0 tests/tirelab/fmu/native/test_equality.py
#
# The hosts in Python (fmpy, CasADi, libcosimpy, ecospy, fmutool) come with the extra `test`, and so do importers in C++
# without Python: the libraries of CasADi and libcosim, the programs ecos and proxyfmu. A slow test downloads pycosim
# itself, whose program cosim runs under Wine. Neither PyPI, Debian nor npm has fmusim, the FMU Compliance Checker,
# FMI4cpp, OMSimulator, or the FMI Library that PyFMI needs: they have to be built from their repositories.
set -eu
if ! command -v apt-get >/dev/null; then
    echo "no apt-get here: install wine, qemu-user and the C library of aarch64 yourself" >&2
    exit 1
fi
apt-get update
apt-get install -y --no-install-recommends wine wine64 qemu-user libc6-arm64-cross gcc g++ libc6-dev unzip
