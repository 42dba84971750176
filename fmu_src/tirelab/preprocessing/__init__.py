"""What is done to recordings before anything is fitted: motion, noise, lines and segments."""
