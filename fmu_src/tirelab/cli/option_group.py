"""Options that belong together, handed to a command as one value."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import fields
from functools import wraps
from typing import Any

Decorator = Callable[[Callable[..., Any]], Callable[..., Any]]


def option_group(name: str, kind: type, *options: Decorator) -> Decorator:
    """Return the decorator that adds `options` to a command, which gets their values as `name`, a `kind`.

    kind: a dataclass with one field for each option, of the option's name
    """

    def add(command: Callable[..., Any]) -> Callable[..., Any]:
        @wraps(command)
        def with_group(*args: Any, **given: Any) -> Any:
            values = {field.name: given.pop(field.name) for field in fields(kind)}
            return command(*args, **given, **{name: kind(**values)})

        grouped: Callable[..., Any] = with_group
        for option in reversed(options):
            grouped = option(grouped)
        return grouped

    return add
