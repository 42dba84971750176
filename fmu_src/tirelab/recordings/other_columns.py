"""What else a column of a table may hold than the readings of a channel, by the words of its name or by its numbers."""

from __future__ import annotations

import re

import numpy as np
from numpy.typing import NDArray

from .vocabulary import plain

NOT_MEASURED = frozenset(
    {
        *("command", "cmd", "demand", "target", "setpoint", "set", "reference", "program", "error"),
        *("desired", "des", "ref"),
        *("peak", "valley", "maximum", "max", "minimum", "min", "mean", "average", "amplitude", "limit"),
        *("soll", "sollwert", "consigne", "consigna", "mittelwert", "moyenne", "media"),
        *("borvarde", "medelvarde", "middelvaerdi", "keskiarvo", "hedef", "ortalama", "atlag", "gemiddelde"),
        *("zadana", "zadane", "zadany", "srednia", "prumer", "desejado", "desejada"),
    }
)
"""Words of a name that say that its column holds no reading: what was asked for, or what was worked out."""

NOT_MEASURED_GLUED = ("目标", "目標", "设定", "設定", "指令", "命令", "控制", "峰值", "最大", "最小", "平均")
"""The same in languages that write without spaces."""

COUNTERS = frozenset(
    {
        *(
            "sample",
            "samples",
            "index",
            "idx",
            "no",
            "nr",
            "number",
            "point",
            "points",
            "scan",
            "record",
            "row",
        ),
        *(
            "reading",
            "count",
            "counter",
            "n",
            "id",
            "line",
            "data point",
            "sample number",
            "sample no",
            "sample nr",
        ),
        *("step", "steps", "pulse", "pulses", "tick", "ticks", "cycle", "cycles", "schritt", "schritte"),
        *("point number", "messpunkt", "messwert", "nummer", "zeile", "echantillon", "numero", "muestra"),
        *("numer", "lp", "cislo", "sira", "sorszam", "indeks", "punkt", "mittaus"),
        *("序号", "编号", "番号"),
    }
)
"""Names of columns that count the rows, or the steps of a motor."""

STRAINED = frozenset(
    {
        *("strain", "stress", "dehnung", "spannung", "contrainte", "esfuerzo", "tensione", "应变", "应力"),
        *("tojning", "toyning", "venyma", "jannitys", "gerinim", "gerilme", "odksztalcenie", "naprezenie"),
    }
)
"""Words of a name that say a deflection or a force by the size of the specimen, where no unit says otherwise."""

OTHER_QUANTITIES = frozenset(
    {
        *("acceleration", "accel", "beschleunigung", "aceleracion", "accelerazione", "加速度"),
        *("velocity", "speed", "rate", "geschwindigkeit", "vitesse", "velocidad", "velocita", "速度"),
        *("humidity", "feuchte", "frequency", "frequenz", "energy", "energie", "work", "power", "leistung"),
    }
)
"""Words of a name, as `plain` has them, that say another quantity than what a channel may be."""

FEWEST_LEVELS = 10
"""Values that a gauge takes at least where it follows a motion: with fewer its rounding is 3 % of the stroke."""

_IDENTIFIER = re.compile(r"(?i:(?:^|[\W_])id)$|[a-z]I[dD]$")


def is_measured(name: str) -> bool:
    """Whether no word of a name says that its column holds what was asked for or worked out: `Force command`."""
    glued = any(word in name for word in NOT_MEASURED_GLUED)
    return not glued and not NOT_MEASURED & set(re.split(r"[^\w]+", plain(name)))


def counts_rows(name: str) -> bool:
    """Whether a name is one of a column that counts rows, steps or tests: `Sample`, `No.`, `Messpunkt`, `TestID`."""
    return plain(name) in COUNTERS or bool(_IDENTIFIER.search(name))


def is_strained(name: str) -> bool:
    """Whether a name is one of a strain or a stress: `True Strain`, `Spannung`."""
    return bool(STRAINED & set(re.split(r"[^\w]+", plain(name))))


def says_another(name: str) -> bool:
    """Whether a name says that its column holds neither a deflection nor a force: `Acceleration`, `Speed 1`."""
    return bool(OTHER_QUANTITIES & set(re.findall(r"[^\W\d_]+", plain(name))))


def idle(values: NDArray[np.float64]) -> bool:
    """Whether numbers take fewer values than FEWEST_LEVELS in ten times as many rows: they rest, and follow nothing."""
    return len(values) >= 10 * FEWEST_LEVELS and len(np.unique(values[np.isfinite(values)])) < FEWEST_LEVELS
