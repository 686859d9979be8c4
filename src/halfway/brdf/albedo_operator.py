"""Directional albedo of many tables: a linear function of the samples, worked out once for a grid.

    a(theta_i) = sum over cells of w(theta_i, cell) f(cell)

The weights are those of `directional_albedo` (`Functional.albedo`). A table that is turned by cells of phi_h is another table
on the same grid: so one set of weights serves every azimuth of the light.
"""

from collections.abc import Iterator
from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from jaxtyping import Float64

from .._types import Mask
from ..halfdiff import Grid
from .quadrature import Functional
from .table import TabularBrdf

N_AZIMUTHS = 8
"""Of the light within the period of phi_h; an albedo is smooth along it."""


@dataclass(frozen=True, eq=False)
class AlbedoOperator:
    """What each cell contributes to the albedo from each direction."""

    theta_i: Float64[np.ndarray, " n"]
    rows: tuple[Functional, ...]

    @classmethod
    def of(cls, grid: Grid, measured: Mask, theta_i: Float64[np.ndarray, " n"]) -> "AlbedoOperator":
        """The operator for tables whose measured cells are ``measured``, shape `grid.shape`; the azimuth is 0."""
        return cls(
            theta_i, tuple(Functional.albedo(grid, measured, float(theta)) for theta in theta_i)
        )

    def apply(self, samples: np.ndarray) -> Float64[np.ndarray, "c n"]:
        """Albedos of tables, shape (c, n_cells)."""
        flat = samples.reshape(len(samples), -1)
        return np.stack([row.of(flat) for row in self.rows], axis=1)


def albedos(table: TabularBrdf, theta_i: Float64[np.ndarray, " n"]) -> Float64[np.ndarray, "n 3"]:
    """`directional_albedo` of a table, from its worst azimuth; fast where the unmeasured cells are those of the grid."""
    return np.max([_albedos(each, theta_i) for each in _turned(table)], axis=0)


def _turned(table: TabularBrdf) -> Iterator[TabularBrdf]:
    """A table, turned so that the light comes from other azimuths; itself where they do not matter."""
    if table.is_isotropic:
        yield table
        return
    axis = table.grid.axes.index(table.grid.axis("phi_h"))
    n = table.grid.shape[axis]
    for i in range(0, n, max(1, n // N_AZIMUTHS)):
        yield TabularBrdf(np.roll(table.values, -i, axis=1 + axis), table.grid)


def _albedos(table: TabularBrdf, theta_i: Float64[np.ndarray, " n"]) -> Float64[np.ndarray, "n 3"]:
    measured = ~np.isnan(table.values)
    if all(np.array_equal(channel, table.grid.mask()) for channel in measured):
        return _of_grid(table.grid, tuple(theta_i)).apply(table.values).T
    if all(np.array_equal(channel, measured[0]) for channel in measured):
        operator = AlbedoOperator.of(table.grid, measured[0], theta_i)
        return operator.apply(table.values).T
    channels = [
        AlbedoOperator.of(table.grid, mask, theta_i).apply(samples[None])[0]
        for mask, samples in zip(measured, table.values, strict=True)
    ]
    return np.stack(channels, axis=1)


@lru_cache(maxsize=4)
def _of_grid(grid: Grid, theta_i: tuple[float, ...]) -> AlbedoOperator:
    return AlbedoOperator.of(grid, grid.mask(), np.array(theta_i))
