"""Libraries on disk.

    NAME.brdflib/
        library.json   format version, grid, origin, and per material its name, source, licence and checksum
        tables.npy     float32, channel-major (3, N, p): a channel of a block is N contiguous runs

A library is written beside its final name and renamed into place, so a crash leaves the old one or none. Blocks are read
into memory of their own: pages of a map would count as memory until the whole file does (1.1 GB where this takes .1).
"""

import hashlib
import json
import os
import secrets
import shutil
from collections.abc import Generator, Sequence
from contextlib import contextmanager
from dataclasses import asdict, dataclass
from functools import partial
from pathlib import Path
from typing import Any, BinaryIO, NamedTuple

import numpy as np

from .._types import Rows, Table
from ..brdf import Brdf, TabularBrdf
from ..errors import LibraryError, OutputError
from ..files import require_space
from ..formats import Found, Skipped, find_brdfs
from ..halfdiff import MERL, Axis, Grid
from ..tasks import Track, run, silent
from .blocks import columns_per_block, ranges
from .library import Library, Origin, material_checksum

FORMAT = 1
SUFFIX = ".brdflib"


@dataclass(frozen=True)
class Entry:
    """One material of a stored library."""

    name: str
    source: str
    """Where it was read from."""
    source_sha256: str
    """Of the bytes it was read from."""
    sha256: str
    """Of its samples, (3, p) float32 little endian."""


class StoredLibrary(Library):
    """A library opened from its folder.

    Raises
    ------
    LibraryError
        When the folder holds no library, one of a newer format, or tables that do not fit its description.
    """

    def __init__(self, path: Path) -> None:
        self.path = path
        description = _read_description(path)
        try:
            self.grid = Grid(tuple(Axis(**axis) for axis in description["grid"]))
            self.entries = tuple(Entry(**entry) for entry in description["materials"])
            self.origin = Origin(**description["origin"])
        except (KeyError, TypeError) as error:
            raise LibraryError(
                f"{path / 'library.json'} lacks what a library needs ({error}): build the library again."
            ) from None
        self.name = path.name.removesuffix(SUFFIX)
        self.names = tuple(entry.name for entry in self.entries)
        parts = [(entry.name, entry.sha256) for entry in self.entries]
        self.checksum = hashlib.sha256(repr((parts, self.grid)).encode()).hexdigest()
        self.material_checksums = tuple(
            material_checksum(entry.name, self.grid, entry.sha256.encode())
            for entry in self.entries
        )
        self._check_tables()

    def row(self, i: int) -> Table:
        return self._read(range(i, i + 1), slice(0, self.grid.size))[:, 0]

    def columns(self, columns: slice) -> Rows:
        return self._read(range(len(self)), columns)

    def blocks(self) -> list[slice]:
        return ranges(self.grid.size, columns_per_block(len(self)))

    def _read(self, materials: range, columns: slice) -> Rows:
        rows = np.empty((3, len(materials), columns.stop - columns.start), np.float32)
        with (self.path / "tables.npy").open("rb", buffering=0) as file:
            start = os.fstat(file.fileno()).st_size - 12 * len(self) * self.grid.size
            for channel, planes in enumerate(rows):
                for i, samples in zip(materials, planes, strict=True):
                    cell = (channel * len(self) + i) * self.grid.size + columns.start
                    os.preadv(file.fileno(), [samples.data], start + 4 * cell)
        return rows

    def _check_tables(self) -> None:
        expected = (3, len(self), self.grid.size)
        try:
            tables = np.load(self.path / "tables.npy", mmap_mode="r", allow_pickle=False)
        except (OSError, ValueError) as error:
            raise LibraryError(
                f"{self.path / 'tables.npy'} cannot be read ({error}): build the library again."
            ) from None
        if tables.shape != expected or tables.dtype != np.float32:
            raise LibraryError(
                f"{self.path / 'tables.npy'} holds {tables.dtype} {tables.shape}: library.json describes "
                f"float32 {expected}. Build the library again."
            )


class Built(NamedTuple):
    """What `build_library` did."""

    library: StoredLibrary
    skipped: list[Skipped]
    """What the sources hold that is no BRDF, and why."""


