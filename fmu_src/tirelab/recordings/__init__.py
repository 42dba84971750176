"""Recordings of force and deflection, read from files or arrays, checked, in SI units."""
