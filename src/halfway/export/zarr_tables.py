"""Tables as one Zarr store in half precision: a fourth of the bytes of MERL files, or less.

    tables.zarr/
        zarr.json           float16, shape (n, 3, *grid), one chunk per recipe; attributes: scale, unit
        c.0.0.0.0.0, ...    the chunks: little endian, gzip

    f_r = scale x sample    in 1/sr, within 2^-11 of the table; NaN where unmeasured

``scale`` is that of `halfway.brdf.half_scale` for the largest sample of all. A chunk is a file, and so a store is
written like any other batch.

Source: Zarr core specification, version 3 (regular chunk grid, default chunk keys, codecs bytes and gzip).
"""

import gzip
import json
from pathlib import Path

import numpy as np

from ..brdf import TabularBrdf
from ..files import replacing
from ..halfdiff import Grid

STORE = "tables.zarr"
METADATA = f"{STORE}/zarr.json"


def chunk_names(n: int, grid: Grid) -> list[str]:
    """The files of ``n`` chunks, in the folder that holds the store."""
    zeros = ".0" * (1 + len(grid.axes))
    return [f"{STORE}/c.{i}{zeros}" for i in range(n)]


def chunk_bytes(grid: Grid) -> int:
    """What a chunk takes at most: samples that cannot be compressed."""
    return 6 * grid.size + 4096


def metadata(n: int, grid: Grid, scale: float) -> str:
    """The document ``zarr.json``."""
    document = {
        "zarr_format": 3,
        "node_type": "array",
        "shape": [n, 3, *grid.shape],
        "data_type": "float16",
        "dimension_names": ["recipe", "channel", *(axis.angle for axis in grid.axes)],
        "chunk_grid": {"name": "regular", "configuration": {"chunk_shape": [1, 3, *grid.shape]}},
        "chunk_key_encoding": {"name": "default", "configuration": {"separator": "."}},
        "fill_value": "NaN",
        "codecs": [
            {"name": "bytes", "configuration": {"endian": "little"}},
            {"name": "gzip", "configuration": {"level": 1}},
        ],
        "attributes": {"scale": scale, "unit": "1/sr"},
    }
    return json.dumps(document, indent=1)


def write_chunk(path: Path, table: TabularBrdf, scale: float) -> None:
    """Write the chunk of one table.

    Raises
    ------
    OutputError
        When the file cannot be written.
    """
    samples = (table.values / np.float32(scale)).astype("<f2")
    with replacing(path) as temporary:
        temporary.write_bytes(gzip.compress(samples.data, compresslevel=1, mtime=0))
