"""The native FMU: the tire's step translated to C, the FMI functions around it, and binaries for five platforms."""
