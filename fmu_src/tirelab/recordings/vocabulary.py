"""The words by which the field calls the channels, in the languages of its test machines."""

from __future__ import annotations

import re
import unicodedata

FOREIGN: dict[str, tuple[str, ...]] = {
    "time": (
        *("zeit", "gesamtzeit", "testzeit", "prufzeit", "pruefzeit", "messzeit", "versuchszeit", "laufzeit"),
        *("zeitstempel",),
        *("temps", "temps ecoule", "temps d essai", "horodatage"),
        *("czas", "godzina", "cas", "время", "общее время", "시간", "경과 시간", "시험 시간"),
        *("tempo", "tempo trascorso", "tempo decorrido", "tijd"),
        *("tiempo", "tiempo transcurrido", "tiempo de ensayo", "marca de tiempo"),
        *("tempo de ensaio", "tempo de teste", "tempo di prova", "testtijd", "verstreken tijd"),
        *("tid", "provtid", "mättid", "förfluten tid", "testtid", "prøvetid", "måletid", "forløbet tid"),
        *("forløpt tid", "aika", "kulunut aika", "testiaika", "zaman", "süre", "geçen süre", "test süresi"),
        *("idő", "eltelt idő", "mérési idő", "vizsgálati idő", "czas próby", "czas badania"),
        *("čas zkoušky", "čas skúšky", "timp", "vrijeme"),
        *(
            "datetime",
            "date time",
            "running time",
            "total time",
            "ts",
            "times",
            "millis",
            "micros",
            "时间",
            "時間",
            "试验时间",
            "経過時間",
        ),
    ),
    "deflection": (
        *("weg", "traversenweg", "standardweg", "federweg", "kolbenweg", "hub", "stauchung", "verformung"),
        *("einfederung", "eindruckung", "eindrueckung", "prufweg", "pruefweg", "dehnung", "verlangerung"),
        *("deplacement", "deplacement traverse", "deplacement de la traverse", "course", "ecrasement"),
        *(
            "deplacement verin",
            "enfoncement",
            "fleche",
            "allongement",
            "allongement standard",
            "course standard",
            "traverse",
        ),
        *("course traverse", "course de traverse", "course de la traverse", "deplacement de traverse"),
        *("desplazamiento", "desplazamiento del cabezal", "recorrido", "carrera", "deformacion", "deflexion"),
        *(
            "crosshead",
            "crosshead displacement",
            "crosshead travel",
            "crosshead position",
            "axial displacement",
        ),
        *("standard travel", "standard extension"),
        *("spostamento", "corsa", "corsa traversa", "deformazione", "schiacciamento", "freccia"),
        *("deslocamento", "deformacao", "verplaatsing", "indrukking"),
        *("compressive displacement", "compressive extension", "extension", "position", "pos"),
        *("machine extension", "disp", "displ", "axial disp", "wegaufnehmer", "kolbenhub", "maschinenweg"),
        *("linear pot", "linear potentiometer", "potentiometer"),
        *(
            "penetration",
            "indentation",
            "penetration depth",
            "pd",
            "indentation depth",
            "sinkage",
            "settlement",
            "displacment",
        ),
        *("przemieszczenie", "ugiecie", "droga", "posuv", "posunuti", "draha", "deformace", "skok"),
        *("przemieszczenie trawersy", "odkształcenie", "ściśnięcie", "wydłużenie", "położenie", "pozycja"),
        *(
            "zdvih",
            "stlačení",
            "průhyb",
            "prodloužení",
            "posun",
            "poloha",
            "posunutie",
            "stlačenie",
            "priehyb",
        ),
        *("predĺženie", "deformácia", "pomak", "pomik", "hod", "progib", "deplasare", "cursă", "deformare"),
        *(
            "väg",
            "förskjutning",
            "kolvväg",
            "fjädringsväg",
            "slaglängd",
            "hoptryckning",
            "nedböjning",
            "läge",
        ),
        *(
            "intryckning",
            "förlängning",
            "sträcka",
            "deformation",
            "vej",
            "forskydning",
            "vandring",
            "flytning",
        ),
        *("slaglængde", "sammentrykning", "nedbøjning", "indtrykning", "forlængelse", "vei", "forskyvning"),
        *("slaglengde", "deformasjon", "nedbøyning", "forlengelse", "posisjon"),
        *("siirtymä", "matka", "iskunpituus", "puristuma", "painuma", "muodonmuutos", "taipuma", "venymä"),
        *(
            "yer değiştirme",
            "yerdeğiştirme",
            "deplasman",
            "strok",
            "kurs",
            "sehim",
            "çökme",
            "uzama",
            "konum",
        ),
        *("deformasyon", "elmozdulás", "út", "löket", "benyomódás", "összenyomódás", "deformáció"),
        *("alakváltozás", "behajlás", "lehajlás", "megnyúlás", "pozíció"),
        *("slag", "indeuking", "vervorming", "doorbuiging", "inveering", "verlenging", "positie"),
        *("curso", "compressão", "deflexão", "extensão", "alongamento", "percurso", "posição", "flecha"),
        *("compresión", "alargamiento", "posición", "posizione", "allungamento", "compressione"),
        *("kompression", "verschiebung", "durchbiegung", "auslenkung", "eindringweg", "zustellung"),
        *("перемещение", "положение", "деформация", "ход"),
        *("位移", "变形", "行程", "横梁位移", "变位", "変位", "ストローク", "変位量", "변위", "스트로크"),
    ),
    "radius": (
        "oberflachenradius",
        "krummungsradius",
        "rayon",
        "rayon de courbure",
        "radio",
        "radio de curvatura",
        "raggio",
        "raggio di curvatura",
        "raio",
        "raio de curvatura",
        "straal",
        "drum radius",
    ),
    "force": (
        *(
            "kraft",
            "standardkraft",
            "prufkraft",
            "pruefkraft",
            "normalkraft",
            "radialkraft",
            "druckkraft",
            "last",
        ),
        *("force standard", "force d essai", "force de compression", "force de traction"),
        *("force verticale", "effort", "charge", "charge verticale"),
        *("fuerza", "fuerza vertical", "fuerza radial", "carga"),
        *("forza", "carico", "forca", "kracht", "belasting"),
        *("compressive load", "axial force", "axial load", "standard force", "compression force", "fz", "fn"),
        *(
            "siła",
            "siła standardowa",
            "obciążenie",
            "nacisk",
            "sila",
            "zatizeni",
            "сила",
            "нагрузка",
            "усилие",
        ),
        *("siła ściskająca", "tlaková síla", "zaťaženie", "opterećenje", "obremenitev", "forță", "sarcină"),
        *("tryckkraft", "provkraft", "belastning", "trykkraft", "trykkkraft", "prøvekraft"),
        *("voima", "kuorma", "kuormitus", "puristusvoima", "kuvvet", "yük", "basma kuvveti"),
        *("erő", "terhelés", "nyomóerő", "drukkracht", "força normal", "força vertical", "força radial"),
        *("belastung", "axialkraft", "vertikalkraft", "radlast", "andruckkraft"),
        *("力", "载荷", "负荷", "试验力", "試験力", "荷重", "하중", "힘", "시험력"),
    ),
    "pressure": (
        *("druck", "luftdruck", "reifendruck", "innendruck", "fulldruck", "fuelldruck", "reifenfulldruck"),
        *("reifenfuelldruck", "uberdruck", "ueberdruck", "relativdruck", "absolutdruck", "druck absolut"),
        "pression",
        "presion",
        "pressione",
        "pressao",
        "bandenspanning",
        *(
            "tryck",
            "däcktryck",
            "tryk",
            "trykk",
            "paine",
            "rengaspaine",
            "basınç",
            "nyomás",
            "druk",
            "ciśnienie",
        ),
        "tlak",
        "压力",
        "气压",
        "圧力",
        "空気圧",
    ),
    "temperature": (
        *("temperatur", "reifentemperatur", "temperature du pneu", "temperatura", "temperatuur", "温度"),
        *("lämpötila", "sıcaklık", "hőmérséklet", "teplota"),
    ),
    "speed": (
        *("geschwindigkeit", "vitesse", "velocidad", "velocidade", "hastighet", "hastighed", "nopeus", "hız"),
        *("sebesség", "snelheid", "prędkość", "rychlost", "速度"),
    ),
}
"""Names of each channel that are taken where no column has one of the usual English names, however their accents are
written."""

