"""Exports as test machines, loggers and programs write them, made of one motion whose values are known.

The structure of each is that of the machine or program it is named for; the numbers and the texts are ours.
"""

from __future__ import annotations

import datetime
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

RATE = 10.0
"""Samples in a second."""

INCH, POUND, KILOPOND = 0.0254, 4.4482216152605, 9.80665
"""An inch [m], a pound-force [N] and a kilogram-force [N], exact by definition."""


@dataclass(frozen=True)
class Motion:
    """What was recorded: time [s], deflection [m] and force [N], compression positive."""

    time: Array
    deflection: Array
    force: Array


def pressed(seconds: float = 40.0, stroke: float = 0.020) -> Motion:
    """Return two triangles of a press on the article's tire, with friction of 4 %: the force of no sample is round."""
    time = np.arange(0.0, seconds, 1.0 / RATE)
    phase = 2.0 * time / seconds
    deflection = stroke * (1.0 - np.abs(1.0 - 2.0 * (phase - np.floor(phase))))
    law = 550.9 * (100.0 * deflection) ** 1.422
    return Motion(time, deflection, law * np.where(phase - np.floor(phase) < 0.5, 1.02, 0.98) + 0.37)


def damped(seconds: float = 20.0, stroke: float = 0.0254) -> Motion:
    """Return sines of a damper: 1500 N s/m in compression, 2500 N s/m in rebound; both channels of both signs."""
    time = np.arange(0.0, seconds, 1.0 / RATE)
    angle = 2.0 * np.pi * 0.37 * time
    speed = stroke * 2.0 * np.pi * 0.37 * np.cos(angle)
    force = np.where(speed > 0.0, 1500.0 * speed, 2500.0 * speed) + 35.0
    return Motion(time, stroke * np.sin(angle), force)


Writer = Callable[[Path, Motion], None]


@dataclass(frozen=True)
class Export:
    """One export: the name of its file and how it is written.

    signed: of a part that pulls
    """

    name: str
    write: Writer
    signed: bool = False

    @property
    def motion(self) -> Motion:
        """What was recorded."""
        return damped() if self.signed else pressed()


EXPORTS: dict[str, Export] = {}
"""By the name of the file."""


def export(name: str, signed: bool = False) -> Callable[[Writer], Writer]:
    """Register how a file is written."""

    def registered(write: Writer) -> Writer:
        EXPORTS[name] = Export(name, write, signed)
        return write

    return registered


def table(
    columns: Sequence[Array], separator: str = ",", digits: int = 5, comma: bool = False, quote: bool = False
) -> str:
    """Return rows of numbers."""
    rows = []
    for values in zip(*columns, strict=True):
        cells = [f"{value:.{digits}f}" for value in values]
        if comma:
            cells = [cell.replace(".", ",") for cell in cells]
        if quote:
            cells = [f'"{cell}"' for cell in cells]
        rows.append(separator.join(cells))
    return "\n".join(rows) + "\n"


def mm(m: Motion) -> Array:
    return 1e3 * m.deflection


# -- test machines ---------------------------------------------------------------------------------------------------


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


# -- loggers and their programs --------------------------------------------------------------------------------------


@export("catman.asc")
def _(path: Path, m: Motion) -> None:
    names = "Zeit  1 - Standardmessrate [s]\tKraft [kN]\tWegaufnehmer Stempel [mm]\n"
    head = (
        "HBM_CATMAN_DATAFILE_40\tDATAFILE_40\nNumber of channels:\t3\nDatei: Versuch_3\n\n"
        + names
        + "dt=100,000000 ms\tdt=100,000000 ms\tdt=100,000000 ms\n"
        "Dezimaltrennzeichen=,\t\t\nT0 = 03.06.2025 14:05:00\tT0 = 03.06.2025 14:05:00\tT0 = 03.06.2025 14:05:00\n"
    )
    rows = table((m.time, 1e-3 * m.force, mm(m)), "\t", 8, comma=True)
    path.write_bytes((head + rows).encode("latin-1"))


@export("dewesoft.txt")
def _(path: Path, m: Motion) -> None:
    head = (
        "Data file: tire_0003.dxd\nStart time: 3/6/2025 14:05:00.123\nSample rate: 10 Hz\nNumber of channels: 2\n"
        "\nTime (s)\tForce (N)\tDisplacement (mm)\n"
    )
    path.write_text(head + table((m.time, m.force, mm(m)), "\t"))


