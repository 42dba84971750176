"""Where a soft knee, s ln(1 + exp(u / s)), is one of its two straight lines."""

FAR = 40.0
"""u / s from which on ln(1 + exp(u / s)) is u / s, or below -FAR 0, to the last digit."""
