"""Libraries on disk.

    NAME.brdflib/
        library.json   format version, grid, origin, and per material its name, source, licence and checksum
        tables-0123456789ab.npy
                       float32, channel-major (3, N, p): a channel of a block is N contiguous runs

library.json names the file of tables, whose own name begins like the library's checksum. So a library is replaced by putting
its new tables beside the old ones and then, at once, the new library.json: whoever looks, and whatever crashes, there is
one whole library. The folder may be remote (``s3://bucket/NAME.brdflib``), and is read in ranges.

Blocks are read into memory of their own: pages of a map would count as memory until the whole file does (1.1 GB where this
takes .1).
"""

import hashlib
import io
import json
import math
import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from secrets import token_hex
from typing import Any

import numpy as np

from .._types import Rows, Table
from ..errors import HalfwayError, LibraryError
from ..formats import find_brdfs
from ..halfdiff import Axis, Grid
from ..locations import Location, RemotePath, read_into
from ..origin import Origin
from ..tasks import HERE, Work
from . import compact_file
from .blocks import columns_per_block, ranges
from .compact import CompactLibrary
from .library import FileLibrary, Verdict, material_checksum, texts

FORMAT = 1
SUFFIX = ".brdflib"
DESCRIPTION = "library.json"


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


class StoredLibrary(FileLibrary):
    """A library opened from its folder.

    Raises
    ------
    LibraryError
        When the folder holds no library, one of a newer format, or tables that do not fit its description.
    """

    def __init__(self, path: Location) -> None:
        self.path = path
        """Its folder."""
        description = None
        # It may be replaced while we look: then there is another description.
        while description != (latest := _read_description(path)):
            description = latest
            self._describe(latest)
            if self.tables.is_file():
                break
        self._start = self._check_tables()

    def _describe(self, description: dict[str, Any]) -> None:
        path = self.path
        try:
            self.grid = Grid(tuple(Axis(**axis) for axis in description["grid"]))
            self.entries = tuple(Entry(**texts(entry)) for entry in description["materials"])
            self.origin = Origin(**texts(description["origin"]))
            self.tables = path / _tables_name(description["tables"])
            """Its file of samples."""
        except (KeyError, TypeError, ValueError, AttributeError) as error:
            raise LibraryError(
                f"{path / DESCRIPTION} lacks what a library needs ({error}): build the library again."
            ) from None
        # A URL can be opened from anywhere; a path means something on one machine.
        self.name = str(path) if isinstance(path, RemotePath) else path.name.removesuffix(SUFFIX)
        self.names = tuple(entry.name for entry in self.entries)
        self.checksum = library_checksum(self.entries, self.grid)
        self.material_checksums = tuple(
            material_checksum(entry.name, self.grid, entry.sha256.encode())
            for entry in self.entries
        )

    def row(self, i: int) -> Table:
        return self._read(range(i, i + 1), slice(0, self.grid.size))[:, 0]

    def columns(self, columns: slice) -> Rows:
        return self._read(range(len(self)), columns)

    def blocks(self) -> list[slice]:
        return ranges(self.grid.size, columns_per_block(len(self)))

    def verify(self, *, work: Work = HERE) -> Verdict:
        """Read all samples again, and those of its sources that are still there."""
        right = list(work.run(partial(_is_right, self), range(len(self)), label="Samples"))
        sources = list(dict.fromkeys(filter(None, map(_file, self.entries))))
        checksums = work.run(_checksums, sources, label="Sources")
        now = dict(zip(sources, checksums, strict=True))
        return Verdict(
            sum(right),
            tuple(name for name, is_right in zip(self.names, right, strict=True) if not is_right),
            tuple(entry.name for entry in self.entries if _has_changed(entry, now)),
        )

    def _sources(self) -> list[tuple[str, str]]:
        return [(entry.source, entry.source_sha256) for entry in self.entries]

    def _read(self, materials: range, columns: slice) -> Rows:
        rows = np.empty((3, len(materials), columns.stop - columns.start), np.float32)
        cells = [
            (channel * len(self) + i) * self.grid.size + columns.start
            for channel in range(3)
            for i in materials
        ]
        buffers = [samples.data.cast("B") for planes in rows for samples in planes]
        try:
            read_into(self.tables, [self._start + 4 * cell for cell in cells], buffers)
        except FileNotFoundError:
            raise LibraryError(
                f"{self.tables} is gone: it was there when the library was opened. It was built again or moved; "
                "run the same command again."
            ) from None
        return rows

    def _check_tables(self) -> int:
        """Where the samples begin."""
        shape = (3, len(self), self.grid.size)
        header = npy_header(shape)
        begins = bytearray(len(header))
        try:
            n_bytes = self.tables.stat().st_size
            if n_bytes >= len(header):
                read_into(self.tables, [0], [memoryview(begins)])
        except OSError as error:
            raise LibraryError(
                f"{self.tables} cannot be read ({error.strerror or error}): build the library again."
            ) from None
        expected = len(header) + 4 * math.prod(shape)
        if bytes(begins) != header or n_bytes != expected:
            raise LibraryError(
                f"{self.tables} does not hold what {DESCRIPTION} describes, float32 {shape} in {expected:,} bytes "
                f"(it has {n_bytes:,}): build the library again."
            )
        return len(header)


