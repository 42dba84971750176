"""The encoding of a text file: what its first bytes say, or what its letters make likely."""

from __future__ import annotations

import codecs
import re
import shlex
from pathlib import Path

from ..vocabulary import WORDS, plain
from .table import RecordingError

BYTE_ORDER_MARKS = (
    (codecs.BOM_UTF8, "utf-8-sig"),
    (codecs.BOM_UTF32_LE, "utf-32"),
    (codecs.BOM_UTF32_BE, "utf-32"),
    (codecs.BOM_UTF16_LE, "utf-16"),
    (codecs.BOM_UTF16_BE, "utf-16"),
)

JUDGED = 16_384
"""Bytes of a file that are given to the detector."""

_TOGETHER = re.compile(rb"[\x80-\xff]{2}")
"""Two bytes beyond ASCII side by side, as nearly every Chinese letter has them; one alone is a western one (µm, °C)."""

_CONTROL = re.compile(rb"[\x01-\x08\x0e-\x1a\x1c-\x1f]")

LOCAL = {
    "gb18030": "GBK (GB 18030)",
    "cp932": "Shift-JIS (CP 932)",
    "cp949": "EUC-KR (CP 949)",
    "cp950": "Big5 (CP 950)",
    "cp1250": "Windows-1250 (Central European)",
    "cp1251": "Windows-1251 (Cyrillic)",
    "cp1254": "Windows-1254 (Turkish)",
    "cp850": "CP 850 (DOS)",
}
"""Encodings that are told from Latin-1 by the words for channels that they make, and what a note calls them."""

BY_BYTES = frozenset({"utf-8", "utf-8-sig", "latin-1", *LOCAL})
"""Encodings in which the bytes of separators, quotes, line ends and # stand for nothing else, so far as tables go."""


def find_encoding(path: Path, raw: bytes, whole: bool) -> tuple[str, tuple[str, ...]]:
    """Return the encoding of a text that begins with `raw`, and notes where it had to be found.

    whole: whether `raw` is all of the file
    Errors: RecordingError for bytes that are no text.
    """
    for mark, name in BYTE_ORDER_MARKS:
        if raw.startswith(mark):
            return name, ()
    text = raw.rstrip(b"\x00") if whole else raw
    if b"\x00" in text or not text:
        return _without_mark(path, raw), ("read as UTF-16 without a byte order mark",)
    try:
        codecs.getincrementaldecoder("utf-8")().decode(raw, final=whole)
    except UnicodeDecodeError as error:
        where = f"not UTF-8 (byte 0x{raw[error.start]:02x} at {error.start})"
        local = _local(raw, whole)
        if local:
            return local, (f"{where}: read as {LOCAL[local]}",)
        return "latin-1", (f"{where}: read as Latin-1",)
    return "utf-8", ()


def _without_mark(path: Path, raw: bytes) -> str:
    """Return which UTF-16 it is: text of a table has a zero in nearly every second byte."""
    for name, empty, filled in (("utf-16-le", raw[1::2], raw[::2]), ("utf-16-be", raw[::2], raw[1::2])):
        if empty.count(0) > 0.9 * len(empty) and b"\x00" not in filled:
            return name
    if _CONTROL.search(raw) or not raw.strip(b"\x00"):
        raise RecordingError(
            f"{path.name} is not text (it holds zero bytes); export it as CSV, Parquet, .mat, MDF4 or TDMS"
        )
    row = raw[: raw.index(b"\x00")].count(b"\n") + 1
    clean = path.with_name(f"{path.stem}.clean{path.suffix}")
    raise RecordingError(
        f"{path.name}, row {row}: holds zero bytes, as a card leaves them whose power was lost; what is "
        f"beside them may be cut: look at it, and leave them out: tr -d '\\000' < {shlex.quote(str(path))} > "
        f"{shlex.quote(str(clean))}"
    )


def _local(raw: bytes, whole: bool) -> str:
    """Return the encoding in which the text has most words for channels, if Latin-1 has fewer; else that of Chinese
    where it is likelier than western letters, or "".
    """
    counts = {"": 0}
    for encoding in ("latin-1", *LOCAL):
        try:
            text = plain(codecs.getincrementaldecoder(encoding)().decode(raw[:JUDGED], final=False))
        except UnicodeDecodeError:
            continue
        counts[encoding] = sum(word in text for word in WORDS)
    best = max(counts, key=lambda encoding: counts[encoding])
    if best in LOCAL and _decodes(raw, best, whole):
        return best
    return "gb18030" if _is_chinese(raw) else ""


def _decodes(raw: bytes, encoding: str, whole: bool) -> bool:
    try:
        codecs.getincrementaldecoder(encoding)().decode(raw, final=whole)
    except UnicodeDecodeError:
        return False
    return True


def _is_chinese(raw: bytes) -> bool:
    """Return whether the bytes beyond ASCII are likelier Chinese than western letters."""
    if not _TOGETHER.search(raw):
        return False
    from charset_normalizer import from_bytes

    best = from_bytes(raw[:JUDGED], cp_isolation=["cp1252", "cp1250", "gb18030"]).best()
    return best is not None and best.encoding == "gb18030"
