"""Tabular BRDFs: samples on a grid of half/difference angles.

A sample stands at its cell's centre, and NaN means unmeasured. Trilinear interpolation runs between the centres and
renormalises over the corners that are measured:

    f = sum_j w_j v_j / sum_j w_j        over the corners j with v_j measured

so an unmeasured sample never blends into a value, and a table agrees in the mean with the floor lookup of the
database's own reader.
"""

import hashlib
import math
from dataclasses import dataclass
from typing import Literal

import numpy as np

from .._types import Directions, Part, Table, Values
from ..errors import FormatError
from ..halfdiff import Grid, above_horizon
from .brdf import Brdf

Interpolation = Literal["trilinear", "floor"]


@dataclass(frozen=True, eq=False)
class TabularBrdf(Brdf):
    """The samples of one material on a grid.

    Parameters
    ----------
    values : float32 array, shape (3, *grid.shape)
        f_r in 1/sr at the cell centres; NaN where unmeasured. Made read-only.
    grid : Grid
        Where the samples stand.
    name : str
        What the material is called.

    Examples
    --------
    >>> import numpy as np
    >>> from halfway import MERL, TabularBrdf
    >>> white = TabularBrdf(np.full((3, *MERL.shape), 1 / np.pi, np.float32), MERL, name="white")
    >>> up = np.array([0.0, 0.0, 1.0])
    >>> white.eval(up, up).round(4).tolist()
    [0.3183, 0.3183, 0.3183]
    """

    values: Table
    grid: Grid
    name: str = ""

    def __post_init__(self) -> None:
        expected = (3, *self.grid.shape)
        if self.values.shape != expected:
            raise FormatError(
                f"the table {self.name!r} has shape {self.values.shape}: a {self.grid} grid takes {expected}."
            )
        values = np.asarray(self.values, np.float32).view()
        values.flags.writeable = False
        object.__setattr__(self, "values", values)

    def __repr__(self) -> str:
        return f"TabularBrdf({self.name!r}, {self.grid})"

    @property
    def is_isotropic(self) -> bool:
        return self.grid.is_isotropic

    @property
    def about(self) -> str:
        nothing = ", nothing is measured" if np.isnan(self.values).all() else ""
        return f"a table of {self.grid} cells{nothing}"

    def eval(
        self, wi: Directions, wo: Directions, *, interpolation: Interpolation = "trilinear"
    ) -> Values:
        """f_r in 1/sr, shape (..., 3): 0 below the horizon, NaN where no corner is measured.

        ``floor`` is the lookup of the database's own reader and of pbrt-v2, for comparison.
        """
        lookups = {"trilinear": self.grid.multilinear, "floor": self.grid.floor}
        if interpolation not in lookups:
            raise FormatError(
                f"there is no interpolation {interpolation!r}: expected {' or '.join(lookups)}."
            )
        lookup = lookups[interpolation]
        return above_horizon(lambda i, o: lookup(i, o).blend(self.values), wi, wo)

    def fingerprint(self) -> bytes:
        return hashlib.sha256(np.ascontiguousarray(self.values).data).digest()

    @property
    def own_grid(self) -> Grid:
        return self.grid

    def scaled(self, factor: float) -> "TabularBrdf":
        return TabularBrdf(self.values * np.float32(factor), self.grid, name=self.name)

    def turned_mean(self) -> "TabularBrdf":
        if self.is_isotropic:
            return self
        axis = self.grid.axes.index(self.grid.axis("phi_h"))
        measured = ~np.isnan(self.values)
        counts = measured.sum(axis=1 + axis)
        total = np.sum(self.values, axis=1 + axis, where=measured, dtype=np.float64)
        means = np.divide(total, counts, out=np.full_like(total, np.nan), where=counts > 0)
        return TabularBrdf(means.astype(np.float32), self.grid.without("phi_h"), name=self.name)

    def _sample_rows(self, grid: Grid, rows: Part) -> Table:
        if grid != self.grid:
            return super()._sample_rows(grid, rows)
        return self.values[(slice(None), *(rows if isinstance(rows, tuple) else (rows,)))]


LARGEST_HALF = 60_000.0
"""A half float reaches 65,504; a value may be rounded up and must stay below."""


def half_scale(largest: float) -> float:
    """The scale at which values up to ``largest`` are kept as half floats, value / scale: 1 for all that fit.

    A power of two, so that dividing by it loses nothing; 11 significant bits are at most .05 % off.
    """
    return 2.0 ** max(0, math.ceil(math.log2(largest / LARGEST_HALF))) if largest > 0 else 1.0


def tabulate(brdf: Brdf, grid: Grid, *, name: str = "") -> TabularBrdf:
    """The table of any BRDF on a grid: its values at the cell centres, NaN off the grid's mask."""
    return TabularBrdf(brdf.sample_rows(grid, slice(None)), grid, name=name)
