"""The mapping in which materials are recovered, and its inverse: dark values count as much as bright ones.

    m = ln(f c + e)        c = max(cos_i cos_o, e),  e = .001 (`halfway.brdf.metrics`)

Nielsen et al. 2015, eq. 6, divide by a reference first: that is a difference of two such values, and cancels wherever samples are taken about
their mean, as they are here.
"""

import numpy as np

from .._types import Angle
from ..brdf import metrics, quadrature
from ..halfdiff import Grid

_LARGEST = 80.0
"""What extrapolates further than this is nothing; its f_r over .001 is still a float32."""
Cosines = tuple[Angle, Angle]
"""Of the angles that wi and wo make with the normal."""


def mapped(f: np.ndarray, cosines: Cosines) -> np.ndarray:
    """Log-relative values of f_r in 1/sr."""
    return metrics.MAPPINGS["log-relative"](f, *cosines)


def unmapped(m: np.ndarray, cosines: Cosines) -> np.ndarray:
    """f_r in 1/sr of log-relative values; below 1 e these mean nothing and give 0."""
    cos_i, cos_o = cosines
    values = np.maximum(np.exp(np.minimum(m, _LARGEST)) - metrics.EPSILON, 0)
    return values / np.maximum(cos_i * cos_o, metrics.EPSILON)


def cosines_at(grid: Grid, columns: slice) -> Cosines:
    """The cosines of some cells of a grid."""
    cells = quadrature.comparison_cells(grid)
    cos_i, cos_o = (
        np.broadcast_to(cosine, grid.shape).reshape(-1)[columns].astype(np.float32)
        for cosine in (cells.cos_i, cells.cos_o)
    )
    return cos_i, cos_o
