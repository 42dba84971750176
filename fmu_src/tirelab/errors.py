"""The one kind of failure that is the user's to mend."""


class TirelabError(ValueError):
    """Bad input, told in one sentence with the place and the next step."""