SECOND = {
    "deflection": (
        *(
            "werkzeugabstand",
            "klemmenabstand",
            "einspannlange",
            "ecartement entre outils",
            "ecartement des outils",
        ),
        *("traversenposition", "traversenweg absolut", "absoluter traversenweg", "absolute crosshead travel"),
        *("position traverse", "position de la traverse"),
        *("distance entre mors", "tool separation", "grip to grip separation", "grip separation", "gap"),
        *("depth", "eindringtiefe", "tiefe", "profondeur", "profundidad", "profondita"),
    ),
    "force": ("fx", "fy", "weight", "gewicht", "poids", "peso"),
}
"""Names of each channel, in any language, that are taken where no column has one of the others."""

BESIDE = {"deflection": ("displacement", "distance", "stroke", "travel"), "force": ("load",)}
"""English words for a channel of which a column may have the beginning."""

STAND_INS = {
    "deflection": frozenset(
        {"angle", "rotation", "theta", "winkel", "drehwinkel", "angolo", "angulo", "角度"}
    ),
    "force": frozenset({"torque", "moment", "tau", "drehmoment", "couple", "coppia", "momento", "扭矩"}),
}
"""Quantities that stand for a channel in a test of torsion, proposed to be checked."""

SHORTEST = 4
"""Letters of a name that is taken for the beginning of a word."""

