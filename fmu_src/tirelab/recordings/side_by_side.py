"""Tests that stand side by side in one table: how many there are, and which columns are those of one."""

import re
from collections.abc import Mapping, Sequence
from itertools import pairwise

from .formats import Header, RecordingError
from .origin import Origin

NUMBER = re.compile(r"[+-]?\s*#(\d{1,6})", re.ASCII)
"""A column that is named by its number, the first #1, with a sign before it or none."""

_DIGITS = re.compile(r"\d+", re.ASCII)


class SeveralTrials(RecordingError):
    """Several tests stand side by side in a table, and none is named."""

    def __init__(self, origin: Origin, trials: int) -> None:
        how = (
            f"{origin}@trial1 to {origin}@trial{trials}"
            if origin.kind == "file"
            else 'columns={"force": "#3", ...}'
        )
        super().__init__(f"{origin}: holds {trials} trials side by side; name one: {how}")
        self.trials = trials


def no_such_trial(origin: Origin, trials: int) -> RecordingError:
    """Return the error for a trial beyond those that stand side by side."""
    return RecordingError(f"{origin}: has {trials} trials side by side; name @trial1 to @trial{trials}")


def width_of_a_test(headers: Sequence[Header]) -> int:
    """Return after how many columns the names begin again, all columns being such tests; the number of columns else."""
    texts = [header.text for header in headers]
    widths = (width for width in range(2, len(texts) // 2 + 1) if len(texts) % width == 0)
    return next((width for width in widths if texts[width:] == texts[:-width]), len(texts))


def number_within(text: str, first: int, width: int) -> str:
    """Return a number of a column in the whole table as that in the test that begins after `first` columns."""
    found = NUMBER.fullmatch(text.strip())
    if found is None or not first < int(found[1]) <= first + width:
        return text
    return text.replace(found[1], str(int(found[1]) - first))


def trials_in(found: Mapping[str, Sequence[int]]) -> int:
    """Return how many tests stand side by side: as many deflections as forces, in turn, and one time or as many.

    found: the columns that may be each channel
    """
    count = len(found.get("force", ()))
    if (
        count < 2
        or len(found.get("deflection", ())) != count
        or len(found.get("time", ())) not in (0, 1, count)
    ):
        return 1
    pairs = _pairs(found)
    apart = all(max(pair) < min(after) for pair, after in pairwise(pairs))
    return count if apart else 1


def of_trial(
    origin: Origin, found: Mapping[str, list[int]], trials: int, trial: int | None
) -> dict[str, list[int]]:
    """Return the columns of one of the tests side by side; a column that all share stays.

    Errors: SeveralTrials where none is asked for; RecordingError where it is beyond them.
    """
    if trial is None:
        raise SeveralTrials(origin, trials)
    if not 1 <= trial <= trials:
        raise no_such_trial(origin, trials)
    return {
        name: [columns[trial - 1]] if len(columns) == trials else columns if len(columns) == 1 else []
        for name, columns in found.items()
    }


def in_own_test(headers: Sequence[Header], found: Mapping[str, list[int]], index: int, trial: int) -> int:
    """Return the column of a test that stands where a column of the first test stands in that: `#1` of the second is
    its own clock, as the names of the two say, which differ in numbers alone.

    found: the columns that may be each channel; the column itself where the tests are not laid out alike
    """
    pairs = _pairs(found)
    width = min(pairs[1]) - min(pairs[0])
    as_wide = all(min(pair) == min(pairs[0]) + n * width for n, pair in enumerate(pairs))
    own = index + (trial - 1) * width
    if not as_wide or max(pairs[0]) >= width or index >= width or own >= len(headers):
        return index
    one, other = (_DIGITS.sub("#", headers[i].text) for i in (index, own))
    return own if one == other else index


def _pairs(found: Mapping[str, Sequence[int]]) -> list[tuple[int, int]]:
    return list(zip(found.get("deflection", ()), found.get("force", ()), strict=True))
