"""A route as a folder: its recipes, and their tables as files that renderers read.

    DIR/
        recipes.json
        000.binary, 001.binary, ...     one table per recipe, in the route's order

A folder holds one route. Where recipes.json says the same as before, tables that are there are kept and the rest is
written: a file under its final name is always whole. Where it says something else, the old route's tables go first.
"""

import json
from collections.abc import Sequence
from functools import partial
from pathlib import Path
from typing import Any, NamedTuple

from ..errors import OutputError
from ..files import replacing, require_space
from ..formats import write_brdf
from ..formats.content import merl_bytes
from ..library import Library
from ..space import Mixer, Recipe, Route
from ..tasks import Track, run, silent

SUFFIXES = {"merl": ".binary"}


class Written(NamedTuple):
    """What `write_route` did."""

    n_written: int
    n_kept: int
    """Tables that an earlier run had finished."""


def write_route(
    folder: Path,
    route: Route,
    ts: Sequence[float],
    library: Library,
    *,
    format: str = "none",
    track: Track = silent,
) -> Written:
    """Write recipes.json, and with ``format`` a table for each t.

    Raises
    ------
    OutputError
        When the folder cannot be written, or the disk has no room for the tables.
    """
    document = {**route.to_json(ts), "library_checksum": library.checksum}
    text = json.dumps(document)
    recipes = route.recipes(ts) if format != "none" else []
    names = table_names(len(recipes), SUFFIXES.get(format, ""))
    same = _is_same_route(folder, text)
    size = merl_bytes(library.grid.shape)
    missing = [
        (folder / name, recipe)
        for name, recipe in zip(names, recipes, strict=True)
        if not (same and _is_whole(folder / name, size))
    ]
    require_space(folder, len(missing) * size, f"a route of {len(missing)} tables")
    if not same:
        _remove_tables(folder)
        with replacing(folder / "recipes.json") as temporary:
            temporary.write_text(text)
    write = partial(_write_table, Mixer(library))
    for _ in run(write, missing, label="Tables", track=track):
        pass
    return Written(len(missing), len(recipes) - len(missing))


def table_names(n: int, suffix: str) -> list[str]:
    """``000.binary``, ``001.binary``, ... with as many digits as n needs, at least three."""
    digits = max(3, len(str(n - 1)))
    return [f"{i:0{digits}d}{suffix}" for i in range(n)]


def _write_table(mixer: Mixer, task: tuple[Path, Recipe]) -> None:
    path, recipe = task
    write_brdf(path, mixer.mix(recipe))


def _is_same_route(folder: Path, text: str) -> bool:
    try:
        return (folder / "recipes.json").read_text() == text
    except (FileNotFoundError, NotADirectoryError, UnicodeDecodeError):
        return False


def _is_whole(path: Path, size: int) -> bool:
    return path.is_file() and path.stat().st_size == size


def _remove_tables(folder: Path) -> None:
    """Remove the tables that the folder's recipes.json speaks of: they are another route's."""
    path = folder / "recipes.json"
    if not path.exists():
        return
    try:
        document: Any = json.loads(path.read_text())
        n = len(document["recipes"])
    except (ValueError, KeyError, TypeError):
        raise OutputError(
            f"{path} is in the way: it is no route of halfway. Choose another folder with -o."
        ) from None
    for suffix in SUFFIXES.values():
        for name in table_names(n, suffix):
            (folder / name).unlink(missing_ok=True)
