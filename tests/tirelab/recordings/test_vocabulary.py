"""The names of the channels in the languages of Europe, with their letters and in those of English alone."""

from __future__ import annotations

import unicodedata
from pathlib import Path

import numpy as np
import pytest
from house_form import loading
from tirelab.recordings.other_columns import is_measured
from tirelab.recordings.recording import read_recording
from tirelab.recordings.vocabulary import foreign_channel, plain

LANGUAGES = {
    "Swedish": ("Tid", "Väg", "Kraft"),
    "Swedish test": ("Förfluten tid", "Förskjutning", "Tryckkraft"),
    "Danish": ("Tid", "Vej", "Kraft"),
    "Danish test": ("Prøvetid", "Forskydning", "Belastning"),
    "Norwegian": ("Tid", "Forskyvning", "Trykkraft"),
    "Finnish": ("Aika", "Siirtymä", "Voima"),
    "Finnish load": ("Kulunut aika", "Puristuma", "Kuorma"),
    "Turkish": ("Zaman", "Yer değiştirme", "Kuvvet"),
    "Turkish in one": ("SÜRE", "YERDEĞİŞTİRME", "YÜK"),
    "Hungarian": ("Idő", "Elmozdulás", "Erő"),
    "Hungarian stroke": ("Eltelt idő", "Löket", "Terhelés"),
    "Dutch": ("Tijd", "Verplaatsing", "Kracht"),
    "Dutch spring": ("Testtijd", "Inveering", "Belasting"),
    "Polish": ("Czas", "Przemieszczenie", "Siła"),
    "Polish deflection": ("Czas próby", "Ugięcie", "Obciążenie"),
    "Czech": ("Čas", "Posunutí", "Síla"),
    "Czech stroke": ("Čas zkoušky", "Zdvih", "Zatížení"),
    "Slovak": ("Čas", "Posunutie", "Zaťaženie"),
    "Portuguese": ("Tempo", "Deslocamento", "Força"),
    "Portuguese stroke": ("Tempo de ensaio", "Curso", "Carga"),
    "Spanish": ("Tiempo", "Posición", "Fuerza"),
    "Italian": ("Tempo di prova", "Posizione", "Carico"),
    "German": ("Zeit", "Verschiebung", "Belastung"),
    "Romanian": ("Timp", "Deplasare", "Forță"),
    "Croatian": ("Vrijeme", "Pomak", "Sila"),
}

LETTERS = str.maketrans("łŁøØıđ", "lLoOid")


def bare(text: str) -> str:
    """A text as a machine writes it that has the letters of English alone."""
    parts = unicodedata.normalize("NFKD", text.translate(LETTERS))
    return "".join(letter for letter in parts if not unicodedata.combining(letter))


@pytest.mark.parametrize("language", LANGUAGES)
@pytest.mark.parametrize("written", [str, bare, str.upper, str.lower])
def test_the_channels_in_a_language(language: str, written: object) -> None:
    assert callable(written)
    found = [foreign_channel(written(name)) for name in LANGUAGES[language]]
    assert found == ["time", "deflection", "force"]


@pytest.mark.parametrize(
    ("language", "encoding"),
    [
        ("Turkish", "cp1254"),
        ("Turkish in one", "cp1254"),
        ("Hungarian", "cp1250"),
        ("Polish", "cp1250"),
        ("Swedish", "latin-1"),
        ("Danish test", "latin-1"),
        ("Swedish test", "cp850"),
        ("Finnish", "utf-16"),
    ],
)
def test_a_file_in_a_language_and_its_letters(tmp_path: Path, language: str, encoding: str) -> None:
    names = ";".join(f"{n} [{u}]" for n, u in zip(LANGUAGES[language], ("s", "cm", "N"), strict=True))
    time, deflection, force = loading()
    rows = [
        f"{t:.2f};{x:.6f};{f:.5f}".replace(".", ",") for t, x, f in zip(time, deflection, force, strict=True)
    ]
    (tmp_path / "a.csv").write_bytes("\n".join([names, *rows, ""]).encode(encoding))
    found = read_recording(tmp_path / "a.csv", radius="flat")
    np.testing.assert_allclose(found.time, time, atol=1e-6)
    np.testing.assert_allclose(found.deflection, 0.01 * deflection, atol=1e-8)
    np.testing.assert_allclose(found.force, force, atol=1e-5)


@pytest.mark.parametrize("name", ["Wartość zadana siły", "Ortalama kuvvet", "Kraft börvärde", "Średnia siła"])
def test_what_was_asked_for_or_worked_out_is_no_reading(name: str) -> None:
    assert not is_measured(name)


def test_letters_that_unicode_does_not_part() -> None:
    assert plain("SIŁA Prøve-længde ISI ısı") == "sila prove laengde isi isi"
