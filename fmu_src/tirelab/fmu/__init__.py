"""Packing a tire as an FMU: the archive, its Linux binary (see loader.c) and its documentation."""
