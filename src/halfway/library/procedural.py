"""Libraries whose samples are computed when asked for: published fits, neural fits.

A few hundred kilobytes of parameters stand for 1.7 GB of tables. Blocks are whole rows of the grid's first axis,
because that is what a BRDF computes cheaply, or parts of such rows where there are many materials.
"""

import hashlib
from collections.abc import Mapping
from itertools import groupby
from pathlib import Path

import numpy as np

from .._types import Rows, Table
from ..brdf import Brdf
from ..halfdiff import MERL, Grid
from ..origin import Origin
from .blocks import columns_per_block, grid_parts
from .library import Library, material_checksum


class ProceduralLibrary(Library):
    """Materials given as BRDFs, on a grid.

    Parameters
    ----------
    name : str
        What the library is called, as `open_library` understands it.
    brdfs : mapping of str to Brdf
        The materials, by name.
    path : path, optional
        Of the file that they are from.
    """

    def __init__(
        self,
        name: str,
        brdfs: Mapping[str, Brdf],
        *,
        grid: Grid = MERL,
        origin: Origin = Origin(),  # noqa: B008 (frozen)
        path: Path | None = None,
    ) -> None:
        self.name = name
        self.path = path
        self.names = tuple(brdfs)
        self.grid = grid
        self.origin = origin
        self._brdfs = tuple(brdfs.values())
        prints = [brdf.fingerprint() for brdf in self._brdfs]
        digest = hashlib.sha256(repr((self.names, self.grid)).encode())
        for fingerprint in prints:
            digest.update(fingerprint)
        self.checksum = digest.hexdigest()
        self.material_checksums = tuple(
            material_checksum(name, grid, fingerprint)
            for name, fingerprint in zip(self.names, prints, strict=True)
        )
        parts = grid_parts(grid.shape, columns_per_block(len(self)))
        self._parts = {(columns.start, columns.stop): part for columns, part in parts}

    @property
    def address(self) -> str:
        return str(self.path.absolute()) if self.path else self.name

    def material(self, name: str) -> Brdf:
        return self._brdfs[self.index(name)]

    def row(self, i: int) -> Table:
        return self._brdfs[i].sample_rows(self.grid, slice(None)).reshape(3, -1)

    def columns(self, columns: slice) -> Rows:
        part = self._parts[columns.start, columns.stop]
        sets = [
            kind.sample_many(list(brdfs), self.grid, part)
            for kind, brdfs in groupby(self._brdfs, type)
        ]
        together = sets[0] if len(sets) == 1 else np.concatenate(sets, axis=1)
        return together.reshape(3, len(self), -1)

    def blocks(self) -> list[slice]:
        return [slice(start, stop) for start, stop in self._parts]
