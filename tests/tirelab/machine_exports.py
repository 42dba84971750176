"""Exports of test machines."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from exported import INCH, KILOPOND, POUND, Motion, export, mm, table


@export("bluehill_results_above.csv")
def _(path: Path, m: Motion) -> None:
    head = (
        '"Results Table 1"\n,"Maximum Compressive load","Compressive extension at Maximum Compressive load"\n'
        ',"(N)","(mm)"\n1,"1520.42","20.00"\n2,"1519.88","20.00"\nMean,"1520.15","20.00"\n\n\n'
        '"Time","Compressive extension","Compressive load"\n"(s)","(mm)","(N)"\n'
    )
    path.write_text(head + table((m.time, mm(m), m.force), quote=True))


@export("bluehill_raw_thousands.csv")
def _(path: Path, m: Motion) -> None:
    rows = [f'"{t:.3f}","{x:.5f}","{f:,.3f}"' for t, x, f in zip(m.time, mm(m), m.force, strict=True)]
    path.write_text(
        '"Time","Extension","Load"\n"(s)","(mm)","(N)"\n' + "\n".join(rows) + "\n", encoding="utf-8-sig"
    )


@export("wavematrix.csv")
def _(path: Path, m: Motion) -> None:
    head = (
        '"Total Time (s)","Cycle Elapsed Time (s)","Total Cycles","Elapsed Cycles","Step",'
        '"Position(8800 (0,1):Position) (mm)","Load(8800 (0,1):Load) (kN)"\n'
    )
    zero = np.zeros_like(m.time)
    columns = (m.time, m.time % 20.0, np.floor(m.time / 20.0), zero, zero + 1.0, -mm(m), -1e-3 * m.force)
    path.write_text(head + table(columns, digits=7))


@export("mts_flextest_blocks.dat")
def _(path: Path, m: Motion) -> None:
    text = "MTS793|MPT|ENU|1|2|.|/|:|1|0|0|A\n\n"
    for block, part in enumerate((slice(0, 150), slice(150, 300), slice(300, 400))):
        text += f"Data Acquisition\t\tCyclic {block}\nStation Name:\ttire.cfg\nTest File Name:\ttire.000\n"
        text += f"Data Header:\t\tTime:\t{m.time[part][0]:.5f}\tSec\t6/3/2025 2:05:{block:02d} PM\n\n"
        text += "Time\tAxial Displacement\tAxial Force\nSec\tmm\tkN\n"
        text += table((m.time[part], mm(m)[part], 1e-3 * m.force[part]), "\t", 8) + "\n"
    path.write_text(text)


@export("mts_testsuite.txt")
def _(path: Path, m: Motion) -> None:
    head = "Data Acquisition: Timed\tTime: 0.10 s\t6/3/2025 14:05:00\nCrosshead \tLoad \tTime \nmm\tN\tsec\n"
    path.write_text(head + table((mm(m), m.force, m.time), "\t"))


@export("zwick_de.TRA")
def _(path: Path, m: Motion) -> None:
    head = '"Prüfer";"Labor 2"\n"Probe";"Nr. 3"\n"Prüfzeit";"Standardweg";"Standardkraft";"Traversenweg absolut"\n'
    head += '"s";"mm";"N";"mm"\n'
    rows = table((m.time, mm(m), m.force, 210.0 - mm(m)), ";", comma=True)
    path.write_bytes((head + rows).encode("latin-1"))


@export("zwick_en.csv")
def _(path: Path, m: Motion) -> None:
    head = "Test time;Crosshead travel;Standard force\ns;mm;N\n"
    path.write_text(head + table((m.time, mm(m), m.force), ";"))


@export("trapezium_trials.csv")
def _(path: Path, m: Motion) -> None:
    head = (
        '"1 _ 1","","","1 _ 2","",""\n"Time","Force","Stroke","Time","Force","Stroke"\n'
        '"sec","N","mm","sec","N","mm"\n'
    )
    rows = []
    for i in range(len(m.time)):
        cells = [f'"{v:.5f}"' for v in (m.time[i], m.force[i], mm(m)[i])]
        other = cells if i < 0.6 * len(m.time) else ['""'] * 3  # the second trial is shorter
        rows.append(",".join(cells + other))
    path.write_text(head + "\n".join(rows) + "\n")


@export("trapezium_ja.csv")
def _(path: Path, m: Motion) -> None:
    head = "時間,試験力,ストローク\nsec,N,mm\n"
    path.write_bytes((head + table((m.time, m.force, mm(m)))).encode("shift_jis"))


@export("chinese_press.csv")
def _(path: Path, m: Motion) -> None:
    head = "试验名称,轮胎压缩\n时间(s),位移(mm),试验力(kN)\n"
    path.write_bytes((head + table((m.time, mm(m), 1e-3 * m.force), digits=8)).encode("gbk"))


@export("tinius_olsen.csv")
def _(path: Path, m: Motion) -> None:
    head = "Test Name,tire\nSpecimen,3\n\nTime (Sec),Position (in),Force (lbf)\n"
    path.write_text(head + table((m.time, m.deflection / INCH, m.force / POUND), digits=6))


@export("nexygen.csv")
def _(path: Path, m: Motion) -> None:
    head = "Load (kgf);Machine Extension (mm);Time (s)\n"
    path.write_text(head + table((m.force / KILOPOND, mm(m), m.time), ";", 6))


@export("mark_10.csv")
def _(path: Path, m: Motion) -> None:
    head = "Reading,Load [lbF],Travel [in],Time [sec.]\n"
    columns = (np.arange(1.0, len(m.time) + 1.0), -m.force / POUND, -m.deflection / INCH, m.time)
    path.write_text(head + table(columns, digits=6))


@export("roehrig_damper.csv", signed=True)
def _(path: Path, m: Motion) -> None:
    speed = np.gradient(m.deflection, m.time)
    head = "Shock,left rear\nTest,sine 2 in\n\nTime (sec),Displacement (in),Velocity (in/sec),Load (lbs),Temp (F)\n"
    columns = (m.time, m.deflection / INCH, speed / INCH, m.force / POUND, 71.0 + 0.0 * m.time)
    path.write_text(head + table(columns, digits=6))


@export("ctw_damper.txt", signed=True)
def _(path: Path, m: Motion) -> None:
    speed = np.gradient(m.deflection, m.time)
    head = "Time\tPosition\tVelocity\tForce\tTemperature\ns\tmm\tmm/s\tN\tC\n"
    path.write_text(head + table((m.time, mm(m), 1e3 * speed, m.force, 21.5 + 0.0 * m.time), "\t"))


@export("dartec_percent_and_mm.csv")
def _(path: Path, m: Motion) -> None:
    head = "Time (s),Stroke (%),Stroke (mm),Load (kN)\n"
    path.write_text(head + table((m.time, mm(m) / 0.5, mm(m), 1e-3 * m.force), digits=7))
