"""The result of an identification: values, JSON, and sentences about what it could not determine."""

from __future__ import annotations

import json
import math
from dataclasses import asdict, dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray
from radialtire import TireModel

from ..names import plain, with_power
from .surfaces import CM_PER_M, describe

WEAK = 1.5
"""A constant is weakly determined if it may be this many times larger or smaller."""


@dataclass(frozen=True)
class SurfaceFit:
    """One row of the article's Table 1.

    surface_radius: [m]; recordings: their names; samples: that load or unload the tire; resting: that do neither
    coefficient, exponent: A [N/cm^B] and B [1] of this surface by itself, with their standard uncertainties
    rmse: [N] of these, loading and unloading weighted alike; noise: standard deviation of a sample's noise [N]
    independent: effective number of independent samples; loop: loading less unloading, mean [N]
    law_coefficient, law_exponent, law_rmse: the same from the law of all surfaces
    largest_error: of the law [N], without sign; at: its deflection [m]; relative_error: as a fraction of force_max
    deflection_max: [m]; force_max: [N]
    """

    surface_radius: float
    recordings: tuple[str, ...]
    samples: int
    resting: int
    coefficient: float
    coefficient_uncertainty: float
    exponent: float
    exponent_uncertainty: float
    rmse: float
    noise: float
    independent: float
    loop: float | None
    law_coefficient: float
    law_exponent: float
    law_rmse: float
    largest_error: float
    at: float
    relative_error: float
    deflection_max: float
    force_max: float


@dataclass(frozen=True)
class Constant:
    """One constant of the law.

    name, symbol, unit: as in the law; value: of the joint fit; two_stage: by the article's own two stages
    uncertainty: standard uncertainty, infinite where nothing determines it
    low, high: ends of the interval of three standard uncertainties, by profile; 0 or infinite where there is no end
    """

    name: str
    symbol: str
    unit: str
    value: float
    two_stage: float
    uncertainty: float
    low: float
    high: float

    @property
    def standing(self) -> str:
        """Return "determined", "weakly determined" or "not determined"."""
        if self.low <= 0.0 or not math.isfinite(self.high) or not math.isfinite(self.uncertainty):
            return "not determined"
        return (
            "weakly determined" if max(self.high / self.value, self.value / self.low) > WEAK else "determined"
        )

    def statement(self) -> str:
        """Return the sentence that says how wide the constant's interval is."""
        unit = "" if self.unit == "1" else f" {self.unit}"
        if self.low <= 0.0 and not math.isfinite(self.high):
            span = "any value at all"
        elif self.low <= 0.0:
            span = f"anything up to {digits(self.high, 3)}{unit}"
        elif not math.isfinite(self.high):
            span = f"anything from {digits(self.low, 3)}{unit} upwards"
        else:
            span = f"anything from {digits(self.low, 3)} to {digits(self.high, 3)}{unit}"
        value = digits(self.value, 4)
        return f"{self.symbol} = {value}{unit} ({self.name}) is {self.standing}: {span} fits as well"


@dataclass(frozen=True)
class Identification:
    """A tire and how it was found.

    tire: with the law of the joint fit and the range of its recordings
    surfaces: from the sharpest bump over flat ground to the tightest dip; constants: of the law
    correlation: of the constants' logarithms (k, k); condition: of what determines them
    rmse: of the law over all samples [N]; two_stage_rmse: the same of the article's two stages
    chi_square, freedom: what the law leaves of the surfaces' A and B, in units of their noise, and its expectation
    notes: sentences about the choice of law, the recordings and what they cannot determine
    reading_noise: [N], of the readings alone; NaN where they are too few
    misfit: the note that the law leaves more than that noise, "" where it does not
    """

    tire: TireModel
    surfaces: tuple[SurfaceFit, ...]
    constants: tuple[Constant, ...]
    correlation: NDArray[np.float64]
    condition: float
    rmse: float
    two_stage_rmse: float
    chi_square: float
    freedom: int
    notes: tuple[str, ...]
    reading_noise: float = math.nan
    misfit: str = ""

    def to_json(self) -> str:
        """Return everything but the tire itself as JSON; infinite numbers are the text "inf" or "-inf"."""
        content = {
            "schema": 1,
            "tire": self.tire.name,
            "law": self.tire.law.name,
            "constants": [asdict(c) | {"standing": c.standing} for c in self.constants],
            "correlation": self.correlation.tolist(),
            "condition": self.condition,
            "rmse": self.rmse,
            "two_stage_rmse": self.two_stage_rmse,
            "chi_square": self.chi_square,
            "freedom": self.freedom,
            "reading_noise": self.reading_noise,
            "surfaces": [asdict(s) for s in self.surfaces],
            "notes": list(self.notes),
        }
        return json.dumps(_plain(content), indent=2, ensure_ascii=False, allow_nan=False) + "\n"


