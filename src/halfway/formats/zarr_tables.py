"""Tables on any grid as one Zarr store, readable by any program that knows Zarr.

    NAME.zarr/
        zarr.json           float32 or float16, shape (n, 3, *grid), one chunk a table; attributes as below
        c.0.0.0.0.0, ...    the chunks: little endian, gzip

    f_r = scale x sample    in 1/sr; NaN where unmeasured

    attributes   scale; unit, "1/sr"; grid, the axes as `halfway.halfdiff.Axis` has them; names, of the tables

One table by itself is float32 and exact. Those of a route are float16, a fourth of the bytes of MERL files or less, within 2^-11
of the tables; their ``scale`` is that of `halfway.brdf.half_scale` for the largest sample of all. A chunk is a file, and so a
store is written like any other batch.

Source: Zarr core specification, version 3 (regular chunk grid, default chunk keys, codecs bytes and gzip).
"""

import gzip
import json
import zlib
from collections.abc import Sequence
from dataclasses import asdict
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from ..brdf import TabularBrdf
from ..errors import FormatError, OutputError
from ..files import replacing, scratch_folder
from ..halfdiff import Axis, Grid, HalfDiff
from .sources import FileSource

STORE = "tables.zarr"
DOCUMENT = "zarr.json"
METADATA = f"{STORE}/{DOCUMENT}"
MOST_TABLES = 100_000
LARGEST_GRID = 1 << 28
"""Cells of a table that is read, at most."""
_SAMPLES = {"float16": "<f2", "float32": "<f4"}
_CODECS = [
    {"name": "bytes", "configuration": {"endian": "little"}},
    {"name": "gzip", "configuration": {"level": 1}},
]


class ZarrStore(NamedTuple):
    """What a store says of the tables in it."""

    path: Path
    names: tuple[str, ...]
    grid: Grid
    samples: str
    scale: float

    @classmethod
    def open(cls, path: Path) -> "ZarrStore":
        """The store in a folder; no chunk is read.

        Raises
        ------
        FormatError
            When it is none of ours, or is damaged.
        """
        try:
            document = json.loads((path / DOCUMENT).read_text(encoding="utf-8"))
            return _store(path, document)
        except (OSError, ValueError, KeyError, TypeError, AttributeError, RecursionError) as error:
            reason = (str(error) or type(error).__name__).splitlines()[0][:100]
            raise FormatError(
                f"{path.name} is no Zarr store of tables ({reason}): expected an array "
                f"(n, 3, *grid) with the grid in its attributes, as `halfway convert IN OUT.zarr` writes it."
            ) from None

    def chunk(self, i: int) -> FileSource:
        """The file of one table."""
        return FileSource(self.path / chunk_name(i, self.grid))

    def read(self, i: int) -> TabularBrdf:
        """One table.

        Raises
        ------
        FormatError
            When its chunk is missing or damaged.
        """
        n_bytes = 3 * self.grid.size * np.dtype(self.samples).itemsize
        source = self.chunk(i)
        with source.open() as stream:
            unpacked = zlib.decompressobj(wbits=31)
            content = unpacked.decompress(stream.read(n_bytes + (1 << 16)), n_bytes + 1)
        if len(content) != n_bytes:
            raise FormatError(
                f"{source.label} of {self.path.name} unpacks to {'more' if len(content) > n_bytes else 'fewer'} than the "
                f"{n_bytes:,} bytes of a table of {self.grid} cells. It is damaged; write the store again."
            )
        values = np.frombuffer(content, self.samples).astype(np.float32)
        if np.isinf(values).any():
            raise FormatError(
                f"{source.label} of {self.path.name} has infinite samples: expected numbers, or NaN where unmeasured."
            )
        values *= np.float32(self.scale)
        return TabularBrdf(values.reshape(3, *self.grid.shape), self.grid, name=self.names[i])


def is_zarr(path: Path) -> bool:
    """Whether a folder is a Zarr store, of whatever kind."""
    return (path / DOCUMENT).is_file()


