"""The samples of a library in the mapping of a blend, weighed as light uses them: what a space's components are made of.

    x_ij = sqrt(w_j) m(f_ij)        w_j = solid angle of cell j x cos_i cos_o, summing to 1

A component then spends itself on what is seen. By cell, two thirds of a MERL table lie within 40 degrees of a mirror's
highlight and beyond 60 degrees of theta_d; and in squares of values the brightest highlight of a library is nearly all.
"""

from functools import lru_cache

import numpy as np
from jaxtyping import Float32

from ..brdf import quadrature
from ..halfdiff import Grid
from ..library import Library, Streamed
from ..recipes import Blend


class MappedRows(Streamed):
    """The mapped and weighed samples of all materials of a library."""

    def __init__(self, library: Library, blend: Blend) -> None:
        self._library = library
        self._mapping = blend.mapping
        self.name, self.names, self.grid = library.name, library.names, library.grid
        label = f"-{self._mapping.name}-by-cosines"
        self.checksum = library.checksum + label
        self.material_checksums = tuple(each + label for each in library.material_checksums)

    def columns(self, columns: slice) -> Float32[np.ndarray, "n_channels N n"]:
        return self.of(self._library.columns(columns), columns)

    def of(self, samples: np.ndarray, columns: slice) -> np.ndarray:
        """Mapped and weighed samples of any material on the grid."""
        return self._mapping.to(samples) * _scale(self.grid)[columns]

    def blocks(self) -> list[slice]:
        return self._library.blocks()


@lru_cache(maxsize=2)
def _scale(grid: Grid) -> Float32[np.ndarray, " p"]:
    """The root of each cell's weight."""
    return np.sqrt(quadrature.light_weights(grid)).astype(np.float32)
