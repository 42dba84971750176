"""Packing a tire as an FMU: the archive, its loader library and its documentation."""
