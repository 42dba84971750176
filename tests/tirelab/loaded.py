"""What a page of HTML loads from elsewhere or links to."""

from __future__ import annotations

from html.parser import HTMLParser


def loaded_by(page: str) -> list[str]:
    """Return the tags that load something, and the targets of all links that leave the page."""
    found = _Loaded()
    found.feed(page)
    return found.found


class _Loaded(HTMLParser):
    def __init__(self) -> None:
        super().__init__()
        self.found: list[str] = []

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        if tag in ("script", "link", "iframe", "img", "object"):
            self.found.append(tag)
        targets = [str(value) for name, value in attrs if name in ("src", "href", "xlink:href")]
        self.found += [target for target in targets if not target.startswith("#")]
