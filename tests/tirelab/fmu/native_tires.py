"""Tires with every law, every effect with plain and with optional parameters, random sets; and their drives."""

from __future__ import annotations

import math
import random
import struct
from collections.abc import Iterator
from pathlib import Path

from radialtire import CATALOGUE, Effect, Parameter, PowerLaw, Recalibrated, TireModel
from radialtire.curvature_law import CurvatureLaw
from radialtire.effect import PLACES

NOISE = 8e-6
"""Noise of a reading [m]."""

ORDER = sorted(CATALOGUE.values(), key=lambda effect: PLACES.index(effect.place))
LAW = CurvatureLaw.through([(-2.6, 640.0, 1.2), (0.0, 550.9, 1.422), (3.0, 500.0, 1.3)])
TABLE = ((math.inf, 0.1, 0.01), (0.3, -0.05, 0.02), (-0.4, 0.2, -0.1))

HELD = ("rate_independent_hysteresis", "viscous_damping", "force_offset")
"""Effects of a bushing or a damper."""

Moment = tuple[float, float, float]


def aside(parameter: Parameter, part: float) -> float:
    """A value beside the nominal one: by a part of it upwards, or downwards where it is the largest one."""
    value = parameter.nominal_value
    step = part * (abs(value) or min(1.0, parameter.maximum))
    return (
        min(value + step, parameter.maximum)
        if value < parameter.maximum
        else max(value - step, parameter.minimum)
    )


def values(effect: Effect, r: random.Random, *, optional: bool) -> tuple[float, ...]:
    """Usual values, each up to a third larger or smaller; optional parameters only where they are asked for."""
    found = []
    for parameter in effect.parameters:
        value = parameter.nominal_value
        if parameter.optional and optional:
            value = aside(parameter, r.choice([0.3, 0.5]))
        if not parameter.optional:
            value *= r.uniform(0.75, 1.33)
        found.append(min(max(value, parameter.minimum), parameter.maximum))
    return tuple(found)


def tires(random_sets: int) -> Iterator[tuple[str, TireModel]]:
    """Yield the tires with a name each; the same ones every time."""
    r = random.Random(20)
    yield "bare", TireModel()
    yield "power law", TireModel(law=PowerLaw())
    yield "curvature law", TireModel(law=LAW)
    yield "recalibrated twice", TireModel(law=Recalibrated(Recalibrated(LAW, ((0.2, 0.1, 0.1),)), TABLE))
    held = tuple((CATALOGUE[name], CATALOGUE[name].nominal) for name in HELD)
    yield "part held at both ends, without air", TireModel(PowerLaw(), held, two_sided=True, inflated=False)
    shaped = (
        (CATALOGUE["elastic_shape"], values(CATALOGUE["elastic_shape"], random.Random(21), optional=True)),
        *held,
    )
    yield "part with a preload", TireModel(PowerLaw(), shaped, two_sided=True, preload=50.0, inflated=False)
    for effect in ORDER:
        for optional in (False, True):
            tire = TireModel(effects=((effect, values(effect, r, optional=optional)),))
            yield f"{effect.name}{' with options' * optional}", tire
            if effect.differentiates:
                yield (
                    f"{effect.name} from readings{' with options' * optional}",
                    TireModel(effects=tire.effects, reading_noise=NOISE),
                )
    for number in range(random_sets):
        chosen = [effect for effect in ORDER if r.random() < 0.35]
        effects = tuple((effect, values(effect, r, optional=r.random() < 0.5)) for effect in chosen)
        yield (
            f"random {number}",
            TireModel(
                law=r.choice([TireModel().law, LAW]), effects=effects, reading_noise=r.choice([0.0, NOISE])
            ),
        )
    every = tuple((effect, values(effect, r, optional=True)) for effect in ORDER)
    yield "every effect", TireModel(effects=every, reading_noise=NOISE)


def options() -> Iterator[tuple[str, TireModel]]:
    """Yield each optional parameter of each effect alone, as the catalogue declares them."""
    for effect in ORDER:
        plain = effect.nominal
        for number, parameter in enumerate(effect.parameters):
            if parameter.optional:
                changed = (*plain[:number], aside(parameter, 0.4), *plain[number + 1 :])
                noise = NOISE if effect.differentiates else 0.0
                yield (
                    f"{effect.name}.{parameter.name}",
                    TireModel(effects=((effect, changed),), reading_noise=noise),
                )


def drive(count: int, seed: int) -> list[Moment]:
    """A ride with air, reversals, uneven and zero intervals, a pause, all kinds of ground: deflection, radius, time."""
    r = random.Random(seed)
    phases = [r.uniform(0.0, 6.28) for _ in range(2)]
    radii = [math.inf, 1e5, 0.0127, 0.3, -0.4, -5.0, 1.0]
    time, radius, moments = 0.0, math.inf, []
    for i in range(count):
        time += r.choice([0.0025, 0.0025, 0.0025, 0.001, 0.02, 0.0]) if i else 0.0
        time += 3.0 if i == count // 3 else 0.0
        x = 0.014 + 0.012 * math.sin(4.4 * time + phases[0]) + 0.006 * math.sin(31.4 * time + phases[1])
        radius = r.choice(radii) if i % 97 == 0 else radius
        moments.append((x + r.gauss(0.0, NOISE), radius, time))
    return moments


def stepped(tire: TireModel, moments: list[Moment]) -> list[float]:
    """The forces [N] of the Python FMU: TireModel.step at the times that its steps end at."""
    state, forces, before = tire.initial_state, [], None
    for x, radius, time in moments:
        now = time if before is None else before + (time - before)
        force, state = tire.step(x, radius, now, state)
        forces.append(force)
        before = time
    return forces


def sensitivity(tire: TireModel, moments: list[Moment]) -> float:
    """By how much of the largest force the Python's forces move with the last digit of every seventh deflection."""
    moved = [
        (math.nextafter(x, 1.0) if i % 7 == 0 else x, radius, time)
        for i, (x, radius, time) in enumerate(moments)
    ]
    plain = stepped(tire, moments)
    return max(abs(a - b) for a, b in zip(stepped(tire, moved), plain, strict=True)) / max(map(abs, plain))


def written(moments: list[Moment], path: Path) -> Path:
    """Write moments for the host drive.c."""
    path.write_bytes(b"".join(struct.pack("<3d", *moment) for moment in moments))
    return path


def read(path: Path) -> list[float]:
    """Read the forces that drive.c wrote."""
    content = path.read_bytes()
    return list(struct.unpack(f"<{len(content) // 8}d", content))
