"""Tables with what happens to exports of any machine: units, blocks, remarks, stamps."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from exported import INCH, KILOPOND, POUND, Motion, export, mm, table


@export("summary_below.csv")
def _(path: Path, m: Motion) -> None:
    rows = table((m.time, mm(m), m.force))
    path.write_text(
        "Time (s),Displacement (mm),Force (N)\n" + rows + "\nMaximum,20.0,1520.4\nMinimum,0.0,0.4\n"
    )


@export("statistics_below.csv")
def _(path: Path, m: Motion) -> None:
    rows = table((m.time, mm(m), m.force), ";", comma=True)
    below = "\nStatistik;;\nAnzahl;400;\nMittelwert;;612,5\nStandardabweichung;;480,1\n"
    path.write_text("Zeit [s];Weg [mm];Kraft [N]\n" + rows + below)


@export("header_again.csv")
def _(path: Path, m: Motion) -> None:
    head = "Time (s),Displacement (mm),Force (N)\n"
    parts = [
        head + table((m.time[p], mm(m)[p], m.force[p]))
        for p in (slice(0, 120), slice(120, 260), slice(260, 400))
    ]
    path.write_text("".join(parts))


@export("units_again.csv")
def _(path: Path, m: Motion) -> None:
    head = "Time,Displacement,Force\ns,mm,N\n"
    parts = [head + table((m.time[p], mm(m)[p], m.force[p])) for p in (slice(0, 120), slice(120, 400))]
    path.write_text("\n\n".join(parts))


@export("remarks_between.csv")
def _(path: Path, m: Motion) -> None:
    lines = table((m.time, mm(m), m.force)).splitlines()
    lines.insert(300, "// second cycle")
    lines.insert(100, "# hold of 0 s")
    lines.insert(50, "")
    path.write_text("Time (s),Displacement (mm),Force (N)\n" + "\n".join(lines) + "\n")


@export("step_names_between.txt")
def _(path: Path, m: Motion) -> None:
    lines = table((m.time, mm(m), m.force), "\t").splitlines()
    lines.insert(200, "Step 2: load again")
    path.write_text("Time (s)\tDisplacement (mm)\tForce (N)\nStep 1: load\n" + "\n".join(lines) + "\n")


@export("nan_and_empty.csv")
def _(path: Path, m: Motion) -> None:
    lines = table((m.time, mm(m), m.force)).splitlines()
    for i, bad in ((30, "NaN"), (31, ""), (90, "nan"), (250, "")):
        lines[i] = ",".join([*lines[i].split(",")[:2], bad])
    path.write_text("Time (s),Displacement (mm),Force (N)\n" + "\n".join(lines) + "\n")


@export("slash_units.csv")
def _(path: Path, m: Motion) -> None:
    path.write_text(
        "Zeit/s;Weg/µm;Kraft/daN\n" + table((m.time, 1e3 * mm(m), 0.1 * m.force), ";", comma=True)
    )


@export("symbols.csv")
def _(path: Path, m: Motion) -> None:
    path.write_text("t [s],s [mm],F [kN]\n" + table((m.time, mm(m), 1e-3 * m.force), digits=8))


@export("underscores.csv")
def _(path: Path, m: Motion) -> None:
    path.write_text("time_ms,disp_mm,load_N\n" + table((1e3 * m.time, mm(m), m.force)))


@export("kip_and_mil.csv")
def _(path: Path, m: Motion) -> None:
    columns = (m.time / 60.0, m.deflection / INCH * 1e3, m.force / POUND * 1e-3)
    path.write_text("Time (min),Stroke (mil),Load (kip)\n" + table(columns, digits=9))


@export("gram_force.csv")
def _(path: Path, m: Motion) -> None:
    columns = (m.time, m.deflection / INCH, 1e3 * m.force / KILOPOND)
    path.write_text("Time (sec),Travel (inch),Load (gf)\n" + table(columns, digits=7))


@export("negative_compression.csv")
def _(path: Path, m: Motion) -> None:
    path.write_text("Time (s),Position (mm),Force (N)\n" + table((m.time, -mm(m), -m.force)))


@export("quoted_decimal_commas.csv")
def _(path: Path, m: Motion) -> None:
    rows = table((m.time, mm(m), m.force), ",", comma=True, quote=True)
    path.write_text('"Zeit [s]","Weg [mm]","Kraft [N]"\n' + rows)


@export("old_mac.csv")
def _(path: Path, m: Motion) -> None:
    text = "Time (s),Displacement (mm),Force (N)\n" + table((m.time, mm(m), m.force))
    path.write_bytes(text.replace("\n", "\r").encode())


@export("unicode_text.txt")
def _(path: Path, m: Motion) -> None:
    text = "Zeit [s]\tWeg [mm]\tKraft [N]\n" + table((m.time, mm(m), m.force), "\t", comma=True)
    path.write_text(text, encoding="utf-16")


@export("two_gauges.csv")
def _(path: Path, m: Motion) -> None:
    head = "Time (s),Crosshead (mm),Displacement (mm),Force (N)\n"
    path.write_text(head + table((m.time, 1.1 * mm(m), mm(m), m.force)))


@export("set_point_beside.csv")
def _(path: Path, m: Motion) -> None:
    head = "Time (s),Axial Displacement Command (mm),Axial Displacement (mm),Axial Force Command (N),Axial Force (N)\n"
    path.write_text(head + table((m.time, mm(m) + 0.3, mm(m), m.force * 1.2, m.force)))


@export("peak_beside.csv")
def _(path: Path, m: Motion) -> None:
    head = "Time [s],Peak Load [N],Actual Load [N],Stroke [mm]\n"
    path.write_text(head + table((m.time, np.maximum.accumulate(m.force), m.force, mm(m))))


@export("names_on_two_rows.csv")
def _(path: Path, m: Motion) -> None:
    head = "Test,Axial,Axial\nTime,Displacement,Force\n(s),(mm),(N)\n"
    path.write_text(head + table((m.time, mm(m), m.force)))


@export("repeated_stamps.csv")
def _(path: Path, m: Motion) -> None:
    head = "Time (s),Displacement (mm),Force (N)\n"
    path.write_text(head + table((np.floor(m.time * 5.0) / 5.0, mm(m), m.force)))


@export("symbols_with_units.csv")
def _(path: Path, m: Motion) -> None:
    path.write_text("t_ms,x_mm,F_kN\n" + table((1e3 * m.time, mm(m), 1e-3 * m.force), digits=8))


@export("capitals_at_the_start.csv")
def _(path: Path, m: Motion) -> None:
    columns = (m.time, m.deflection / INCH, m.force / POUND)
    path.write_text("Time (Sec),Stroke (Inch),Load (Lbf)\n" + table(columns, digits=7))


@export("capitals.dat")
def _(path: Path, m: Motion) -> None:
    rows = [f"{t:15.8E}{x:15.8E}{f:15.8E}" for t, x, f in zip(m.time, m.deflection, m.force, strict=True)]
    path.write_text("   TIME (S)    DISPL (M)    FORCE (N)\n" + "\n".join(rows).replace("E", "D") + "\n")


@export("full_counter.csv")
def _(path: Path, m: Motion) -> None:
    counts = (1e6 * m.time + 2.0**32 - 1e7) % 2.0**32
    path.write_text("time (us),displacement (mm),force (N)\n" + table((counts, mm(m), m.force)))