@export("labview.lvm")
def _(path: Path, m: Motion) -> None:
    head = (
        "LabVIEW Measurement\t\nWriter_Version\t2\nReader_Version\t2\nSeparator\tTab\nDecimal_Separator\t.\n"
        "Multi_Headings\tNo\nX_Columns\tOne\nTime_Pref\tRelative\nOperator\tlab\nDate\t2025/06/03\n"
        "Time\t14:05:00.123\n***End_of_Header***\t\n\t\nChannels\t2\t\t\nSamples\t400\t400\t\n"
        "Date\t2025/06/03\t2025/06/03\t\nTime\t14:05:00.123\t14:05:00.123\t\nY_Unit_Label\tNewtons\tmm\t\n"
        "X_Dimension\tTime\tTime\t\nX0\t0.0000000000000000E+0\t0.0000000000000000E+0\t\n"
        "Delta_X\t0.100000\t0.100000\t\n***End_of_Header***\t\t\t\nX_Value\tForce\tDisplacement\tComment\n"
    )
    path.write_text(head + table((m.time, m.force, mm(m)), "\t"))


@export("labview_headings.lvm")
def _(path: Path, m: Motion) -> None:
    head = (
        "LabVIEW Measurement\t\nWriter_Version\t2\nReader_Version\t2\nSeparator\tComma\nDecimal_Separator\t.\n"
        "Multi_Headings\tYes\nX_Columns\tNo\nTime_Pref\tRelative\n***End_of_Header***\t\n\t\n"
    ).replace("\t", ",")
    text = head
    for part in (slice(0, 250), slice(250, 400)):
        count = part.stop - part.start
        text += f"Channels,2,,\nSamples,{count},{count},\nY_Unit_Label,N,mm,\nX_Dimension,Time,Time,\n"
        text += f"X0,{m.time[part][0]:.3f},{m.time[part][0]:.3f},\nDelta_X,0.100000,0.100000,\n"
        text += "***End_of_Header***,,,\nX_Value,Force,Displacement,Comment\n"
        text += "".join(f",{f:.5f},{x:.5f}\n" for f, x in zip(m.force[part], mm(m)[part], strict=True))
        text += "\n"
    path.write_text(text)


@export("dasylab.asc")
def _(path: Path, m: Motion) -> None:
    head = (
        "DASYLab - V 11.00.00\nWorksheet name: presse\nRecording date: 03.06.2025, 14:05:00\nBlock length: 1\n"
        "Delta: 0,1 sec\nNumber of channels: 2\nMeasurement time[hh:mm:ss];Kraft [N];Weg [mm];\n"
    )
    clock = [(datetime.datetime(2025, 6, 3) + datetime.timedelta(seconds=t)) for t in m.time]
    rows = [
        f"{c:%H:%M:%S},{c.microsecond // 1000:03d};" + f"{f:.5f};{x:.5f};".replace(".", ",")
        for c, f, x in zip(clock, m.force, mm(m), strict=True)
    ]
    path.write_bytes((head + "\n".join(rows) + "\n").encode("latin-1"))


@export("famos.txt")
def _(path: Path, m: Motion) -> None:
    head = "Zeit\tKraft_1\tWeg_1\ns\tN\tmm\n"
    path.write_text(head + table((m.time, m.force, mm(m)), "\t", comma=True))


@export("arduino_ms.txt")
def _(path: Path, m: Motion) -> None:
    rows = [f"{1000 * t:.0f} {x:.4f} {f:.3f}" for t, x, f in zip(m.time, mm(m), m.force, strict=True)]
    path.write_text("\n".join(rows) + "\n")


@export("arduino_monitor.log")
def _(path: Path, m: Motion) -> None:
    start = datetime.datetime(2025, 6, 3, 14, 5)
    lines = [
        f"{(start + datetime.timedelta(seconds=t)).strftime('%H:%M:%S.%f')[:-3]} -> {x:.4f},{f:.3f}"
        for t, x, f in zip(m.time, mm(m), m.force, strict=True)
    ]
    path.write_text("\n".join(lines) + "\n")


@export("epoch.csv")
def _(path: Path, m: Motion) -> None:
    rows = [
        f"{1748959500.25 + t:.3f},{x:.5f},{f:.4f}" for t, x, f in zip(m.time, mm(m), m.force, strict=True)
    ]
    path.write_text("timestamp [s],displacement [mm],force [N]\n" + "\n".join(rows) + "\n")


@export("epoch_ms.csv")
def _(path: Path, m: Motion) -> None:
    rows = [
        f"{1748959500250 + round(1000 * t)},{x:.5f},{f:.4f}"
        for t, x, f in zip(m.time, mm(m), m.force, strict=True)
    ]
    path.write_text("timestamp,displacement [mm],force [N]\n" + "\n".join(rows) + "\n")


@export("epoch_us.csv")
def _(path: Path, m: Motion) -> None:
    rows = [
        f"{1748959500250000 + round(1e6 * t)},{x:.5f},{f:.4f}"
        for t, x, f in zip(m.time, mm(m), m.force, strict=True)
    ]
    path.write_text("ts,displacement [mm],force [N]\n" + "\n".join(rows) + "\n")


