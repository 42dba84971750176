"""The elastic force of a part that no power law follows: a curve over the deflection, beside A x^B.

    F = A x^B + g(x) - g(0)

    g(x) = sum_k g_k b(7 (x - x_from) / (x_to - x_from) + 2 - k),   k = 1 ... 10

b: the cubic B-spline of unit spacing (C. de Boor, A Practical Guide to Splines, Springer 1978), so g is smooth, has any
cubic law exactly, and goes along the straight lines between its ten forces g_k; constant below x_from and above x_to.
At no deflection it adds nothing: there is the preload, which may be the zero of a load cell.

Where only this is needed no physics is missing: the law was fitted to another part, or over another range. A factor on
A x^B, as a tire's shape is, cannot do it: a part's force need not be the same pulled as pressed, and where it has no
spring a factor changes nothing.
"""

from __future__ import annotations

from ..effect import Effect, Instant, State
from ..parameter import Parameter
from ..prior import Prior


def bump(distance: float) -> float:
    """Return the cubic B-spline b of unit spacing at a distance from its middle: 2/3 there, 0 from 2 on."""
    far = max(2.0 - abs(distance), 0.0)
    near = max(1.0 - abs(distance), 0.0)
    return (far * far * far - 4.0 * near * near * near) / 6.0


def curve(x: float, values: State) -> float:
    """Return g(x) [N] at a deflection [m]."""
    lowest, highest, g1, g2, g3, g4, g5, g6, g7, g8, g9, g10 = values
    place = 2.0 + min(max(7.0 * (x - lowest) / max(highest - lowest, 1e-300), 0.0), 7.0)
    force = g1 * bump(place - 1.0) + g2 * bump(place - 2.0) + g3 * bump(place - 3.0) + g4 * bump(place - 4.0)
    force += g5 * bump(place - 5.0) + g6 * bump(place - 6.0) + g7 * bump(place - 7.0) + g8 * bump(place - 8.0)
    return force + g9 * bump(place - 9.0) + g10 * bump(place - 10.0)


def respond(signal: float, instant: Instant, state: State, values: State) -> tuple[float, State]:
    """Add g(x) - g(0) to the elastic force [N]."""
    if instant.deflection <= 0.0 and not instant.two_sided:
        return signal, state
    return signal + (curve(instant.deflection, values) - curve(0.0, values)), state


def _end(name: str, symbol: str, start: float, meaning: str) -> Parameter:
    return Parameter(name, symbol, "m", start, -1e3, 1e3, meaning, optional=True, role="reading")


def _force(number: int) -> Parameter:
    return Parameter(
        f"force_{number}",
        f"g{number}",
        "N",
        0.0,
        -1e9,
        1e9,
        f"force along which the curve goes {number - 2} sevenths of the way from the lowest deflection up",
        neutral=0.0,
        nominal=10.0 if number == 10 else 0.0,
        role="strength",
        prior=Prior("normal", 0, 0.05, "force", "the same as that of a part's preload"),
    )


PART_SHAPE = Effect(
    name="part_shape",
    place="law",
    parameters=(
        _end("lowest", "x_from", 0.0, "lowest deflection that was measured"),
        _end("highest", "x_to", 0.025, "highest deflection that was measured"),
        *(_force(number) for number in range(1, 11)),
    ),
    initial_state=(),
    respond=respond,
    statement="the elastic force of the part is no power of the deflection",
    tell_tale="a smooth misfit over the deflection, the same at every rate and time",
    imitators=("series_compliance", "deflection_offset", "bottoming"),
    source="any law: a cubic spline along ten forces (C. de Boor, A Practical Guide to Splines, Springer 1978)",
    traits=("static", "law"),
    form_error=0.014,
)
