"""The tire's step as C: kernel.h and kernel.c, which the native FMU's binaries are made of.

One kernel serves every tire: its signal path has every effect of the catalogue, and a tire's data says which act. So a
corrected FMU differs from its baseline by data only, and no user needs a compiler. `python -m tirelab.fmu.native.make`
writes the files anew.
"""

from __future__ import annotations

import hashlib
from functools import cache

from radialtire import CATALOGUE, CHANNELS, Effect, TireModel, flat_law, flat_step, power_law
from radialtire.effect import PLACES
from radialtire.flat_step import (
    CONTINUOUS,
    FOLLOWED,
    INFLATED,
    NOISE,
    PARAMETERS,
    PRELOAD,
    TRACKED,
    TWO_SIDED,
    SignalPath,
    laid_out,
)

from .translation.c_types import DOUBLE, OUT, ROW, Tuple
from .translation.expression import Expression, number
from .translation.function import translate
from .translation.program import Program

PAIR = Tuple((DOUBLE, DOUBLE))
MOTION = Tuple((DOUBLE,) * (5 + len(CHANNELS)))


@cache
def universal() -> tuple[tuple[Effect, ...], SignalPath, tuple[float, ...], tuple[float, ...]]:
    """Return every effect in its order, their path, the parameters with all of them off, and the state at rest."""
    effects = tuple(sorted(CATALOGUE.values(), key=lambda effect: PLACES.index(effect.place)))
    path, parameters, state = laid_out(effects)
    return effects, path, tuple(parameters), tuple(state)


def parameters_of(tire: TireModel) -> list[float]:
    """Return the row of parameters of a tire's effects, as the kernel has them."""
    effects, _, off, _ = universal()
    row = list(off)
    names = {effect.name for effect, _ in tire.effects}
    row[TRACKED] = float(tire.differentiates)
    follows = any(effect.place in ("deflection", "series") for effect, _ in tire.effects)
    row[FOLLOWED] = float(tire.differentiates and follows)
    row[NOISE], row[TWO_SIDED], row[PRELOAD] = tire.reading_noise, float(tire.two_sided), tire.preload
    row[INFLATED] = float(tire.inflated)
    at = PARAMETERS
    values = {effect.name: given for effect, given in tire.effects}
    for effect in effects:
        if effect.name in names:
            row[at : at + 1 + len(effect.parameters)] = (1.0, *values[effect.name])
        at += 1 + len(effect.parameters)
    return row


def places() -> dict[str, int]:
    """Return the index in the kernel's parameters of each parameter EFFECT.NAME, of reading_noise and preload."""
    effects, *_ = universal()
    found, at = {"reading_noise": NOISE, "preload": PRELOAD}, PARAMETERS
    for effect in effects:
        for i, parameter in enumerate(effect.parameters):
            found[f"{effect.name}.{parameter.name}"] = at + 1 + i
        at += 1 + len(effect.parameters)
    return found


def layout() -> str:
    """Return a short name for what stands where: data laid out in another way is not this kernel's."""
    effects, _, parameters, state = universal()
    words = [f"{effect.name}({', '.join(p.name for p in effect.parameters)})" for effect in effects]
    words += [channel.name for channel in CHANNELS]
    text = "; ".join([*words, f"{len(parameters)} {len(state)}", f"{flat_law.LAW_VALUES}"])
    return hashlib.sha256(text.encode()).hexdigest()[:16]


def sources() -> dict[str, str]:
    """Return kernel.h and kernel.c by their names."""
    _, path, parameters, state = universal()
    program = Program()
    fixed = Expression("path", "object", constant=path)
    rows = [Expression(name, kind) for name, kind in (("p", ROW), ("s", ROW), ("n", OUT))]
    pair, motion = Expression("law", PAIR), Expression("motion", MOTION)
    numbers = [Expression(name, DOUBLE) for name in ("deflection", "coefficient", "exponent")]
    translate(program, power_law.force, numbers, name="tire_elastic", public=True)
    translate(program, power_law.stiffness, numbers, name="tire_elastic_tangent", public=True)
    translate(program, flat_step.step, [fixed, pair, motion, *rows], name="tire_step", public=True)
    translate(program, flat_step.stiffness, [fixed, pair, motion, *rows], name="tire_stiffness", public=True)
    translate(
        program,
        flat_law.coefficients,
        [Expression("q", ROW), Expression("R", DOUBLE)],
        name="tire_law",
        public=True,
    )
    moved = program.structs[MOTION]
    public = [head for head, _ in program.texts if not head.startswith("static ")]
    shared = [text for text in program.definitions if text.endswith((" Vector2;", f" {moved};"))]
    own = [text for text in program.definitions if text not in shared]
    header = [
        "/* The step of a bicycle tire. Made from the Python of radialtire; change that, not this. */",
        "#ifndef KERNEL_H",
        "#define KERNEL_H",
        "",
        f'#define LAYOUT "{layout()}" /* what stands where in p and s */',
        "enum {",
        f"    PARAMETERS = {len(parameters)},",
        f"    STATES = {len(state)},",
        f"    S_TIME = {flat_step.TIME},",
        f"    S_STARTED = {flat_step.STARTED},",
        f"    P_TRACKED = {TRACKED}, /* p: rate and acceleration follow from the readings */",
        f"    P_TWO_SIDED = {TWO_SIDED}, P_INFLATED = {INFLATED},",
        f"    P_CONTINUOUS = {CONTINUOUS}, /* p: effects that are differential equations are a solver's */",
        f"    CHANNELS = {len(CHANNELS)}, /* quantities after the first five of a motion */",
        f"    LAW_TABLES = {flat_law.TABLES} /* q: number of tables after the law's parameters */",
        "};",
        "",
        "/* s before the first sample. */",
        "extern const double REST[STATES];",
        "",
        *shared,
        f"typedef {moved} Motion;",
        "",
        *(f"{head};" for head in public),
        "",
        "#endif",
    ]
    body = [
        "/* The step of a bicycle tire. Made from the Python of radialtire; change that, not this. */",
        '#include "kernel.h"',
        "",
        "#include <math.h>",
        "#include <stdbool.h>",
        "",
        *(
            f"static const double {name} = {number(value).text};"
            for name, value in sorted(program.constants.items())
        ),
        "",
        *own,
        "",
        f"const double REST[STATES] = {{{_sparse(state)}}};",
        "",
        "/* min and max as Python has them, also with NaN. */",
        "static inline double lesser(double a, double b) { return b < a ? b : a; }",
        "static inline double greater(double a, double b) { return b > a ? b : a; }",
        "",
        "\n".join(text for _, text in program.texts),
    ]
    return {"kernel.h": "\n".join(header) + "\n", "kernel.c": "\n".join(body).rstrip() + "\n"}


def _sparse(row: tuple[float, ...]) -> str:
    """Return the elements that are not 0, as an initializer in C."""
    return ", ".join(f"[{i}] = {value!r}" for i, value in enumerate(row) if value != 0.0) or "0"
