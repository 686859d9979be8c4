"""How the annotations of the package are checked while the tests run."""

import sys
from collections.abc import Callable
from functools import wraps
from inspect import getattr_static
from typing import Any, no_type_check

from beartype import BeartypeConf, beartype

# An int is a float, as type checkers have it.
_strict = beartype(conf=BeartypeConf(is_pep484_tower=True))
ENOUGH = 20
"""Calls of one function. A fit or a triangulation calls some a hundred thousand times, and the checks would be much of what all tests take."""


def check(function: Callable[..., Any]) -> Callable[..., Any]:
    """Check the annotations of a function, in its first calls; of one that is never called, nothing is made ready."""
    checked: Callable[..., Any] | None = None
    calls = 0

    @wraps(function)
    def counted(*args: Any, **kwargs: Any) -> Any:
        nonlocal calls, checked
        checked = checked or _strict(function)
        calls += 1
        if calls == ENOUGH:
            _leave_alone(function)
        return checked(*args, **kwargs)

    return counted


def _leave_alone(function: Callable[..., Any]) -> None:
    """Check a function of a module or a class no more; those within functions are new at each call of these."""
    found: Any = sys.modules.get(function.__module__)
    for name in function.__qualname__.split("."):
        found = getattr_static(found, name, None)
    found = getattr(found, "fget", None) or getattr(found, "__func__", found)
    if found is not None:
        no_type_check(found)
