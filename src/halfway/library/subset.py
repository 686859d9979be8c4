"""Some materials of a library, as a library of their own: what a static explorer carries."""

import hashlib
from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from .._types import Rows, Table
from ..errors import LibraryError
from .blocks import ranges
from .library import Library

BLOCK_BYTES = 1.5e8
"""How many bytes of float32 a block holds: eight materials on the MERL grid are one."""


class Subset(Library):
    """The materials called ``names`` of ``library``, in its order and under its name: their recipes are recipes of it.

    Raises
    ------
    LibraryError
        When the library has no material of a name.
    """

    def __init__(self, library: Library, names: Sequence[str]) -> None:
        self._library = library
        self._indices = sorted({library.index(name) for name in names})
        if len(self._indices) < 2:
            raise LibraryError(
                f"{len(self._indices)} material of {library.name} makes no space: name at least two."
            )
        self.name = library.name
        self.names = tuple(library.names[i] for i in self._indices)
        self.grid = library.grid
        self.origin = replace(
            library.origin,
            description=f"{len(self.names)} of {len(library)} materials; {library.origin.description}",
        )
        self.checksum = hashlib.sha256(repr((library.checksum, self.names)).encode()).hexdigest()
        self.material_checksums = tuple(library.material_checksums[i] for i in self._indices)

    def row(self, i: int) -> Table:
        return self._library.row(self._indices[i])

    def columns(self, columns: slice) -> Rows:
        # Of these materials alone: the library's own columns would be computed of all.
        return np.stack([self.row(i)[:, columns] for i in range(len(self))], axis=1)

    def blocks(self) -> list[slice]:
        # Few and wide, since every block takes whole rows.
        return ranges(self.grid.size, max(1, int(BLOCK_BYTES / (12 * len(self)))))
