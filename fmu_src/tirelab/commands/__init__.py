"""The commands of the `tirelab` program, one module each."""