def is_stored(path: Location) -> bool:
    """Whether there is a stored library at ``path``, whole or damaged."""
    return (path / DESCRIPTION).exists()


def library_checksum(entries: Sequence[Entry], grid: Grid) -> str:
    """The checksum of a library of these materials."""
    parts = [(entry.name, entry.sha256) for entry in entries]
    return hashlib.sha256(repr((parts, grid)).encode()).hexdigest()


def tables_name(checksum: str, path: Location) -> str:
    """What the file of the tables of a library with this checksum is called.

    Nobody can be kept from putting files at a URL meanwhile: there the name is used once.
    """
    once = token_hex(6) if isinstance(path, RemotePath) else ""
    return f"tables-{checksum[:12]}{once}.npy"


def npy_header(shape: tuple[int, ...]) -> bytes:
    """How a .npy file of little-endian float32 of this shape begins."""
    header = io.BytesIO()
    np.lib.format.write_array_header_1_0(
        header, {"descr": "<f4", "fortran_order": False, "shape": shape}
    )
    return header.getvalue()


def _is_right(library: StoredLibrary, i: int) -> bool:
    return hashlib.sha256(library.row(i).data).hexdigest() == library.entries[i].sha256


def _file(entry: Entry) -> str | None:
    """The file that a material came from, if it is there; a member of a zip is called ``archive.zip:member``."""
    files = map(Path, (entry.source, entry.source.rpartition(":")[0]))
    # Workers may be in another folder.
    return next((str(file.absolute()) for file in files if file.is_file()), None)


def _checksums(source: str) -> dict[str, str]:
    """Of the materials in a file, by name; none where it is no BRDF any more."""
    try:
        compact = Path(source).suffix == compact_file.SUFFIX
        there = CompactLibrary(Path(source)).materials() if compact else find_brdfs([source])[0]
    except HalfwayError:
        return {}
    return {material.name: material.sha256 for material in there}


def _has_changed(entry: Entry, now: Mapping[str, Mapping[str, str]]) -> bool:
    checksums = now.get(_file(entry) or "")
    return checksums is not None and checksums.get(entry.name) != entry.source_sha256


def _tables_name(name: str) -> str:
    if not re.fullmatch(r"tables-[0-9a-f]+\.npy", name):
        raise ValueError(f"tables {name!r}")
    return name


def _read_description(path: Location) -> dict[str, Any]:
    try:
        description = json.loads((path / DESCRIPTION).read_text(encoding="utf-8"))
        version = description["format"]
    except FileNotFoundError:
        raise LibraryError(
            f"{path} is no library: there is no {DESCRIPTION} in it. "
            f"`halfway library build {path} -o NAME{SUFFIX}` makes one of a folder of BRDF files."
        ) from None
    except (OSError, ValueError, KeyError, TypeError, RecursionError) as error:
        raise LibraryError(
            f"{path / DESCRIPTION} cannot be read ({error}): build the library again."
        ) from None
    if version != FORMAT:
        raise LibraryError(
            f"{path} has library format {version}, and this version of halfway reads format {FORMAT}: "
            "upgrade halfway, or build the library again."
        )
    return description
