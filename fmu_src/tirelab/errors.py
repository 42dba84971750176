"""The one kind of failure that the user can correct, and arguments of another kind than a function takes."""

import json
from collections.abc import Iterable, Mapping
from numbers import Real
from pathlib import Path


class TirelabError(ValueError):
    """Bad input, explained in one sentence with the place and the next step."""


def unwritable_folder(folder: Path, error: OSError) -> TirelabError:
    """Return the error of a command whose folder for its files, given with --out, cannot be written."""
    return TirelabError(f"{folder} cannot be written ({error.strerror}); name another folder with --out")


def missing_library(purpose: str, library: str, package: str) -> str:
    """Return the sentence for a library that is not installed; `package`: its name on the package index."""
    return f"{purpose} needs {library}; install it: python -m pip install {package}"


def what_is_wrong(error: Exception) -> str:
    """Return why a JSON document cannot be used, in words: of an entry that lacks, has another kind, or of its text."""
    if isinstance(error, json.JSONDecodeError):
        return f"not JSON at line {error.lineno}, column {error.colno}"
    if isinstance(error, KeyError):
        return f"it has no entry {error}"
    return str(error) if isinstance(error, ValueError) else "an entry is of another kind than it should be"


def check_recordings_given(given: Iterable[object]) -> None:
    """Raise TypeError, in one sentence, where one of several recordings is none, such as the path of a file."""
    for one in given:
        if not hasattr(one, "deflection"):
            how = f"read it first: read_recording({str(one)!r})" if isinstance(one, (str, Path)) else _ARRAYS
            raise TypeError(f"{str(one)[:60]!r} is of type {type(one).__name__}, not a recording; {how}")


def check_given(given: object, kind: type, argument: str, what: str, instance: str) -> None:
    """Raise TypeError, in one sentence, where an argument is not of the type `kind`; what: it should be, with what is
    given for instance.
    """
    if not isinstance(given, kind):
        raise TypeError(
            f"{argument}={str(given)[:60]!r} is of type {type(given).__name__}, not {what}; give for instance "
            f"{instance}"
        )


def check_names_given(argument: str, given: object) -> None:
    """Raise TypeError, in one sentence, where several names are one text, or no names."""
    if isinstance(given, str):
        raise TypeError(
            f"{argument}={given[:60]!r} is one text, not several names; give {argument}=[{given[:60]!r}]"
        )
    if not isinstance(given, Iterable):
        raise TypeError(
            f"{argument}={str(given)[:60]!r} is of type {type(given).__name__}, not several names; give a list of them"
        )


def refuse_unknown(given: Mapping[str, object], known: Mapping[str, object]) -> None:
    """Raise TypeError, in one sentence, where a keyword argument is none of those known."""
    names = sorted(known)
    for name in given:
        if name not in names:
            raise TypeError(
                f"unexpected keyword argument {name!r}; beside those of the signature: {', '.join(names)}"
            )


_OF_CHANNELS = {"columns": {"force": "#3"}, "units": {"force": "kN"}, "zero": {"force": "5 N"}}


def texts_of_channels(argument: str, given: object) -> Mapping[str, str]:
    """Return what an argument (columns, units, zero) says of channels as text, nothing where it is None.

    Raise TypeError, in one sentence, where it is no mapping, such as the text of a command's option.
    """
    if given is None:
        return {}
    if isinstance(given, Mapping):
        return {name: str(text) for name, text in given.items()}
    raise TypeError(
        f"{argument}={str(given)[:60]!r} is of type {type(given).__name__}, no mapping; give for instance "
        f"{argument}={json.dumps(_OF_CHANNELS[argument])}"
    )


_OF_ALL_SAMPLES = {"radius": '"flat"', "sampling": '"10 Hz"'}


def text_or_number(argument: str, given: object) -> str | float | None:
    """Return an argument (radius, sampling) that is a text, a number of any library, or None.

    Raise TypeError, in one sentence, for any other, such as a list.
    """
    if given is None or isinstance(given, (str, int, float)):
        return given
    if isinstance(given, Real):
        return float(given)
    raise TypeError(
        f"{argument}={str(given)[:60]!r} is of type {type(given).__name__}, neither a text nor a number; give for "
        f"instance {argument}={_OF_ALL_SAMPLES[argument]}"
    )


_ARRAYS = "make one of arrays with Recording.from_arrays, of a data frame with Recording.from_dataframe"


def check_tire_given(given: object) -> None:
    """Raise TypeError, in one sentence, where a tire is none, such as the path of its file."""
    if not hasattr(given, "law"):
        how = (
            f"read_tire({str(given)!r})"
            if isinstance(given, (str, Path))
            else "read_tire(FILE) or TireModel()"
        )
        raise TypeError(f"{str(given)[:60]!r} is of type {type(given).__name__}, not a tire; give {how}")