SMALLEST = 1e-4
"""A smaller number is written with a power of ten."""


def digits(value: float, count: int) -> str:
    """Return `value` with `count` significant digits, with a power of ten below `SMALLEST` and from eight places on."""
    if not SMALLEST <= abs(value) < 1e8:
        return with_power(f"{value:.{count}g}")
    return f"{float(f'{value:.{count}g}'):.10f}".rstrip("0").rstrip(".")


def statements(
    constants: tuple[Constant, ...],
    surfaces: tuple[SurfaceFit, ...],
    law_uncertainties: NDArray[np.float64],
    chi_square: float,
    freedom: int,
) -> list[str]:
    """Return the sentences about what the surfaces do not determine; uncertainties of the law's A and B (n, 2)."""
    found = [c.statement() for c in constants if c.standing != "determined"]
    if found and any(c.name.endswith("_decay") for c in constants):
        found.append(
            "these constants compensate each other; the law itself is determined where it was measured: "
            + "; ".join(_known(surfaces[i], *law_uncertainties[i]) for i in sorted({0, len(surfaces) - 1}))
        )
    if freedom and chi_square / freedom > 1.0 + 4.0 * math.sqrt(2.0 / freedom):
        worst = max(surfaces, key=lambda s: s.law_rmse - s.rmse)
        found.append(
            f"the law does not follow all surfaces within their noise: on {describe(worst.surface_radius)} it leaves "
            f"{plain(worst.law_rmse, 3)} N where A and B of that surface alone leave {plain(worst.rmse, 3)} N; the "
            f"uncertainties are {digits(math.sqrt(chi_square / freedom), 2)} times wider for it"
        )
    return found


def _known(surface: SurfaceFit, coefficient_uncertainty: float, exponent_uncertainty: float) -> str:
    return (
        f"on {describe(surface.surface_radius)}, A = {digits(surface.law_coefficient, 4)} ± "
        f"{digits(coefficient_uncertainty, 2)} N/cm^B and B = {digits(surface.law_exponent, 4)} ± "
        f"{digits(exponent_uncertainty, 2)}"
    )


def recording_notes(surfaces: tuple[SurfaceFit, ...], one_sided: tuple[bool, ...]) -> list[str]:
    """Return the sentences about unused samples and missing branches; one_sided: which surfaces lack a branch."""
    found = []
    for surface, alone in zip(surfaces, one_sided, strict=True):
        where = f"{', '.join(surface.recordings)} ({describe(surface.surface_radius)})"
        if surface.resting:
            found.append(
                f"{where}: {surface.resting} samples at rest between loading and unloading are not used"
            )
        if alone:
            found.append(
                f"{where}: only one of loading and unloading was recorded, so A and B hold half the tire's hysteresis"
            )
        if surface.loop is not None and abs(surface.loop) > 0.03 * surface.force_max:
            found.append(
                f"{where}: loading and unloading differ by {plain(surface.loop, 3)} N, "
                f"{plain(100.0 * abs(surface.loop) / surface.force_max, 3)} % of the largest force; the law is "
                "their mean"
            )
        if surface.deflection_max * CM_PER_M < 0.2:
            found.append(
                f"{where}: the tire was compressed by {plain(1e3 * surface.deflection_max, 2)} mm at most; check "
                "the unit"
            )
    return found


def _plain(value: Any) -> Any:
    """Return `value` with infinite and missing numbers as text, which JSON has no numbers for."""
    if isinstance(value, float) and not math.isfinite(value):
        return str(value)
    if isinstance(value, dict):
        return {key: _plain(item) for key, item in value.items()}
    if isinstance(value, (list, tuple)):
        return [_plain(item) for item in value]
    return value
