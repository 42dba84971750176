"""Exports that are no text: workbooks, MATLAB, Parquet, TDMS, MDF and HDF5."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from exported import Motion, export, mm


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
