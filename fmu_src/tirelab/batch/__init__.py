"""Batch diagnosis: one verdict for each of many recordings, on all cores."""
