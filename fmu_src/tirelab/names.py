"""Names that a verdict may use besides those of the catalogue's effects, and how powers of ten are written."""

UNKNOWN = "unknown"
"""Something that no effect of the catalogue explains."""

REFITTED_LAW = "recalibration"
"""The elastic law with other coefficients than the baseline's."""

_RAISED = str.maketrans("-0123456789", "⁻⁰¹²³⁴⁵⁶⁷⁸⁹")


def with_power(text: str) -> str:
    """Return a number in Python's notation as people write it, `9.60·10⁻⁵` of `9.60e-05`; without a power as it is."""
    mantissa, mark, exponent = text.partition("e")
    return f"{mantissa}{power_of_ten(int(exponent))}" if mark else text


def power_of_ten(exponent: int) -> str:
    """Return what stands behind a factor: `·10⁻⁵`."""
    return f"·10{str(exponent).translate(_RAISED)}"
