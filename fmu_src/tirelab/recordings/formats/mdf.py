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
        read: dict[int, FloatArray] = {}
        clock: FloatArray | None = None
        with (
            reading_with(self.path, "MDF", "asammdf"),
            _Stream(self.path) as file,
            self.library.MDF(file) as mdf,
        ):
            for want in wanted:
                if want.index == self.time_axis:
                    continue
                group, index = self.channels[want.index]
                # asammdf would leave invalid samples out, and with them the channel's step with the others.
                signal = mdf.get(group=group, index=index, ignore_invalidation_bits=True)
                column = numbers(
                    Origin(self.path.name), self.headers[want.index], signal.samples, want.channel
                )
                invalid = signal.invalidation_bits
                if invalid is not None:
                    column = np.where(np.asarray(invalid, dtype=bool), np.nan, column)
                read[want.index] = column
                stamps = np.asarray(signal.timestamps, dtype=np.float64)
                clock = stamps if clock is None else clock
                of_one_length(Origin(self.path.name), [self.headers[i] for i in read], list(read.values()))
                if not np.array_equal(clock, stamps):
                    first, this = self.headers[next(iter(read))], self.headers[want.index]
                    raise RecordingError(
                        f"{self.path.name}: {quoted(first.text)} and {quoted(this.text)} were sampled at "
                        "different times; resample them to one time (asammdf: MDF.resample) and save again"
                    )
        if clock is None:
            raise RecordingError(f"{self.path.name}: holds no channel but time; name channels with --columns")
        columns = [clock if want.index == self.time_axis else read[want.index] for want in wanted]
        notes = tuple(f"asammdf warns: {message}" for message in dict.fromkeys(self.warned))
        return Columns(tuple(columns), sample_place, notes)
