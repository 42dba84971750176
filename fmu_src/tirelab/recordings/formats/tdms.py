"""TDMS files (National Instruments), read with npTDMS; units and time come from the channel properties."""

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np

from ..origin import Origin
from ..units import split_header
from .libraries import load_library, reading_with
from .table import (
    Columns,
    FloatArray,
    Header,
    RecordingError,
    Wanted,
    numbers,
    of_one_length,
    of_other_length,
    quoted,
    sample_place,
    with_others_blank,
)


class TdmsTable:
    """The channels of a TDMS file; time is a channel, or the waveform's increment where there is one."""

    def __init__(self, path: Path) -> None:
        self.path = path
        self.library = load_library(path, "nptdms", "npTDMS")
        self.channels: list[tuple[str, str] | None] = []
        self.headers: list[Header] = []
        self.samples = 0
        waveform = False
        with reading_with(path, "TDMS", "nptdms") as self.warned, path.open("rb") as stream:
            file = self.library.TdmsFile.open(stream)
            found = [channel for group in file.groups() for channel in group.channels()]
            names = [channel.name for channel in found]
            for channel in found:
                self.samples = max(self.samples, len(channel))
                waveform = waveform or "wf_increment" in channel.properties
                self.channels.append((channel.group_name, channel.name))
                self.headers.append(_header(channel, names.count(channel.name) > 1))
        self.time_axis: int | None = None
        if waveform:
            self.time_axis = len(self.headers)
            self.channels.append(None)
            self.headers.append(Header("time", "s", "time (waveform)"))

    def bytes_needed(self, columns: int) -> int:
        """The channels as stored, scaled, and as float64."""
        return self.samples * columns * 8 * 3

    def read(self, wanted: Sequence[Wanted]) -> Columns:
        """The channels wanted; refused when their lengths or waveform clocks differ, but for those that can be done
        without."""
        origin, headers = Origin(self.path.name), [self.headers[want.index] for want in wanted]
        read: dict[int, FloatArray] = {}
        clocks: dict[int, tuple[object, ...]] = {}
        times: dict[int, FloatArray] = {}
        with reading_with(self.path, "TDMS", "nptdms"), self.path.open("rb") as stream:
            file = self.library.TdmsFile.open(stream)
            for i, want in enumerate(wanted):
                place = self.channels[want.index]
                if place is None:
                    continue
                channel = file[place[0]][place[1]]
                read[i] = numbers(origin, headers[i], channel[:], want.channel)
                if "wf_increment" in channel.properties:
                    clocks[i] = _clock(channel)
                    times[i] = _waveform_time(channel)
        apart = of_other_length([wanted[i] for i in read], list(read.values()))
        apart = {list(read)[i]: said for i, said in apart.items()}
        by_waveform = [i for i in range(len(wanted)) if i not in read]
        if by_waveform:
            needed = [i for i in clocks if wanted[i].needed] or list(clocks)
            if not needed:
                raise RecordingError(
                    f"{self.path.name}: no channel wanted has a waveform time; name one: time=NAME"
                )
            odd = [i for i in clocks if clocks[i] != clocks[needed[0]]]
            if set(odd) & set(needed):
                named = " and ".join(quoted(headers[i].text) for i in (needed[0], odd[0]))
                raise RecordingError(
                    f"{self.path.name}: {named} start or step differently in time; resample them to one time"
                )
            apart = {**dict.fromkeys(odd, "starts or steps differently in time"), **apart}
            read |= dict.fromkeys(by_waveform, times[needed[0]])
        columns, left_out = with_others_blank(headers, [read[i] for i in range(len(wanted))], apart)
        of_one_length(origin, headers, columns)
        return Columns(columns, sample_place, (*_notes(self.warned), *left_out))


UNIT_KEYS = ("unit_string", "NI_UnitDescription")
"""Properties of a channel that state its unit, of DIAdem and of LabVIEW."""


def _header(channel: Any, repeated: bool) -> Header:
    name, unit = split_header(channel.name)
    text = f"{channel.group_name}/{channel.name}" if repeated else channel.name
    stated = next(
        (str(channel.properties[key]).strip() for key in UNIT_KEYS if channel.properties.get(key)), ""
    )
    dated = channel.dtype is not None and np.dtype(channel.dtype).kind == "M"
    return Header(name, "s" if dated else (stated or unit), text, dated)


def _waveform_time(channel: Any) -> FloatArray:
    start = float(channel.properties.get("wf_start_offset", 0.0))
    return start + float(channel.properties["wf_increment"]) * np.arange(len(channel), dtype=np.float64)


def _notes(warned: Sequence[str]) -> tuple[str, ...]:
    # npTDMS reads a file that was cut short as far as it goes, and only logs it.
    return tuple(f"npTDMS warns: {message}" for message in dict.fromkeys(warned))


def _clock(channel: Any) -> tuple[object, ...]:
    keys = ("wf_increment", "wf_start_offset", "wf_start_time")
    return tuple(str(channel.properties.get(key, 0.0)) for key in keys)
