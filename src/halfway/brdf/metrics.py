"""How different two tables are.

All but the last are root mean squares of mapped values, over pairs of directions and colour channels:

    d(f, g) = sqrt( sum_j w_j |m(f_j) - m(g_j)|^2 / sum_j w_j )

    cosine         m = f cos_i                    the radiance that an even light reflects; ruled by highlights [1]
    cube-root      m = (f cos_i)^(1/3)            near to lightness [2]
    log            m = ln(1 + f cos_i)            linear where dark, logarithmic in highlights [3]
    log-relative   m = ln(f w + .001)             w = max(cos_i cos_o, .001): dark values as much as bright ones [4]
    relative       |f - g| / |f|, no weights      the paper's Table I

``w_j`` is the solid angle of cell j, its measure in the integral over pairs of directions (`Grid.solid_angles`), and the
cosines are those at its centre. A cell counts where both tables are measured. Cells in which either direction is more
than 80 degrees from the normal, where measurements are poor and 1/cos is large, are reported apart.

[1] A. Ngan, F. Durand, W. Matusik, "Experimental Analysis of BRDF Models", EGSR 2005, section 3.1.
[2] A. Fores, J. Ferwerda, J. Gu, "Toward a Perceptually Based Metric for BRDF Modeling", Color and Imaging Conference 2012.
[3] J. Löw, J. Kronander, A. Ynnerman, J. Unger, "BRDF Models for Accurate and Efficient Rendering of Glossy Surfaces",
ACM TOG 31(1), 2012, the metric E2.
[4] J. B. Nielsen, H. W. Jensen, R. Ramamoorthi, "On Optimal, Minimal BRDF Sampling for Reflectance Acquisition", ACM TOG
34(6), 2015, equation 6: ln((f w + e) / (f_ref w + e)); the reference cancels in a difference.
"""

from collections.abc import Callable
from functools import partial
from typing import Literal, NamedTuple, cast, get_args

import numpy as np
from jaxtyping import Float

from .._types import Angle, Mask, Table
from ..errors import FormatError
from .quadrature import Cells, comparison_cells
from .table import TabularBrdf

EPSILON = 1e-3
"""Of Nielsen's mapping: keeps the logarithm finite, and a difference between two blacks small."""

Metric = Literal["cosine", "cube-root", "log", "log-relative", "relative"]
Array = Float[np.ndarray, "..."]


class Difference(NamedTuple):
    """A difference of two tables; NaN where no cell counts."""

    below: float
    """Over cells with both directions within 80 degrees of the normal."""
    grazing: float
    """Over the others."""


def difference(f: TabularBrdf, g: TabularBrdf, metric: str = "log") -> Difference:
    """The difference of ``g`` from the reference ``f``; all metrics but ``relative`` are symmetric.

    Raises
    ------
    FormatError
        When the tables are on different grids, or there is no such metric.
    """
    if metric not in METRICS:
        raise FormatError(f"there is no metric {metric!r}: expected one of {', '.join(METRICS)}.")
    if f.grid != g.grid:
        raise FormatError(
            f"{f.name!r} is on a {f.grid} grid and {g.name!r} on {g.grid}: only tables on one grid can be compared. "
            "Tabulate one of them on the other's grid."
        )
    cells = comparison_cells(f.grid)
    measured = ~(np.isnan(f.values) | np.isnan(g.values))
    if metric == "relative":
        apart = _relative
    else:
        apart = partial(_root_mean_square, cells, MAPPINGS[cast("Metric", metric)])
    below, grazing = (
        apart(f.values, g.values, measured & part) for part in (~cells.grazing, cells.grazing)
    )
    return Difference(below, grazing)


Mapping = Callable[[Array, Angle, Angle], Array]
"""Of samples, with the cosines of their directions."""
MAPPINGS: dict[Metric, Mapping] = {
    "cosine": lambda f, cos_i, _: f * cos_i,
    "cube-root": lambda f, cos_i, _: np.cbrt(f * cos_i),
    "log": lambda f, cos_i, _: np.log1p(f * cos_i),
    "log-relative": lambda f, cos_i, cos_o: np.log(
        f * np.maximum(cos_i * cos_o, EPSILON) + EPSILON
    ),
}
METRICS: tuple[str, ...] = get_args(Metric)


def _root_mean_square(cells: Cells, mapping: Mapping, f: Table, g: Table, counts: Mask) -> float:
    total = weight = 0.0
    for f_c, g_c, counts_c in zip(f, g, counts, strict=True):
        solid_angle, cos_i, cos_o, _ = (array[counts_c] for array in cells)
        a, b = (mapping(x[counts_c].astype(np.float64), cos_i, cos_o) for x in (f_c, g_c))
        total += solid_angle @ (a - b) ** 2
        weight += solid_angle.sum()
    return float(np.sqrt(total / weight)) if weight else float("nan")


def _relative(f: Table, g: Table, counts: Mask) -> float:
    """``|f - g| / |f|``, the mean of the channels.

    M. da Silva Nunes, G. F. Miranda Jr., B. Trinchão Andrade, "Using Dimensionality Reduction to Create New Materials
    from Tabular BRDFs", Table I, which gives no formula; there f and g have the library's centroid subtracted.
    """
    norms, distances = (
        np.linalg.norm(np.where(counts, x, 0).reshape(3, -1).astype(np.float64), axis=1)
        for x in (f, f - g)
    )
    return float((distances / norms).mean()) if norms.all() else float("nan")
