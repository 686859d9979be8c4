"""Make a library on disk of the BRDFs in files, folders, zips and the package.

Materials are tabulated by tasks, and written here as they come. The library takes its place when it is whole, in one step;
see `halfway.library.stored`.
"""

import hashlib
import json
from collections.abc import Sequence
from contextlib import suppress
from dataclasses import asdict, astuple
from functools import partial
from pathlib import Path
from typing import NamedTuple

import numpy as np

from .._types import Table
from ..brdf import TabularBrdf
from ..errors import LibraryError, OutputError
from ..files import lock, require_space, scratch_folder
from ..formats import Credit, Found, Skipped, find_brdfs
from ..halfdiff import MERL, Grid
from ..locations import Location, RemotePath, to_location
from ..tasks import HERE, Work
from .compact import SUFFIX as COMPACT_SUFFIX
from .compact import CompactLibrary
from .library import Origin
from .stored import (
    DESCRIPTION,
    FORMAT,
    Entry,
    StoredLibrary,
    library_checksum,
    npy_header,
    tables_name,
)


class Built(NamedTuple):
    """What `build_library` did."""

    library: StoredLibrary
    skipped: list[Skipped]
    """What the sources hold that is no BRDF, and why."""


def build_library(
    sources: Sequence[str | Path],
    path: Location,
    *,
    origin: Origin | None = None,
    grid: Grid | None = None,
    work: Work = HERE,
) -> Built:
    """Tabulate every BRDF found in ``sources`` (files, folders, zips, ``builtin:NAME``) into a library at ``path``.

    A source may be a stored library, the one at ``path`` as well: so materials are added to it; or a compact one. Materials that are not tables
    are sampled on ``grid``, by default that of those that are, or else the MERL grid.

    Raises
    ------
    LibraryError
        When nothing is found, or two tables have different grids.
    OutputError
        When ``path`` cannot be written or the disk has no room.
    """
    found, skipped = find_materials(sources)
    if not found:
        reasons = "; ".join(f"{item.path}: {item.reason}" for item in skipped[:3])
        raise LibraryError(
            f"there is no BRDF in {', '.join(map(str, sources))}"
            + (f" ({reasons})" if reasons else "")
            + ": expected MERL .binary files, NBRDF .h5 files, zips of them, or builtin:NAME."
        )
    _refuse_foreign_folder(path)
    grid = _common_grid(found, grid)
    require_space(path.parent, 12 * len(found) * grid.size, f"a library of {len(found)} materials")
    with scratch_folder(path) as folder:
        entries = _write_tables(folder / "tables.npy", found, grid, work)
        tables = tables_name(library_checksum(entries, grid), path)
        description = {
            "format": FORMAT,
            "grid": [asdict(axis) for axis in grid.axes],
            "origin": asdict(origin or _common_origin(found)),
            "tables": tables,
            "materials": [asdict(entry) for entry in entries],
        }
        (folder / "tables.npy").rename(folder / tables)
        (folder / DESCRIPTION).write_text(json.dumps(description, indent=1))
        if isinstance(path, RemotePath):
            _put(folder, path, tables)
        else:
            _move(folder, path, tables)
    return Built(StoredLibrary(path), skipped)


def _move(folder: Path, path: Path, tables: str) -> None:
    """Rename the whole folder; where a library is there already, its tables first, then its description."""
    try:
        folder.rename(path)
    except OSError:
        if not path.is_dir():
            raise
    else:
        return
    with lock(path, wait=True):
        for name in (tables, DESCRIPTION):
            (folder / name).replace(path / name)
        for old in path.glob("tables-*.npy"):
            if old.name != tables:
                old.unlink()


def _put(folder: Path, path: RemotePath, tables: str) -> None:
    """As `_move`, where nothing can be renamed or locked: no other builder has tables of this name."""
    old = None
    with suppress(LibraryError):
        old = StoredLibrary(path).tables
    for name in (tables, DESCRIPTION):
        (path / name).put(folder / name)
    if old is not None:
        old.unlink(missing_ok=True)


