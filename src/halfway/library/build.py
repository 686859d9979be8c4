"""Make a library on disk of the BRDFs in files, folders, zips and the package.

Materials are tabulated by tasks, and written here as they come. The library takes its place when it is whole, in one step;
see `halfway.library.stored`.
"""

import hashlib
import json
from collections.abc import Sequence
from contextlib import suppress
from dataclasses import asdict
from functools import partial
from pathlib import Path
from typing import BinaryIO, NamedTuple

import numpy as np

from .._types import Table
from ..brdf import TabularBrdf
from ..errors import FormatError, LibraryError, OutputError
from ..files import lock, require_space, scratch_folder
from ..formats import Skipped, SourceBrdf, find_brdfs
from ..halfdiff import Grid, common_grid
from ..locations import BUILTIN_PREFIX, Location, RemotePath, to_location
from ..origin import Origin
from ..tasks import HERE, Work
from . import compact_file
from .opening import open_library
from .stored import (
    DESCRIPTION,
    FORMAT,
    Entry,
    StoredLibrary,
    is_stored,
    library_checksum,
    npy_header,
    tables_name,
)


class Built(NamedTuple):
    """What `build_library` did."""

    library: StoredLibrary
    skipped: list[Skipped]
    """What the sources hold that is no BRDF, or a damaged one, and why."""


def build_library(
    sources: Sequence[str | Path],
    path: Location,
    *,
    origin: Origin = Origin(),  # noqa: B008 (frozen)
    grid: Grid | None = None,
    work: Work = HERE,
) -> Built:
    """Tabulate every BRDF found in ``sources`` (files, folders, zips, ``builtin:NAME``) into a library at ``path``.

    A source may be a stored library, the one at ``path`` as well: so materials are added to it; or a compact one. Materials that
    are not tables are sampled on ``grid``, by default that of those that are, or else their usual one; and so are isotropic tables
    where the grid has phi_h. Files that are damaged are
    left out, and told. ``origin`` says what the files do not.

    Raises
    ------
    LibraryError
        When nothing is found, or two tables have different grids.
    OutputError
        When ``path`` cannot be written or the disk has no room.
    """
    materials, skipped = find_materials(sources)
    if not materials:
        raise _nothing_in(sources, skipped)
    _refuse_foreign_folder(path)
    grid = _common_grid(materials, grid)
    n = len(materials)
    require_space(path.parent, 12 * n * grid.size, f"a library of {n} materials")
    with scratch_folder(path) as folder:
        entries, damaged = _write_tables(folder / "tables.npy", materials, grid, work)
        skipped += damaged
        if not entries:
            raise _nothing_in(sources, skipped)
        tables = tables_name(library_checksum(entries, grid), path)
        description = {
            "format": FORMAT,
            "grid": [asdict(axis) for axis in grid.axes],
            "origin": asdict(_common_origin(materials, origin)),
            "tables": tables,
            "materials": [asdict(entry) for entry in entries],
        }
        (folder / "tables.npy").rename(folder / tables)
        (folder / DESCRIPTION).write_text(json.dumps(description, indent=1), encoding="utf-8")
        if isinstance(path, RemotePath):
            _put(folder, path, tables)
        else:
            _move(folder, path, tables)
    return Built(StoredLibrary(path), skipped)


def _nothing_in(sources: Sequence[str | Path], skipped: Sequence[Skipped]) -> LibraryError:
    reasons = "; ".join(f"{item.path}: {item.reason}" for item in skipped[:3])
    return LibraryError(
        f"there is no BRDF in {', '.join(map(str, sources))}"
        + (f" ({reasons})" if reasons else "")
        + ": expected MERL .binary files, NBRDF .h5 files, zips of them, or builtin:NAME."
    )


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
    if path.exists() and not is_stored(path):
        raise OutputError(
            f"{path} exists and is no library: it is not replaced. Choose another name with -o."
        )


