"""From recordings and a baseline model to a verdict."""
