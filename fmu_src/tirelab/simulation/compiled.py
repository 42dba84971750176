"""Compiles the physics of `radialtire` for whole recordings, and stores the result between runs.

Compiling a loop takes a few tenths of a second, loading it again a few hundredths. The compiled loops are stored in the
cache, in a folder named after the content of `radialtire`: numba itself checks only the file of a loop, not those of
the functions it calls.
"""

from __future__ import annotations

import hashlib
import importlib.util
import sys
from collections.abc import Callable
from functools import cache
from pathlib import Path
from types import FunctionType, ModuleType
from typing import Any

import radialtire

from .cache_folder import keep, private_folder

KERNEL, INSTANTS = (Path(__file__).with_name(name) for name in ("kernel.py", "instants.py"))


@cache
def loop(name: str, key: str, function: Callable[..., Any] | None = None) -> Callable[..., Any]:
    """Return the loop `name` of the kernel compiled, with `function` as its `respond`.

    key: an identifier under which the loop is stored, one for each `function`.
    """
    import numba  # here, since it takes half a second and only fits need it

    module, kept = _copy_of_kernel(key)
    if function is not None:
        module.__dict__["respond"] = function
    bare: FunctionType = getattr(module, name)
    module.__dict__.update(_compiled_globals(bare))
    compiled: Callable[..., Any] = numba.njit(cache=kept, nogil=True, error_model="numpy")(bare)
    return compiled


@cache
def names_read(function: FunctionType) -> frozenset[str]:
    """Return the names that a function and those of `radialtire` that it calls read, of attributes too."""
    names = function.__code__.co_names
    called = (function.__globals__.get(name) for name in names)
    return frozenset(names).union(*(names_read(f) for f in called if isinstance(f, FunctionType)))


def _compiled_globals(function: FunctionType) -> dict[str, Any]:
    """Return the functions of `radialtire` that `function` calls by their names, compiled with those they call."""
    called = ((name, function.__globals__.get(name)) for name in function.__code__.co_names)
    return {name: _compiled(one) for name, one in called if isinstance(one, FunctionType)}


@cache
def _compiled(function: FunctionType) -> Any:
    """Return a function compiled, once for all that call it."""
    import numba

    scope = {**function.__globals__, **_compiled_globals(function)}
    bare = FunctionType(function.__code__, scope, function.__name__)
    return numba.njit(error_model="numpy")(bare)


def _copy_of_kernel(key: str) -> tuple[ModuleType, bool]:
    """Return a module of the kernel's code of its own, and whether its compilation can be stored beside it."""
    path, folder = KERNEL, private_folder(_fingerprint())
    if folder is not None:
        path = folder / f"{key}.py"
        if not path.exists() and not keep(path, KERNEL.read_bytes()):
            path, folder = KERNEL, None
    spec = importlib.util.spec_from_file_location(f"tirelab_kernel_{key}", path)
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    sys.modules[spec.name] = module  # numba looks there for what it stored
    spec.loader.exec_module(module)
    return module, folder is not None


@cache
def _fingerprint() -> str:
    """Return a short name for the content of `radialtire`, the kernel and what it calls."""
    content = hashlib.sha256(KERNEL.read_bytes() + INSTANTS.read_bytes())
    for path in sorted(Path(radialtire.__file__).parent.rglob("*.py")):
        content.update(path.read_bytes())
    return content.hexdigest()[:16]
