"""Fits of sets of effects in the catalogue's own forms, and the ranking by those fits."""
