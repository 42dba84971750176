"""The sizes of a recording that priors are multiples of."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field


@dataclass(frozen=True)
class Scales:
    """force [N] peak; travel [m] span of the deflection; duration and interval [s]; rate [m/s] and acceleration [m/s^2]
    root mean squares over what moves; gauge [m] noise of the deflection's reading; channels: the level of each channel
    [SI] by its name. All positive.
    """

    force: float
    travel: float
    duration: float
    interval: float
    rate: float
    acceleration: float
    gauge: float
    channels: Mapping[str, float] = field(default_factory=dict)

    def of(self, scale: str) -> float:
        """Return the size that a prior's `scale` names, such as "force/travel"."""
        above, _, below = scale.partition("/")
        return self._size(above) / self._size(below or "1")

    def _size(self, name: str) -> float:
        if name in self.channels:
            return self.channels[name]
        return 1.0 if name == "1" else float(getattr(self, name))
