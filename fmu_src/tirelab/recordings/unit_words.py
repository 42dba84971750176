"""The words and signs by which engineers, machines and programs call units, where pint has others."""

import re

COMMON = {
    "s": ("s", "ms", "us", "min", "h"),
    "m": ("m", "cm", "mm", "in", "ft"),
    "N": ("N", "kN", "lbf", "kgf"),
    "Pa": ("Pa", "kPa", "MPa", "bar", "mbar", "psi"),
    "K": ("K", "degC", "degF"),
    "m/s": ("m/s", "mm/s", "km/h", "mph"),
}
# Words such as min, in and h may be part of a name.
USUAL = frozenset(unit for units in COMMON.values() for unit in units) - {"min", "in", "h"}
# Instron's own exports write the ring above for a degree.
LOOKALIKES = str.maketrans(
    {"\N{GREEK SMALL LETTER MU}": "\N{MICRO SIGN}"}
    | dict.fromkeys("\N{RING ABOVE}\N{MASCULINE ORDINAL INDICATOR}", "\N{DEGREE SIGN}")
)
# Spellings that mean one thing only where the quantity is known; pint reads "C" as coulomb.
SPELLINGS = {
    ("K", "C"): "degC",
    ("K", "F"): "degF",
    ("K", "deg C"): "degC",
    ("K", "deg F"): "degF",
    ("K", "° C"): "degC",
    ("K", "° F"): "degF",
    ("K", "℃"): "degC",
    ("K", "℉"): "degF",
    ("s", "S"): "s",
    ("s", "Sec"): "s",
    ("s", "Seconds"): "s",
    ("N", "Newton"): "N",
    ("N", "Newtons"): "N",
    ("N", "lbF"): "lbf",
    ("N", "kp"): "kgf",
    **{
        ("N", f"{one}{joint}{end}"): "lbf"
        for one in ("lb", "pound", "pounds")
        for joint in "- ."
        for end in ("f", "force")
    },
    **{
        ("N", f"{one}{joint}{end}"): "kgf"
        for one in ("kg", "kilogram")
        for joint in "- ."
        for end in ("f", "force")
    },
    **{("N", f"gram{joint}force"): "gf" for joint in "- "},
    **{("m", sign): "in" for sign in ('"', "''", "\N{DOUBLE PRIME}", "\N{RIGHT DOUBLE QUOTATION MARK}")},
    **{("m", word): "thou" for word in ("milli-inch", "milliinch", "milli inch")},
    # torques, which are no forces: pint's Nm is a length
    **{("N", f"{force}{arm}"): f"{force}*{arm}" for force in ("N", "kN", "mN") for arm in ("m", "cm", "mm")},
    **{("N", f"{a}{b}"): "ft*lbf" for a, b in (("ft", "-lb"), ("lb", "-ft"), ("ft", "-lbf"), ("lbf", "-ft"))},
    **{("N", f"{a}{b}"): "in*lbf" for a, b in (("in", "-lb"), ("lb", "-in"), ("in", "-lbf"), ("lbf", "-in"))},
    ("m", "°"): "deg",
    # pint's mil is an angle
    ("m", "mil"): "thou",
    ("m", "mils"): "thou",
    **{
        ("s", word): unit
        for word, unit in (("с", "s"), ("сек", "s"), ("мс", "ms"), ("мин", "min"), ("초", "s"))
    },
    **{("m", word): unit for word, unit in (("м", "m"), ("см", "cm"), ("мм", "mm"), ("мкм", "um"))},
    **{
        ("N", word): unit
        for word, unit in (("Н", "N"), ("кН", "kN"), ("мН", "mN"), ("даН", "daN"), ("кгс", "kgf"))
    },
    **{
        (si, word): unit
        for si, unit, words in (
            (
                "s",
                "s",
                "sek sekunde sekunden sekunder sekund sekundy sekunnit seconde secondes seconden secondi segundo",
            ),
            ("s", "s", "seg segundos saniye sn másodperc"),
            ("s", "ms", "millisekunden millisekunder millisecondes milisegundos milisaniye"),
            ("s", "min", "minute minuten minuter minutes minutos minuti"),
            (
                "m",
                "mm",
                "millimètre millimètres milímetro milímetros milimetro milimetros millimetri milimetry milimetre",
            ),
            ("m", "cm", "zentimeter centimètres centímetros centimetros centimetri"),
            ("m", "in", "zoll pouce pouces pulgada pulgadas"),
            ("N", "N", "niuton niutony newtonů newtony"),
        )
        for word in words.split()
    },
    ("N", "тс"): "tf",
    **{("s", word): unit for word, unit in (("秒", "s"), ("毫秒", "ms"), ("分", "min"))},
    **{("m", word): unit for word, unit in (("米", "m"), ("厘米", "cm"), ("毫米", "mm"), ("微米", "um"))},
    **{("N", word): unit for word, unit in (("牛", "N"), ("牛顿", "N"), ("千牛", "kN"), ("公斤力", "kgf"))},
}

