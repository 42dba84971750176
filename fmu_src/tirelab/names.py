"""Names that a verdict may use besides those of the catalogue's effects."""

UNKNOWN = "unknown"
"""Something that no effect of the catalogue explains."""

REFITTED_LAW = "recalibration"
"""The elastic law with other coefficients than the baseline's."""
