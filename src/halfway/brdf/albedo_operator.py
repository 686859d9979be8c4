"""Directional albedo of many tables: a linear function of the samples, worked out once for a grid.

    a(theta_i) = sum over cells of w(theta_i, cell) f(cell)

The weights are those of `directional_albedo`: the midpoint rule over half vectors, each node spread over the corners of
its trilinear lookup that are measured. They depend on which cells are measured, not on what is in them.
"""

from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from jaxtyping import Float64

from .._types import Indices, Mask
from ..halfdiff import Grid
from .brdf import require_isotropic
from .quadrature import HalfVectors
from .table import TabularBrdf

N_THETA_H = 360
N_PHI_H = 60


@dataclass(frozen=True, eq=False)
class AlbedoOperator:
    """What each cell contributes to the albedo from each direction."""

    theta_i: Float64[np.ndarray, " n"]
    cells: tuple[Indices, ...]
    weights: tuple[Float64[np.ndarray, "_"], ...]

    @classmethod
    def of(cls, grid: Grid, measured: Mask, theta_i: Float64[np.ndarray, " n"]) -> "AlbedoOperator":
        """The operator for tables whose measured cells are ``measured``, shape `grid.shape`.

        Raises
        ------
        AnisotropyError
            When tables on the grid depend on the light's azimuth.
        """
        require_isotropic(grid, "its albedo", name=f"a table on a grid of {grid} cells")
        rows = [_row(grid, measured.ravel(), float(theta)) for theta in theta_i]
        return cls(
            theta_i, tuple(cells for cells, _ in rows), tuple(weights for _, weights in rows)
        )

    def apply(self, samples: np.ndarray) -> Float64[np.ndarray, "c n"]:
        """Albedos of tables, shape (c, n_cells)."""
        flat = samples.reshape(len(samples), -1)
        rows = [
            np.take(flat, cells, axis=1).astype(np.float64) @ weights
            for cells, weights in zip(self.cells, self.weights, strict=True)
        ]
        return np.stack(rows, axis=1)


def albedos(table: TabularBrdf, theta_i: Float64[np.ndarray, " n"]) -> Float64[np.ndarray, "n 3"]:
    """`directional_albedo` of a table; fast where the unmeasured cells are those of the grid."""
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


def _row(grid: Grid, measured: Mask, theta_i: float) -> tuple[Indices, Float64[np.ndarray, "_"]]:
    rule = HalfVectors.at(theta_i, N_THETA_H, N_PHI_H)
    corners = grid.multilinear(rule.fixed, rule.other)
    weights = np.where(measured[corners.cells], corners.weights, 0)
    total = weights.sum(axis=0)
    shares = np.divide(weights, total, out=np.zeros_like(weights), where=total > 0)
    sums = np.bincount(corners.cells.ravel(), (rule.weights * shares).ravel(), minlength=grid.size)
    cells = np.flatnonzero(sums)
    return cells, sums[cells]
