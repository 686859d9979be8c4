"""Write a table in the format that a file's suffix names."""

from pathlib import Path

from ..brdf import TabularBrdf
from ..files import suffix_of
from .merl import write_merl
from .rgl_writer import write_rgl
from .zarr_tables import write_zarr

WRITERS = {".binary": write_merl, ".bsdf": write_rgl, ".zarr": write_zarr}


def write_brdf(path: str | Path, table: TabularBrdf) -> None:
    """Write ``table`` to ``path``: ``.binary`` is a MERL file, ``.bsdf`` an RGL file (see `write_rgl`), ``.zarr`` a Zarr
    store of the table as it is.

    Raises
    ------
    OutputError
        When the suffix names no format, the format cannot hold the table, or the file cannot be written.
    """
    WRITERS[suffix_of(Path(path), WRITERS)](path, table)
