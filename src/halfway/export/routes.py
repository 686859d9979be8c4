"""A route as a folder: its recipes, and their tables as files.

    DIR/
        recipes.json
        000.binary, 001.binary, ...     one table per recipe, in the route's order; or 000.bsdf, ...
        tables.zarr/                    or all tables in one Zarr store, half precision
        manifest.json                   what each file is made of, and its checksum

A folder holds one route, as a `Batch`: where recipes.json says the same as before, tables that are there are kept and the
rest is written. Where it says something else, the old route's tables go first.
"""

import hashlib
import json
from collections.abc import Callable, Sequence
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from ..batch import Batch, Checksum
from ..brdf import TabularBrdf, half_scale
from ..errors import OutputError
from ..files import replacing
from ..formats import merl_bytes, write_brdf, zarr_tables
from ..library import Library, LibraryRef, is_stored
from ..locations import Location, absolute, name_in
from ..recipes import Mixer, Recipe
from ..space import Route
from ..tasks import HERE, Work

FORMATS = ("none", "merl", "bsdf", "zarr")
RECIPES = "recipes.json"
BSDF_BYTES = 18_000_000
"""Of the largest file that `halfway.formats.write_brdf` makes of its own accord."""


class Written(NamedTuple):
    """What `write_route` did."""

    n_written: int
    n_kept: int
    """Tables that an earlier run had finished."""


def write_route(
    folder: Location,
    route: Route,
    ts: Sequence[float],
    library: Library,
    *,
    format: str = "none",
    work: Work = HERE,
) -> Written:
    """Write recipes.json, and with ``format`` a table for each t.

    Parameters
    ----------
    format : str
        ``none``; ``merl`` or ``bsdf``, a file for each table; ``zarr``, all in one store.

    Raises
    ------
    OutputError
        When the folder cannot be written or has no room, another run works in it, a file in it is in the way, or it is
        a library's.
    """
    folder = absolute(folder)  # workers may be elsewhere
    if is_stored(folder):
        raise OutputError(
            f"{folder} holds a library: expected a folder of the route's own. Choose another with -o."
        )
    # The library may have moved since the route was made.
    document = replace(route, library=LibraryRef.of(library)).to_json(ts)
    text = json.dumps(document)
    recipes = route.recipes(ts)
    tables = _tables(format, recipes, library)
    # Not the library's address: a library that moves is the same.
    made = {
        "by": "route",
        "library": library.name,
        "library_checksum": library.checksum,
        "recipes_sha256": _sha256(json.dumps(document["recipes"])),
    }
    outputs: dict[str, Any] = {RECIPES: {"sha256": _sha256(text)}} | dict.fromkeys(tables.texts)
    outputs |= dict(zip(tables.names, document["recipes"], strict=False))
    opened = Batch.open(folder, outputs, made=made, n_bytes=tables.n_bytes, work=work)
    with opened as batch:
        for name, content in ({RECIPES: text} | tables.texts).items():
            if name in batch.missing:
                batch.add(name, _write_text(folder / name, content))
        missing = set(batch.missing)
        tasks = [
            (folder / name, recipe)
            for name, recipe in zip(tables.names, recipes, strict=False)
            if name in missing
        ]
        write = partial(_write_table, Mixer(library), tables.write)
        written = work.run(write, tasks, label="Tables")
        for (path, _), checksum in zip(tasks, written, strict=True):
            batch.add(name_in(folder, path), checksum)
    return Written(len(tasks), len(tables.names) - len(tasks))


class _Tables(NamedTuple):
    """How the tables of a route lie in its folder."""

    names: list[str]
    n_bytes: int
    """That one takes at most."""
    write: Callable[[Path, TabularBrdf], None]
    texts: dict[str, str]
    """Small files beside them."""


def _tables(format: str, recipes: Sequence[Recipe], library: Library) -> _Tables:
    n, grid = len(recipes), library.grid
    match format:
        case "none":
            return _Tables([], 0, write_brdf, {})
        case "merl":
            return _Tables(_numbered(n, ".binary"), merl_bytes(grid.shape), write_brdf, {})
        case "bsdf":
            return _Tables(_numbered(n, ".bsdf"), BSDF_BYTES, write_brdf, {})
        case "zarr":
            scale = half_scale(_largest(recipes, library))
            return _Tables(
                zarr_tables.chunk_names(n, grid),
                zarr_tables.chunk_bytes(grid),
                partial(zarr_tables.write_chunk, scale=scale),
                {zarr_tables.METADATA: zarr_tables.metadata(n, grid, scale)},
            )
        case _:
            raise OutputError(
                f"there is no format {format!r}: expected one of {', '.join(FORMATS)}."
            )


def _numbered(n: int, suffix: str) -> list[str]:
    """``000.binary``, ``001.binary``, ... with as many digits as n needs, at least three."""
    digits = max(3, len(str(n - 1)))
    return [f"{i:0{digits}d}{suffix}" for i in range(n)]


def _largest(recipes: Sequence[Recipe], library: Library) -> float:
    """No mix exceeds the largest sample of its ingredients."""
    names = sorted({name for recipe in recipes for name in recipe.names})
    return max(float(np.nanmax(library.row(library.index(name)))) for name in names)


def _sha256(text: str) -> str:
    return hashlib.sha256(text.encode()).hexdigest()


def _write_text(path: Location, text: str) -> Checksum:
    with replacing(path) as temporary:
        temporary.write_text(text, encoding="utf-8")
        return Checksum.of(temporary)


def _write_table(
    mixer: Mixer, write: Callable[[Path, TabularBrdf], None], task: tuple[Location, Recipe]
) -> Checksum:
    path, recipe = task
    with replacing(path) as temporary:
        write(temporary, mixer.mix(recipe))
        return Checksum.of(temporary)