LIKELY = {
    **{("N", word): "lbf" for word in ("lb", "lbs", "pound", "pounds")},
    **{("N", word): "kgf" for word in ("kg", "kgs", "kilogram", "kilograms")},
    **{("N", word): "gf" for word in ("g", "gr", "gram", "grams", "gramm", "gramme", "grammes")},
    **{("N", word): "ozf" for word in ("oz", "ounce", "ounces")},
    **{("N", word): "tf" for word in ("t", "ton", "tons", "tonne", "tonnes", "tonf")},
    ("Pa", "kgf"): "kgf/cm^2",
    ("s", "hz"): "s, the time of each row",
    ("s", "m"): "min",
}

CASED = ("daN", "gf", "tf", "um", "hr", "hPa", *(unit for units in COMMON.values() for unit in units))
"""Units that programs write in capitals too, or with another letter large: KN, MM, DAN."""

MICRO_LOST = re.compile(r"(?:[^\x00-\x7f]|\?){1,3}(?P<unit>[ms])")
"""A unit whose sign for a millionth was lost between two encodings: ?m."""

_SO_MANY = re.compile(
    r"x?\s*(?P<value>\d+(?:\.\d+)?)(?:\s*/\s*(?P<by>[1-9]\d*))?\s*\*?\s*(?P<unit>[^\W\d].*)", re.ASCII
)
_TIMES = re.compile(
    r"(?P<unit>[^\W\d].*?)\s*[\[(]?\s*[x*\N{MULTIPLICATION SIGN}\N{MIDDLE DOT}]\s*"
    r"(?P<value>\d+(?:\.\d+)?)\s*[\])]?(?P<by>)",
    re.ASCII,
)
_PART_OF_ONE = re.compile(r"(?P<value>)(?P<unit>[^\W\d]\w*)\s*/\s*(?P<by>[1-9]\d*)", re.ASCII)
POWER = re.compile(
    r"x?\s*10\s*(?:\^|\*\*)\s*(?P<power>[+-]?\d{1,2})\s*[*\N{MIDDLE DOT}]?\s*(?P<unit>[^\W\d].*)", re.ASCII
)
"""A unit that stands for a power of ten of another one: 10^-3 m."""


def so_many(unit: str) -> str:
    """Return a unit that stands for so many of another one as a calibration, `10 ms`, of `1/100 mm`, `ms/10` and
    `10^-3 m` too."""
    power = POWER.fullmatch(unit)
    if power:
        return f"{10.0 ** int(power['power']):g} {power['unit']}"
    found = _SO_MANY.fullmatch(unit) or _PART_OF_ONE.fullmatch(unit) or _TIMES.fullmatch(unit)
    if found is None:
        return ""
    value = float(found["value"] or 1.0) / float(found["by"] or 1.0)
    return f"{value:g} {found['unit']}"
