"""How a benchmark prints a figure beside what is wanted of it."""


def beside(value: float, unit: str, aim: float) -> str:
    """Return the figure with its aim, and whether that is met: 0.41 s (wanted: under 1 s; met)."""
    return f"{value:.2f} {unit} (wanted: under {aim:g} {unit}; {'met' if value < aim else 'NOT met'})"
