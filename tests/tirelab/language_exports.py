"""Exports in the languages, letters and marks of many countries."""

from __future__ import annotations

import datetime
from pathlib import Path

from exported import KILOPOND, Motion, export, mm, table


def _with_commas(m: Motion, names: str) -> str:
    return names + "\n" + table((m.time, mm(m), m.force), ";", comma=True)


@export("italian.csv")
def _(path: Path, m: Motion) -> None:
    path.write_text(_with_commas(m, "Tempo [s];Spostamento [mm];Forza [N]"))


@export("portuguese.csv")
def _(path: Path, m: Motion) -> None:
    path.write_bytes(_with_commas(m, "Tempo (s);Deslocamento (mm);Força (N)").encode("latin-1"))


@export("dutch.csv")
def _(path: Path, m: Motion) -> None:
    path.write_text(_with_commas(m, "Tijd (s);Verplaatsing (mm);Kracht (N)"))


@export("polish.csv")
def _(path: Path, m: Motion) -> None:
    path.write_bytes(_with_commas(m, "Czas [s];Przemieszczenie [mm];Obciążenie [N]").encode("cp1250"))


@export("czech.csv")
def _(path: Path, m: Motion) -> None:
    path.write_bytes(_with_commas(m, "Čas [s];Dráha [mm];Síla [N]").encode("cp1250"))


@export("russian.csv")
def _(path: Path, m: Motion) -> None:
    path.write_bytes(_with_commas(m, "Время [s];Перемещение [mm];Усилие [N]").encode("cp1251"))


@export("chinese_units.csv")
def _(path: Path, m: Motion) -> None:
    head = "试验机,万能\n日期,2025-06-03\n时间(秒),位移（毫米）,力(千牛)\n"
    path.write_bytes((head + table((m.time, mm(m), 1e-3 * m.force), digits=8)).encode("gbk"))


@export("micrometres.csv")
def _(path: Path, m: Motion) -> None:
    head = "Time (s),Displacement (µm),Force (N),Temperature (°C)\n"
    rows = table((m.time, 1e3 * mm(m), m.force, 0.0 * m.time + 21.0))
    path.write_bytes((head + rows).encode("latin-1"))


@export("bars.txt")
def _(path: Path, m: Motion) -> None:
    path.write_text("Time [s]|Displacement [mm]|Force [N]\n" + table((m.time, mm(m), m.force), "|"))


@export("universal_time.csv")
def _(path: Path, m: Motion) -> None:
    begin = datetime.datetime(2025, 6, 3, 14, 5)
    stamps = [(begin + datetime.timedelta(seconds=t)).isoformat(" ", "milliseconds") for t in m.time.tolist()]
    rows = table((mm(m), m.force)).splitlines()
    body = "\n".join(f"{stamp} UTC,{row}" for stamp, row in zip(stamps, rows, strict=True))
    path.write_text(f"timestamp,displacement [mm],force [N]\n{body}\n")


@export("units_beside_words.txt")
def _(path: Path, m: Motion) -> None:
    head = "Time\tAxial Displacement\tAxial Force\tAxial Count\tEnergy\nSec\tmm\tkN\tsegments\tJ\n"
    count = 1.0 + m.time // 10.0
    path.write_text(head + table((m.time, mm(m), 1e-3 * m.force, count, 1e-6 * m.force * mm(m)), "\t", 8))


@export("drum.csv")
def _(path: Path, m: Motion) -> None:
    head = "Time (s),Displacement (mm),Force (N),Drum radius (in)\n"
    path.write_text(head + table((m.time, mm(m), m.force, 0.0 * m.time + 10.0)))


@export("labview_short_rows.lvm")
def _(path: Path, m: Motion) -> None:
    """The column of remarks has a name and no cells, and the line above the names is as wide as the rows."""
    head = (
        "LabVIEW Measurement\t\nDecimal_Separator\t,\n***End_of_Header***\t\n\t\nChannels\t2\t\n"
        "Y_Unit_Label\tmm\tN\t\nDelta_X\t0,1\t0,1\t\n***End_of_Header***\t\t\nX_Value\tDisplacement\tForce\tComment\n"
    )
    path.write_text(head + table((m.time, mm(m), m.force), "\t", comma=True))


@export("korean.csv")
def _(path: Path, m: Motion) -> None:
    head = "시험기,만능\n시간(s),변위(mm),하중(N)\n"
    path.write_bytes((head + table((m.time, mm(m), m.force))).encode("cp949"))


@export("korean_unicode.csv")
def _(path: Path, m: Motion) -> None:
    path.write_text(
        "시간(초),변위(mm),하중(kgf)\n" + table((m.time, mm(m), m.force / KILOPOND), digits=7), "utf-8"
    )


@export("taiwan.csv")
def _(path: Path, m: Motion) -> None:
    path.write_bytes(("時間(s),位移(mm),荷重(N)\n" + table((m.time, mm(m), m.force))).encode("big5"))


@export("russian_units.csv")
def _(path: Path, m: Motion) -> None:
    rows = table((m.time, mm(m), 1e-3 * m.force), ";", 8, comma=True)
    path.write_bytes(("Время, с;Перемещение, мм;Нагрузка, кН\n" + rows).encode("cp1251"))


@export("russian_channels.csv")
def _(path: Path, m: Motion) -> None:
    names = "Общее время (s);Шаг;Положение(8800 (0,1):Положение) (mm);Нагрузка(8800 (0,1):Нагрузка) (kN)\n"
    path.write_bytes(
        (names + table((m.time, 0.0 * m.time + 1.0, mm(m), 1e-3 * m.force), ";", 8)).encode("cp1251")
    )


@export("deformation_cz.csv")
def _(path: Path, m: Motion) -> None:
    path.write_text(_with_commas(m, "Čas [s];Deformace [mm];Zatížení [N]"), "utf-8")


@export("standard_force_pl.csv")
def _(path: Path, m: Motion) -> None:
    path.write_bytes(_with_commas(m, "Czas [s];Ugięcie [mm];Siła standardowa [N]").encode("cp1250"))
