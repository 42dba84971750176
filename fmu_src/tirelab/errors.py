"""The one kind of failure that the user can correct."""

import json


class TirelabError(ValueError):
    """Bad input, explained in one sentence with the place and the next step."""


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
