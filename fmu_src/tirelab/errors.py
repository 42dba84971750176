"""The one kind of failure that the user can correct."""


class TirelabError(ValueError):
    """Bad input, explained in one sentence with the place and the next step."""


def missing_library(purpose: str, library: str, package: str) -> str:
    """Return the sentence for a library that is not installed; `package`: its name on the package index."""
    return f"{purpose} needs {library}; install it: python -m pip install {package}"
