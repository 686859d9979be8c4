"""The file of a compact library: a whole library as principal components.

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
"""

import hashlib
import json
import math
import zipfile
import zlib
from dataclasses import asdict, dataclass, field
from typing import Any, NamedTuple, get_args

import numpy as np
from jaxtyping import Float32, UInt8, UInt64

from ..errors import LibraryError
from ..files import replacing
from ..halfdiff import Axis, Grid
from ..locations import Location
from ..origin import Origin
from .coding import Coding, MappingName, Precision
from .library import texts

FORMAT = 1
SUFFIX = ".brdfc"
HEADER = "compact.json"
LARGEST_HEADER = 64_000_000


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
    checksum: str = ""
    """Of the library itself."""
    error: dict[str, float] = field(default_factory=dict[str, float])
    """What reading loses, by measure; empty where it was not measured."""


def is_compact(path: Location) -> bool:
    """Whether a file is a compact library, or is called like one."""
    if path.suffix == SUFFIX:
        return True
    try:
        with path.open("rb") as file, zipfile.ZipFile(file) as archive:
            return HEADER in archive.namelist()
    # Python has no code for some ways to compress: a zip of another program, or a damaged one.
    except (zipfile.BadZipFile, NotImplementedError):
        return False


def checksum(header: Header, arrays: Arrays) -> str:
    """The checksum of a compact library: of its names, grid, coding and arrays."""
    digest = hashlib.sha256(repr((header.names, header.grid, header.coding)).encode())
    for array in arrays:
        digest.update(np.ascontiguousarray(array).data)
    return digest.hexdigest()


def write(path: Location, header: Header, arrays: Arrays) -> None:
    """Write a compact library, whole or not at all."""
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


def read_header(path: Location) -> Header:
    """What a compact library says of itself.

    Raises
    ------
    LibraryError
        When the file is no compact library, one of a newer format, or damaged.
    """
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


def read_arrays(path: Location, header: Header) -> Arrays:
    """The numbers of a compact library, which have its checksum, or a `LibraryError`."""
    arrays = _read_arrays(path, header)
    actual = checksum(header, arrays)
    if actual != header.checksum:
        raise _damaged(
            path,
            f"its numbers have checksum {actual[:12]} and {HEADER} says {header.checksum[:12]}",
        )
    return arrays


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
    n_there = archive.getinfo(name).file_size
    if n_there != n_bytes:
        raise ValueError(f"{name} has {n_there:,} bytes where {n_bytes:,} are expected")
    return np.frombuffer(archive.read(name), dtype).reshape(shape)


def _damaged(path: Location, what: str) -> LibraryError:
    return LibraryError(
        f"{path} is no sound compact library: {what}. `halfway library compact LIB -o {path}` makes one."
    )


_DAMAGE = (
    *(OSError, KeyError, ValueError, EOFError, NotImplementedError),
    *(zipfile.BadZipFile, zlib.error),
)
"""What reading a damaged zip may raise: a bit of its directory names a way to compress that is not supported."""
_DTYPES: dict[Precision, str] = {"int8": "i1", "float16": "<f2", "float32": "<f4"}
_CODINGS = {
    (mapping, shared, precision): Coding(mapping, shared, precision)
    for mapping in get_args(MappingName)
    for shared in (True, False)
    for precision in _DTYPES
}
