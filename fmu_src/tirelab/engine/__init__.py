"""The catalogue against the residual."""
