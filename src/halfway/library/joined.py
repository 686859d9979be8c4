"""A library and one material more: a measurement of a person's own beside those of others."""

import hashlib
from dataclasses import replace

import numpy as np

from .._types import Rows, Table
from ..brdf import Brdf, TabularBrdf, tabulate
from .library import Library, material_checksum


class Joined(Library):
    """``library``, and ``brdf`` after its materials under a name that none of them has, on its grid and under its name.

    What was computed of the library's own materials holds for it too (`halfway.components.Gram.extended`).
    """

    def __init__(self, library: Library, name: str, brdf: Brdf) -> None:
        self._library = library
        table = brdf if isinstance(brdf, TabularBrdf) else None
        if table is None or table.grid != library.grid:
            table = tabulate(brdf, library.grid, name=name)
        self._row = np.ascontiguousarray(table.values.reshape(3, -1), np.float32)
        self.name = library.name
        self.names = (*library.names, name)
        self.grid = library.grid
        self.origin = replace(
            library.origin, description=f"{library.origin.description}; and {name}, your own"
        )
        content = hashlib.sha256(self._row.data).digest()
        own = material_checksum(name, self.grid, content)
        self.material_checksums = (*library.material_checksums, own)
        self.checksum = hashlib.sha256(repr((library.checksum, own)).encode()).hexdigest()

    @property
    def address(self) -> str:
        return self._library.address

    def row(self, i: int) -> Table:
        return self._row.copy() if i == len(self._library) else self._library.row(i)

    def columns(self, columns: slice) -> Rows:
        own = self._row[:, None, columns]
        return np.concatenate([self._library.columns(columns), own], axis=1)

    def blocks(self) -> list[slice]:
        return self._library.blocks()
