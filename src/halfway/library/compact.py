"""Compact libraries: a whole library in one file, as principal components.

    FILE.brdfc, a zip of
        compact.json      what it is (below)
        cells             p bits, first cell first, highest bit of a byte first: 1 where every material is measured; m of them
        starts            uint64 (n_runs + 1): where runs of measured cells begin; the last is m
        mean              float32 (B, m)
        steps             float32 (B, k, n_runs)
        components        int8, float16 or float32 (B, k, m)
        scores            float32 (B, R, k)

    compact.json          {"format": 1, "grid": [axes], "materials": [names], "origin": {...}, "mapping": "log" | "linear",
                           "shared": true | false, "precision": ..., "n_components": k, "source_checksum": ...,
                           "checksum": ..., "error": {...}}

All numbers are little endian, arrays in C order. There are B = 1 bases of R = 3N rows, all red, then all green, then all blue,
where the channels share their components, and B = 3 bases of R = N rows where not. A coded row on the measured cells is

    x_r = mean + sum_j score_rj  step_j,run(cell)  component_j

and its samples follow by `halfway.library.coding`. A cell that is unmeasured in any material is unmeasured in all.

What is read is a reconstruction, not the measurement. It is never negative, but nothing else of a measured material is
promised of it, and a mix of a compact library is a mix of reconstructions.
"""

import hashlib
import json
import math
import zipfile
import zlib
from dataclasses import asdict, dataclass
from functools import cached_property, lru_cache
from typing import Any, NamedTuple, get_args

import numpy as np
from jaxtyping import Float32, UInt8, UInt64

from .._types import Rows, Table
from ..errors import LibraryError
from ..files import replacing
from ..halfdiff import Axis, Grid
from ..locations import Location, absolute
from .blocks import columns_per_block, ranges
from .coding import Coding, Mapping, Precision
from .library import Library, Origin, material_checksum, texts

FORMAT = 1
SUFFIX = ".brdfc"
HEADER = "compact.json"
LARGEST_HEADER = 64_000_000
CELLS_AT_ONCE = 32768
"""Of one row: its components in float32 stay small."""


class Arrays(NamedTuple):
    """The numbers of a compact library, as its file holds them."""

    cells: UInt8[np.ndarray, " n_bytes"]
    starts: UInt64[np.ndarray, " n_starts"]
    mean: Float32[np.ndarray, "n_bases m"]
    steps: Float32[np.ndarray, "n_bases k n_runs"]
    components: np.ndarray  # (n_bases, k, m)
    scores: Float32[np.ndarray, "n_bases n_rows k"]


@dataclass(frozen=True)
class Header:
    """What ``compact.json`` says."""

    grid: Grid
    names: tuple[str, ...]
    origin: Origin
    coding: Coding
    n_components: int
    source_checksum: str
    """Of the library that it was made of."""
    checksum: str
    """Of the names, the grid, the coding and the arrays: `arrays_checksum`."""
    error: dict[str, float]
    """What reading loses, by measure; empty where it was not measured."""


