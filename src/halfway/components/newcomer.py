"""A material that is not of a library, beside those that are: what its coordinates among them are made of."""

import warnings
from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property, lru_cache, partial

import numpy as np
from jaxtyping import Float64

from .._types import Table
from ..brdf import Brdf
from ..library import Library, ProceduralLibrary
from ..recipes import Blend
from ..tasks import HERE, Work
from .mapped import MappedRows
from .sums import join_channels, measured_pieces, sum_blocks


@dataclass(frozen=True, eq=False)
class Newcomer:
    """A material beside those of a library, on the library's grid."""

    library: Library
    brdf: Brdf
    name: str = "the material"
    work: Work = HERE

    @property
    def alone(self) -> Library:
        """It as a library of one."""
        return ProceduralLibrary(self.name, {self.name: self.brdf}, grid=self.library.grid)

    @cached_property
    def row(self) -> Table:
        """Its samples."""
        return self.alone.row(0)

    def products(self, blend: Blend | None = None) -> Float64[np.ndarray, "n_channels N"]:
        """``(p_i - C) . (p - C)`` of each material i with this one, per channel, about the library's centroid.

        Of samples as they are, or as `MappedRows` has them for a blend. Over the cells measured in every material of the library. Where this one is not, it counts as the centroid, and a
        warning says how often.
        """
        return self._kept(blend)

    @cached_property
    def _kept(self) -> Callable[[Blend | None], np.ndarray]:
        # A space of three charts asks three times.
        return lru_cache(2)(partial(_products, self))


def _products(newcomer: Newcomer, blend: Blend | None) -> Float64[np.ndarray, "n_channels N"]:
    library = newcomer.library
    block = partial(_block, library, newcomer.row, blend)
    label = f"Scores of {newcomer.name}"
    products, n_known, n_cells = sum_blocks(library, block, label=label, work=newcomer.work)
    if (n_known < n_cells).any():
        warnings.warn(
            f"{newcomer.name} is unmeasured in {1 - n_known.sum() / n_cells.sum():.1%} of what {library.name} is measured "
            "in: there it counts as the mean material.",
            stacklevel=3,
        )
    return products


def _block(
    library: Library, row: Table, blend: Blend | None, columns: slice
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """The products on one block; the cells where the newcomer is measured, of those that count."""
    samples, own = library.columns(columns), row[:, columns]
    if blend:
        rows = MappedRows(library, blend)
        samples, own = rows.of(samples, columns), rows.of(own, columns)
    channels = map(_channel, samples, own)
    products, n_known, n_cells = join_channels(channels, len(own))
    return products, n_known, n_cells


def _channel(samples: np.ndarray, own: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    products, n_known, n_cells = np.zeros(len(samples)), 0, 0
    # The newcomer is carried along as numbers that are never NaN, so that it takes no cell away.
    known = ~np.isnan(own)
    carried = np.stack([np.where(known, own, 0), known])
    for piece in measured_pieces(np.concatenate([samples, carried])):
        others, value, is_known = piece[:-2], piece[-2], piece[-1]
        centroid = others.mean(axis=0)
        products += (others - centroid) @ (is_known * (value - centroid))
        n_known, n_cells = n_known + int(is_known.sum()), n_cells + len(value)
    return products, np.array(n_known), np.array(n_cells)