@export("sample_numbers.csv")
def _(path: Path, m: Motion) -> None:
    head = "Sample,Displacement (mm),Force (N)\n"
    path.write_text(head + table((np.arange(1.0, len(m.time) + 1.0), mm(m), m.force)))


@export("elapsed_clock.csv")
def _(path: Path, m: Motion) -> None:
    rows = [
        f"00:{int(t // 60):02d}:{t % 60:06.3f},{x:.5f},{f:.4f}"
        for t, x, f in zip(m.time, mm(m), m.force, strict=True)
    ]
    path.write_text("Elapsed Time,Displacement (mm),Force (N)\n" + "\n".join(rows) + "\n")


# -- what happens to any of them -------------------------------------------------------------------------------------


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


# -- binary ----------------------------------------------------------------------------------------------------------


@export("several_sheets.xlsx")
def _(path: Path, m: Motion) -> None:
    import openpyxl

    book = openpyxl.Workbook()
    first = book.active
    first.title = "Results"
    for row in (("Specimen", "Maximum force", "at"), ("", "N", "mm"), (1, 1520.4, 20.0), (2, 1519.8, 20.0)):
        first.append(row)
    book.create_sheet("Settings").append(("Speed", 2.0, "mm/s"))
    raw = book.create_sheet("Raw data")
    raw.append(("Customer", "somebody"))
    raw.append(())
    raw.append(("Time", "Displacement", "Force"))
    raw.append(("s", "mm", "kN"))
    for row in zip(m.time, mm(m), 1e-3 * m.force, strict=True):
        raw.append(tuple(float(v) for v in row))
    book.save(path)


@export("numbers_as_text.xlsx")
def _(path: Path, m: Motion) -> None:
    import openpyxl

    book = openpyxl.Workbook()
    sheet = book.active
    sheet.append(("Zeit [s]", "Weg [mm]", "Kraft [N]"))
    for row in zip(m.time, mm(m), m.force, strict=True):
        sheet.append(tuple(f"{v:.5f}".replace(".", ",") for v in row))
    book.save(path)


@export("summary_in_sheet.xlsx")
def _(path: Path, m: Motion) -> None:
    import openpyxl

    book = openpyxl.Workbook()
    sheet = book.active
    sheet.append(("Time [s]", "Displacement [mm]", "Force [N]"))
    for row in zip(m.time, mm(m), m.force, strict=True):
        sheet.append(tuple(float(v) for v in row))
    sheet.append(())
    sheet.append(("Maximum", 20.0, 1520.4))
    book.save(path)


@export("structs.mat")
def _(path: Path, m: Motion) -> None:
    import scipy.io

    scipy.io.savemat(path, {"data": {"time_s": m.time, "stroke_mm": mm(m), "force_kN": 1e-3 * m.force}})


@export("frame.parquet")
def _(path: Path, m: Motion) -> None:
    import polars as pl

    pl.DataFrame({"t [ms]": 1e3 * m.time, "Weg [mm]": mm(m), "Kraft [kN]": 1e-3 * m.force}).write_parquet(
        path
    )


@export("groups.tdms")
def _(path: Path, m: Motion) -> None:
    import nptdms

    properties = {"wf_increment": 0.1, "wf_start_offset": 0.0}
    with nptdms.TdmsWriter(path) as writer:
        writer.write_segment(
            [
                nptdms.ChannelObject("Log", "Force", 1e-3 * m.force, {"unit_string": "kN", **properties}),
                nptdms.ChannelObject("Log", "Displacement", mm(m), {"unit_string": "mm", **properties}),
            ]
        )


@export("signals.mf4")
def _(path: Path, m: Motion) -> None:
    import asammdf

    with asammdf.MDF(version="4.10") as mdf:
        mdf.append(
            [
                asammdf.Signal(mm(m), m.time, unit="mm", name="Displacement"),
                asammdf.Signal(1e-3 * m.force, m.time, unit="kN", name="Force"),
            ]
        )
        mdf.save(path, overwrite=True)


@export("arrays.h5")
def _(path: Path, m: Motion) -> None:
    import h5py

    with h5py.File(path, "w") as file:
        for name, values, unit in (("time", m.time, "s"), ("stroke", mm(m), "mm"), ("load", m.force, "N")):
            file.create_dataset(f"run 1/{name}", data=values).attrs["units"] = unit


@export("version_7_3.mat")
def _(path: Path, m: Motion) -> None:
    import h5py

    with h5py.File(path, "w", userblock_size=512) as file:
        for name, values in (("t", m.time), ("stroke_mm", mm(m)), ("load_kN", 1e-3 * m.force)):
            file.create_dataset(name, data=values.reshape(1, -1)).attrs["MATLAB_class"] = np.bytes_("double")
    with path.open("r+b") as stream:
        stream.write(b"MATLAB 7.3 MAT-file, Platform: GLNXA64".ljust(124) + b"\x00\x02IM")