def _refuse_foreign_folder(path: Location) -> None:
    if path.exists() and not (path / DESCRIPTION).exists():
        raise OutputError(
            f"{path} exists and is no library: it is not replaced. Choose another name with -o."
        )


def find_materials(sources: Sequence[str | Location]) -> tuple[list[Found], list[Skipped]]:
    """The materials of the libraries among the sources, then the BRDFs in the others.

    Raises
    ------
    LibraryError
        When two have the same name, or a library is damaged.
    FormatError
        As `halfway.formats.find_brdfs`.
    """
    libraries = [source for source in sources if _is_library(source)]
    others = [str(source) for source in sources if source not in libraries]
    kept = [item for source in libraries for item in _materials(to_location(source))]
    found, skipped = find_brdfs(others)
    origins: dict[str, str] = {}
    for item in [*kept, *found]:
        if item.name in origins:
            raise LibraryError(
                f"{item.name} is there twice, as {origins[item.name]} and {item.source}: "
                "each material needs a name of its own. Rename one, or leave one out."
            )
        origins[item.name] = item.source
    return [*kept, *found], skipped


def _is_library(source: str | Location) -> bool:
    if str(source).startswith("builtin:"):
        return False
    place = to_location(source)
    return place.suffix == COMPACT_SUFFIX or (place / DESCRIPTION).exists()


def _materials(place: Location) -> list[Found]:
    if place.suffix == COMPACT_SUFFIX:
        library = CompactLibrary(place)
        origins = [(str(place), checksum) for checksum in library.material_checksums]
    else:
        library = StoredLibrary(place)
        origins = [(entry.source, entry.source_sha256) for entry in library.entries]
    credit = Credit(*astuple(library.origin))
    return [
        Found(
            name, source, library.grid, credit, partial(library.brdf, name), partial(str, checksum)
        )
        for name, (source, checksum) in zip(library.names, origins, strict=True)
    ]


def _common_grid(found: Sequence[Found], wanted: Grid | None) -> Grid:
    grids = {item.grid: item.name for item in reversed(found) if item.grid is not None}
    if wanted is not None:
        grids = {wanted: "the library"} | grids
    if len(grids) > 1:
        listed = ", ".join(f"{name} has {grid}" for grid, name in grids.items())
        raise LibraryError(
            f"the tables have {len(grids)} different grids ({listed}): a library has one. "
            "Build one library per grid."
        )
    return next(iter(grids), MERL)


def _common_origin(found: Sequence[Found]) -> Origin:
    origins = dict.fromkeys(item.origin for item in found)
    description, source, licence = (
        "; ".join(dict.fromkeys(filter(None, column))) for column in zip(*origins, strict=True)
    )
    return Origin(description, source, licence)


def _write_tables(path: Path, found: Sequence[Found], grid: Grid, work: Work) -> list[Entry]:
    rows = work.run(partial(_tabulate, grid), found, label="Tables")
    with path.open("wb") as file:
        start = file.write(npy_header((3, len(found), grid.size)))
        file.truncate(start + 12 * len(found) * grid.size)
        entries: list[Entry] = []
        for i, row in enumerate(rows):
            for channel, samples in enumerate(row.samples):
                file.seek(start + 4 * grid.size * (channel * len(found) + i))
                file.write(samples.data)
            entries.append(row.entry)
    return entries


class _Row(NamedTuple):
    entry: Entry
    samples: Table


def _tabulate(grid: Grid, found: Found) -> _Row:
    brdf = found.load()
    table = brdf.values if isinstance(brdf, TabularBrdf) else brdf.sample_rows(grid, slice(None))
    samples = np.ascontiguousarray(table, "<f4").reshape(3, -1)
    checksum = hashlib.sha256(samples.data).hexdigest()
    return _Row(Entry(found.name, found.source, found.sha256, checksum), samples)
