"""What the catalogue's effects would do on the recorded motion: their signatures, found by simulating them."""
