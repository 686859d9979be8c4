"""Readings: what the instruments say of a table, or of every material of a library, in each channel.

Everything that is said of a material is a function of these few numbers. Each is linear in the table, so the readings of a
linear mix are the mix of the readings (exactly where the materials are measured on the same cells).
"""

from collections.abc import Collection
from dataclasses import dataclass
from functools import lru_cache, partial
from typing import NamedTuple

import numpy as np
from jaxtyping import Float, Float64, Int

from ..brdf import TabularBrdf, quadrature
from ..errors import RecipeError
from ..halfdiff import Grid
from ..library import Library
from ..recipes import Blend
from ..tasks import HERE, Work
from .attribute import Reading
from .functionals import INSTRUMENTS, VERSION, functionals


@dataclass(frozen=True, eq=False)
class Readings:
    """The readings of all materials of a library."""

    names: tuple[str, ...]
    """The materials, in the library's order."""
    values: Float64[np.ndarray, "N n_instruments 3"]

    @classmethod
    def fit(cls, library: Library, *, work: Work = HERE) -> "Readings":
        """The readings of ``library``; kept in the cache under its checksum."""

        def compute() -> dict[str, np.ndarray]:
            tasks = work.run(partial(_row, library), range(len(library)), label="Attributes")
            return {"values": np.stack(list(tasks))}

        key = f"readings-{VERSION}-{library.checksum}"
        return cls(library.names, work.cached(key, compute)["values"])

    def mix(self, weights: Float[np.ndarray, "3 *k N"], blend: Blend) -> Reading:
        """The readings of recipes, given by their weights over all materials.

        Raises
        ------
        RecipeError
            When the readings of a blend are not those of its materials, mixed.
        """
        if blend is not Blend.LINEAR:
            raise RecipeError(
                f"readings cannot be mixed in the blend {str(blend)!r}: expected 'linear'. Read the mixed table instead."
            )
        used = weights.any(axis=tuple(range(weights.ndim - 1)))  # others may be unmeasured
        few = self.values[used]
        return np.einsum("c...n,nfc->...fc", weights[..., used], few)


class Reader(NamedTuple):
    """Some instruments at tables that are measured wherever their grid is, of which they need some columns.

    A column is all theta_h where the other angles are the same.
    """

    columns: Int[np.ndarray, " n_columns"]
    which: list[int]
    """Of `INSTRUMENTS`."""
    functionals: list[quadrature.Functional]
    """Of these columns, theta_h first."""

    @classmethod
    def of(cls, names: Collection[str], grid: Grid, *, whole: bool = False) -> "Reader":
        """The instruments of these names, at tables on ``grid``; with all columns of ``whole`` ones."""
        which = [i for i, name in enumerate(INSTRUMENTS) if name in names]
        rows = [_of_grid(grid)[i] for i in which]
        n = grid.size // grid.axis("theta_h").size
        needed = [np.arange(n)] if whole else [row.cells % n for row in rows]
        columns = np.unique(np.concatenate(needed))
        few = [
            row._replace(cells=row.cells // n * len(columns) + columns.searchsorted(row.cells % n))
            for row in rows
        ]
        return cls(columns, which, few)

    def read(
        self, values: Float[np.ndarray, "*k 3 p"]
    ) -> Float64[np.ndarray, "*k n_instruments 3"]:
        """The readings of tables of which these columns are given; NaN of other instruments."""
        *many, _, _ = values.shape
        readings = np.full((len(INSTRUMENTS), *many, 3), np.nan)
        channels = values.reshape(-1, values.shape[-1])
        if self.which:
            readings[self.which] = _read(self.functionals, channels).reshape(-1, *many, 3)
        return np.moveaxis(readings, 0, -2)


def read_table(table: TabularBrdf) -> Reading:
    """The readings of a table; of one that depends on phi_h, as an instrument reads the mean over turns of the sample."""
    table = table.turned_mean()
    measured = ~np.isnan(table.values)
    usual = table.grid.mask()
    if all(np.array_equal(channel, usual) for channel in measured):
        return _read(_of_grid(table.grid), table.values.reshape(3, -1))
    channels = [
        _read(functionals(table.grid, mask), samples.reshape(1, -1))
        for mask, samples in zip(measured, table.values, strict=True)
    ]
    return np.concatenate(channels, axis=1)


def _row(library: Library, i: int) -> Reading:
    samples = library.row(i).reshape(3, *library.grid.shape)
    return read_table(TabularBrdf(samples, library.grid))


def _read(
    rows: list[quadrature.Functional], samples: Float[np.ndarray, "c p"]
) -> Float64[np.ndarray, "n c"]:
    nothing = np.full(len(samples), np.nan)
    return np.stack([row.of(samples) if len(row.cells) else nothing for row in rows])


@lru_cache(maxsize=4)  # 5 MB each on the MERL grid
def _of_grid(grid: Grid) -> list[quadrature.Functional]:
    """Of tables that are measured wherever their grid is; of their mean over phi_h, if it has that."""
    if grid.is_isotropic:
        return functionals(grid, grid.mask())
    axis = grid.axes.index(grid.axis("phi_h"))
    n = grid.shape[axis]
    turned = np.moveaxis(np.arange(grid.size).reshape(grid.shape), axis, -1).reshape(-1, n)
    return [
        quadrature.Functional(turned[row.cells].ravel(), np.repeat(row.weights / n, n))
        for row in _of_grid(grid.without("phi_h"))
    ]
