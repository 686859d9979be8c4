"""The tables of many recipes as files of one folder, written so that a run that was stopped goes on.

    000.binary, 001.binary, ...     MERL, one table per recipe; or 000.bsdf, ... for Mitsuba and pbrt-v4
    tables.zarr/                    or all tables in one Zarr store, half precision
    manifest.json                   what each file is made of, and its checksum

The folder is a `Batch`: a table that is there and made of the same is kept, the rest is written.
"""

import hashlib
import json
from collections.abc import Callable, Mapping, Sequence
from functools import partial
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from ..batch import Batch, Checksum, Written
from ..brdf import TabularBrdf, half_scale
from ..errors import OutputError
from ..files import replacing
from ..formats import encode_header, merl_bytes, write_brdf, zarr_tables
from ..library import Library, is_stored
from ..locations import Location, absolute, name_in
from ..recipes import Mixer, Recipe
from ..tasks import HERE, Work

FORMATS = ("none", "merl", "bsdf", "zarr")
BSDF_BYTES = 18_000_000
ANISOTROPIC_BSDF_BYTES = 175_000_000
"""Of the largest files that `halfway.formats.write_brdf` makes of its own accord."""


def write_tables(
    folder: Location,
    recipes: Sequence[Recipe],
    library: Library,
    *,
    by: str,
    format: str,
    of: Sequence[Any],
    texts: Mapping[str, str],
    stems: Sequence[str] = (),
    work: Work = HERE,
) -> Written:
    """Write the tables of ``recipes`` in one of `FORMATS`, and small ``texts`` beside them.

    Parameters
    ----------
    by : str
        The command that writes them.
    of : sequence
        What each table is made of, as JSON.
    texts : mapping
        The small files, by name.
    stems : sequence of str
        What each table is called, where each has a file; numbers, where none are given.

    Raises
    ------
    OutputError
        When there is no such format, the folder cannot be written or has no room, another run works in it, a file in it
        is in the way, or it is a library's.
    """
    folder = absolute(folder)  # workers may be elsewhere
    if is_stored(folder):
        raise OutputError(
            f"{folder} holds a library: expected a folder of its own for what `halfway {by}` writes. Choose another with -o."
        )
    files = _files(format, recipes, library, stems or _numbers(len(recipes)))
    # Not the library's address: a library that moves is the same.
    made = {
        "by": by,
        "library": library.name,
        "library_checksum": library.checksum,
        "recipes_sha256": _sha256(json.dumps(of)),
    }
    outputs: dict[str, Any] = {name: {"sha256": _sha256(text)} for name, text in texts.items()}
    outputs |= dict.fromkeys(files.texts) | dict(zip(files.names, of, strict=False))
    with Batch.open(folder, outputs, made=made, n_bytes=files.n_bytes, work=work) as batch:
        for name, content in (dict(texts) | files.texts).items():
            if name in batch.missing:
                batch.add(name, _write_text(folder / name, content))
        missing = set(batch.missing)
        pairs = zip(files.names, recipes, strict=False)
        tasks = [(folder / name, recipe) for name, recipe in pairs if name in missing]
        write = partial(_write_table, Mixer(library), files.write)
        written = work.run(write, tasks, label="Tables")
        for (path, _), checksum in zip(tasks, written, strict=True):
            batch.add(name_in(folder, path), checksum)
    return Written(len(tasks), len(files.names) - len(tasks))


class _Files(NamedTuple):
    """How tables lie in their folder."""

    names: list[str]
    n_bytes: int
    """That one takes at most."""
    write: Callable[[Path, TabularBrdf], None]
    texts: dict[str, str]
    """Small files beside them."""


def _files(
    format: str, recipes: Sequence[Recipe], library: Library, stems: Sequence[str]
) -> _Files:
    n, grid = len(recipes), library.grid
    match format:
        case "none":
            return _Files([], 0, write_brdf, {})
        case "merl":
            encode_header(grid)  # refuses a grid that no MERL file holds
            names = [f"{stem}.binary" for stem in stems]
            return _Files(names, merl_bytes(grid.shape), write_brdf, {})
        case "bsdf":
            largest = BSDF_BYTES if grid.is_isotropic else ANISOTROPIC_BSDF_BYTES
            return _Files([f"{stem}.bsdf" for stem in stems], largest, write_brdf, {})
        case "zarr":
            scale = half_scale(_largest(recipes, library))
            return _Files(
                zarr_tables.chunk_names(n, grid),
                zarr_tables.chunk_bytes(grid),
                partial(zarr_tables.write_chunk, scale=scale),
                {zarr_tables.METADATA: zarr_tables.metadata(n, grid, scale)},
            )
        case _:
            raise OutputError(
                f"there is no format {format!r}: expected one of {', '.join(FORMATS)}."
            )


def _numbers(n: int) -> list[str]:
    """``000``, ``001``, ... with as many digits as n needs, at least three."""
    digits = max(3, len(str(n - 1)))
    return [f"{i:0{digits}d}" for i in range(n)]


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