def build_library(
    sources: Sequence[str | Path],
    path: Path,
    *,
    origin: Origin | None = None,
    track: Track = silent,
) -> Built:
    """Tabulate every BRDF found in ``sources`` (files, folders, zips, ``builtin:NAME``) into a library at ``path``.

    Materials that are not tables are sampled on the grid of those that are, or on the MERL grid.

    Raises
    ------
    LibraryError
        When nothing is found, or two tables have different grids.
    OutputError
        When ``path`` cannot be written or the disk has no room.
    """
    found, skipped = find_brdfs(sources)
    if not found:
        reasons = "; ".join(f"{item.path}: {item.reason}" for item in skipped[:3])
        raise LibraryError(
            f"there is no BRDF in {', '.join(map(str, sources))}"
            + (f" ({reasons})" if reasons else "")
            + ": expected MERL .binary files, NBRDF .h5 files, zips of them, or builtin:NAME."
        )
    _refuse_foreign_folder(path)
    grid = _common_grid(found)
    require_space(path.parent, 12 * len(found) * grid.size, f"a library of {len(found)} materials")
    with _replacing_folder(path) as folder:
        entries = _write_tables(folder / "tables.npy", found, grid, track)
        description = {
            "format": FORMAT,
            "grid": [asdict(axis) for axis in grid.axes],
            "origin": asdict(origin or _common_origin(found)),
            "materials": [asdict(entry) for entry in entries],
        }
        (folder / "library.json").write_text(json.dumps(description, indent=1))
    return Built(StoredLibrary(path), skipped)


def _read_description(path: Path) -> dict[str, Any]:
    try:
        description = json.loads((path / "library.json").read_text())
        version = description["format"]
    except FileNotFoundError:
        raise LibraryError(
            f"{path} is no library: there is no library.json in it. "
            f"`halfway library build {path} -o NAME{SUFFIX}` makes one of a folder of BRDF files."
        ) from None
    except (OSError, ValueError, KeyError, TypeError) as error:
        raise LibraryError(
            f"{path / 'library.json'} cannot be read ({error}): build the library again."
        ) from None
    if version != FORMAT:
        raise LibraryError(
            f"{path} has library format {version}, and this version of halfway reads format {FORMAT}: "
            "upgrade halfway, or build the library again."
        )
    return description


def _refuse_foreign_folder(path: Path) -> None:
    if path.exists() and not (path / "library.json").exists():
        raise OutputError(
            f"{path} exists and is no library: it is not replaced. Choose another name with -o."
        )


def _common_grid(found: Sequence[Found]) -> Grid:
    grids = {item.grid: item.name for item in reversed(found) if item.grid is not None}
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


def _write_tables(path: Path, found: Sequence[Found], grid: Grid, track: Track) -> list[Entry]:
    shape = (3, len(found), grid.size)
    with path.open("wb") as file:
        header = {"descr": "<f4", "fortran_order": False, "shape": shape}
        np.lib.format.write_array_header_1_0(file, header)
        start = file.tell()
        write = partial(_write_row, file, start, found, grid)
        return list(run(write, range(len(found)), label="Tables", track=track))


def _write_row(file: BinaryIO, start: int, found: Sequence[Found], grid: Grid, i: int) -> Entry:
    item = found[i]
    row = _tabulated(item.load(), grid).reshape(3, -1)
    for channel, samples in enumerate(row):
        os.pwrite(file.fileno(), samples.data, start + 4 * grid.size * (channel * len(found) + i))
    return Entry(item.name, item.source, item.sha256, hashlib.sha256(row.data).hexdigest())


def _tabulated(brdf: Brdf, grid: Grid) -> Table:
    table = brdf.values if isinstance(brdf, TabularBrdf) else brdf.sample_rows(grid, slice(None))
    return np.ascontiguousarray(table, "<f4")


@contextmanager
def _replacing_folder(path: Path) -> Generator[Path]:
    token = secrets.token_hex(6)
    temporary, old = (path.with_name(f".{path.name}.{token}.{role}") for role in ("new", "old"))
    try:
        temporary.mkdir(parents=True)
        yield temporary
        if path.exists():
            path.rename(old)
        temporary.rename(path)
    except OSError as error:
        raise OutputError(f"{path} cannot be written: {error.strerror or error}.") from error
    finally:
        for folder in (temporary, old):
            shutil.rmtree(folder, ignore_errors=True)
