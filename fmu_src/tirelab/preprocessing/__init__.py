"""Before anything is fitted: motion from a noisy reading, noise model, spectral lines and segments."""
