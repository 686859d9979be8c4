"""Write a table in the format that a file's suffix names."""

from pathlib import Path

from ..brdf import TabularBrdf
from ..errors import OutputError
from .merl import write_merl
from .rgl_writer import write_rgl

WRITERS = {".binary": write_merl, ".bsdf": write_rgl}


def write_brdf(path: str | Path, table: TabularBrdf) -> None:
    """Write ``table`` to ``path``: ``.binary`` is a MERL file, ``.bsdf`` an RGL file (see `write_rgl`).

    Raises
    ------
    OutputError
        When the suffix names no format, the format cannot hold the table, or the file cannot be written.
    """
    suffix = Path(path).suffix
    if suffix not in WRITERS:
        raise OutputError(
            f"{path} has the suffix {suffix!r}, which names no format: expected {' or '.join(WRITERS)}."
        )
    WRITERS[suffix](path, table)
