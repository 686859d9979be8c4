"""Libraries whose samples are computed when asked for: published fits, neural fits.

A few hundred kilobytes of parameters stand for 1.7 GB of tables. Blocks are whole rows of the grid's first axis,
because that is what a BRDF computes cheaply.
"""

import hashlib
import math
from collections.abc import Mapping

import numpy as np

from .._types import Rows, Table
from ..brdf import Brdf
from ..halfdiff import MERL, Grid
from .library import BLOCK_BYTES, Library, Origin


class ProceduralLibrary(Library):
    """Materials given as BRDFs, on a grid.

    Parameters
    ----------
    name : str
        What the library is called, as `open_library` understands it.
    brdfs : mapping of str to Brdf
        The materials, by name.
    """

    def __init__(
        self,
        name: str,
        brdfs: Mapping[str, Brdf],
        *,
        grid: Grid = MERL,
        origin: Origin = Origin(),  # noqa: B008 (frozen)
    ) -> None:
        self.name = name
        self.names = tuple(brdfs)
        self.grid = grid
        self.origin = origin
        self._brdfs = tuple(brdfs.values())
        digest = hashlib.sha256(repr((self.names, self.grid)).encode())
        for brdf in self._brdfs:
            digest.update(brdf.fingerprint())
        self.checksum = digest.hexdigest()

    def row(self, i: int) -> Table:
        return self._brdfs[i].sample_rows(self.grid, slice(None)).reshape(3, -1)

    def columns(self, columns: slice) -> Rows:
        rows = slice(columns.start // self._stride, columns.stop // self._stride)
        block = np.empty((3, len(self), columns.stop - columns.start), np.float32)
        for i, brdf in enumerate(self._brdfs):
            block[:, i] = brdf.sample_rows(self.grid, rows).reshape(3, -1)
        return block

    def blocks(self) -> list[slice]:
        n_rows = max(1, int(BLOCK_BYTES / (8 * len(self) * self._stride)))
        starts = range(0, self.grid.shape[0], n_rows)
        ends = [min(start + n_rows, self.grid.shape[0]) for start in starts]
        return [
            slice(start * self._stride, end * self._stride)
            for start, end in zip(starts, ends, strict=True)
        ]

    @property
    def _stride(self) -> int:
        """Cells in one row of the grid's first axis."""
        return math.prod(self.grid.shape[1:])
