"""A material that is not of a library, beside those that are: what its coordinates among them are made of."""

import warnings
from dataclasses import dataclass
from functools import cached_property, partial

import numpy as np
from jaxtyping import Float64

from .._types import Table
from ..brdf import Brdf, require_isotropic
from ..library import Library, ProceduralLibrary
from ..tasks import HERE, Work
from .sums import join_channels, measured_pieces, sum_blocks


@dataclass(frozen=True, eq=False)
class Newcomer:
    """A material beside those of a library, on the library's grid.

    Raises
    ------
    AnisotropyError
        When it depends on phi_h and they do not.
    """

    library: Library
    brdf: Brdf
    name: str = "the material"
    work: Work = HERE

    def __post_init__(self) -> None:
        if self.library.grid.is_isotropic:
            require_isotropic(self.brdf, "its table", name=self.name)

    @property
    def alone(self) -> Library:
        """It as a library of one."""
        return ProceduralLibrary(self.name, {self.name: self.brdf}, grid=self.library.grid)

    @cached_property
    def products(self) -> Float64[np.ndarray, "n_channels N"]:
        """``(p_i - C) . (p - C)`` of each material i with this one, per channel, about the library's centroid; 1/sr^2.

        Over the cells measured in every material of the library. Where this one is not, it counts as the centroid, and a
        warning says how often.
        """
        block = partial(_block, self.library, self.alone.row(0))
        label = f"Scores of {self.name}"
        products, n_known, n_cells = sum_blocks(self.library, block, label=label, work=self.work)
        if (n_known < n_cells).any():
            warnings.warn(
                f"{self.name} is unmeasured in {1 - n_known.sum() / n_cells.sum():.1%} of what {self.library.name} is measured "
                "in: there it counts as the mean material.",
                stacklevel=2,
            )
        return products


def _block(
    library: Library, row: Table, columns: slice
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """The products on one block; the cells where the newcomer is measured, of those that count."""
    own = row[:, columns]
    channels = map(_channel, library.columns(columns), own)
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