class CompactLibrary(Library):
    """A library opened from a compact file.

    Raises
    ------
    LibraryError
        When the file is no compact library, one of a newer format, or damaged.
    """

    def __init__(self, path: Location) -> None:
        self.path = path
        self.header = _read_header(path)
        self.name = str(path)
        self.names, self.grid, self.origin = (
            self.header.names,
            self.header.grid,
            self.header.origin,
        )
        self.checksum = self.header.checksum
        self.material_checksums = tuple(
            material_checksum(name, self.grid, f"{self.checksum} {i}".encode())
            for i, name in enumerate(self.names)
        )

    @property
    def address(self) -> str:
        return str(absolute(self.path))

    def __reduce__(self) -> tuple[Any, ...]:
        """A library travels as its path."""
        return _opened, (absolute(self.path), self.checksum)

    @property
    def n_bytes(self) -> int:
        """Size of the file."""
        return self.path.stat().st_size

    def facts(self) -> dict[str, Any]:
        """How it is stored, in bytes, and what that loses: JSON for programs."""
        header = self.header
        return {
            "n_components": header.n_components,
            **asdict(header.coding),
            "n_bytes": self.n_bytes,
            "table_bytes": 12 * len(self) * self.grid.size,
            "error": header.error,
        }

    def row(self, i: int) -> Table:
        rows = np.array([i]) if not self.header.coding.shared else i + len(self) * np.arange(3)
        parts = [self._read(rows, part) for part in ranges(self.grid.size, CELLS_AT_ONCE)]
        return np.concatenate(parts, axis=-1)[:, 0]

    def columns(self, columns: slice) -> Rows:
        return self._read(np.arange(self._arrays.scores.shape[1]), columns)

    def blocks(self) -> list[slice]:
        return ranges(self.grid.size, columns_per_block(len(self)))

    def _read(self, rows: np.ndarray, columns: slice) -> Rows:
        arrays = self._arrays
        cells = np.flatnonzero(self._mask[columns])
        first = int(self._n_before[columns.start])
        measured = slice(first, first + len(cells))
        run = np.searchsorted(arrays.starts, np.arange(measured.start, measured.stop), "right") - 1
        basis = arrays.components[:, :, measured].astype(np.float32) * arrays.steps[:, :, run]
        coded = arrays.scores[:, rows] @ basis + arrays.mean[:, None, measured]
        values = self.header.coding.to_samples(coded, self.grid, columns.start + cells)
        samples = np.full((3, values.shape[1], columns.stop - columns.start), np.nan, np.float32)
        samples[..., cells] = values
        return samples

    @cached_property
    def _arrays(self) -> Arrays:
        arrays, header = _read_arrays(self.path, self.header), self.header
        found = arrays_checksum(header.names, header.grid, header.coding, arrays)
        if found != header.checksum:
            raise _damaged(
                self.path,
                f"its numbers have checksum {found[:12]} and {HEADER} says {header.checksum[:12]}",
            )
        return arrays

    @cached_property
    def _mask(self) -> np.ndarray:
        return np.unpackbits(self._arrays.cells, count=self.grid.size).astype(bool)

    @cached_property
    def _n_before(self) -> np.ndarray:
        """Measured cells before each cell."""
        return np.append(0, np.cumsum(self._mask))


def is_compact(path: Location) -> bool:
    """Whether a file is a compact library, or is called like one."""
    if path.suffix == SUFFIX:
        return True
    try:
        with path.open("rb") as file, zipfile.ZipFile(file) as archive:
            return HEADER in archive.namelist()
    except (zipfile.BadZipFile, NotImplementedError):
        return False


def arrays_checksum(names: tuple[str, ...], grid: Grid, coding: Coding, arrays: Arrays) -> str:
    """The checksum of a compact library."""
    digest = hashlib.sha256(repr((names, grid, coding)).encode())
    for array in arrays:
        digest.update(np.ascontiguousarray(array).data)
    return digest.hexdigest()


def write_compact(path: Location, header: Header, arrays: Arrays) -> None:
    """Write a compact library.

    Raises
    ------
    OutputError
        When the file cannot be written.
    """
    document = {
        "format": FORMAT,
        "grid": [asdict(axis) for axis in header.grid.axes],
        "materials": list(header.names),
        "origin": asdict(header.origin),
        **asdict(header.coding),
        "n_components": header.n_components,
        "source_checksum": header.source_checksum,
        "checksum": header.checksum,
        "error": header.error,
    }
    # Deflated: the later components are small numbers most of the time.
    with (
        replacing(path) as temporary,
        zipfile.ZipFile(temporary, "w", zipfile.ZIP_DEFLATED, compresslevel=6) as archive,
    ):
        # Opened like the others, so that it bears no date: the same library is the same bytes.
        with archive.open(HEADER, "w") as member:
            member.write(json.dumps(document, indent=1).encode())
        for name, array in arrays._asdict().items():
            little = np.ascontiguousarray(array, array.dtype.newbyteorder("<"))
            with archive.open(name, "w", force_zip64=True) as member:
                member.write(little.data)


