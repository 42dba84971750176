"""A small page on this machine: drop recordings, correct how they are read, diagnose, take the tire."""
