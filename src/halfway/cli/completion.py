"""What the shell completes: libraries that come with the package, and names of materials; files are its own business."""

from collections.abc import Sequence
from contextlib import suppress

import typer

from ..errors import HalfwayError
from ..locations import BUILTIN_PREFIX


def complete_library(incomplete: str) -> list[str]:
    """The libraries of the package that begin so."""
    from ..models import BUILTIN

    return [name for name in map(BUILTIN_PREFIX.__add__, BUILTIN) if name.startswith(incomplete)]


def complete_names(ctx: typer.Context, incomplete: str) -> list[str]:
    """The materials that begin so: of the library before a colon, of the one that was given first, or of the default."""
    from ..library import open_library
    from ..recipes import split_address, split_library

    words = split_address(incomplete)
    given: Sequence[str] = ctx.params.get("words") or ()
    where, rest = split_library(words if len(words) == 2 else [*given[:1], incomplete])
    if not rest:
        return complete_library(incomplete)
    before = incomplete.removesuffix(rest[-1])
    names = list[str]()
    with suppress(HalfwayError, OSError):
        names = [before + name for name in open_library(where).names if name.startswith(rest[-1])]
    return [*names, *([] if before else complete_library(incomplete))]
