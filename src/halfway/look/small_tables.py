"""Small tables of a library's materials: what pictures of mixes are made from where pictures do not mix.

A blend that is not linear mixes tables, and a route asks for the pictures of hundreds of mixes. So each material is
sampled on a grid that is as fine as the database's along theta_h, where highlights are, and coarse along the other angles,
where materials are smooth. There every cell has a value, an unmeasured one that of its neighbour nearer to the normal, and
a picture is two products with sparse matrices.
"""

from functools import lru_cache, partial
from typing import Any

import numpy as np
from jaxtyping import Float, Float32

from ..brdf import TabularBrdf, gloss, tabulate
from ..halfdiff import Grid
from ..library import Library
from ..recipes import Blend, Recipe, aligned_mean, with_body
from ..tasks import HERE, Work
from .samples import body_mask

SMALL_GRID = Grid.merl(90, 15, 18)
N_PHI_H = 24
"""Cells along phi_h in a whole turn, of materials that depend on it."""
N_KEPT = 256
"""Tables kept in memory: .3 MB each, and as much again twice for body and gloss; fewer where they are larger."""


def small_grid(grid: Grid) -> Grid:
    """The grid of the small tables of materials on ``grid``."""
    if grid.is_isotropic:
        return SMALL_GRID
    period = grid.axis("phi_h").stop
    return Grid.anisotropic(48, round(N_PHI_H * period / (2 * np.pi)), 8, 10, period=period)


class SmallTables:
    """The small tables of a library, read when they are asked for."""

    def __init__(self, library: Library, *, work: Work = HERE) -> None:
        self._library = library
        self.grid = small_grid(library.grid)
        n_kept = N_KEPT * SMALL_GRID.size // self.grid.size
        self._row = lru_cache(n_kept)(partial(_kept, library, work))
        self._parts = lru_cache(n_kept)(self._parted)

    def __reduce__(self) -> tuple[Any, ...]:
        """They travel without what they keep."""
        return SmallTables, (self._library,)

    def _parted(self, i: int) -> gloss.Gloss:
        return gloss.Gloss.of(self._row(i), self.grid)

    def mix(
        self, weights: Float[np.ndarray, "3 k N"], blend: Blend
    ) -> Float32[np.ndarray, "3 k p"]:
        """The small tables of k mixes, given by their weights over all materials."""
        used = np.flatnonzero(weights.any(axis=(0, 1))).tolist()
        few = weights[..., used]
        if blend.aligns:
            parts = [self._parts(i) for i in used]
            mixes = (
                aligned_mean(parts, each, blend.mapping, self.grid) for each in few.swapaxes(0, 1)
            )
            return np.stack(list(mixes), axis=1)
        mapped = blend.mapping.to(np.stack([self._row(i) for i in used], axis=1))
        return blend.mapping.back(few.astype(np.float32) @ mapped)

    def of(self, recipe: Recipe) -> Float32[np.ndarray, "3 p"]:
        """The small table of a recipe."""
        mixed = self.mix(recipe.dense(self._library.names)[:, None], recipe.blend)
        return with_body(mixed[:, 0], recipe.body_scale, self.grid)

    def table(self, recipe: Recipe) -> TabularBrdf:
        """The same, unmeasured where the grid is: below the horizon a small table has the values of neighbours."""
        values = self.of(recipe).reshape(3, *self.grid.shape)
        return TabularBrdf(np.where(self.grid.mask(), values, np.float32(np.nan)), self.grid)

    def body_colour(
        self, weights: Float[np.ndarray, "3 k N"], blend: Blend
    ) -> Float[np.ndarray, "k 3"]:
        """Body colours of k mixes, 1/sr."""
        cells = np.flatnonzero(body_mask(self.grid))
        return self.mix(weights, blend)[..., cells].mean(axis=-1, dtype=np.float64).T


def _kept(library: Library, work: Work, i: int) -> Float32[np.ndarray, "3 p"]:
    shape = "x".join(map(str, small_grid(library.grid).shape))
    key = f"small-1-{shape}-{library.material_checksums[i]}"
    return work.cached(key, lambda: {"table": _small(library, i)})["table"]


def _small(library: Library, i: int) -> Float32[np.ndarray, "3 p"]:
    table = TabularBrdf(library.row(i).reshape(3, *library.grid.shape), library.grid)
    grid = small_grid(library.grid)
    lobes = gloss.to_lobes(np.array(tabulate(table, grid).values), grid)
    for row, following in zip(
        lobes[:, :-1].swapaxes(0, 1), lobes[:, 1:].swapaxes(0, 1), strict=True
    ):
        np.copyto(following, row, where=np.isnan(following))
    return np.nan_to_num(lobes.reshape(3, -1), nan=0.0)
