"""A workbook as Excel wrote it until 2003 (.xls): a BIFF8 stream in a compound file of sectors of 512 bytes."""

import struct
from collections.abc import Sequence
from pathlib import Path

SECTOR = 512
LEAST = 4096
"""A shorter stream would have to lie in the mini stream."""

END, FREE, FAT_ITSELF, NONE = 0xFFFFFFFE, 0xFFFFFFFF, 0xFFFFFFFD, 0xFFFFFFFF


def write_old_workbook(path: Path, rows: Sequence[Sequence[object]]) -> Path:
    """Write rows of texts and numbers as the one sheet of an .xls file."""
    stream = _biff(rows)
    stream += bytes(max(LEAST, -(-len(stream) // SECTOR) * SECTOR) - len(stream))
    sectors = len(stream) // SECTOR
    # sector 0: the allocation table, 1: the directory, 2 and on: the stream
    table = [FAT_ITSELF, END, *range(3, sectors + 2), END]
    assert len(table) <= SECTOR // 4
    table += [FREE] * (SECTOR // 4 - len(table))
    header = bytes.fromhex("D0CF11E0A1B11AE1") + bytes(16) + struct.pack("<5H", 0x3E, 3, 0xFFFE, 9, 6)
    header += bytes(6) + struct.pack("<9I", 0, 1, 1, 0, LEAST, END, 0, END, 0)
    header += struct.pack("<109I", 0, *[FREE] * 108)
    directory = _entry("Root Entry", 5, child=1, start=END, size=0)
    directory += _entry("Workbook", 2, child=NONE, start=2, size=len(stream))
    directory += bytes(SECTOR - len(directory))
    path.write_bytes(header + struct.pack(f"<{len(table)}I", *table) + directory + stream)
    return path


def _entry(name: str, kind: int, child: int, start: int, size: int) -> bytes:
    text = name.encode("utf-16-le") + b"\0\0"
    entry = text.ljust(64, b"\0") + struct.pack("<HBB3I", len(text), kind, 1, NONE, NONE, child)
    return entry + bytes(36) + struct.pack("<IQ", start, size)


def _biff(rows: Sequence[Sequence[object]]) -> bytes:
    bound = struct.pack("<IBBBB", 0, 0, 0, 6, 0) + b"Sheet1"
    globals_before = _record(0x0809, struct.pack("<4H2I", 0x0600, 5, 0, 0, 0, 0))
    after = _record(0x000A, b"")
    start = len(globals_before) + 4 + len(bound) + len(after)
    bound = struct.pack("<I", start) + bound[4:]
    cells = b""
    for r, row in enumerate(rows):
        for c, cell in enumerate(row):
            place = struct.pack("<3H", r, c, 0)
            if isinstance(cell, str):
                text = cell.encode("utf-16-le")
                cells += _record(0x0204, place + struct.pack("<HB", len(cell), 1) + text)
            else:
                assert isinstance(cell, float)
                cells += _record(0x0203, place + struct.pack("<d", cell))
    sheet = _record(0x0809, struct.pack("<4H2I", 0x0600, 0x10, 0, 0, 0, 0)) + cells + after
    return globals_before + _record(0x0085, bound) + after + sheet


def _record(kind: int, data: bytes) -> bytes:
    return struct.pack("<2H", kind, len(data)) + data
