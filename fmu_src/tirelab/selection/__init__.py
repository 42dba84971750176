"""Which sets of effects are worth a fit: marginal likelihoods of their signatures, and a search over the sets."""
