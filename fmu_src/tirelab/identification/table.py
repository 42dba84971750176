"""The tables that an identification prints: the article's Table 1, and the constants."""

from __future__ import annotations

import math
import sys
from collections.abc import Sequence

from radialtire import Hull1996
from rich import box
from rich.markup import escape
from rich.table import Table

from ..names import power_of_ten, with_power
from .law_fit import LawFit
from .result import SMALLEST, Identification, SurfaceFit, digits
from .surfaces import CM_PER_M, describe


def surface_table(identification: Identification) -> Table:
    """Return Table 1 of Hull, Wang & Moore (1996): for each surface A, B, RMSE and the largest errors."""
    table = _table(
        "A and B of each surface",
        "A [N/cm^B] and B with standard uncertainties; RMSE of each surface's own A and B, and of the law; the law's "
        "largest error, the deflection where it is, and its percentage of the largest force on that surface",
    )
    table.add_column("surface", no_wrap=True)
    for head in ("A", "B", "RMSE\n[N]", "law's\n[N]", "largest\n[N]", "at\n[cm]", "\n[%]"):
        table.add_column(escape(head), justify="right", no_wrap=True)
    for row in identification.surfaces:
        table.add_row(describe(row.surface_radius), *_cells(row))
    return table


SHOWN = 6
"""Most constants of a law that are printed; with --json all are."""


def law_table(fits: Sequence[LawFit]) -> Table:
    """Return the laws that were compared: what each leaves, and its constants."""
    amid = next((fit.name for fit in fits if fit.amid_loop), "")
    table = _table(
        "Laws compared",
        "all samples alike, loading and unloading together; standard uncertainties for white noise; the first has the "
        "least Bayesian criterion"
        + (
            f"; {amid} goes amid the loop of both ways, and others may pass all samples nearer"
            if amid
            else ""
        ),
    )
    table.add_column("law", no_wrap=True)
    table.add_column("RMSE\n" + escape("[N]"), justify="right", no_wrap=True)
    table.add_column("constants")
    for fit in fits:
        constants = [
            f"{symbol} = {with_uncertainty(value, spread)}{'' if unit == '1' else ' ' + unit}"
            if math.isfinite(spread)
            else f"{symbol} not determined"
            for symbol, value, spread, unit in fit.constants
        ]
        if len(constants) > SHOWN:
            first, last = (f"{1e3 * x:.3g} mm" for x in (fit.at[0], fit.at[-1]))
            constants = [f"{len(constants)} forces, from {first} to {last}"]
        table.add_row(fit.name, digits(fit.rmse, 4), escape(", ".join(constants)))
    return table


def constant_table(identification: Identification) -> Table:
    """Return the constants of the law with their intervals."""
    two_stages = identification.tire.law.name == Hull1996.name
    table = _table(
        f"Constants of the law {identification.tire.law.name}",
        "joint fit of all samples with its standard uncertainty; the interval of three standard uncertainties on "
        "either side, that the recordings allow"
        + ("; the same constants by the article's two stages" if two_stages else ""),
    )
    table.add_column("constant", no_wrap=True)
    table.add_column("unit", no_wrap=True)
    for head in ("joint fit", "interval", *(["two stages"] if two_stages else [])):
        table.add_column(head, justify="right", no_wrap=True)
    table.add_column("standing")
    for constant in identification.constants:
        table.add_row(
            constant.symbol,
            constant.unit,
            with_uncertainty(constant.value, constant.uncertainty),
            f"{digits(constant.low, 4)} to {digits(constant.high, 4)}",
            *([digits(constant.two_stage, 4)] if two_stages else []),
            constant.standing,
        )
    return table


def with_uncertainty(value: float, uncertainty: float) -> str:
    """Return "value ± uncertainty", the uncertainty with two digits and the value to the same place.

    Where both are small, one power of ten stands behind both.
    """
    if not math.isfinite(uncertainty):
        return f"{digits(value, 4)} ± ?"
    if uncertainty == 0.0:
        return f"{digits(value, 4)} ± 0"
    if uncertainty < 1e-6 * abs(value):
        return f"{digits(value, 6)} ± {with_power(f'{uncertainty:.1g}')}"
    largest = max(abs(value), uncertainty)
    if largest >= SMALLEST:
        return _to_two_digits(value, uncertainty)
    power = max(math.floor(math.log10(largest)), sys.float_info.min_10_exp)
    return f"({_to_two_digits(value / 10.0**power, uncertainty / 10.0**power)}){power_of_ten(power)}"


def _to_two_digits(value: float, uncertainty: float) -> str:
    places = 1 - math.floor(math.log10(uncertainty))
    if places < -6:  # beyond what anybody counts the noughts of
        return f"{digits(value, 2)} ± {digits(uncertainty, 2)}"
    if places <= 0:
        return f"{round(value, places):.0f} ± {round(uncertainty, places):.0f}"
    return f"{value:.{places}f} ± {uncertainty:.{places}f}"


def _table(title: str, caption: str) -> Table:
    return Table(
        title=title, caption=caption, box=box.SIMPLE_HEAD, title_justify="left", caption_justify="left"
    )


def _cells(row: SurfaceFit) -> tuple[str, ...]:
    return (
        with_uncertainty(row.coefficient, row.coefficient_uncertainty),
        with_uncertainty(row.exponent, row.exponent_uncertainty),
        digits(row.rmse, 3),
        digits(row.law_rmse, 3),
        digits(row.largest_error, 3),
        f"{CM_PER_M * row.at:.2f}",
        f"{100.0 * row.relative_error:.2g}",
    )
