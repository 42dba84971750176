"""One diagnosis for each of many recordings, on all cores."""
