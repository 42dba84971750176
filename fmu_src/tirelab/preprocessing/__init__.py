"""Before anything is fitted: the motion from a noisy reading, the noise of the force, and the data's faults."""
