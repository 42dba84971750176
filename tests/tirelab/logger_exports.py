"""Exports of loggers and their programs."""

from __future__ import annotations

import datetime
from pathlib import Path

import numpy as np
from exported import Motion, export, mm, table


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


@export("labview_bare_ends.lvm")
def _(path: Path, m: Motion) -> None:
    """Without the tabs at the ends of lines, the names are a cell wider than the numbers, and X_Dimension is not."""
    head = (
        "LabVIEW Measurement\nWriter_Version\t2\nSeparator\tTab\nDecimal_Separator\t.\nX_Columns\tOne\n"
        "***End_of_Header***\n\nChannels\t2\nSamples\t400\t400\nDate\t2025/06/03\t2025/06/03\n"
        "Y_Unit_Label\tNewtons\tmm\nX_Dimension\tTime\tTime\nX0\t0.0\t0.0\nDelta_X\t0.1\t0.1\n"
        "***End_of_Header***\nX_Value\tForce\tDisplacement\tComment\n"
    )
    path.write_text(head + table((m.time, m.force, mm(m)), "\t"))


@export("scale_in_grams.csv")
def _(path: Path, m: Motion) -> None:
    columns = (np.round(1e3 * m.time), 1e6 * m.deflection, m.force / 9.80665e-3)
    path.write_text("millis,position_um,weight_g\n" + table(columns, ","))


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
