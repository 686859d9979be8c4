"""Small tables of a library's materials: what pictures of mixes are made from where pictures do not mix.

A blend that is not linear mixes tables, and a route asks for the pictures of hundreds of mixes. So each material is
sampled on a grid that is as fine as the database's along theta_h, where highlights are, and coarse along the other angles,
where materials are smooth. There every cell has a value, an unmeasured one that of its neighbour nearer to the normal, and
a picture is two products with sparse matrices.
"""

from collections.abc import Callable
from functools import lru_cache, partial
from typing import Any

import numpy as np
from jaxtyping import Float, Float32, Float64, Int

from ..brdf import TabularBrdf, gloss
from ..halfdiff import Corners, Grid
from ..library import Library
from ..recipes import Blend, Recipe, aligned_mean, with_body
from ..tasks import HERE, Work
from .samples import body_mask

SMALL_GRID = Grid.merl(90, 15, 18)
N_PHI_H = 24
"""Cells along phi_h in a whole turn, of materials that depend on it."""
N_KEPT = 256
"""Tables kept in memory: .3 MB each, and as much again twice for body and gloss; fewer where they are larger."""

WIDER = 0.01
"""Of the logarithm of a width: by how much one is made wider to see what that changes."""


def small_grid(grid: Grid) -> Grid:
    """The grid of the small tables of materials on ``grid``."""
    if grid.is_isotropic:
        return SMALL_GRID
    period = grid.axis("phi_h").stop
    return Grid.anisotropic(48, round(N_PHI_H * period / (2 * np.pi)), 8, 10, period=period)


class SmallMixes:
    """Mixes of small tables, or of some columns of them: a column is all theta_h where the other angles are the same.

    ``row`` and ``parts`` have the tables of materials, by their place in the library, and their body and gloss.
    """

    def __init__(
        self,
        row: Callable[[int], Float32[np.ndarray, "3 p"]],
        parts: Callable[[int], gloss.Gloss],
        grid: Grid,
    ) -> None:
        self._row, self._parts = row, parts
        self.grid = grid

    def on(self, columns: Int[np.ndarray, " n"]) -> "SmallMixes":
        """The same on these columns alone."""
        n = self.grid.axis("theta_h").size

        def row(i: int) -> Float32[np.ndarray, "3 p"]:
            whole = self._row(i).reshape(3, n, -1)
            return np.take(whole, columns, axis=-1).reshape(3, -1)

        def parts(i: int) -> gloss.Gloss:
            whole = self._parts(i)
            body, lobe = (np.take(each, columns, axis=-1) for each in whole[:2])
            return gloss.Gloss(body, lobe, whole.width)

        return SmallMixes(lru_cache(N_KEPT)(row), lru_cache(N_KEPT)(parts), self.grid)

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

    def about(
        self, weights: Float64[np.ndarray, " N"], blend: Blend, among: Int[np.ndarray, " n"]
    ) -> tuple[Float32[np.ndarray, "3 p"], Float32[np.ndarray, "n 3 p"]]:
        """The small table of a mix with the same weights in every channel, and how it changes towards each material ``among``.

        About weights w, of materials g_i that are stretched to the width s where the blend aligns,

            f = m^-1(M)        M = sum_i w_i m(g_i)        log s = sum_i w_i log s_i

            d/de f((1 - e) w + e e_k) = (m^-1)'(M) (m(g_k) - M + log(s_k / s) dM/dlog s)

        All that are in the mix are among them.
        """
        few = weights[among]
        log_widths = self._log_widths(among, blend)
        log_width = float(few @ log_widths)
        mapped = self._mapped(among, blend, log_width)
        mean = _mean(few, mapped)
        used = few > 0
        wider = _mean(few[used], self._mapped(among[used], blend, log_width + WIDER))
        by_width = (log_widths - log_width).astype(np.float32) / WIDER
        towards = mapped - mean
        towards += by_width[:, None, None] * (wider - mean)
        return blend.mapping.back(mean), blend.mapping.slope(mean) * towards

    def _log_widths(self, which: Int[np.ndarray, " n"], blend: Blend) -> Float64[np.ndarray, " n"]:
        """The logarithms of the widths of highlights; 0 where the blend leaves them as they are."""
        if not blend.aligns:
            return np.zeros(len(which))
        return np.log([self._parts(i).width for i in which.tolist()])

    def _mapped(
        self, which: Int[np.ndarray, " n"], blend: Blend, log_width: float
    ) -> Float32[np.ndarray, "n 3 p"]:
        """Materials in the blend's mapping, all of one width where it aligns."""
        if blend.aligns:
            width = float(np.exp(log_width))
            tables = [self._parts(i).stretched(width, self.grid) for i in which.tolist()]
        else:
            tables = [self._row(i) for i in which.tolist()]
        return blend.mapping.to(np.stack(tables).reshape(len(tables), 3, -1))


class SmallTables(SmallMixes):
    """The small tables of a library, read when they are asked for."""

    def __init__(self, library: Library, *, work: Work = HERE) -> None:
        self._library = library
        grid = small_grid(library.grid)
        n_kept = N_KEPT * SMALL_GRID.size // grid.size
        row = lru_cache(n_kept)(partial(_kept, library, work))
        super().__init__(row, lru_cache(n_kept)(self._parted), grid)

    def __reduce__(self) -> tuple[Any, ...]:
        """They travel without what they keep."""
        return SmallTables, (self._library,)

    def _parted(self, i: int) -> gloss.Gloss:
        return gloss.Gloss.of(self._row(i), self.grid)

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


def _mean(
    weights: Float64[np.ndarray, " n"], mapped: Float32[np.ndarray, "n 3 p"]
) -> Float32[np.ndarray, "3 p"]:
    return np.tensordot(weights.astype(np.float32), mapped, axes=1)


def _kept(library: Library, work: Work, i: int) -> Float32[np.ndarray, "3 p"]:
    shape = "x".join(map(str, small_grid(library.grid).shape))
    key = f"small-1-{shape}-{library.material_checksums[i]}"
    return work.cached(key, lambda: {"table": _small(library, i)})["table"]


def _small(library: Library, i: int) -> Float32[np.ndarray, "3 p"]:
    grid = small_grid(library.grid)
    values = np.full((3, *grid.shape), np.nan, np.float32)
    values[:, grid.mask()] = _lookup(library.grid).blend(
        library.row(i).reshape(3, *library.grid.shape)
    )
    lobes = gloss.to_lobes(values, grid)
    for row, following in zip(
        lobes[:, :-1].swapaxes(0, 1), lobes[:, 1:].swapaxes(0, 1), strict=True
    ):
        np.copyto(following, row, where=np.isnan(following))
    return np.nan_to_num(lobes.reshape(3, -1), nan=0.0)


@lru_cache(maxsize=1)  # 2 MB; of materials that depend on phi_h, 18 MB
def _lookup(grid: Grid) -> Corners:
    """Where in tables on ``grid`` the measurable cells of the small ones are."""
    small = small_grid(grid)
    wi, wo = (directions[small.mask()] for directions in small.directions())
    return grid.multilinear(wi, wo)