def _read_header(path: Location) -> Header:
    document = _parsed(path)
    version = document.get("format")
    if version != FORMAT:
        raise LibraryError(
            f"{path} has compact format {version}, and this version of halfway reads format {FORMAT}: "
            "upgrade halfway, or make it again."
        )
    try:
        names = tuple(map(str, document["materials"]))
        if not names or len(set(names)) < len(names):
            raise ValueError(f"{len(names)} materials have {len(set(names))} names")
        coding = _CODINGS[document["mapping"], document["shared"], document["precision"]]
        return Header(
            Grid(tuple(Axis(**axis) for axis in document["grid"])),
            names,
            Origin(**texts(document["origin"])),
            coding,
            int(document["n_components"]),
            str(document["source_checksum"]),
            str(document["checksum"]),
            {key: float(value) for key, value in document["error"].items()},
        )
    except (KeyError, TypeError, ValueError, AttributeError) as error:
        raise _damaged(path, f"{HEADER} lacks what a compact library needs ({error})") from None


def _parsed(path: Location) -> dict[str, Any]:
    try:
        with path.open("rb") as file, zipfile.ZipFile(file) as archive:
            if archive.getinfo(HEADER).file_size > LARGEST_HEADER:
                raise _damaged(path, f"its {HEADER} unpacks to more than {LARGEST_HEADER:,} bytes")
            document = json.loads(archive.read(HEADER))
    except (*_DAMAGE, RecursionError) as error:
        raise _damaged(path, f"{HEADER} cannot be read ({error})") from None
    if not isinstance(document, dict):
        raise _damaged(path, f"{HEADER} is no object")
    return document


def _read_arrays(path: Location, header: Header) -> Arrays:
    n_bases, k = header.coding.n_bases, header.n_components
    n_rows = 3 * len(header.names) // n_bases
    try:
        with path.open("rb") as file, zipfile.ZipFile(file) as archive:
            cells = _member(archive, "cells", "u1", (math.ceil(header.grid.size / 8),))
            m = int(np.unpackbits(cells, count=header.grid.size).sum())
            n_starts = archive.getinfo("starts").file_size // 8
            starts = _member(archive, "starts", "<u8", (n_starts,))
            if n_starts < 1 or starts[0] != 0 or starts[-1] != m or (np.diff(starts) <= 0).any():
                raise ValueError("starts do not ascend from 0 to the number of measured cells")
            return Arrays(
                cells,
                starts,
                _member(archive, "mean", "<f4", (n_bases, m)),
                _member(archive, "steps", "<f4", (n_bases, k, n_starts - 1)),
                _member(archive, "components", _DTYPES[header.coding.precision], (n_bases, k, m)),
                _member(archive, "scores", "<f4", (n_bases, n_rows, k)),
            )
    except _DAMAGE as error:
        raise _damaged(path, str(error)) from None


def _member(archive: zipfile.ZipFile, name: str, dtype: str, shape: tuple[int, ...]) -> np.ndarray:
    """The array in a member; its size is that of the shape before anything is unpacked."""
    n_bytes = np.dtype(dtype).itemsize * math.prod(shape)
    found = archive.getinfo(name).file_size
    if found != n_bytes:
        raise ValueError(f"{name} has {found:,} bytes where {n_bytes:,} are expected")
    return np.frombuffer(archive.read(name), dtype).reshape(shape)


def _damaged(path: Location, what: str) -> LibraryError:
    return LibraryError(
        f"{path} is no sound compact library: {what}. `halfway library compact LIB -o {path}` makes one."
    )


@lru_cache(maxsize=1)
def _opened(path: Location, checksum: str) -> CompactLibrary:
    """The library that another process means; the last one stays open, with its numbers."""
    library = CompactLibrary(path)
    if library.checksum != checksum:
        raise LibraryError(
            f"{path} has checksum {library.checksum[:12]} here and {checksum[:12]} where the work began: it was made "
            "again, or is another file on this machine. Run the same command again."
        )
    return library


_DAMAGE = (
    *(OSError, KeyError, ValueError, EOFError, NotImplementedError),
    *(zipfile.BadZipFile, zlib.error),
)
"""What reading a damaged zip may raise: a bit of its directory names a way to compress that is not supported."""
_DTYPES: dict[Precision, str] = {"int8": "i1", "float16": "<f2", "float32": "<f4"}
_CODINGS = {
    (mapping, shared, precision): Coding(mapping, shared, precision)
    for mapping in get_args(Mapping)
    for shared in (True, False)
    for precision in _DTYPES
}
