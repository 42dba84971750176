"""Names that a verdict may use besides those of the catalogue's effects, and how numbers are written in sentences."""

UNKNOWN = "unknown"
"""Something that no effect of the catalogue explains."""

REFITTED_LAW = "recalibration"
"""The elastic law with other coefficients than the baseline's."""

PLAIN_MOST = 1e15
"""Numbers up to here are written without a power of ten."""

_RAISED = str.maketrans("-0123456789", "⁻⁰¹²³⁴⁵⁶⁷⁸⁹")


def plain(value: float, digits: int) -> str:
    """Return a number to so many significant digits, without noughts at its end, for a sentence.

    All digits before the point are written, and a power of ten where it is small.
    """
    text = f"{value:.{digits}g}"
    return f"{value:.0f}" if "e+" in text and abs(value) < PLAIN_MOST else with_power(text)


def in_seconds(seconds: float) -> str:
    """Return a time [s] to a hundredth, so that those of a list add up to their sum as it is written."""
    return f"{seconds:.2f}".rstrip("0").removesuffix(".")


def with_power(text: str) -> str:
    """Return a number in Python's notation as people write it, `9.60·10⁻⁵` of `9.60e-05`; without a power as it is."""
    mantissa, mark, exponent = text.partition("e")
    return f"{mantissa}{power_of_ten(int(exponent))}" if mark else text


def power_of_ten(exponent: int) -> str:
    """Return what stands behind a factor: `·10⁻⁵`."""
    return f"·10{str(exponent).translate(_RAISED)}"
