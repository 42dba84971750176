"""What makes the FMU, and nothing that runs in it: see loader.c for its Linux binary."""
