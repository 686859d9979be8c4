"""What a compact library makes of samples before it takes their principal components, and back.

    linear      x = f
    log         x = ln(f w + e)        w = max(cos_i cos_o, .001),  e = .001

The logarithm is that of Nielsen et al. 2015, relative to the mean over the materials instead of the median, which the
components subtract. In it an error is a share of the value, in the dark as in a highlight; linear components spend
themselves on the highlights.

Either each channel has components of its own, or the three share them: then a material is three rows of one analysis, and
what its channels have in common, which is nearly all, is stored once.

Reference: J. B. Nielsen, H. W. Jensen, R. Ramamoorthi, "On Optimal, Minimal BRDF Sampling for Reflectance Acquisition",
ACM TOG 34(6), 2015, equation 6.
"""

from dataclasses import dataclass
from functools import lru_cache
from typing import Literal

import numpy as np
from jaxtyping import Float

from .._types import Rows
from ..brdf import metrics, quadrature
from ..halfdiff import Grid

MappingName = Literal["log", "linear"]
Precision = Literal["int8", "float16", "float32"]


@dataclass(frozen=True)
class Coding:
    """How the samples of a compact library are stored."""

    mapping: MappingName = "log"
    shared: bool = True
    """Whether the three channels share their components."""
    precision: Precision = "int8"
    """Of the components."""

    @property
    def n_bases(self) -> int:
        """Sets of components: one, or one per channel."""
        return 1 if self.shared else 3

    def to_coded(
        self, samples: Rows, grid: Grid, columns: slice
    ) -> Float[np.ndarray, "n_bases n_rows n"]:
        """The rows of a block of samples that components are taken of; NaN where a material is unmeasured."""
        coded = samples
        if self.mapping == "log":
            coded = np.log(samples * _weights(grid)[columns] + np.float32(metrics.EPSILON))
        return coded.reshape(self.n_bases, -1, samples.shape[-1])

    def to_samples(
        self, coded: Float[np.ndarray, "n_bases n_rows n"], grid: Grid, cells: np.ndarray
    ) -> Rows:
        """Samples of coded rows on ``cells``, 1/sr, shape (3, n_materials, n); never negative."""
        samples = coded.reshape(3, len(coded) * coded.shape[1] // 3, -1 if coded.size else 0)
        if self.mapping == "log":
            samples = (np.exp(samples) - np.float32(metrics.EPSILON)) / _weights(grid)[cells]
        return np.maximum(samples, 0, dtype=np.float32)


@lru_cache(maxsize=2)
def _weights(grid: Grid) -> Float[np.ndarray, " p"]:
    cells = quadrature.comparison_cells(grid)
    return np.maximum(cells.cos_i * cells.cos_o, metrics.EPSILON).ravel().astype(np.float32)