def find_materials(sources: Sequence[str | Location]) -> tuple[list[SourceBrdf], list[Skipped]]:
    """The materials of the libraries among the sources, then the BRDFs in the others.

    Raises
    ------
    LibraryError
        When two have the same name, or a library is damaged.
    FormatError
        As `halfway.formats.find_brdfs`.
    """
    libraries = [source for source in sources if _is_library(source)]
    files = [str(source) for source in sources if source not in libraries]
    materials = [item for source in libraries for item in open_library(source).materials()]
    others, skipped = find_brdfs(files, skip_damaged=True)
    sources_of: dict[str, str] = {}
    for item in [*materials, *others]:
        if item.name in sources_of:
            raise LibraryError(
                f"{item.name} is there twice, as {sources_of[item.name]} and {item.source}: "
                "each material needs a name of its own. Rename one, or leave one out."
            )
        sources_of[item.name] = item.source
    return [*materials, *others], skipped


def _is_library(source: str | Location) -> bool:
    if str(source).startswith(BUILTIN_PREFIX):
        return False
    location = to_location(source)
    return location.suffix == compact_file.SUFFIX or is_stored(location)


def _common_grid(materials: Sequence[SourceBrdf], wanted: Grid | None) -> Grid:
    grids = {item.grid: item.name for item in reversed(materials) if item.grid is not None}
    if wanted is not None:
        grids = {wanted: "the library"} | grids
    grid = wanted or common_grid(
        [*grids, *(item.usual_grid for item in materials if item.grid is None)]
    )
    if not grid.is_isotropic:  # others are lifted to it
        grids = {each: name for each, name in grids.items() if not each.is_isotropic}
    if len(grids) > 1:
        listed = ", ".join(f"{name} has {grid}" for grid, name in grids.items())
        raise LibraryError(
            f"the tables have {len(grids)} different grids ({listed}): a library has one. "
            "Build one library per grid."
        )
    return grid


def _common_origin(materials: Sequence[SourceBrdf], given: Origin) -> Origin:
    """What the materials say of themselves, and a person of their source and licence."""
    own = Origin.of_all(dict.fromkeys(material.origin for material in materials))
    return Origin(
        own.description or given.description,
        given.source or own.source,
        given.licence or own.licence,
    )


def _write_tables(
    path: Path, materials: Sequence[SourceBrdf], grid: Grid, work: Work
) -> tuple[list[Entry], list[Skipped]]:
    """Write the tables of all materials that can be read, and tell of the others."""
    n, n_bytes = len(materials), 4 * grid.size
    entries: list[Entry] = []
    damaged: list[Skipped] = []
    with path.open("w+b") as file:
        start = file.write(npy_header((3, n, grid.size)))
        file.truncate(start + 3 * n * n_bytes)
        for row in work.run(partial(_tabulate, grid), materials, label="Tables"):
            if isinstance(row, Skipped):
                damaged.append(row)
                continue
            for channel, samples in enumerate(row.samples):
                file.seek(start + n_bytes * (channel * n + len(entries)))
                file.write(samples.data)
            entries.append(row.entry)
        if damaged:
            _close_up(file, n, len(entries), grid)
    return entries, damaged


def _close_up(file: BinaryIO, n: int, n_kept: int, grid: Grid) -> None:
    """Make a file of tables of the first ``n_kept`` rows of each channel of ``n``; a row moves towards the start only."""
    header, n_bytes = npy_header((3, n_kept, grid.size)), 4 * grid.size
    start = len(npy_header((3, n, grid.size)))
    for channel in range(3):
        for i in range(n_kept):
            file.seek(start + n_bytes * (channel * n + i))
            samples = file.read(n_bytes)
            file.seek(len(header) + n_bytes * (channel * n_kept + i))
            file.write(samples)
    file.truncate(len(header) + 3 * n_kept * n_bytes)
    file.seek(0)
    file.write(header)


class _Row(NamedTuple):
    entry: Entry
    samples: Table


def _tabulate(grid: Grid, material: SourceBrdf) -> _Row | Skipped:
    try:
        brdf = material.load()
    except FormatError as error:
        return Skipped.because(error, material.source)
    lifted = brdf.is_isotropic and not grid.is_isotropic
    if isinstance(brdf, TabularBrdf) and brdf.grid != grid and not lifted:
        return Skipped(
            material.source, f"is a table of {brdf.grid} cells, not {grid}", damaged=True
        )
    table = brdf.sample_rows(grid, slice(None))
    samples = np.ascontiguousarray(table, "<f4").reshape(3, -1)
    checksum = hashlib.sha256(samples.data).hexdigest()
    return _Row(Entry(material.name, material.source, material.sha256, checksum), samples)