def write_zarr(path: str | Path, table: TabularBrdf) -> None:
    """Write one table as a store by itself, exactly; whole or not at all.

    Raises
    ------
    OutputError
        When it cannot be written, or something else is there.
    """
    path = Path(path)
    if path.exists() and not is_zarr(path):
        raise OutputError(f"{path} exists and is no Zarr store: it is not replaced.")
    with scratch_folder(path) as folder:
        store = folder / "new"
        store.mkdir()
        text = metadata(1, table.grid, 1.0, names=[table.name or path.stem], samples="float32")
        (store / DOCUMENT).write_text(text, encoding="utf-8")
        chunk = gzip.compress(table.values.astype("<f4").data, compresslevel=1, mtime=0)
        (store / chunk_name(0, table.grid)).write_bytes(chunk)
        if path.exists():
            # It goes with the scratch folder, once the new one is in place.
            path.rename(folder / "old")
        store.rename(path)


def chunk_name(i: int, grid: Grid) -> str:
    """The file of chunk ``i``, in the store."""
    return f"c.{i}" + ".0" * (1 + len(grid.axes))


def chunk_names(n: int, grid: Grid) -> list[str]:
    """The files of ``n`` chunks, in the folder that holds the store `STORE`."""
    return [f"{STORE}/{chunk_name(i, grid)}" for i in range(n)]


def chunk_bytes(grid: Grid) -> int:
    """What a chunk of float16 takes at most: samples that cannot be compressed."""
    return 6 * grid.size + 4096


def metadata(
    n: int, grid: Grid, scale: float, *, names: Sequence[str] = (), samples: str = "float16"
) -> str:
    """The document ``zarr.json``; tables without names are called by their number."""
    document = {
        "zarr_format": 3,
        "node_type": "array",
        "shape": [n, 3, *grid.shape],
        "data_type": samples,
        "dimension_names": ["recipe", "channel", *(axis.angle for axis in grid.axes)],
        "chunk_grid": {"name": "regular", "configuration": {"chunk_shape": [1, 3, *grid.shape]}},
        "chunk_key_encoding": {"name": "default", "configuration": {"separator": "."}},
        "fill_value": "NaN",
        "codecs": _CODECS,
        "attributes": {
            "scale": scale,
            "unit": "1/sr",
            "grid": [asdict(axis) for axis in grid.axes],
            "names": list(names),
        },
    }
    return json.dumps(document, indent=1)


def write_chunk(path: Path, table: TabularBrdf, scale: float) -> None:
    """Write the chunk of one table in float16, whole or not at all."""
    samples = (table.values / np.float32(scale)).astype("<f2")
    with replacing(path) as temporary:
        temporary.write_bytes(gzip.compress(samples.data, compresslevel=1, mtime=0))


def _store(path: Path, document: Any) -> ZarrStore:
    attributes = document["attributes"]
    grid = Grid(tuple(_axis(axis) for axis in attributes["grid"]))
    n, *shape = document["shape"]
    scale, names = float(attributes["scale"]), attributes["names"] or _numbers(path, n)
    expected = json.loads(metadata(n, grid, scale, samples=document["data_type"]))
    for key in ("zarr_format", "shape", "chunk_grid", "chunk_key_encoding", "codecs"):
        if document[key] != expected[key]:
            raise ValueError(f"its {key} is another than a table's")
    if not (0 < n <= MOST_TABLES and shape == [3, *grid.shape] and grid.size <= LARGEST_GRID):
        raise ValueError(f"shape {document['shape']}"[:100])
    if not (np.isfinite(scale) and scale > 0):
        raise ValueError(f"scale {scale}")
    if len(names) != n or not all(isinstance(name, str) and name for name in names):
        raise ValueError("names that are not one for each table")
    return ZarrStore(path, tuple(names), grid, _SAMPLES[document["data_type"]], scale)


def _numbers(path: Path, n: Any) -> list[str]:
    if not (isinstance(n, int) and 0 < n <= MOST_TABLES):
        raise ValueError(f"{n} tables")
    return [f"{path.stem}-{i:03d}" for i in range(n)]


def _axis(fields: Any) -> Axis:
    known = fields["angle"] in HalfDiff._fields and type(fields["periodic"]) is bool
    sound = type(fields["size"]) is int and 0 < fields["size"] < 1 << 16
    if not (known and sound and fields["power"] in (1, 2) and 0 < float(fields["stop"]) < 7):
        raise ValueError("an axis that a grid does not have")
    return Axis(**fields)