_WHOLE_LETTERS = str.maketrans(
    {"ß": "ss", "ł": "l", "ø": "o", "æ": "ae", "œ": "oe", "đ": "d", "ı": "i", "ð": "d", "þ": "th"}
)
"""Small letters that Unicode does not part into a letter and its mark."""

_SIGN = re.compile(r"[\u3040-\u30ff\u3400-\u9fff\uac00-\ud7a3]")
_UNIT_AFTER = re.compile(r"(?P<name>.+?)(?:\s+in\s+|\s*/\s*|\s*,\s+|\s+en\s+|\s+)(?P<unit>[^\s,]+)")
_COUNTED = re.compile(
    r"(?P<name>.*?[^\W\d_])(?:(?:[ ._#-]+(?:run|trial|test|versuch|essai|ensayo|prova))?[ ._#-]*\d+|_duplicated_\d+)",
    re.IGNORECASE,
)


def plain(name: str) -> str:
    """Return a name in small letters, without accents, dots and underscores: `Poids_mesuré` is `poids mesure`."""
    letters = unicodedata.normalize("NFKD", name.casefold().translate(_WHOLE_LETTERS))
    kept = "".join(c for c in letters if not unicodedata.combining(c))
    # what stays in parts, as the letters of Korean do, is put together again
    return unicodedata.normalize("NFC", " ".join(re.sub(r"[\s_.'’-]+", " ", kept).split()))


def foreign_channel(name: str) -> str | None:
    """Return the channel that a name is a word for in one of the languages, None where it is none."""
    return _CHANNEL_OF.get(plain(name))


def second_channel(name: str) -> str | None:
    """Return the channel that a name is for where no other column is: `Fx` beside no `Fz`; None where it is none."""
    return _SECOND_OF.get(plain(name))


def any_channel(name: str) -> str | None:
    """Return the channel that a name is a word for in one of the languages, of the first choice or the second."""
    return foreign_channel(name) or second_channel(name)


def begins_like(name: str, channel: str) -> bool:
    """Whether a name of four letters or more is the beginning of a word for a channel: `forc`, `displ`, `dist`."""
    short = plain(name)
    words = (channel, *map(plain, FOREIGN.get(channel, ())), *BESIDE.get(channel, ()))
    return len(short) >= SHORTEST and any(word.startswith(short) for word in words)


def stands_for(name: str, channel: str) -> bool:
    """Whether a word of a name is a quantity that stands for a channel in a test of torsion: `knee angle`, `tau_1`."""
    return bool(STAND_INS.get(channel, frozenset()) & set(re.findall(r"[^\W\d_]+", plain(name))))


def glued_ends(name: str) -> list[str]:
    """Return the ends of a name, without the whole, that begin with a sign of a language written without spaces:
    `位移`, `移` of `350T位移`."""
    return [name[i:] for i in range(1, len(name)) if _SIGN.match(name[i])]


def without_count(name: str) -> str | None:
    """Return a name without the number of its trial: `Kraft 2`, `Kraft.1`, `Force Run 3`; None where it has none."""
    found = _COUNTED.fullmatch(name.strip())
    return found["name"].strip() if found else None


def name_and_unit(text: str) -> tuple[str, str] | None:
    """Return the parts of `Kraft in N`, `Weg / mm`, `Force, kN` or `Force N`; None where there is only one."""
    found = _UNIT_AFTER.fullmatch(text.strip())
    return (found["name"].strip(), found["unit"].strip()) if found else None


_SECOND_OF = {plain(word): channel for channel, words in SECOND.items() for word in words}
_CHANNEL_OF = {plain(word): channel for channel, words in FOREIGN.items() for word in words}
WORDS = frozenset(_CHANNEL_OF)
"""All names of the first choice, as `plain` has them."""
