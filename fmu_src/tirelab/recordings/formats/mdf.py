"""MDF4 files (ASAM), read with asammdf; units and the time axis come from the file."""

import io
from collections.abc import Sequence
from pathlib import Path

import numpy as np

from ..origin import Origin
from .libraries import load_library, reading_with
from .table import (
    Columns,
    FloatArray,
    Header,
    RecordingError,
    Wanted,
    numbers,
    of_one_length,
    quoted,
    sample_place,
    with_others_blank,
)

LEAST_READS = 20_000
"""Reads allowed to any MDF file; a sound one takes a few for each of its blocks."""


class _Stream(io.BufferedReader):
    """A file whose blocks, once damaged, may lead in a circle: read as often as it has bytes, it gives up."""

    def __init__(self, path: Path) -> None:
        super().__init__(io.FileIO(path))
        self.file_name = path.name
        self.reads_left = LEAST_READS + path.stat().st_size

    def read(self, size: int | None = -1, /) -> bytes:
        """The next bytes, while there is patience."""
        self.reads_left -= 1
        if self.reads_left < 0:
            raise RecordingError(f"{self.file_name} is damaged: its blocks lead in a circle; save it anew")
        return super().read(size)


class MdfTable:
    """The channels of an MDF file; the same name in two groups becomes "0/Force" and "1/Force"."""

    time_axis: int | None = 0

    def __init__(self, path: Path) -> None:
        self.path = path
        self.library = load_library(path, "asammdf", "asammdf")
        self.channels: list[tuple[int, int]] = [(-1, -1)]
        self.headers: list[Header] = [Header("time", "s", "time")]
        self.samples = 0
        with (
            reading_with(path, "MDF", "asammdf") as self.warned,
            _Stream(path) as file,
            self.library.MDF(file) as mdf,
        ):
            found: list[tuple[int, int, str, str]] = []
            for group, content in enumerate(mdf.groups):
                for index, channel in enumerate(content.channels):
                    if mdf.masters_db.get(group) != index:
                        unit = mdf.get_channel_unit(group=group, index=index)
                        found.append((group, index, str(channel.name), str(unit or "")))
                self.samples = max(self.samples, int(content.channel_group.cycles_nr))
        names = [name for _, _, name, _ in found]
        for group, index, name, unit in found:
            text = name if names.count(name) == 1 else f"{group}/{name}"
            self.channels.append((group, index))
            self.headers.append(Header(name, unit or None, text))

    def bytes_needed(self, columns: int) -> int:
        """Samples and time stamps of each channel, as stored and as float64."""
        return self.samples * columns * 8 * 3

    def read(self, wanted: Sequence[Wanted]) -> Columns:
        """The channels wanted on the time they share; samples marked invalid are blanks.

        Errors: RecordingError when the channels were sampled at different times: nothing is resampled here.
        """
        origin, headers = Origin(self.path.name), [self.headers[want.index] for want in wanted]
        read: dict[int, FloatArray] = {}
        stamps: dict[int, FloatArray] = {}
        with (
            reading_with(self.path, "MDF", "asammdf"),
            _Stream(self.path) as file,
            self.library.MDF(file) as mdf,
        ):
            for i, want in enumerate(wanted):
                if want.index == self.time_axis:
                    continue
                group, index = self.channels[want.index]
                # asammdf would leave invalid samples out, and with them the channel's step with the others.
                signal = mdf.get(group=group, index=index, ignore_invalidation_bits=True)
                column = numbers(origin, headers[i], signal.samples, want.channel)
                invalid = signal.invalidation_bits
                if invalid is not None:
                    column = np.where(np.asarray(invalid, dtype=bool), np.nan, column)
                read[i] = column
                stamps[i] = np.asarray(signal.timestamps, dtype=np.float64)
        if not read:
            raise RecordingError(f"{self.path.name}: holds no channel but time; name channels with --columns")
        first = next((i for i in read if wanted[i].needed), next(iter(read)))
        odd = [i for i in read if not np.array_equal(stamps[first], stamps[i])]
        at_fault = next((i for i in odd if wanted[i].needed), None)
        if at_fault is not None:
            of_one_length(origin, [headers[i] for i in (first, at_fault)], [read[first], read[at_fault]])
            raise RecordingError(
                f"{self.path.name}: {quoted(headers[first].text)} and {quoted(headers[at_fault].text)} were sampled "
                "at different times; resample them to one time (asammdf: MDF.resample) and save again"
            )
        columns, left_out = with_others_blank(
            headers,
            [read.get(i, stamps[first]) for i in range(len(wanted))],
            dict.fromkeys(odd, "was sampled at different times"),
        )
        notes = tuple(f"asammdf warns: {message}" for message in dict.fromkeys(self.warned))
        return Columns(columns, sample_place, (*notes, *left_out))
